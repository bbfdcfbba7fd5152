//! The algorithms that run over many states.

use super::work::Work;
use crate::link_frame::LinkFrame;
use gyroflex::Scalar;
use gyroflex::dynamics::{
    self, Acceleration, Axes, Bias, CoriolisMatrices, External, Forward, Frame, InertiaRates, Inverse, State,
};
use gyroflex::model::{Model, SizeError};
use gyroflex::spatial::Transform;

/// What is computed of every state.
#[derive(Clone, Debug)]
pub enum Algorithm {
    /// `qdd`, `thetadd`, `tau_j`.
    ForwardDynamics,
    /// `tau_j`, `tau`.
    InverseDynamics,
    /// `M`, by rows.
    MassMatrix,
    /// `S`, by rows.
    CouplingMatrix,
    /// `C`, `C1`, `C2`, by rows.
    CoriolisMatrices,
    /// The rates of `M` and `S`, by rows.
    InertiaRates,
    /// Forces of velocity and gravity on links and motors.
    Bias,
    /// Forces of gravity.
    GravityTorques,
    /// Kinetic energy, that of gravity, and that of the springs [J].
    Energy,
    /// Pose of a link's frame in the world, `4 × 4` by rows.
    Placement(LinkFrame),
    /// Jacobian of a link's frame, `6 × nv` by rows, angular rows first.
    Jacobian(LinkFrame, Axes),
}

impl Algorithm {
    /// Numbers that each result has of a state, for a robot of `nv` velocities.
    pub fn columns(&self, nv: usize) -> Vec<usize> {
        match self {
            Self::ForwardDynamics => vec![nv; 3],
            Self::InverseDynamics | Self::Bias => vec![nv; 2],
            Self::MassMatrix | Self::CouplingMatrix => vec![nv * nv],
            Self::CoriolisMatrices => vec![nv * nv; 3],
            Self::InertiaRates => vec![nv * nv; 2],
            Self::GravityTorques => vec![nv],
            Self::Energy => vec![1; 3],
            Self::Placement(..) => vec![16],
            Self::Jacobian(..) => vec![6 * nv],
        }
    }

    /// What its results are called.
    pub fn names(&self) -> &'static [&'static str] {
        match self {
            Self::ForwardDynamics => &["qdd", "thetadd", "tau_j"],
            Self::InverseDynamics => &["tau_j", "tau"],
            Self::MassMatrix => &["mass matrix"],
            Self::CouplingMatrix => &["coupling matrix"],
            Self::CoriolisMatrices => &["C", "C1", "C2"],
            Self::InertiaRates => &["dM", "dS"],
            Self::Bias => &["link", "motor"],
            Self::GravityTorques => &["gravity torques"],
            Self::Energy => &["kinetic", "gravity", "elastic"],
            Self::Placement(..) => &["placement"],
            Self::Jacobian(..) => &["jacobian"],
        }
    }

    /// Runs it on states side by side, of a robot whose links do not bend.
    pub(super) fn run<T: Scalar>(&self, model: &Model<T::Param>, work: &mut Work<T>) -> Result<(), SizeError> {
        let columns = self.columns(model.nv());
        let room = |i: usize| columns.get(i).copied().unwrap_or(0);
        let Work { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext, out: [a, b, c], scratch } = work;
        let (a, b, c) = (&mut a[..room(0)], &mut b[..room(1)], &mut c[..room(2)]);
        let state = State { q: &*q, qd, theta, thetad };
        let ext = External { tau: &*tau_ext, wrenches: &[] };
        match self {
            Self::ForwardDynamics => {
                let out = Forward { qdd: a, thetadd: b, tau_j: c };
                dynamics::forward_dynamics(model, state, tau, ext, scratch.forward(), out)
            }
            Self::InverseDynamics => {
                let accel = Acceleration { qdd, thetadd };
                dynamics::rnea(model, state, accel, ext, &mut scratch.rnea, Inverse { tau_j: a, tau: b })
            }
            Self::MassMatrix => dynamics::crba(model, q, &mut scratch.crba, a),
            Self::CouplingMatrix => dynamics::coupling(model, q, &mut scratch.crba, a),
            Self::CoriolisMatrices => {
                let out = CoriolisMatrices { c: a, c1: b, c2: c };
                dynamics::coriolis_matrices(model, state, &mut scratch.derivative, out)
            }
            Self::InertiaRates => {
                dynamics::inertia_rates(model, state, &mut scratch.derivative, InertiaRates { m: a, s: b })
            }
            Self::Bias => dynamics::bias(model, state, &mut scratch.derivative, Bias { link: a, motor: b }),
            Self::GravityTorques => dynamics::gravity_torques(model, q, &mut scratch.derivative, a),
            Self::Energy => {
                let energy = dynamics::energy(model, state, &mut scratch.moving)?;
                (a[0], b[0], c[0]) = (energy.kinetic, energy.gravity, energy.elastic);
                Ok(())
            }
            Self::Placement(frame) => {
                dynamics::placements(model, q, &mut scratch.poses)?;
                let placement = frame.placement.map(T::from_f64);
                let pose = frame.body.map_or(placement, |body| placement.after(scratch.poses[body]));
                write_pose(pose, a);
                Ok(())
            }
            Self::Jacobian(frame, axes) => {
                let Some(body) = frame.body else {
                    a.fill(T::zero());
                    return Ok(());
                };
                dynamics::placements(model, q, &mut scratch.poses)?;
                let frame = Frame { body, placement: frame.placement.map(T::from_f64) };
                dynamics::jacobian(model, &scratch.poses, frame, *axes, a)
            }
        }
    }
}

/// A pose as `4 × 4` numbers by rows.
pub(super) fn write_pose<T: Scalar>(pose: Transform<T>, out: &mut [T]) {
    let (rotation, p) = (pose.rotation(), pose.pos.to_array());
    let rows = rotation.rows.into_iter().zip(p).flat_map(|(row, p)| {
        let [x, y, z] = row.to_array();
        [x, y, z, p]
    });
    let last = [T::zero(), T::zero(), T::zero(), T::one()];
    out.iter_mut().zip(rows.chain(last)).for_each(|(to, from)| *to = from);
}
