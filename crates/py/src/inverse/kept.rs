//! Inverses between calls.

use crate::errors;
use gyroflex::model::Fidelity;
use gyroflex_sim::Robot;
use gyroflex_sim::inverse::{InverseModel, with_least_damping};
use pyo3::PyResult;
use std::sync::Mutex;

/// What an inverse was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wanted {
    pub(super) fidelity: Fidelity,
    pub(super) torque_derivatives: usize,
    /// Least damping of the transmissions.
    pub(super) damping: f64,
}

/// Inverses of one robot that no call uses at present: to find out what one needs of a motion takes longer than to run it.
#[derive(Debug, Default)]
pub(crate) struct Inverses {
    idle: Mutex<Vec<(Wanted, InverseModel)>>,
}

/// As many inverses are kept.
const KEPT: usize = 16;

impl Inverses {
    /// Runs `call` with an inverse that nobody else uses.
    pub(super) fn with<R>(
        &self,
        robot: &Robot,
        wanted: Wanted,
        call: impl FnOnce(&mut InverseModel) -> PyResult<R>,
    ) -> PyResult<R> {
        // A call that panicked took its inverse with it: what is kept is always whole.
        let mut idle = self.idle.lock().unwrap_or_else(|e| e.into_inner());
        let found = idle.iter().position(|(made_for, _)| *made_for == wanted).map(|i| idle.swap_remove(i).1);
        drop(idle);
        let mut inverse = match found {
            Some(inverse) => inverse,
            None => {
                let damped = with_least_damping(robot, wanted.damping);
                InverseModel::new(&damped, wanted.fidelity, wanted.torque_derivatives).map_err(errors::raise)?
            }
        };
        let result = call(&mut inverse);
        let mut idle = self.idle.lock().unwrap_or_else(|e| e.into_inner());
        if idle.len() >= KEPT {
            idle.swap_remove(0);
        }
        idle.push((wanted, inverse));
        result
    }
}
