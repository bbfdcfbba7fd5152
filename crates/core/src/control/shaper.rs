//! Input shapers: trains of impulses that leave no vibration behind.

use super::Real;
use super::reference::Reference;

/// A mode that is not to be left vibrating.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode<T> {
    /// Natural frequency of the undamped mode, `|λ| / 2π` [Hz], > 0.
    pub frequency: T,
    /// Damping ratio `ζ` [–], from 0 to below 1.
    pub damping_ratio: T,
}

/// What a shaper is to achieve. With half a period of the damped mode `T/2 = π/ω_d` and its decay over it `K = exp(−ζπ/√(1−ζ²))`:
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaperKind<T> {
    /// No vibration at the mode's frequency (Smith 1957; Singer, Seering 1990): amplitudes `1, K` over `1 + K`, at 0 and `T/2`.
    Zv,
    /// No vibration there, and none to first order nearby (Singer, Seering 1990): `1, 2K, K²` over `(1 + K)²`, at 0, `T/2` and `T`.
    Zvd,
    /// Extra insensitive (Singhose, Seering, Singer 1994): some vibration at the mode's frequency, none at one a little lower and one a little
    /// higher, so that it stays below that over a wide band: `(1 + W)/4, (1 − W)/2 K, (1 + W)/4 K²`, over their sum, at 0, `T/2` and `T`.
    ///
    /// Undamped, `W` is the tolerance. Damped, `W` is chosen such that the vibration at the mode's frequency is the tolerance, up to
    /// `W = 1`; at its two sides it is then small, not zero, and the band as wide or wider. Up to `ζ = 0.1` it exceeds the tolerance by
    /// less than 0.2 % of it. This closed form is not the curve fit to numerical solutions that Singhose gives for damped modes.
    Ei {
        /// Vibration left at the mode's frequency, a share of that without shaping [–], between 0 and 1.
        tolerance: T,
    },
}

/// One impulse of a shaper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse<T> {
    /// Share of the motion that comes with it [–].
    pub amplitude: T,
    /// How much later it comes [s].
    pub delay: T,
}

/// Up to `N` impulses, which sum to 1: a motion is replaced by the sum of its delayed shares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaper<T, const N: usize> {
    impulses: [Impulse<T>; N],
    len: usize,
}

impl<T: Real, const N: usize> Shaper<T, N> {
    /// A single impulse, which leaves motions as they are.
    pub fn none() -> Self {
        let mut impulses = [Impulse { amplitude: T::zero(), delay: T::zero() }; N];
        if let Some(first) = impulses.first_mut() {
            first.amplitude = T::one();
        }
        Self { impulses, len: N.min(1) }
    }

    /// The shaper of one mode; `None` if a number is out of its range, or `N` is less than 2 (ZV) or 3.
    pub fn new(kind: ShaperKind<T>, mode: Mode<T>) -> Option<Self> {
        Self::none().and(kind, mode)
    }

    /// Shapes for one more mode: the convolution with its shaper, two or three times as many impulses. `None` as for
    /// [`Shaper::new`].
    pub fn and(self, kind: ShaperKind<T>, mode: Mode<T>) -> Option<Self> {
        let own = single(kind, mode)?;
        let mut out = Self { len: 0, ..Self::none() };
        for impulse in self.impulses() {
            for with in own.iter().filter(|i| i.amplitude > T::zero()) {
                *out.impulses.get_mut(out.len)? =
                    Impulse { amplitude: impulse.amplitude * with.amplitude, delay: impulse.delay + with.delay };
                out.len += 1;
            }
        }
        Some(out)
    }

    /// Its impulses, the first one without delay.
    pub fn impulses(&self) -> &[Impulse<T>] {
        self.impulses.get(..self.len).unwrap_or(&[])
    }

    /// Its last delay [s]: how much longer a motion takes.
    pub fn duration(&self) -> T {
        self.impulses().iter().fold(T::zero(), |most, i| if most < i.delay { i.delay } else { most })
    }

    /// Vibration of a mode after the last impulse, a share of that with which an impulse of 1 starts [–]:
    /// `e^(−ζω t_n) |Σ A_i e^(ζω t_i) e^(j ω_d t_i)|`.
    pub fn residual(&self, mode: Mode<T>) -> T {
        let omega = T::from_f64(core::f64::consts::TAU) * mode.frequency;
        let swing = omega * (T::one() - mode.damping_ratio * mode.damping_ratio).sqrt();
        let (mut re, mut im, end) = (T::zero(), T::zero(), self.duration());
        for impulse in self.impulses() {
            let (sin, cos) = (swing * impulse.delay).sin_cos();
            let left = impulse.amplitude * (mode.damping_ratio * omega * (impulse.delay - end)).exp();
            re += left * cos;
            im += left * sin;
        }
        (re * re + im * im).sqrt()
    }
}

/// The impulses for one mode; a third one of no amplitude for ZV.
fn single<T: Real>(kind: ShaperKind<T>, mode: Mode<T>) -> Option<[Impulse<T>; 3]> {
    let (zero, one, two) = (T::zero(), T::one(), T::from_f64(2.0));
    let zeta = mode.damping_ratio;
    if !(mode.frequency.positive() && zeta >= zero && zeta < one) {
        return None;
    }
    let root = (one - zeta * zeta).sqrt();
    let k = (-(zeta * T::from_f64(core::f64::consts::PI) / root)).exp();
    let half_period = one / (two * mode.frequency * root);
    let shares = match kind {
        ShaperKind::Zv => [one, k, zero],
        ShaperKind::Zvd => [one, two * k, k * k],
        ShaperKind::Ei { tolerance } => {
            if !(tolerance > zero && tolerance < one) {
                return None;
            }
            // W K² / Σ = tolerance, where Σ = (1+K)²/4 + W (1−K)²/4.
            let quarter = T::from_f64(0.25);
            let given = tolerance * quarter * (one + k) * (one + k);
            let slope = k * k - tolerance * quarter * (one - k) * (one - k);
            let w = if given < slope { given / slope } else { one };
            [quarter * (one + w), two * quarter * (one - w) * k, quarter * (one + w) * k * k]
        }
    };
    let sum = shares.into_iter().fold(zero, |sum, x| sum + x);
    let [a, b, c] = shares.map(|share| share / sum);
    Some([
        Impulse { amplitude: a, delay: zero },
        Impulse { amplitude: b, delay: half_period },
        Impulse { amplitude: c, delay: two * half_period },
    ])
}

/// A reference behind a shaper, `Σ A_i r(t − t_i)`, which has as many derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Shaped<'a, R, T, const N: usize> {
    /// The motion.
    pub reference: &'a R,
    /// The shaper.
    pub shaper: &'a Shaper<T, N>,
}

impl<T: Real, R: Reference<T>, const N: usize> Reference<T> for Shaped<'_, R, T, N> {
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]) {
        for impulse in self.shaper.impulses() {
            self.reference.add_derivatives(t - impulse.delay, weight * impulse.amplitude, out);
        }
    }

    fn smoothness(&self) -> Option<usize> {
        self.reference.smoothness()
    }
}
