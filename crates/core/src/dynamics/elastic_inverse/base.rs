//! The base of the recursion: the world at rest, or a floating root whose motion is given.

use super::joint::JointOutputs;
use super::outward::set;
use super::{ElasticInverseScratch, InverseError, JointMotion, Rates};
use crate::dispatch::{Kernel, Over};
use crate::dynamics::External;
use crate::dynamics::moving::Moving;
use crate::dynamics::tree::RootMotion;
use crate::jet::{factorial, inverse_factorial, reciprocal};
use crate::model::{Body, JointKind, Model};
use crate::spatial::{Force, Motion, Turn, Vec3};
use crate::{Jet, Scalar};

/// Motion of the base, and the force that a floating root needs, with `N` coefficients.
pub(super) struct Base<'a, 'm, T: Scalar, const N: usize> {
    pub(super) model: &'a Model<'m, T::Param>,
    pub(super) motion: JointMotion<'a, T>,
    pub(super) nv: usize,
    pub(super) scratch: &'a mut [ElasticInverseScratch<T>],
}

impl<T: Scalar, const N: usize> Kernel<T> for Base<'_, '_, T, N> {
    type Output = ();
    const WIDE: bool = false;

    #[inline(always)]
    fn run<F: Over<T>>(self) {
        let Self { model, motion, nv, scratch } = self;
        let Some(own) = scratch.first_chunk_mut::<N>() else { return };
        // Gravity enters as an acceleration of the world.
        let lift = -model.gravity.map(F::from_param);
        let root = model.bodies.first().filter(|b| b.joint == JointKind::Floating);
        let mut moving = Moving { omega: Vec3::zero(), accel: Motion::zero() };
        match root {
            None => set(&mut moving.accel.lin, 0, lift),
            Some(_) => {
                let rate = |row: usize, entry: usize, k: usize| {
                    let rows = Rates { of: motion.derivatives, nv, k: entry };
                    rows.row(row).map_or(F::zero(), |x| F::load(*x) * F::from_f64(inverse_factorial(k)))
                };
                let mut v = Vec3::<Jet<F, N>>::zero();
                let mut v_rate = Vec3::<Jet<F, N>>::zero();
                for k in 0..N {
                    let three = |row: usize, first: usize| {
                        Vec3::new(rate(row, first, k), rate(row, first + 1, k), rate(row, first + 2, k))
                    };
                    set(&mut moving.omega, k, three(k, 0));
                    set(&mut moving.accel.ang, k, three(k + 1, 0));
                    set(&mut v, k, three(k, 3));
                    set(&mut v_rate, k, three(k + 1, 3));
                }
                // Gravity as the root sees it turns against it: ġ = g × ω.
                let mut seen = Vec3::<Jet<F, N>>::zero();
                set(&mut seen, 0, RootMotion::<F>::of(motion.q, &motion.derivatives[..0]).rot * lift);
                for k in 0..N.saturating_sub(1) {
                    let w = &moving.omega;
                    let product = |a: &Jet<F, N>, b: &Jet<F, N>| a.convolved(b, k, 0);
                    let turned = Vec3::new(
                        product(&seen.y, &w.z) - product(&seen.z, &w.y),
                        product(&seen.z, &w.x) - product(&seen.x, &w.z),
                        product(&seen.x, &w.y) - product(&seen.y, &w.x),
                    );
                    set(&mut seen, k + 1, turned.scale(F::from_f64(reciprocal(k + 1))));
                }
                // From the spatial to the classical acceleration: + ω × v
                moving.accel.lin = moving.omega.cross_plus(v, v_rate + seen);
            }
        }
        let field = moving.field();
        for k in 0..N {
            let (moving, field) = (moving.map(|c| c.0[k]), field.map(|c| c.0[k]));
            own[k] = ElasticInverseScratch {
                turn: Turn::none(),
                f: root.map_or(Force::zero(), |root| moving.force_on(field, &root.inertia).map(F::store)),
                moving: moving.map(F::store),
                field: field.map(F::store),
            };
        }
    }
}

/// The wrench that a floating root needs, less the loads on it.
pub(super) fn finish<T: Scalar>(
    root: &Body<T::Param>,
    ext: External<T>,
    bodies: usize,
    motion: JointMotion<T>,
    scratch: &mut [ElasticInverseScratch<T>],
    out: &mut JointOutputs<T>,
) -> Result<(), InverseError> {
    let nv = out.nv;
    super::outward::subtract_wrench(root, Rates { of: ext.wrenches, nv: bodies, k: 0 }, scratch);
    let mut finite = true;
    for (row, s) in scratch.iter().enumerate().take(out.rows) {
        for (i, f) in s.f.to_array().into_iter().enumerate() {
            let load = ext.tau.get(row * nv + i).map_or(T::zero(), |x| *x);
            let wrench = f * T::from_f64(factorial(row)) - load;
            finite &= wrench.is_finite();
            for to in [&mut *out.out.tau_j, &mut *out.out.tau] {
                if let Some(slot) = to.get_mut(row * nv + i) {
                    *slot = wrench;
                }
            }
        }
    }
    for i in 0..6 {
        out.theta_of_joint(i, T::zero(), Rates { of: motion.derivatives, nv, k: i });
        for to in [&mut *out.out.deflection, &mut *out.out.deflection_rate] {
            if let Some(slot) = to.get_mut(i) {
                *slot = T::zero();
            }
        }
    }
    if finite { Ok(()) } else { Err(InverseError::Overflow { body: 0 }) }
}
