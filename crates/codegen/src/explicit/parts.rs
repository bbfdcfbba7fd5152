//! The parts of the equations of motion as expressions.

use super::compose::Composer;
use super::traced::friction_of;
use super::{DriveLaw, ExplicitModel, Sum};
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::Friction;

pub(super) fn mass(model: &ExplicitModel, composer: &mut Composer) -> Vec<Sym> {
    let n = model.nv();
    let upper: Vec<Sym> = model.mass.iter().map(|sum| composer.compose(sum)).collect();
    (0..n * n).map(|at| upper[model.upper(at / n, at % n)]).collect()
}

pub(super) fn couplings(model: &ExplicitModel, composer: &mut Composer) -> Vec<Sym> {
    model.coupling.iter().map(|sum| composer.compose(sum)).collect()
}

pub(super) fn weights(model: &ExplicitModel, composer: &mut Composer) -> Vec<Sym> {
    (0..model.nv()).map(|i| composer.compose(&model.gravity(i))).collect()
}

/// Adds what friction on the link side and the modes' springs and dampers take.
pub(super) fn resist(model: &ExplicitModel, composer: &mut Composer, (q, qd): (&[Sym], &[Sym]), link: &mut [Sym]) {
    for (i, joint) in model.joints.iter().enumerate() {
        link[i] += friction(composer, &joint.friction).torque(qd[i]);
    }
    let (first, modes) = (model.joints.len(), model.modes());
    for j in 0..modes {
        for k in 0..modes {
            link[first + j] += Sym::from_f64(model.modal_stiffness(j, k)) * q[first + k];
            link[first + j] += Sym::from_f64(model.modal_damping(j, k)) * qd[first + k];
        }
    }
}

/// `N f_m(N v)`.
pub(super) fn motor_friction(composer: &mut Composer, drive: &DriveLaw, speed: Sym) -> Sym {
    let n = composer.compose(&drive.gear_ratio);
    n * friction(composer, &drive.friction).torque(n * speed)
}

fn friction(composer: &mut Composer, of: &Friction<Sum>) -> Friction<Sym> {
    friction_of(of, |sum| composer.compose(sum))
}
