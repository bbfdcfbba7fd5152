//! Pass 1 at one body: its motion, and the force it needs, as series; coefficient by coefficient the formulas of [`super::super::rnea`].

use super::{ElasticInverseScratch, Rates};
use crate::dispatch::{Kernel, Over};
use crate::dynamics::moving::Moving;
use crate::jet::{inverse_factorial, reciprocal};
use crate::model::{Body, JointKind};
use crate::spatial::{Force, Motion, Turn, Vec3};
use crate::{Jet, Scalar};

/// Motion of the body across a joint, with `N` coefficients.
pub(super) struct Outward<'a, T: Scalar, const N: usize> {
    pub(super) body: &'a Body<T::Param>,
    pub(super) q: T,
    pub(super) rates: Rates<'a, T>,
    pub(super) parent: &'a [ElasticInverseScratch<T>],
    pub(super) own: &'a mut [ElasticInverseScratch<T>],
}

/// Series of `q̇` and of `q̈` of one joint.
#[inline(always)]
pub(super) fn speeds<T: Scalar, F: Over<T>, const N: usize>(rates: Rates<T>) -> (Jet<F, N>, Jet<F, N>) {
    let coefficient =
        |row: usize, k: usize| rates.row(row).map_or(F::zero(), |x| F::load(*x) * F::from_f64(inverse_factorial(k)));
    (Jet::from_fn(|k| coefficient(k, k)), Jet::from_fn(|k| coefficient(k + 1, k)))
}

/// How far a sliding joint will have moved from where it is: the series of `q` but for its value.
#[inline(always)]
pub(super) fn slide<F: Scalar, const N: usize>(qd: Jet<F, N>) -> Jet<F, N> {
    Jet::from_fn(|k| match k {
        0 => F::zero(),
        _ => qd.0[k - 1] * F::from_f64(reciprocal(k)),
    })
}

impl<T: Scalar, const N: usize> Kernel<T> for Outward<'_, T, N> {
    type Output = ();
    const WIDE: bool = false;

    #[inline(always)]
    fn run<F: Over<T>>(self) {
        let Self { body, q, rates, parent, own } = self;
        let (Some(parent), Some(own)) = (parent.first_chunk::<N>(), own.first_chunk_mut::<N>()) else { return };
        let (joint, q) = (body.joint, F::load(q));
        let (qd, qdd) = speeds::<T, F, N>(rates);
        let x = body.across(Turn::none(), q);
        let branch = body.branch::<F>();

        // ω_p, α_p and a_p + Ω_p r where the joint sits, in axes about whose z the joint moves
        let r = match branch {
            None => x.offset(),
            Some(branch) => branch.turn.z_back(branch.shift + x.offset()),
        };
        let mut moving = Moving { omega: Vec3::zero(), accel: Motion::zero() };
        for k in 0..N {
            let mut at = parent[k].moving.map(F::load).at(parent[k].field.map(F::load), r);
            if let Some(branch) = branch {
                at = at.turned(branch.turn);
            }
            set(&mut moving.omega, k, x.alpha.x(at.omega));
            set(&mut moving.accel.ang, k, x.alpha.x(at.accel.ang));
            set(&mut moving.accel.lin, k, x.alpha.x(at.accel.lin));
        }

        // ω = E ω_p + z q̇,   α = E α_p + z q̈ + ω × z q̇,   a = E (a_p + Ω_p r)
        let (sin, cos) = body.angle(q).sin_cos();
        let turn = if joint == JointKind::Prismatic {
            moving = moving.at(moving.field(), Vec3::new(Jet::zero(), Jet::zero(), slide(qd)));
            Turn { sin: Jet::constant(sin), cos: Jet::constant(cos) }
        } else {
            let (sin, cos) = turning(qd, sin, cos);
            Turn { sin, cos }
        };
        let moving = moving.turned(turn).driven(joint, qd, qdd);

        // f = m a + Ω h,   n = I α + ω × I ω + h × a
        let field = moving.field();
        for k in 0..N {
            let (moving, field) = (moving.map(|c| c.0[k]), field.map(|c| c.0[k]));
            own[k] = ElasticInverseScratch {
                turn: turn.map(|c| c.0[k].store()),
                f: moving.force_on(field, &body.inertia).map(F::store),
                moving: moving.map(F::store),
                field: field.map(F::store),
            };
        }
    }
}

/// Sine and cosine of an angle of this rate.
#[inline(always)]
fn turning<F: Scalar, const N: usize>(rate: Jet<F, N>, sin: F, cos: F) -> (Jet<F, N>, Jet<F, N>) {
    slide(rate).sin_cos_from(sin, cos)
}

/// Sets coefficient `k` of a vector's series.
#[inline(always)]
pub(super) fn set<F: Scalar, const N: usize>(series: &mut Vec3<Jet<F, N>>, k: usize, v: Vec3<F>) {
    (series.x.0[k], series.y.0[k], series.z.0[k]) = (v.x, v.y, v.z);
}

/// The load on a body, in its link frame, and its derivatives, are forces that it does not need.
pub(super) fn subtract_wrench<T: Scalar>(
    body: &Body<T::Param>,
    wrenches: Rates<Force<T>>,
    own: &mut [ElasticInverseScratch<T>],
) {
    for (k, s) in own.iter_mut().enumerate() {
        let Some(wrench) = wrenches.row(k) else { break };
        let share = T::from_f64(inverse_factorial(k));
        s.f -= body.frame.map(T::from_param).inv_force(wrench.map(|x| x * share));
    }
}
