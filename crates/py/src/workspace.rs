//! Storage for one call: scratch of the algorithms and room for arguments and results, lent from a pool.

use crate::errors;
use gyroflex::model::Fidelity;
use gyroflex::spatial::Transform;
use gyroflex_sim::{Dynamics, Robot};
use pyo3::PyResult;
use std::sync::Mutex;

/// Everything a call writes to. What an earlier call left behind is never read.
#[derive(Debug)]
pub(crate) struct Workspace {
    pub(crate) dynamics: Dynamics,
    /// Whether any joint has a motor coordinate of its own in this model.
    pub(crate) elastic: bool,
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) theta: Vec<f64>,
    pub(crate) thetad: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
    pub(crate) thetadd: Vec<f64>,
    pub(crate) tau: Vec<f64>,
    pub(crate) tau_ext: Vec<f64>,
    /// Up to three results over the joints.
    pub(crate) out: [Vec<f64>; 3],
    /// A result of `nv * nv` entries by rows.
    pub(crate) matrix: Vec<f64>,
    /// Pose of every body.
    pub(crate) poses: Vec<Transform<f64>>,
}

impl Workspace {
    fn new(robot: &Robot, fidelity: Fidelity) -> Result<Self, gyroflex_sim::Error> {
        let dynamics = Dynamics::new(robot.model(fidelity)?);
        let model = dynamics.model();
        let (nq, nv) = (dynamics.nq(), dynamics.nv());
        let zeros = || vec![0.0; nv];
        Ok(Self {
            elastic: model.bodies().iter().any(|b| b.is_elastic()),
            q: vec![0.0; nq],
            qd: zeros(),
            theta: zeros(),
            thetad: zeros(),
            qdd: zeros(),
            thetadd: zeros(),
            tau: zeros(),
            tau_ext: zeros(),
            out: [zeros(), zeros(), zeros()],
            matrix: vec![0.0; nv * nv],
            poses: vec![Transform::identity(); model.bodies().len()],
            dynamics,
        })
    }
}

/// Workspaces of one robot, for each of its models as many as there ever were calls at the same time.
#[derive(Debug, Default)]
pub(crate) struct Pool {
    idle: [Mutex<Vec<Workspace>>; Fidelity::ALL.len()],
}

impl Pool {
    /// Runs `call` with a workspace that nobody else uses.
    pub(crate) fn with<R>(
        &self,
        robot: &Robot,
        fidelity: Fidelity,
        call: impl FnOnce(&mut Workspace) -> PyResult<R>,
    ) -> PyResult<R> {
        let idle = &self.idle[index(fidelity)];
        // A call that panicked took its workspace with it: what is in the pool is always whole.
        let lent = idle.lock().unwrap_or_else(|e| e.into_inner()).pop();
        let mut workspace = match lent {
            Some(workspace) => workspace,
            None => Workspace::new(robot, fidelity).map_err(errors::raise)?,
        };
        let result = call(&mut workspace);
        idle.lock().unwrap_or_else(|e| e.into_inner()).push(workspace);
        result
    }
}

fn index(fidelity: Fidelity) -> usize {
    match fidelity {
        Fidelity::Complete => 0,
        Fidelity::Reduced => 1,
        Fidelity::Rigid => 2,
        Fidelity::RigidReflected => 3,
    }
}
