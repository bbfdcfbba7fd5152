//! The oracle: the textbook equations of motion, assembled densely.
//!
//! Independent of the core on purpose: it reads the fields of a [`RobotSpec`] and from there on works in world axes with
//! nalgebra matrices. Every rotor is a body of its own that turns by its own angle `theta_m = N theta`; a robot of `n`
//! joints and `r` rotors is a tree of `n + r` rigid bodies with explicit Jacobians, and no recursion over forces, no spatial
//! vector and no lumping of inertias appears anywhere. Coordinates are `x = (q, theta)`, rotors *reflected*, which keeps
//! the mass matrix well scaled. The equations are
//!
//! ```text
//! M(q) xdd + h(q, xd) = Q
//! M = Σ m J_vᵀ J_v + J_ωᵀ I J_ω
//! h = Σ J_vᵀ m (a − g) + J_ωᵀ (I α + ω × I ω)   at xdd = 0
//! ```
//!
//! and a rigid gear is the constraint `theta = q`, imposed by the constant projection `xd = P yd`.
//!
//! In the reduced and the rigid reflected model a rotor does not turn: it rides on its mount, and `½ B θ̇²` is added.

mod energy;
mod equations;
mod kinematics;
mod law;

pub use energy::{Energy, Power};
pub(crate) use equations::solve_scaled;
pub use equations::{Accelerations, Matrices, Torques};

use crate::State;
use gyroflex::model::{DriveSpec, Fidelity, JointKind, RobotSpec, TransmissionSpec};
use kinematics::Tree;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// The equations of motion of one robot in one of the four models.
#[derive(Clone, Copy, Debug)]
pub struct Oracle<'a> {
    spec: RobotSpec<'a>,
    fidelity: Fidelity,
}

/// Where a link is and how it moves, all in world axes.
#[derive(Clone, Debug)]
pub struct LinkMotion {
    /// Takes coordinates of the link frame to world coordinates.
    pub rotation: Matrix3<f64>,
    /// Origin of the link frame.
    pub position: Vector3<f64>,
    /// Angular velocity.
    pub omega: Vector3<f64>,
    /// Velocity of the frame's origin.
    pub velocity: Vector3<f64>,
    /// `6 × nv`, angular rows first.
    pub jacobian: DMatrix<f64>,
}

/// A drive and where its coordinates are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DriveAt<'a> {
    pub(crate) spec: &'a DriveSpec,
    /// Index of its joint among the velocities.
    pub(crate) joint: usize,
    /// Index of the rotor in `x`.
    pub(crate) rotor: usize,
    /// Index of the rotor in `y`; that of the joint behind a rigid gear.
    pub(crate) free: usize,
}

impl<'a> Oracle<'a> {
    /// The oracle of a valid description.
    pub fn new(spec: RobotSpec<'a>, fidelity: Fidelity) -> Self {
        Self { spec, fidelity }
    }

    /// The same robot under another gravity, in world axes [m/s²].
    pub fn with_gravity(mut self, gravity: [f64; 3]) -> Self {
        self.spec.gravity = gravity.into();
        self
    }

    /// Number of link velocities.
    pub fn nv(&self) -> usize {
        self.spec.bodies.iter().map(|b| if b.joint == JointKind::Floating { 6 } else { 1 }).sum()
    }

    /// Motion of every link frame.
    pub fn links(&self, s: &State) -> Vec<LinkMotion> {
        let nv = self.nv();
        let of = |f: kinematics::Frame| {
            let mut jacobian = DMatrix::zeros(6, nv);
            jacobian.rows_mut(0, 3).copy_from(&f.jac_ang.columns(0, nv));
            jacobian.rows_mut(3, 3).copy_from(&f.jac_lin.columns(0, nv));
            LinkMotion { rotation: f.rot, position: f.pos, omega: f.omega, velocity: f.vel, jacobian }
        };
        self.tree(s).links.into_iter().map(of).collect()
    }

    fn is_elastic(&self, drive: &DriveSpec) -> bool {
        matches!(self.fidelity, Fidelity::Complete | Fidelity::Reduced)
            && matches!(drive.transmission, TransmissionSpec::Elastic { .. })
    }

    fn is_gyroscopic(&self) -> bool {
        matches!(self.fidelity, Fidelity::Complete | Fidelity::Rigid)
    }

    pub(crate) fn drives(&self) -> Vec<DriveAt<'a>> {
        let nv = self.nv();
        let (mut out, mut joint, mut elastic) = (Vec::<DriveAt<'a>>::new(), 0, 0);
        for body in self.spec.bodies {
            if let Some(spec) = &body.drive {
                let rotor = nv + out.len();
                let free = if self.is_elastic(spec) { nv + elastic } else { joint };
                elastic += usize::from(self.is_elastic(spec));
                out.push(DriveAt { spec, joint, rotor, free });
            }
            joint += if body.joint == JointKind::Floating { 6 } else { 1 };
        }
        out
    }

    /// `P`: from the free velocities `y = (q, elastic theta)` to all of them.
    fn projection(&self) -> DMatrix<f64> {
        let (nv, drives) = (self.nv(), self.drives());
        let free = nv + drives.iter().filter(|d| d.free >= nv).count();
        let mut p = DMatrix::zeros(nv + drives.len(), free);
        for i in 0..nv {
            p[(i, i)] = 1.0;
        }
        for d in &drives {
            p[(d.rotor, d.free)] = 1.0;
        }
        p
    }

    /// Positions and velocities of all rotors, reflected: those of the joint behind a rigid gear.
    fn rotors(&self, s: &State) -> (Vec<f64>, Vec<f64>) {
        let floating = self.spec.bodies.first().is_some_and(|b| b.joint == JointKind::Floating);
        let nv = self.nv();
        let at = |d: &DriveAt<'_>| {
            let iq = if floating { d.joint + 1 } else { d.joint };
            if d.free < nv { (s.q[iq], s.qd[d.joint]) } else { (s.theta[d.joint], s.thetad[d.joint]) }
        };
        self.drives().iter().map(at).unzip()
    }

    fn tree(&self, s: &State) -> Tree {
        let (theta, thetad) = self.rotors(s);
        Tree::new(&self.spec, self.is_gyroscopic(), s, &theta, &thetad)
    }

    /// All velocities `xd = (qd, thetad)`.
    fn velocities(&self, s: &State) -> DVector<f64> {
        let (_, thetad) = self.rotors(s);
        DVector::from_iterator(s.qd.len() + thetad.len(), s.qd.iter().copied().chain(thetad))
    }
}
