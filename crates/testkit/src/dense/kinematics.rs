//! Positions, Jacobians and velocity-product accelerations of every rigid body, in world axes.

use crate::State;
use gyroflex::model::{JointKind, RobotSpec};
use gyroflex::spatial;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

/// A moving frame.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Takes coordinates of the frame to world coordinates.
    pub(super) rot: Matrix3<f64>,
    /// Origin in the world.
    pub(super) pos: Vector3<f64>,
    pub(super) omega: Vector3<f64>,
    pub(super) vel: Vector3<f64>,
    /// Angular velocity is `jac_ang xd`.
    pub(super) jac_ang: Matrix3xX<f64>,
    /// Velocity of the origin is `jac_lin xd`.
    pub(super) jac_lin: Matrix3xX<f64>,
    /// Accelerations at `xdd = 0`: `J̇ xd`.
    bias_ang: Vector3<f64>,
    bias_lin: Vector3<f64>,
}

/// A rigid body, its frame moved to the centre of mass.
#[derive(Clone, Debug)]
pub(super) struct RigidBody {
    pub(super) mass: f64,
    /// About the centre of mass, in world axes.
    inertia: Matrix3<f64>,
    pub(super) at: Frame,
}

/// All bodies at one state.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// Link frames.
    pub(super) links: Vec<Frame>,
    /// Links, then rotors.
    pub(super) bodies: Vec<RigidBody>,
    /// `B` of rotors that do not turn as bodies, by coordinate.
    lumped: Vec<(usize, f64)>,
    gravity: Vector3<f64>,
    size: usize,
}

impl Frame {
    fn world(size: usize) -> Self {
        let o = Vector3::zeros();
        let (jac_ang, jac_lin) = (Matrix3xX::zeros(size), Matrix3xX::zeros(size));
        Self { rot: Matrix3::identity(), pos: o, omega: o, vel: o, jac_ang, jac_lin, bias_ang: o, bias_lin: o }
    }

    /// A frame fixed in this one: at `offset`, turned by `rot`.
    fn carried(&self, rot: &Matrix3<f64>, offset: &Vector3<f64>) -> Self {
        let d = self.rot * offset;
        Self {
            rot: self.rot * rot,
            pos: self.pos + d,
            omega: self.omega,
            vel: self.vel + self.omega.cross(&d),
            jac_ang: self.jac_ang.clone(),
            jac_lin: &self.jac_lin - d.cross_matrix() * &self.jac_ang,
            bias_ang: self.bias_ang,
            bias_lin: self.bias_lin + self.bias_ang.cross(&d) + self.omega.cross(&self.omega.cross(&d)),
        }
    }

    /// Turns about an axis given in this frame: by `angle`, at `rate` per unit of the coordinate `column` times `gear`.
    fn turned(mut self, axis: &Vector3<f64>, angle: f64, rate: f64, column: usize, gear: f64) -> Self {
        let n = self.rot * axis;
        let spin = n * rate;
        self.bias_ang += self.omega.cross(&spin);
        self.omega += spin;
        let mut entry = self.jac_ang.column_mut(column);
        entry += n * gear;
        self.rot *= Rotation3::from_axis_angle(&Unit::new_normalize(*axis), angle).matrix();
        self
    }

    /// Slides along an axis given in this frame.
    fn slid(self, axis: &Vector3<f64>, q: f64, qd: f64, column: usize) -> Self {
        let mut out = self.carried(&Matrix3::identity(), &(axis * q));
        let n = out.rot * axis;
        out.vel += n * qd;
        out.bias_lin += out.omega.cross(&n) * (2.0 * qd);
        let mut entry = out.jac_lin.column_mut(column);
        entry += n;
        out
    }

    /// Flies freely from a frame at rest. The six accelerations are the rates of the twist's body coordinates, so that the
    /// classical acceleration of the origin is `R (v̇ + ω × v)`.
    fn floating(self, q: &[f64], qd: &[f64]) -> Self {
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[6], q[3], q[4], q[5]));
        let mut out = self.carried(turn.to_rotation_matrix().matrix(), &Vector3::new(q[0], q[1], q[2]));
        out.omega = out.rot * Vector3::new(qd[0], qd[1], qd[2]);
        out.vel = out.rot * Vector3::new(qd[3], qd[4], qd[5]);
        out.bias_lin = out.omega.cross(&out.vel);
        out.jac_ang.fixed_columns_mut::<3>(0).copy_from(&out.rot);
        out.jac_lin.fixed_columns_mut::<3>(3).copy_from(&out.rot);
        out
    }
}

impl Tree {
    pub(super) fn new(spec: &RobotSpec<'_>, gyroscopic: bool, s: &State, theta: &[f64], thetad: &[f64]) -> Self {
        let (nv, size) = (s.qd.len(), s.qd.len() + theta.len());
        let world = Frame::world(size);
        let mut tree =
            Self { links: Vec::new(), bodies: Vec::new(), lumped: Vec::new(), gravity: vector(spec.gravity), size };
        // Link frames.
        let (mut iq, mut iv) = (0, 0);
        for body in spec.bodies {
            let (turn, offset) = pose(&body.placement);
            let joint = body.parent.map_or(&world, |p| &tree.links[p]).carried(&turn, &offset);
            let axis = vector(body.axis);
            let (nq, nv, link) = match body.joint {
                JointKind::Revolute => (1, 1, joint.turned(&axis, s.q[iq], s.qd[iv], iv, 1.0)),
                JointKind::Prismatic => (1, 1, joint.slid(&axis, s.q[iq], s.qd[iv], iv)),
                JointKind::Floating => (7, 6, joint.floating(&s.q[iq..iq + 7], &s.qd[iv..iv + 6])),
            };
            (iq, iv) = (iq + nq, iv + nv);
            tree.links.push(link);
        }
        // Rotors, each at its own centre; and what the links lose that were given with a rotor inside.
        let mut contained = vec![Matrix3::zeros(); spec.bodies.len()];
        let mut rotors = Vec::new();
        for (k, drive) in spec.bodies.iter().filter_map(|b| b.drive.as_ref()).enumerate() {
            let (rotor, n) = (&drive.rotor, drive.gear_ratio);
            let (turn, offset) = pose(&rotor.mount.placement);
            let axis = vector(rotor.mount.axis).normalize();
            let spin = axis * axis.transpose() * rotor.inertia;
            let (mass, transverse) = rotor.body.map_or((0.0, 0.0), |b| (b.mass, b.transverse_inertia));
            if let (None, Some(mount)) = (rotor.body, rotor.mount.body) {
                contained[mount] += turn * spin * turn.transpose();
            }
            let mut at = rotor.mount.body.map_or(&world, |m| &tree.links[m]).carried(&turn, &offset);
            if gyroscopic {
                at = at.turned(&axis, n * theta[k], n * thetad[k], nv + k, n);
            } else {
                tree.lumped.push((nv + k, n * n * rotor.inertia));
            }
            let own = (Matrix3::identity() - axis * axis.transpose()) * transverse + spin;
            rotors.push(RigidBody { mass, inertia: at.rot * own * at.rot.transpose(), at });
        }
        // Links, each at its own centre of mass.
        for ((body, link), rotors_inside) in spec.bodies.iter().zip(&tree.links).zip(contained) {
            let (mass, moment) = (body.inertia.mass, vector(body.inertia.first_moment));
            let com = if mass > 0.0 { moment / mass } else { Vector3::zeros() };
            let about_com = symmetric(body.inertia.rotational) + com.cross_matrix() * com.cross_matrix() * mass;
            let at = link.carried(&Matrix3::identity(), &com);
            let inertia = at.rot * (about_com - rotors_inside) * at.rot.transpose();
            tree.bodies.push(RigidBody { mass, inertia, at });
        }
        tree.bodies.extend(rotors);
        tree
    }

    /// `M = Σ m J_vᵀ J_v + J_ωᵀ I J_ω`.
    pub(super) fn mass_matrix(&self) -> DMatrix<f64> {
        let mut m = DMatrix::zeros(self.size, self.size);
        for b in &self.bodies {
            m.gemm_tr(b.mass, &b.at.jac_lin, &b.at.jac_lin, 1.0);
            m.gemm_tr(1.0, &b.at.jac_ang, &(b.inertia * &b.at.jac_ang), 1.0);
        }
        for &(i, reflected) in &self.lumped {
            m[(i, i)] += reflected;
        }
        m
    }

    /// `M xdd + h`, gravity included, by Newton's and Euler's equations of every body.
    pub(super) fn forces(&self, xdd: &DVector<f64>) -> DVector<f64> {
        let mut q = DVector::zeros(self.size);
        for b in &self.bodies {
            let acc = &b.at.jac_lin * xdd + b.at.bias_lin - self.gravity;
            let alpha = &b.at.jac_ang * xdd + b.at.bias_ang;
            let moment = b.inertia * alpha + b.at.omega.cross(&(b.inertia * b.at.omega));
            q += b.at.jac_lin.tr_mul(&(acc * b.mass)) + b.at.jac_ang.tr_mul(&moment);
        }
        for &(i, reflected) in &self.lumped {
            q[i] += reflected * xdd[i];
        }
        q
    }

    /// Potential energy in the field of gravity, zero at the world's origin.
    pub(super) fn gravity_energy(&self) -> f64 {
        -self.bodies.iter().map(|b| b.mass * self.gravity.dot(&b.at.pos)).sum::<f64>()
    }

    /// Sum of the bodies' kinetic energies.
    pub(super) fn kinetic_energy(&self, xd: &DVector<f64>) -> f64 {
        let of = |b: &RigidBody| b.mass * b.at.vel.norm_squared() + b.at.omega.dot(&(b.inertia * b.at.omega));
        let spin: f64 = self.lumped.iter().map(|&(i, reflected)| reflected * xd[i] * xd[i]).sum();
        0.5 * (self.bodies.iter().map(of).sum::<f64>() + spin)
    }
}

fn vector(v: spatial::Vec3<f64>) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

/// Rotation and translation of a placement the URDF way; the core stores the transposed rotation.
fn pose(t: &spatial::Transform<f64>) -> (Matrix3<f64>, Vector3<f64>) {
    let [a, b, c] = t.rot.rows.map(vector);
    (Matrix3::from_columns(&[a, b, c]), vector(t.pos))
}

fn symmetric(s: spatial::SymMat3<f64>) -> Matrix3<f64> {
    Matrix3::new(s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz)
}
