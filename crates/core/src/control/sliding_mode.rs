//! Sliding mode control of outputs through more inputs than outputs.

use super::Real;
use crate::model::SizeError;
use core::fmt;

/// Sliding mode control of `m` outputs `p` that `n ≥ m` inputs `T` move (Mu & Wu 2004, equations 31 to 34; with `m = n` and `C = M⁻¹`
/// that of Tzafestas, Raibert & Tzafestas 1996 in joint space):
///
/// ```text
/// p̈ = b + C (T − N)                                                  the plant as the controller believes it to be
/// e = p − p_d,    s = ė + 2λe + λ²∫e,    u = p̈_d − 2λė − λ²e
/// T = T₀ + C⁻ (u − b − C (T₀ − N) − tanh(αs) ∘ (|C| η + σ)),    C⁻ = W Cᵀ (C W Cᵀ)⁻¹
/// ```
///
/// Of all inputs that give the outputs the acceleration asked for, these are nearest to `T₀`: they have the least `Σ (Tᵢ − T₀ᵢ)²/wᵢ`.
/// With `T₀ = N` and equal weights that is equation 34; with `T₀ = 0` the inputs themselves are the least. What is added to `T₀` along the
/// null space of `C`, such as the forces that a closed chain is braced with, goes on to the inputs and moves no output.
///
/// While `s = 0` the errors obey `(d/dt + λ)² ∫e = 0`. If the plant is another, so that with an error `Δ` of the inputs
/// `|Δᵢ| ≤ ηᵢ`, the term in `tanh` leads `s` into a boundary layer (equations 35 to 37) and keeps it there.
///
/// A cart of 2 kg pushed by two thrusters, one of them twice as strong as the other, at rest where it should be:
///
/// ```
/// use gyroflex::control::{InputOutput, Outputs, SlidingMode, SlidingScratch};
///
/// let mut law = SlidingMode {
///     lambda: &[10.0],
///     steepness: &[10.0],
///     sigma: &[1.0],
///     eta: &[0.1, 0.1],
///     weights: &[1.0, 1.0],
///     independence: 1e-12,
///     integral: &mut [0.0],
/// };
/// // A head wind of 3 N is known.
/// let plant = InputOutput { drift: &[-3.0 / 2.0], gain: &[0.5, 1.0], bias: &[0.0; 2], preferred: &[0.0; 2] };
/// let here = Outputs { p: &[0.0], pd: &[0.0] };
/// let (mut sliding, mut matrix, mut thrust) = ([0.0], [0.0; 2], [0.0; 2]);
/// let scratch = SlidingScratch { sliding: &mut sliding, matrix: &mut matrix };
/// law.tick(plant, here, &[0.0], here, 1e-3, scratch, &mut thrust)?;
/// // The least commands that hold the cart against it: 0.6 and 2 × 1.2 N.
/// assert!((thrust[0] - 0.6_f64).abs() < 1e-12 && (thrust[1] - 1.2).abs() < 1e-12);
/// # Ok::<(), gyroflex::control::SlidingModeError>(())
/// ```
#[derive(Debug)]
pub struct SlidingMode<'a, T> {
    /// `λ`: how fast errors die out on the sliding surface, `m` entries [1/s].
    pub lambda: &'a [T],
    /// `α`: how steep the boundary layer is, `m` entries [s per unit of the output]; about `2/α` wide.
    pub steepness: &'a [T],
    /// `σ`: acceleration to reach the surface with, `m` entries [unit of the output/s²].
    pub sigma: &'a [T],
    /// `η`: bounds of what the model's errors are worth at the inputs, `n` entries [unit of the input].
    pub eta: &'a [T],
    /// `w`: how freely an input is used, `n` entries, not negative [squared unit of the input]. One whose weight is zero stays at `T₀`.
    pub weights: &'a [T],
    /// What an output must be able to do apart from the outputs before it, as a share of the square of its row of `C`, below which
    /// [`SlidingModeError::Dependent`] says so [–]: some hundred roundings, as 1e-12 in `f64` and 1e-4 in `f32`.
    pub independence: T,
    /// `∫e`, the state of the law: `m` entries [unit of the output · s]; zero at the start.
    pub integral: &'a mut [T],
}

/// What a controller believes of the plant now: `p̈ = b + C (T − N)`.
#[derive(Clone, Copy, Debug)]
pub struct InputOutput<'a, T> {
    /// `b`: accelerations of the outputs with `T = N`, `m` entries [unit of the output/s²]; `B ṗ` of Mu & Wu, equation 19.
    pub drift: &'a [T],
    /// `C` by rows: a row an output, a column an input.
    pub gain: &'a [T],
    /// `N`: inputs that hold what acts already, as gravity and centrifugal forces, `n` entries [unit of the input].
    pub bias: &'a [T],
    /// `T₀`: inputs to stay near to, `n` entries [unit of the input]; the same as `bias` in Mu & Wu.
    pub preferred: &'a [T],
}

/// Outputs to follow, or measured ones: `m` entries each.
#[derive(Clone, Copy, Debug)]
pub struct Outputs<'a, T> {
    /// `p` [unit of the output].
    pub p: &'a [T],
    /// `ṗ` [unit of the output/s].
    pub pd: &'a [T],
}

/// What [`SlidingMode::tick`] works in.
#[derive(Debug)]
pub struct SlidingScratch<'a, T> {
    /// `s`, left for the caller to look at: `m` entries [unit of the output/s].
    pub sliding: &'a mut [T],
    /// `C W Cᵀ` and what is solved with it: `m (m + 1)` entries.
    pub matrix: &'a mut [T],
}

/// Why there are no inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlidingModeError {
    /// A slice is of the wrong length.
    Size(SizeError),
    /// The inputs cannot move this output apart from the ones before it: `C` has lost rank.
    Dependent {
        /// The output.
        output: usize,
    },
}

impl From<SizeError> for SlidingModeError {
    fn from(error: SizeError) -> Self {
        Self::Size(error)
    }
}

impl fmt::Display for SlidingModeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(error) => error.fmt(f),
            Self::Dependent { output } => {
                write!(f, "the inputs cannot move output {output} apart from the outputs before it")
            }
        }
    }
}

impl core::error::Error for SlidingModeError {}

impl<T: Real> SlidingMode<'_, T> {
    /// Writes the inputs `T` (`n` entries) for the motion asked for and the one measured now, and goes on with `∫e` by `step`, the time to the
    /// next tick [s]. `acceleration` is `p̈_d` (`m` entries).
    ///
    /// # Errors
    /// [`SlidingModeError`]; inputs and `∫e` are as they were then.
    #[expect(clippy::too_many_arguments, reason = "each is a thing of its own")]
    pub fn tick(
        &mut self,
        plant: InputOutput<T>,
        desired: Outputs<T>,
        acceleration: &[T],
        measured: Outputs<T>,
        step: T,
        scratch: SlidingScratch<T>,
        input: &mut [T],
    ) -> Result<(), SlidingModeError> {
        let (m, n) = (self.lambda.len(), self.eta.len());
        let SlidingScratch { sliding, matrix } = scratch;
        let lengths = [
            ("steepness", self.steepness.len(), m),
            ("sigma", self.sigma.len(), m),
            ("weights", self.weights.len(), n),
            ("integral", self.integral.len(), m),
            ("drift", plant.drift.len(), m),
            ("gain", plant.gain.len(), m * n),
            ("bias", plant.bias.len(), n),
            ("preferred", plant.preferred.len(), n),
            ("p desired", desired.p.len(), m),
            ("pd desired", desired.pd.len(), m),
            ("acceleration", acceleration.len(), m),
            ("p", measured.p.len(), m),
            ("pd", measured.pd.len(), m),
            ("sliding", sliding.len(), m),
            ("matrix", matrix.len(), m * (m + 1)),
            ("input", input.len(), n),
        ];
        lengths.into_iter().try_for_each(|(name, given, expected)| SizeError::check(name, given, expected))?;

        let (gram, asked) = matrix.split_at_mut((m * m).min(matrix.len()));
        for i in 0..m {
            let (e, ed) = (at(measured.p, i) - at(desired.p, i), at(measured.pd, i) - at(desired.pd, i));
            let lambda = at(self.lambda, i);
            let pull = lambda * (ed + ed + lambda * e);
            let s = ed + lambda * (e + e + lambda * at(self.integral, i));
            let (mut bound, mut held) = (at(self.sigma, i), T::zero());
            for (k, c) in row(plant.gain, i, n).iter().enumerate() {
                bound += c.select_less(T::zero(), -*c, *c) * at(self.eta, k);
                held += *c * (at(plant.preferred, k) - at(plant.bias, k));
            }
            let switching = (at(self.steepness, i) * s).tanh() * bound;
            put(sliding, i, s);
            put(asked, i, at(acceleration, i) - pull - at(plant.drift, i) - held - switching);
            for j in 0..=i {
                let weighted = row(plant.gain, i, n).iter().zip(row(plant.gain, j, n)).zip(self.weights);
                put(gram, i * m + j, weighted.fold(T::zero(), |sum, ((a, b), w)| sum + *a * *b * *w));
            }
        }
        solve(gram, asked, self.independence)?;
        for (k, slot) in input.iter_mut().enumerate() {
            let pushed = (0..m).fold(T::zero(), |sum, i| sum + at(plant.gain, i * n + k) * at(asked, i));
            *slot = at(plant.preferred, k) + at(self.weights, k) * pushed;
        }
        for (sum, (p, p_d)) in self.integral.iter_mut().zip(measured.p.iter().zip(desired.p)) {
            *sum += (*p - *p_d) * step;
        }
        Ok(())
    }
}

fn at<T: Real>(values: &[T], i: usize) -> T {
    values.get(i).map_or(T::zero(), |x| *x)
}

fn put<T>(values: &mut [T], i: usize, x: T) {
    if let Some(slot) = values.get_mut(i) {
        *slot = x;
    }
}

fn row<T>(matrix: &[T], i: usize, width: usize) -> &[T] {
    matrix.get(i * width..(i + 1) * width).unwrap_or(&[])
}

/// Solves in place with a positive definite matrix given by its lower triangle, by `L D Lᵀ` (Golub & Van Loan, §4.1.2). A pivot below
/// `independence` times its diagonal entry means that its row depends on the rows before.
fn solve<T: Real>(matrix: &mut [T], x: &mut [T], independence: T) -> Result<(), SlidingModeError> {
    let m = x.len();
    for i in 0..m {
        let diagonal = at(matrix, i * m + i);
        let mut pivot = diagonal;
        for j in 0..i {
            let mut entry = at(matrix, i * m + j);
            for k in 0..j {
                entry -= at(matrix, i * m + k) * at(matrix, j * m + k) * at(matrix, k * m + k);
            }
            let factor = entry / at(matrix, j * m + j);
            pivot -= factor * entry;
            put(matrix, i * m + j, factor);
        }
        // Neither is true of what is not a number.
        if !(pivot > independence * diagonal && diagonal.positive()) {
            return Err(SlidingModeError::Dependent { output: i });
        }
        put(matrix, i * m + i, pivot);
    }
    for i in 0..m {
        let done = (0..i).fold(at(x, i), |sum, k| sum - at(matrix, i * m + k) * at(x, k));
        put(x, i, done);
    }
    for i in (0..m).rev() {
        let start = at(x, i) / at(matrix, i * m + i);
        let done = (i + 1..m).fold(start, |sum, k| sum - at(matrix, k * m + i) * at(x, k));
        put(x, i, done);
    }
    Ok(())
}
