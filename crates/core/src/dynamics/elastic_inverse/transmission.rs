//! From the torque through an elastic transmission to the position of its motor, as series.

use crate::dispatch::Over;
use crate::jet::inverse_factorial;
use crate::model::{Elastic, Knot, Piece, Rotor};
use crate::newton::increasing_root;
use crate::{Jet, Scalar};

/// A deflection, its rate, and what the spring makes of it.
pub(super) struct Deflection<F, const N: usize> {
    pub(super) now: F,
    /// `δ̇`; without damping its last coefficient is not known, and zero.
    pub(super) rate: Jet<F, N>,
    /// `k'(δ)`.
    slope: F,
}

/// `k(δ(t))` of a cubic while the coefficients of `x = δ − start` are being found one by one.
struct Growing<F, const N: usize> {
    c: [F; 4],
    x: Jet<F, N>,
    /// `x²`.
    square: Jet<F, N>,
}

impl<F: Scalar, const N: usize> Growing<F, N> {
    #[inline(always)]
    fn new(piece: &Piece<F>, x: F) -> Self {
        Self { c: piece.c, x: Jet::constant(x), square: Jet::constant(x * x) }
    }

    /// Coefficient `k` of `k(δ)` as far as it does not depend on that of `x`, which the slope multiplies:
    /// `c₂ Σ' x_i x_{k−i} + c₃ (x_0 Σ' x_i x_{k−i} + Σ' x_i (x²)_{k−i})`, sums without the first and the last.
    #[inline(always)]
    fn known(&self, k: usize) -> F {
        let [_, _, c2, c3] = self.c;
        let pairs = self.x.convolved(&self.x, k, 1);
        let triples = self.x.value().mul_add(pairs, self.x.convolved(&self.square, k, 1));
        c2.mul_add(pairs, c3 * triples)
    }

    #[inline(always)]
    fn push(&mut self, k: usize, x: F) {
        self.x.0[k] = x;
        self.square.0[k] = self.x.convolved(&self.x, k, 0);
    }
}

/// `k(δ) = τ_J` solved for the series of `δ`: `k' δ_k = τ_k − …`, power-series inversion.
#[inline(always)]
pub(super) fn undamped<T: Scalar, F: Over<T>, const N: usize>(
    elastic: &Elastic<T::Param>,
    knots: &[Knot<T::Param>],
    torque: &Jet<F, N>,
) -> Deflection<F, N> {
    let (now, piece) = elastic.spring.deflection(torque.value(), knots);
    let (_, slope) = piece.value_and_slope(now - piece.start);
    let share = F::one() / slope;
    let mut growing = Growing::<F, N>::new(&piece, now - piece.start);
    for k in 1..N {
        let known = if elastic.spring.straight { F::zero() } else { growing.known(k) };
        growing.push(k, (torque.0[k] - known) * share);
    }
    Deflection { now, rate: growing.x.rate(), slope }
}

/// `D δ̇ = τ_J − k(δ)` with a known `δ` now: the internal dynamics of the inverse (Thümmel, Otter & Bals, eq. 1).
#[inline(always)]
pub(super) fn damped<T: Scalar, F: Over<T>, const N: usize>(
    elastic: &Elastic<T::Param>,
    knots: &[Knot<T::Param>],
    torque: &Jet<F, N>,
    now: F,
) -> Deflection<F, N> {
    let piece = elastic.spring.piece_at(now, knots);
    let (value, slope) = piece.value_and_slope(now - piece.start);
    let share = F::one() / F::from_param(elastic.damping);
    let mut growing = Growing::<F, N>::new(&piece, now - piece.start);
    let mut rate = Jet::constant((torque.value() - value) * share);
    for k in 1..N {
        growing.push(k, rate.0[k - 1] * F::from_f64(1.0 / k as f64));
        let known = if elastic.spring.straight { F::zero() } else { growing.known(k) };
        rate.0[k] = (torque.0[k] - slope.mul_add(growing.x.0[k], known)) * share;
    }
    Deflection { now, rate, slope }
}

/// How many of the functions `φ` are summed up where they are small.
const TERMS: usize = 20;

impl<F: Scalar, const N: usize> Deflection<F, N> {
    /// The deflection of a damped transmission after `step`, the spring taken as straight about the present deflection:
    /// `δ + h φ₁(z) δ̇ + Σ_{m≥1} h^{m+1} φ_{m+1}(z) τ_J⁽ᵐ⁾/D` with `z = −h k'/D` (Hochbruck & Ostermann 2010, eq. 2.42).
    #[inline(always)]
    pub(super) fn after(&self, step: F, damping: F, torque: &Jet<F, N>) -> F {
        let share = F::one() / damping;
        let z = -(step * self.slope * share);
        // φ_m(z) = Σ zⁱ/(i + m)!.   φ_m = 1/m! + z φ_{m+1}: from the far end where z is small, from φ_0 = e^z where it is not.
        let small = (z * z).select_less(F::one(), F::one(), F::zero());
        let near = z * small;
        let mut inside = [F::zero(); TERMS];
        let mut phi = F::from_f64(inverse_factorial(TERMS));
        for m in (0..TERMS).rev() {
            phi = near.mul_add(phi, F::from_f64(inverse_factorial(m)));
            inside[m] = phi;
        }
        let (far, mut outside) = ((z * z).select_less(F::one(), -F::one(), z), z.exp());
        let mut end = self.now;
        let mut power = F::one();
        for m in 0..N.min(TERMS - 1) {
            outside = (outside - F::from_f64(inverse_factorial(m))) / far;
            let phi = (z * z).select_less(F::one(), inside[m + 1], outside);
            power = power * step;
            let drive =
                if m == 0 { self.rate.value() } else { torque.0[m] * share * F::from_f64(1.0 / inverse_factorial(m)) };
            end = (power * phi).mul_add(drive, end);
        }
        end
    }
}

/// The motor's position, its rate, and `1 − e'(θ)`, what of the torque it feels.
pub(super) struct MotorMotion<F, const N: usize> {
    pub(super) now: F,
    pub(super) rate: Jet<F, N>,
    pub(super) share: Jet<F, N>,
}

/// Steps of the search for the position of a motor whose gear has an error.
const STEPS: usize = 14;
/// How near the search must come before its last steps, as part of the error's amplitude [–].
const NEAR: f64 = 1e-3;

/// `θ − e(θ) = q + δ` solved for the series of `θ`: `(1 − e') θ̇ = q̇ + δ̇`.
#[inline(always)]
pub(super) fn motor<T: Scalar, F: Over<T>, const N: usize>(
    elastic: &Elastic<T::Param>,
    rotor: &Rotor<T::Param>,
    q: F,
    qd: &Jet<F, N>,
    deflection: &Deflection<F, N>,
) -> MotorMotion<F, N> {
    let (target, speed) = (q + deflection.now, *qd + deflection.rate);
    let Some(error) = &elastic.error else {
        return MotorMotion { now: target, rate: speed, share: Jet::one() };
    };
    // The root lies within the amplitude of the target, and the left side increases.
    let ratio = F::from_param(rotor.gear_ratio);
    let amplitude = F::from_param(error.amplitude);
    let reach = amplitude.select_less(F::zero(), -amplitude, amplitude);
    let near = reach * F::from_f64(NEAR);
    let theta = increasing_root::<F, STEPS>((target - reach, target + reach), target, near, |theta| {
        let (e, slope) = error.value_and_slope(theta, ratio);
        (theta - e - target, F::one() - slope)
    });

    // With u = c N θ + φ:   e' = A c N cos u,   and coefficient k of e' needs those of θ̇ before k.
    let cycles = F::from_param(error.cycles_per_rotor_turn) * ratio;
    let (s, c) = cycles.mul_add(theta, F::from_param(error.phase)).sin_cos();
    let (mut sin, mut cos) = (Jet::<F, N>::constant(s), Jet::<F, N>::constant(c));
    let mut share = Jet::constant(F::one() - amplitude * cycles * c);
    let mut rate = Jet::<F, N>::zero();
    let inverse = F::one() / share.value();
    for k in 0..N {
        let mut rest = speed.0[k];
        for i in 1..=k {
            rest = (-share.0[i]).mul_add(rate.0[k - i], rest);
        }
        rate.0[k] = rest * inverse;
        if k + 1 < N {
            let each = cycles * F::from_f64(1.0 / (k + 1) as f64);
            (sin.0[k + 1], cos.0[k + 1]) = (rate.convolved(&cos, k, 0) * each, -(rate.convolved(&sin, k, 0) * each));
            share.0[k + 1] = -(amplitude * cycles * cos.0[k + 1]);
        }
    }
    MotorMotion { now: theta, rate, share }
}
