//! Pass 2 at one body: the force through its joint, on its parent.

use super::outward::{set, slide, speeds};
use super::{ElasticInverseScratch, Rates};
use crate::dispatch::{Kernel, Over};
use crate::model::{Body, JointKind};
use crate::spatial::{Force, Turn, Vec3};
use crate::{Jet, Scalar};

/// Adds the force on a body to that on its parent, with the parent's `N` coefficients.
pub(super) struct Inward<'a, T: Scalar, const N: usize> {
    pub(super) body: &'a Body<T::Param>,
    pub(super) q: T,
    pub(super) rates: Rates<'a, T>,
    pub(super) own: &'a [ElasticInverseScratch<T>],
    pub(super) parent: &'a mut [ElasticInverseScratch<T>],
}

impl<T: Scalar, const N: usize> Kernel<T> for Inward<'_, T, N> {
    type Output = ();
    const WIDE: bool = false;

    #[inline(always)]
    fn run<F: Over<T>>(self) {
        let Self { body, q, rates, own, parent } = self;
        let (Some(own), Some(parent)) = (own.first_chunk::<N>(), parent.first_chunk_mut::<N>()) else { return };
        let x = body.across(Turn::none(), F::load(q));
        let branch = body.branch::<F>();

        // Eᵀ f
        let zero = Vec3::new(Jet::zero(), Jet::zero(), Jet::zero());
        let (mut ang, mut lin) = (zero, zero);
        let mut turn = Turn { sin: Jet::<F, N>::zero(), cos: Jet::zero() };
        for k in 0..N {
            let f = own[k].f.map(F::load);
            set(&mut ang, k, f.ang);
            set(&mut lin, k, f.lin);
            (turn.sin.0[k], turn.cos.0[k]) = (F::load(own[k].turn.sin), F::load(own[k].turn.cos));
        }
        (ang, lin) = (turn.z_back(ang), turn.z_back(lin));
        if body.joint == JointKind::Prismatic {
            let (qd, _) = speeds::<T, F, N>(rates);
            ang = Vec3::new(Jet::zero(), Jet::zero(), slide(qd)).cross_plus(lin, ang);
        }

        // Xᵀ f
        for k in 0..N {
            let lin = x.alpha.x_back(lin.map(|c| c.0[k]));
            let ang = x.offset().cross_plus(lin, x.alpha.x_back(ang.map(|c| c.0[k])));
            let mut on_parent = Force { ang, lin };
            if let Some(branch) = branch {
                on_parent = branch.inv_force(on_parent);
            }
            parent[k].f = (parent[k].f.map(F::load) + on_parent).map(F::store);
        }
    }
}
