//! From the torque through an elastic transmission to the position of its motor, as series.
//!
//! Straight springs and gears without error are a few products and part of the caller. The others are subroutines, which know no
//! instruction set: there would be one for every number of coefficients and set.

use crate::dispatch::Over;
use crate::jet::{factorial, inverse_factorial, reciprocal};
use crate::model::{Elastic, Knot, Piece, Rotor, TransmissionError};
use crate::newton::increasing_root;
use crate::{Jet, Scalar};

/// A deflection, its rate, and what the spring makes of it.
#[derive(Clone, Copy)]
pub(super) struct Deflection<F, const N: usize> {
    pub(super) now: F,
    /// `δ̇`; without damping its last coefficient is not known, and zero.
    pub(super) rate: Jet<F, N>,
    /// `k'(δ)`.
    slope: F,
}

impl<F: Scalar, const N: usize> Deflection<F, N> {
    #[inline(always)]
    fn load<T: Scalar>(of: Deflection<T, N>) -> Self
    where
        F: Over<T>,
    {
        Self { now: F::load(of.now), rate: load(&of.rate), slope: F::load(of.slope) }
    }
}

/// A series in the arithmetic of a kernel.
#[inline(always)]
pub(super) fn load<T: Scalar, F: Over<T>, const N: usize>(of: &Jet<T, N>) -> Jet<F, N> {
    Jet::from_fn(|k| F::load(of.0[k]))
}

/// A series as it is kept.
#[inline(always)]
pub(super) fn store<T: Scalar, F: Over<T>, const N: usize>(of: &Jet<F, N>) -> Jet<T, N> {
    Jet::from_fn(|k| of.0[k].store())
}

/// Where the spring, damped or not, carries the torque `τ_J`.
#[inline(always)]
pub(super) fn deflection<T: Scalar, F: Over<T>, const N: usize>(
    elastic: &Elastic<T::Param>,
    knots: &[Knot<T::Param>],
    torque: &Jet<F, N>,
    damped: bool,
    now: F,
) -> Deflection<F, N> {
    if !elastic.spring.straight {
        let (torque, now) = (store(torque), now.store());
        return Deflection::load(if damped {
            curved_damped(elastic, knots, &torque, now)
        } else {
            curved(elastic, knots, &torque)
        });
    }
    let slope = F::from_param(elastic.spring.stiffness);
    if !damped {
        let all = torque.scale(F::one() / slope);
        return Deflection { now: all.value(), rate: all.rate(), slope };
    }
    // D δ̇ = τ_J − K δ
    let share = F::one() / F::from_param(elastic.damping);
    let (mut delta, mut rate) = (now, Jet::zero());
    for k in 0..N {
        rate.0[k] = (-slope).mul_add(delta, torque.0[k]) * share;
        delta = rate.0[k] * F::from_f64(reciprocal(k + 1));
    }
    Deflection { now, rate, slope }
}

/// `k(δ(t))` of a cubic while the coefficients of `x = δ − start` are being found one by one.
struct Growing<T, const N: usize> {
    c: [T; 4],
    x: Jet<T, N>,
    /// `x²`.
    square: Jet<T, N>,
}

impl<T: Scalar, const N: usize> Growing<T, N> {
    fn new(piece: &Piece<T>, x: T) -> Self {
        Self { c: piece.c, x: Jet::constant(x), square: Jet::constant(x * x) }
    }

    /// Coefficient `k` of `k(δ)` as far as it does not depend on that of `x`, which the slope multiplies:
    /// `c₂ Σ' x_i x_{k−i} + c₃ (x_0 Σ' x_i x_{k−i} + Σ' x_i (x²)_{k−i})`, sums without the first and the last.
    fn known(&self, k: usize) -> T {
        let [_, _, c2, c3] = self.c;
        let pairs = self.x.convolved(&self.x, k, 1);
        let triples = self.x.value().mul_add(pairs, self.x.convolved(&self.square, k, 1));
        c2.mul_add(pairs, c3 * triples)
    }

    fn push(&mut self, k: usize, x: T) {
        self.x.0[k] = x;
        self.square.0[k] = self.x.convolved(&self.x, k, 0);
    }
}

/// `k(δ) = τ_J` solved for the series of `δ`: `k' δ_k = τ_k − …`, power-series inversion.
#[inline(never)]
fn curved<T: Scalar, const N: usize>(
    elastic: &Elastic<T::Param>,
    knots: &[Knot<T::Param>],
    torque: &Jet<T, N>,
) -> Deflection<T, N> {
    let (now, piece) = elastic.spring.deflection(torque.value(), knots);
    let (_, slope) = piece.value_and_slope(now - piece.start);
    let share = T::one() / slope;
    let mut growing = Growing::<T, N>::new(&piece, now - piece.start);
    for k in 1..N {
        growing.push(k, (torque.0[k] - growing.known(k)) * share);
    }
    Deflection { now, rate: growing.x.rate(), slope }
}

/// `D δ̇ = τ_J − k(δ)` with a known `δ` now: the internal dynamics of the inverse (Thümmel, Otter & Bals, eq. 1).
#[inline(never)]
fn curved_damped<T: Scalar, const N: usize>(
    elastic: &Elastic<T::Param>,
    knots: &[Knot<T::Param>],
    torque: &Jet<T, N>,
    now: T,
) -> Deflection<T, N> {
    let piece = elastic.spring.piece_at(now, knots);
    let (value, slope) = piece.value_and_slope(now - piece.start);
    let share = T::one() / T::from_param(elastic.damping);
    let mut growing = Growing::<T, N>::new(&piece, now - piece.start);
    let mut rate = Jet::constant((torque.value() - value) * share);
    for k in 1..N {
        growing.push(k, rate.0[k - 1] * T::from_f64(reciprocal(k)));
        rate.0[k] = (torque.0[k] - slope.mul_add(growing.x.0[k], growing.known(k))) * share;
    }
    Deflection { now, rate, slope }
}

/// How many of the functions `φ` are summed up where they are small.
const TERMS: usize = 20;

/// The deflection of a damped transmission after `step`, the spring taken as straight about the present deflection:
/// `δ + h φ₁(z) δ̇ + Σ_{m≥1} h^{m+1} φ_{m+1}(z) τ_J⁽ᵐ⁾/D` with `z = −h k'/D` (Hochbruck & Ostermann 2010, eq. 2.42).
#[inline(never)]
pub(super) fn after<T: Scalar, F: Over<T>, const N: usize>(
    deflection: &Deflection<F, N>,
    step: T,
    damping: T,
    torque: &[T],
) -> T {
    let (now, rate, slope) = (deflection.now.store(), deflection.rate.value().store(), deflection.slope.store());
    let share = T::one() / damping;
    let z = -(step * slope * share);
    // φ_m(z) = Σ zⁱ/(i + m)!.   φ_m = 1/m! + z φ_{m+1}: from the far end where z is small, from φ_0 = e^z where it is not.
    let (zero, one) = (T::zero(), T::one());
    let near = z * (z * z).select_less(one, one, zero);
    let mut inside = [zero; TERMS];
    let mut phi = T::from_f64(inverse_factorial(TERMS));
    for m in (0..TERMS).rev() {
        phi = near.mul_add(phi, T::from_f64(inverse_factorial(m)));
        inside[m] = phi;
    }
    let (far, mut outside) = ((z * z).select_less(one, -one, z), z.exp());
    let (mut end, mut power) = (now, one);
    for (m, (torque, inside)) in torque.iter().zip(inside.iter().skip(1)).enumerate() {
        outside = (outside - T::from_f64(inverse_factorial(m))) / far;
        let phi = (z * z).select_less(one, *inside, outside);
        power = power * step;
        let drive = if m == 0 { rate } else { *torque * share * T::from_f64(factorial(m)) };
        end = (power * phi).mul_add(drive, end);
    }
    end
}

/// The motor's position, its rate, and `1 − e'(θ)`, what of the torque it feels.
pub(super) struct MotorMotion<T, const N: usize> {
    pub(super) now: T,
    pub(super) rate: Jet<T, N>,
    pub(super) share: Jet<T, N>,
}

/// Steps of the search for the position of a motor whose gear has an error.
const STEPS: usize = 14;
/// How near the search must come before its last steps, as part of the error's amplitude [–].
const NEAR: f64 = 1e-3;

/// `θ − e(θ) = q + δ` solved for the series of `θ`: `(1 − e') θ̇ = q̇ + δ̇`, with `target` and `speed` on the right.
#[inline(never)]
pub(super) fn motor<T: Scalar, const N: usize>(
    error: &TransmissionError<T::Param>,
    rotor: &Rotor<T::Param>,
    target: T,
    speed: &Jet<T, N>,
) -> MotorMotion<T, N> {
    // The root lies within the amplitude of the target, and the left side increases.
    let ratio = T::from_param(rotor.gear_ratio);
    let amplitude = T::from_param(error.amplitude);
    let reach = amplitude.select_less(T::zero(), -amplitude, amplitude);
    let near = reach * T::from_f64(NEAR);
    let theta = increasing_root::<T, STEPS>((target - reach, target + reach), target, near, |theta| {
        let (e, slope) = error.value_and_slope(theta, ratio);
        (theta - e - target, T::one() - slope)
    });

    // With u = c N θ + φ:   e' = A c N cos u,   and coefficient k of e' needs those of θ̇ before k.
    let cycles = T::from_param(error.cycles_per_rotor_turn) * ratio;
    let (s, c) = cycles.mul_add(theta, T::from_param(error.phase)).sin_cos();
    let (mut sin, mut cos) = (Jet::<T, N>::constant(s), Jet::<T, N>::constant(c));
    let mut share = Jet::constant(T::one() - amplitude * cycles * c);
    let mut rate = Jet::<T, N>::zero();
    let inverse = T::one() / share.value();
    for k in 0..N {
        let mut rest = speed.0[k];
        for (share, rate) in share.0.iter().skip(1).zip(rate.0.iter().take(k).rev()) {
            rest = (-*share).mul_add(*rate, rest);
        }
        rate.0[k] = rest * inverse;
        let each = cycles * T::from_f64(reciprocal(k + 1));
        let (next_sin, next_cos) = (rate.convolved(&cos, k, 0) * each, -(rate.convolved(&sin, k, 0) * each));
        let slots = (sin.0.get_mut(k + 1), cos.0.get_mut(k + 1), share.0.get_mut(k + 1));
        if let (Some(sin), Some(cos), Some(share)) = slots {
            (*sin, *cos, *share) = (next_sin, next_cos, -(amplitude * cycles * next_cos));
        }
    }
    MotorMotion { now: theta, rate, share }
}
