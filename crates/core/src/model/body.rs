//! The record of one link and its joint.

use super::{Drive, Friction, Rotor};
use crate::Scalar;
use crate::spatial::{
    ArticulatedInertia, Branch, Force, JointTransform, Motion, SpatialInertia, SymMat3, Transform, Turn, Vec3,
};

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointKind {
    /// Turns about its axis; `q` [rad] is not wrapped. URDF's `continuous` is this joint without limits.
    Revolute,
    /// Slides along its axis; `q` [m].
    Prismatic,
    /// Moves freely, only as body 0: `q` is the position of the link frame in the world [m] and the unit quaternion
    /// `x y z w` of its orientation; `qd` is the link's twist in its own frame, angular part first.
    Floating,
}

impl JointKind {
    /// Number of position coordinates.
    pub const fn nq(self) -> usize {
        match self {
            Self::Floating => 7,
            _ => 1,
        }
    }

    /// Number of velocity coordinates.
    pub const fn nv(self) -> usize {
        match self {
            Self::Floating => 6,
            _ => 1,
        }
    }
}

/// Where a joint sits in its parent: the constant part of its [`JointTransform`].
#[derive(Clone, Copy, Debug)]
pub struct Placement<T> {
    /// From the parent's frame to the common normal of both axes. `None` says that the parent is the body before, not a
    /// floating root, and that the common normal is its x-axis.
    pub branch: Option<Branch<T>>,
    /// `a`: length of the common normal [m].
    pub a: T,
    /// `α`: angle from the parent's z-axis to the joint axis, about x.
    pub alpha: Turn<T>,
    /// `d`: along the joint axis from the common normal to the body's origin; at `q = 0`, where the joint slides [m].
    pub d: T,
    /// Angle about the joint axis at `q = 0` [rad].
    pub zero: T,
}

/// One link, the joint that moves it and the drive of that joint, as the recursions walk them.
///
/// [`RobotSpec::lower`](super::RobotSpec::lower) writes these records from a checked description. Its frames have the joint
/// axis for z-axis and the common normal with the next axis for x-axis; only [`Body::frame`] knows the user's frame.
/// Other numbers than it writes give other accelerations, never a panic.
#[derive(Clone, Copy, Debug)]
pub struct Body<T> {
    /// Index of the parent body, an earlier one; `None` is the fixed world.
    pub parent: Option<u16>,
    /// How the joint moves.
    pub joint: JointKind,
    /// Index of the joint's first entry in `q`: those of the bodies before it come first.
    pub q_index: u16,
    /// Index of the joint's first entry in `qd` and all vectors of its length.
    pub v_index: u16,
    /// Whether anything but the next body's joint refers to this body: another child, or the rotor of a later joint.
    pub shared: bool,
    /// Where the joint sits; of no meaning for a floating root.
    pub placement: Placement<T>,
    /// Inertia of the link with what is fixed to it, rotors at rest included; an elastic rotor's `J n nᵀ` excluded.
    pub inertia: SpatialInertia<T>,
    /// `Σ J n nᵀ` of the elastic rotors that the body carries: what `inertia` lacks of the body with its rotors at rest [kg m²].
    pub rotors: SymMat3<T>,
    /// Friction on the link side of the joint.
    pub friction: Friction<T>,
    /// The drive of the joint.
    pub drive: Option<Drive<T>>,
    /// From the frame the recursions use to the user's link frame.
    pub frame: Transform<T>,
}

impl<T: Scalar> Body<T> {
    /// Index of the parent body; `None` is the fixed world.
    #[inline(always)]
    pub fn parent(&self) -> Option<usize> {
        self.parent.map(usize::from)
    }

    /// Index of the joint's first entry in `q`.
    pub fn q_index(&self) -> usize {
        self.q_index.into()
    }

    /// Index of the joint's first entry in `qd` and all vectors of its length.
    pub fn v_index(&self) -> usize {
        self.v_index.into()
    }

    /// Whether the joint has a rotor behind an elastic transmission, and so a motor coordinate of its own.
    pub fn is_elastic(&self) -> bool {
        self.drive.is_some_and(|d| d.elastic.is_some())
    }

    /// Angle about the joint axis at the joint's coordinate `q`.
    #[inline(always)]
    pub(crate) fn angle<F: Scalar<Param = T>>(&self, q: F) -> F {
        self.angle_as(self.joint, q)
    }

    /// The same where the kind of joint is known.
    #[inline(always)]
    pub(crate) fn angle_as<F: Scalar<Param = T>>(&self, joint: JointKind, q: F) -> F {
        let zero = F::from_param(self.placement.zero);
        match joint {
            JointKind::Revolute => q + zero,
            _ => zero,
        }
    }

    /// The transform from the parent, beyond its branch, to this body, the joint being at `q` and turned by `theta`.
    #[inline(always)]
    pub(crate) fn across<F: Scalar<Param = T>>(&self, theta: Turn<F>, q: F) -> JointTransform<F> {
        self.across_as(self.joint, theta, q)
    }

    /// The same where the kind of joint is known.
    #[inline(always)]
    pub(crate) fn across_as<F: Scalar<Param = T>>(&self, joint: JointKind, theta: Turn<F>, q: F) -> JointTransform<F> {
        let at = &self.placement;
        let mut d = F::from_param(at.d);
        if joint == JointKind::Prismatic {
            d += q;
        }
        JointTransform { a: F::from_param(at.a), alpha: at.alpha.map(F::from_param), d, theta }
    }

    /// Inertia of the body with its rotors at rest.
    #[inline(always)]
    pub(crate) fn inertia_with_rotors<F: Scalar<Param = T>>(&self) -> SpatialInertia<F> {
        let mut inertia = self.inertia.map(F::from_param);
        inertia.rotational += self.rotors.map(F::from_param);
        inertia
    }

    /// The branch, unless the joint continues a chain.
    #[inline(always)]
    pub(crate) fn branch<F: Scalar<Param = T>>(&self) -> Option<Branch<F>> {
        self.placement.branch.map(|b| b.map(F::from_param))
    }

    /// The same record in another scalar.
    pub(crate) fn map<U>(&self, mut f: impl FnMut(T) -> U) -> Body<U> {
        let at = &self.placement;
        Body {
            parent: self.parent,
            joint: self.joint,
            q_index: self.q_index,
            v_index: self.v_index,
            shared: self.shared,
            placement: Placement {
                branch: at.branch.map(|b| b.map(&mut f)),
                a: f(at.a),
                alpha: at.alpha.map(&mut f),
                d: f(at.d),
                zero: f(at.zero),
            },
            inertia: self.inertia.map(&mut f),
            rotors: self.rotors.map(&mut f),
            friction: self.friction.map(&mut f),
            drive: self.drive.map(|d| d.map(&mut f)),
            frame: self.frame.map(&mut f),
        }
    }
}

/// What the recursions ask of a joint of one degree of freedom, its axis along z.
impl JointKind {
    /// `Iᴬ S`.
    #[inline(always)]
    pub(crate) fn column_of<F: Scalar>(self, ia: &ArticulatedInertia<F>) -> Force<F> {
        match self {
            Self::Prismatic => {
                let [x, y, z] = ia.mixed.rows;
                Force { ang: Vec3::new(x.z, y.z, z.z), lin: Vec3::new(ia.lin.xz, ia.lin.yz, ia.lin.zz) }
            }
            _ => Force { ang: Vec3::new(ia.ang.xz, ia.ang.yz, ia.ang.zz), lin: ia.mixed.rows[2] },
        }
    }

    /// `I S`.
    #[inline(always)]
    pub(crate) fn column_of_rigid<F: Scalar>(self, i: &SpatialInertia<F>) -> Force<F> {
        let h = i.first_moment;
        match self {
            Self::Prismatic => {
                Force { ang: Vec3::new(h.y, -h.x, F::zero()), lin: Vec3::new(F::zero(), F::zero(), i.mass) }
            }
            _ => {
                let ang = Vec3::new(i.rotational.xz, i.rotational.yz, i.rotational.zz);
                Force { ang, lin: Vec3::new(-h.y, h.x, F::zero()) }
            }
        }
    }

    /// `Sᵀ f`.
    #[inline(always)]
    pub(crate) fn along<F: Scalar>(self, f: Force<F>) -> F {
        match self {
            Self::Prismatic => f.lin.z,
            _ => f.ang.z,
        }
    }

    /// `m + S s`.
    #[inline(always)]
    pub(crate) fn moved<F: Scalar>(self, mut m: Motion<F>, s: F) -> Motion<F> {
        match self {
            Self::Prismatic => m.lin.z += s,
            _ => m.ang.z += s,
        }
        m
    }
}

/// What the recursions ask of a rotor.
impl<T: Scalar> Body<T> {
    /// A rotor that turns with the joint.
    #[inline(always)]
    pub(crate) fn rigid_rotor(&self) -> Option<&Rotor<T>> {
        self.drive.as_ref().filter(|d| d.elastic.is_none()).map(|d| &d.rotor)
    }

    /// The body that carries the joint's rotor.
    #[inline(always)]
    pub(crate) fn carrier(&self) -> Option<u16> {
        self.drive.as_ref().and_then(|d| d.rotor.mount)
    }

    /// `B` of a rigidly geared rotor, which turns with the joint; zero without one.
    #[inline(always)]
    pub(crate) fn rigid_reflected_inertia<F: Scalar<Param = T>>(&self) -> F {
        self.rigid_rotor().map_or(F::zero(), |r| F::from_param(r.reflected_inertia))
    }

    /// `[N J n; 0]` of a rigidly geared rotor, in the frame of its carrier; zero without one.
    #[inline(always)]
    pub(crate) fn rigid_coupling<F: Scalar<Param = T>>(&self) -> Force<F> {
        self.rigid_rotor().map_or(Force::zero(), |r| Force::couple(r.coupling()))
    }
}

impl Body<f64> {
    /// The same record in another scalar, every number rounded to it.
    pub fn cast<U: Scalar>(&self) -> Body<U> {
        self.map(U::from_f64)
    }
}
