//! Where every body is and how it moves, in world axes and in any number type.

use gyroflex::Scalar;
use gyroflex::model::{BodySpec, Fidelity, JointKind, RobotSpec};
use gyroflex::spatial::{Transform, Vec3};
use nalgebra::{Matrix3, Vector3};

/// Positions in a number type, so that they can move: `q` as in [`crate::State`], `theta` one a velocity coordinate.
#[derive(Clone, Debug)]
pub(super) struct Positions<T> {
    pub(super) q: Vec<T>,
    pub(super) theta: Vec<T>,
}

/// A rigid body at its centre of mass.
#[derive(Clone, Debug)]
pub(super) struct Body<T> {
    mass: f64,
    /// About the centre of mass, in axes of the body [kg m²].
    inertia: Matrix3<f64>,
    /// Centre of mass in the world [m].
    pub(super) centre: Vec3<T>,
    /// Velocity of the centre of mass, world axes [m/s].
    pub(super) velocity: Vec3<T>,
    /// Angular velocity in axes of the body [rad/s].
    spin: [T; 3],
}

impl<T: Scalar> Body<T> {
    fn new(mass: f64, inertia: Matrix3<f64>, at: &Frame<T>) -> Self {
        let spin = at.axes.map(|a| a.dot(at.omega));
        Self { mass, inertia, centre: at.origin, velocity: at.velocity, spin }
    }

    /// `m v·v' + ω·I ω'` with another motion from the same place: twice the kinetic energy, polarised.
    pub(super) fn pairing(&self, other: &Self) -> T {
        let mut sum = self.velocity.dot(other.velocity) * T::from_f64(self.mass);
        for (i, a) in self.spin.iter().enumerate() {
            for (j, b) in other.spin.iter().enumerate() {
                sum += *a * *b * T::from_f64(self.inertia[(i, j)]);
            }
        }
        sum
    }

    /// `−m g·c` [J].
    pub(super) fn potential(&self, gravity: Vec3<f64>) -> T {
        -(self.centre.dot(gravity.map(T::from_f64)) * T::from_f64(self.mass))
    }
}

/// A moving frame: its axes, origin and velocities in world axes.
#[derive(Clone, Copy)]
struct Frame<T> {
    axes: [Vec3<T>; 3],
    origin: Vec3<T>,
    omega: Vec3<T>,
    velocity: Vec3<T>,
}

impl<T: Scalar> Frame<T> {
    fn world() -> Self {
        let (o, i) = (T::zero(), T::one());
        let axes = [Vec3::new(i, o, o), Vec3::new(o, i, o), Vec3::new(o, o, i)];
        Self { axes, origin: Vec3::zero(), omega: Vec3::zero(), velocity: Vec3::zero() }
    }

    /// A vector given in this frame, in world axes.
    fn out(&self, v: [T; 3]) -> Vec3<T> {
        self.axes[0] * v[0] + self.axes[1] * v[1] + self.axes[2] * v[2]
    }

    /// The same of plain numbers.
    fn fixed(&self, v: Vec3<f64>) -> Vec3<T> {
        self.out(v.map(T::from_f64).to_array())
    }

    /// With the origin at another point that moves along.
    fn shifted(mut self, by: Vec3<T>) -> Self {
        self.origin += by;
        self.velocity += self.omega.cross(by);
        self
    }

    /// Placed in this frame the URDF way; the core stores the transposed rotation, whose rows are the axes.
    fn placed(&self, at: &Transform<f64>) -> Self {
        let axes = at.rot.rows.map(|a| self.fixed(a));
        Self { axes, ..self.shifted(self.fixed(at.pos)) }
    }

    /// Turned about a unit axis of this frame (Rodrigues), at a rate. In its own axes: in the world's every turn would enlarge the
    /// rounding of those before.
    fn turned(mut self, axis: Vec3<f64>, angle: T, rate: T) -> Self {
        let n = axis.map(T::from_f64);
        let (sin, cos) = angle.sin_cos();
        let turn = |a: Vec3<T>| a * cos + n.cross(a) * sin + n * (n.dot(a) * (T::one() - cos));
        self.omega += self.out(n.to_array()) * rate;
        self.axes = Self::world().axes.map(|a| self.out(turn(a).to_array()));
        self
    }

    /// Shifted along an axis of this frame, at a rate.
    fn slid(self, axis: Vec3<f64>, by: T, rate: T) -> Self {
        let n = self.fixed(axis);
        let mut out = self.shifted(n * by);
        out.velocity += n * rate;
        out
    }

    /// At the pose `x y z qx qy qz qw` in this frame, which rests, with a twist in its own axes.
    fn flying(&self, q: &[T], twist: &[T]) -> Self {
        let (u, w) = (Vec3::new(q[3], q[4], q[5]), q[6]);
        let twice = T::from_f64(2.0) / (u.dot(u) + w * w);
        let turn = |v: Vec3<T>| {
            let side = u.cross(v);
            v + (side * w + u.cross(side)) * twice
        };
        let mut out = *self;
        out.axes = Self::world().axes.map(|a| self.out(turn(a).to_array()));
        out.origin += self.out([q[0], q[1], q[2]]);
        out.omega = out.out([twist[0], twist[1], twist[2]]);
        out.velocity = out.out([twist[3], twist[4], twist[5]]);
        out
    }
}

/// Links, then rotors, of a robot at `x` that moves with `xd`: `nv` link velocities, then `nv` reflected motor velocities.
/// `rotors` says for every joint where in `xd` its rotor has its velocity: behind a rigid gear where the joint has its own.
pub(super) fn bodies<T: Scalar>(
    spec: &RobotSpec<'_>,
    fidelity: Fidelity,
    rotors: &[usize],
    x: &Positions<T>,
    xd: &[T],
) -> Vec<Body<T>> {
    let nv = xd.len() / 2;
    let mut links: Vec<Frame<T>> = Vec::new();
    let mut joints = Vec::new();
    let (mut iq, mut iv) = (0, 0);
    for body in spec.bodies {
        let joint = body.parent.map_or(Frame::world(), |p| links[p]).placed(&body.placement);
        links.push(match body.joint {
            JointKind::Revolute => joint.turned(body.axis, x.q[iq], xd[iv]),
            JointKind::Prismatic => joint.slid(body.axis, x.q[iq], xd[iv]),
            JointKind::Floating => joint.flying(&x.q[iq..iq + 7], &xd[iv..iv + 6]),
        });
        joints.push((iq, iv));
        (iq, iv) = (iq + body.joint.nq(), iv + body.joint.nv());
    }

    let mut inside = vec![Matrix3::zeros(); links.len()];
    let mut spinning = Vec::new();
    for (body, &(iq, iv)) in spec.bodies.iter().zip(&joints) {
        let Some(drive) = &body.drive else { continue };
        let (rotor, mount) = (&drive.rotor, &drive.rotor.mount);
        let axis = vector(mount.axis);
        let along = axis * axis.transpose();
        let (mass, transverse) = rotor.body.map_or((0.0, 0.0), |b| (b.mass, b.transverse_inertia));
        let inertia = along * rotor.inertia + (Matrix3::identity() - along) * transverse;
        if let (None, Some(link)) = (rotor.body, mount.body) {
            let turn = Matrix3::from_columns(&mount.placement.rot.rows.map(vector));
            inside[link] += turn * inertia * turn.transpose();
        }
        let mut at = mount.body.map_or(Frame::world(), |m| links[m]).placed(&mount.placement);
        if fidelity.is_gyroscopic() {
            let column = rotors[iv];
            let theta = if column < nv { x.q[iq] } else { x.theta[iv] };
            let gear = T::from_f64(drive.gear_ratio);
            at = at.turned(mount.axis, gear * theta, gear * xd[column]);
        }
        spinning.push(Body::new(mass, inertia, &at));
    }

    let link = |((body, at), inside): ((&BodySpec, &Frame<T>), Matrix3<f64>)| {
        let (i, mass) = (body.inertia.rotational, body.inertia.mass);
        let about_origin = Matrix3::new(i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz);
        let centre = if mass > 0.0 { vector(body.inertia.first_moment) / mass } else { Vector3::zeros() };
        let about_centre = about_origin + centre.cross_matrix() * centre.cross_matrix() * mass;
        let at = at.shifted(at.fixed([centre.x, centre.y, centre.z].into()));
        Body::new(mass, about_centre - inside, &at)
    };
    let mut all: Vec<Body<T>> = spec.bodies.iter().zip(&links).zip(inside).map(link).collect();
    all.extend(spinning);
    all
}

fn vector(v: Vec3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}
