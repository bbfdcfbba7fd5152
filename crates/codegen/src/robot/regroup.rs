//! Base inertial parameters: the same equations of motion from seven numbers a link in place of ten.
//!
//! What of a link's inertia looks the same from its parent wherever the joint is may belong to the parent as well. Of a link that
//! turns about z these are its mass, the first moment along z and a rotational inertia alike about x and y; of one that slides,
//! the whole rotational inertia (Gautier and Khalil 1990, *Direct calculation of minimum set of inertial parameters of serial
//! robots*, eq. 15 and 17). Forces between links become others; those at the joints, the inertia matrix and
//! all accelerations stay.

use gyroflex::Scalar;
use gyroflex::model::{Body, JointKind};
use gyroflex::spatial::{JointTransform, SpatialInertia, SymMat3, Turn, Vec3};

/// Hands what belongs to the parent as well to the parent, from the tips to the base.
pub(super) fn regroup<T: Scalar<Param = T>>(bodies: &mut [Body<T>]) {
    for i in (0..bodies.len()).rev() {
        let body = &bodies[i];
        let Some(handed) = common_with_parent(body) else { continue };
        let own = body.inertia;
        let kept = SpatialInertia {
            mass: own.mass - handed.mass,
            first_moment: own.first_moment - handed.first_moment,
            rotational: own.rotational - handed.rotational,
        };
        let parent = body.parent();
        let seen = seen_from_parent(body, handed);
        bodies[i].inertia = kept;
        if let Some(parent) = parent {
            bodies[parent].inertia = bodies[parent].inertia + seen;
        }
    }
}

/// The part that looks the same from the parent at every position of the joint.
fn common_with_parent<T: Scalar>(body: &Body<T>) -> Option<SpatialInertia<T>> {
    let SpatialInertia { mass, first_moment, rotational } = body.inertia;
    let zero = T::zero();
    match body.joint {
        JointKind::Revolute => Some(SpatialInertia {
            mass,
            first_moment: Vec3::new(zero, zero, first_moment.z),
            rotational: SymMat3::diagonal(rotational.yy, rotational.yy, zero),
        }),
        JointKind::Prismatic => Some(SpatialInertia { mass: zero, first_moment: Vec3::zero(), rotational }),
        JointKind::Floating => None,
    }
}

/// An inertia of the body as its parent has it, the joint being wherever it is.
fn seen_from_parent<T: Scalar<Param = T>>(body: &Body<T>, inertia: SpatialInertia<T>) -> SpatialInertia<T> {
    let at = &body.placement;
    let theta = match body.joint {
        JointKind::Prismatic => {
            let (sin, cos) = at.zero.sin_cos();
            Turn { sin, cos }
        }
        _ => Turn::none(),
    };
    let beyond = JointTransform { a: at.a, alpha: at.alpha, d: at.d, theta }.inv_inertia(inertia);
    match at.branch {
        Some(branch) => branch.inv_inertia(beyond),
        None => beyond,
    }
}
