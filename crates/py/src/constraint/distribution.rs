//! How motors and constraints share a load, as arrays and names say it.

use crate::arrays::{read, read_without};
use crate::errors;
use crate::robot::PyRobot;
use gyroflex::dynamics::{Constraint, TorqueDistribution, constraint_rows};
use gyroflex_sim::load::nearest::nearest;
use pyo3::prelude::*;

/// What a force along a constrained direction costs beside torques: next to nothing, but enough to determine all forces.
const NEXT_TO_NOTHING: f64 = 1e-6;
const PER_JOINT: &str = "give one weight per velocity coordinate, in the order of `joint_names`";
const PER_DIRECTION: &str = "give one entry per constrained direction, constraint by constraint";

pub(super) struct Distribution {
    torques: Vec<f64>,
    passive: Vec<usize>,
    multipliers: Vec<f64>,
    wanted: Vec<f64>,
}

impl Distribution {
    pub(super) fn read(
        robot: &PyRobot,
        held: &[Constraint<f64>],
        passive: Option<Vec<String>>,
        torques: Option<&Bound<'_, PyAny>>,
        multipliers: Option<&Bound<'_, PyAny>>,
        wanted: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        if let Some(i) = held.iter().position(|c| c.contact.is_some_and(|contact| contact.slip.is_some())) {
            let remedy = "leave it out, and give its force by `tau_ext`";
            let problem = format!("constraint {i} slips, so that its force is no choice");
            return Err(errors::argument("constraints", problem, remedy));
        }
        let (nv, rows) = (robot.layout.nv, constraint_rows(held));
        let mut own = Self {
            torques: vec![1.0; nv],
            passive: passive_of(robot, &passive.unwrap_or_default())?,
            multipliers: vec![NEXT_TO_NOTHING; rows],
            wanted: vec![0.0; rows],
        };
        if let Some(given) = torques {
            read_without("torque_weights", given, nv - robot.joint_names().len(), &mut own.torques, PER_JOINT)?;
            if let Some(k) = (0..nv).find(|k| !own.passive.contains(k) && own.torques[*k] <= 0.0) {
                let problem = format!("entry {k} is {}", own.torques[k]);
                return Err(errors::argument("torque_weights", problem, "give weights above zero"));
            }
        }
        if let Some(given) = multipliers {
            read("multiplier_weights", given, &mut own.multipliers, PER_DIRECTION)?;
            if let Some(k) = own.multipliers.iter().position(|cost| *cost < 0.0) {
                let problem = format!("entry {k} is {}", own.multipliers[k]);
                return Err(errors::argument("multiplier_weights", problem, "give weights of zero or more"));
            }
        }
        if let Some(given) = wanted {
            read("wanted", given, &mut own.wanted, PER_DIRECTION)?;
        }
        Ok(own)
    }

    /// Velocities that nothing drives.
    pub(super) fn passive(&self) -> &[usize] {
        &self.passive
    }

    pub(super) fn view(&self) -> TorqueDistribution<'_, f64> {
        let Self { torques, passive, multipliers, wanted } = self;
        TorqueDistribution { torques, passive, multipliers, wanted }
    }
}

/// A floating root's velocities, and those of the joints of these names.
fn passive_of(robot: &PyRobot, names: &[String]) -> PyResult<Vec<usize>> {
    let known = robot.joint_names();
    let lead = robot.layout.nv - known.len();
    let mut passive: Vec<usize> = (0..lead).collect();
    for name in names {
        let Some(at) = known.iter().position(|joint| joint == name) else {
            let remedy = match nearest(name, known.iter().copied()) {
                Some(near) => format!("the nearest known one is `{near}`"),
                None => "the robot has no joints".to_owned(),
            };
            return Err(errors::argument("passive", format!("the robot has no joint `{name}`"), remedy));
        };
        if !passive.contains(&(lead + at)) {
            passive.push(lead + at);
        }
    }
    Ok(passive)
}
