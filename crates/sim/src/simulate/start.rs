//! The state a scenario starts from.

use crate::contact::Contacts;
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::equilibrium::Equilibrium;
use crate::error::Error;
use crate::loads::Loads;
use crate::reference::References;
use crate::scenario::{ScenarioFile, fault};
use gyroflex::control::Motors;
use gyroflex::dynamics::State;
use gyroflex::integrate::StateMut;

/// A state in storage of its own; lengths as in [`State`].
#[derive(Clone, Debug, PartialEq)]
pub struct StateVec {
    /// Joint positions, then modal coordinates of links that bend, `nq` entries.
    pub q: Vec<f64>,
    /// Joint velocities, then rates of the modal coordinates, `nv` entries.
    pub qd: Vec<f64>,
    /// Reflected motor positions, `nv` entries.
    pub theta: Vec<f64>,
    /// Reflected motor velocities, `nv` entries.
    pub thetad: Vec<f64>,
}

impl StateVec {
    /// A state of zeros.
    pub fn zeros(nq: usize, nv: usize) -> Self {
        Self { q: vec![0.0; nq], qd: vec![0.0; nv], theta: vec![0.0; nv], thetad: vec![0.0; nv] }
    }

    /// For algorithms that read it.
    pub fn view(&self) -> State<'_, f64> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }

    /// For algorithms that change it.
    pub fn view_mut(&mut self) -> StateMut<'_, f64> {
        StateMut { q: &mut self.q, qd: &mut self.qd, theta: &mut self.theta, thetad: &mut self.thetad }
    }
}

/// The initial state: what the scenario gives, and for the rest the reference at time 0 and static equilibrium, with the forces of what holds the
/// robot if there is one with them; or, where the controller knows how the motors move, that.
pub(super) fn initial_state(
    file: &ScenarioFile,
    joints: &Coordinates,
    references: &References,
    motors: Option<Motors<f64>>,
    dynamics: &mut Dynamics,
    loads: &mut Loads,
    contacts: &mut Contacts,
) -> Result<StateVec, Error> {
    let (initial, keys) = (&file.scenario.initial, &file.keys);
    let mut state = StateVec::zeros(dynamics.nq(), dynamics.nv());
    match (&initial.base, joints.floating) {
        (Some(_), false) => {
            let problem = "the robot's root is fixed";
            return Err(fault(keys, "initial.base", problem, "remove it, or load the robot with a floating root"));
        }
        (base, true) => {
            let base = base.clone().unwrap_or_default();
            state.q[..3].copy_from_slice(&base.xyz);
            state.q[3..7].copy_from_slice(&quaternion(base.rpy));
            state.qd[..6].copy_from_slice(&base.twist);
        }
        (None, false) => {}
    }
    let q = joints.spread(&initial.q, keys, "initial.q")?;
    let qd = joints.spread(&initial.qd, keys, "initial.qd")?;
    let theta = joints.spread(&initial.theta, keys, "initial.theta")?;
    let thetad = joints.spread(&initial.thetad, keys, "initial.thetad")?;
    for (i, joint) in joints.joints.iter().enumerate() {
        let start = references.point(i, 0.0);
        state.q[joint.q] = q[i].unwrap_or(start.q);
        state.qd[joint.v] = qd[i].unwrap_or(start.qd);
        state.thetad[joint.v] = state.qd[joint.v];
    }

    let eta = joints.spread_modes(&initial.eta, keys, "initial.eta")?;
    let etad = joints.spread_modes(&initial.etad, keys, "initial.etad")?;
    loads.set_time(0.0);
    hang(dynamics, loads, &mut state.q, &eta)?;
    let first = state.qd.len() - etad.len();
    state.qd[first..].iter_mut().zip(&etad).for_each(|(rate, given)| *rate = given.unwrap_or(0.0));
    state.thetad[first..].copy_from_slice(&state.qd[first..]);
    loads.update(dynamics, &state.q)?;
    let mut tau = vec![0.0; dynamics.nv()];
    let mut equilibrium = Equilibrium::new(dynamics.nv());
    equilibrium.solve(dynamics, &state.q, loads.external(), &mut state.theta, &mut tau)?;
    contacts.equilibrium(dynamics, &mut state, loads, &mut equilibrium)?;
    for (i, joint) in joints.joints.iter().enumerate() {
        let elastic = dynamics.model().bodies()[joint.body].is_elastic();
        if let Some(motors) = motors.filter(|_| elastic) {
            (state.theta[joint.v], state.thetad[joint.v]) = (motors.theta[joint.v], motors.thetad[joint.v]);
        }
        for (given, slot, key) in [(theta[i], &mut state.theta, "theta"), (thetad[i], &mut state.thetad, "thetad")] {
            let Some(value) = given else { continue };
            if !elastic {
                let problem = format!("joint `{}` has no elastic transmission in this model", joint.name);
                let remedy = "remove it: the motor turns with the joint";
                return Err(fault(keys, &format!("initial.{key}.{}", joint.name), problem, remedy));
            }
            slot[joint.v] = value;
        }
    }
    Ok(state)
}

/// Modal coordinates as given; those that are not as the links hang at rest. Loads turn with the links, so both are found in turn.
fn hang(dynamics: &mut Dynamics, loads: &mut Loads, q: &mut [f64], given: &[Option<f64>]) -> Result<(), Error> {
    if given.is_empty() {
        return Ok(());
    }
    let first = q.len() - given.len();
    if given.iter().any(Option::is_none) {
        for _ in 0..MOST_TURNS {
            let before = q[first..].to_vec();
            loads.update(dynamics, q)?;
            dynamics.settle(q, loads.external())?;
            let moved = q[first..].iter().zip(&before).fold(0.0, |most: f64, (x, b)| most.max((x - b).abs()));
            let size = q[first..].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            if loads.is_empty() || moved <= 1e-13 * size {
                break;
            }
        }
    }
    q[first..].iter_mut().zip(given).for_each(|(eta, given)| *eta = given.unwrap_or(*eta));
    Ok(())
}

/// Deflection and loads that turn with it agree after a few turns, or will not.
const MOST_TURNS: usize = 50;

/// The unit quaternion `x y z w` of roll, pitch and yaw about fixed axes, as in URDF.
fn quaternion([roll, pitch, yaw]: [f64; 3]) -> [f64; 4] {
    let ((sr, cr), (sp, cp), (sy, cy)) = ((roll / 2.0).sin_cos(), (pitch / 2.0).sin_cos(), (yaw / 2.0).sin_cos());
    [sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy]
}
