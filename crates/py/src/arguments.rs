//! The arguments every call of a robot shares: positions, velocities, motors, forces, and the name of a model.

use crate::arrays::Fit;
use crate::workspace::Workspace;
use crate::{arrays, errors};
use gyroflex::model::Fidelity;
use gyroflex_sim::eval::unit_quaternion;
use gyroflex_sim::load::{Mimic, nearest::nearest};
use pyo3::prelude::*;

/// Entries of a floating root in an array over the velocities.
pub(crate) const ROOT: usize = 6;

const POSITIONS: &str = "give one entry per position coordinate, in the order of `joint_names`, then `mode_names`; a floating root leads with x y z qx qy qz qw";
const VELOCITIES: &str = "give one entry per velocity coordinate, in the order of `joint_names`, then `mode_names`; a floating root leads with six";

/// Which entry of an array belongs to what.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) nq: usize,
    pub(crate) nv: usize,
    /// How many of these are modes of links that bend, the last ones.
    pub(crate) modes: usize,
    pub(crate) floating: bool,
    /// What the call takes several of, too, as its messages then say: a batch of states, or times.
    pub(crate) several: Option<&'static str>,
}

impl Layout {
    /// The layout for a call that takes one state or a batch.
    pub(crate) fn or_batch(self) -> Self {
        Self { several: Some("batch"), ..self }
    }

    /// The layout for a call that takes one moment or many.
    pub(crate) fn or_times(self) -> Self {
        Self { several: Some("times"), ..self }
    }

    /// Joint positions; the quaternion of a floating root must be a unit quaternion and is freed of rounding to fewer digits.
    pub(crate) fn positions(&self, value: &Bound<'_, PyAny>, q: &mut [f64]) -> PyResult<()> {
        self.positions_of("q", value, q)
    }

    /// Joint positions by another name.
    pub(crate) fn positions_of(&self, name: &str, value: &Bound<'_, PyAny>, q: &mut [f64]) -> PyResult<()> {
        arrays::read_fitting(name, value, self.given(value, q), self.fit(0, POSITIONS))?;
        if !self.floating {
            return Ok(());
        }
        unit_quaternion(&mut q[3..7]).map_err(|e| errors::argument(name, e.problem, e.remedy))
    }

    /// Joint velocities or accelerations.
    pub(crate) fn velocities(&self, name: &str, value: &Bound<'_, PyAny>, out: &mut [f64]) -> PyResult<()> {
        arrays::read_fitting(name, value, self.given(value, out), self.fit(0, VELOCITIES))
    }

    fn fit(&self, skip: usize, meaning: &'static str) -> Fit<'static> {
        Fit { skip, several: self.several, meaning }
    }

    /// What of a vector over joints and modes an argument gives: all, or with the modes left out the joints. Those are zero then.
    fn given<'a>(&self, value: &Bound<'_, PyAny>, out: &'a mut [f64]) -> &'a mut [f64] {
        let joints = out.len() - self.modes.min(out.len());
        let root = if self.floating { ROOT } else { 0 };
        let left_out = |n: usize| n == joints || n + root == joints;
        if self.modes == 0 || !value.len().is_ok_and(left_out) {
            return out;
        }
        out[joints..].fill(0.0);
        &mut out[..joints]
    }

    /// A state of which the motors' positions do not count.
    pub(crate) fn motion(
        &self,
        w: &mut Workspace,
        q: &Bound<'_, PyAny>,
        qd: &Bound<'_, PyAny>,
        thetad: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        self.positions(q, &mut w.q)?;
        self.velocities("qd", qd, &mut w.qd)?;
        w.theta.fill(0.0);
        self.motors("thetad", thetad, w.elastic, &mut w.thetad)
    }

    /// A state under motor torques and generalised forces from outside.
    pub(crate) fn torqued(
        &self,
        w: &mut Workspace,
        [q, qd]: [&Bound<'_, PyAny>; 2],
        [theta, thetad, tau, tau_ext]: [Option<&Bound<'_, PyAny>>; 4],
    ) -> PyResult<()> {
        self.state(w, q, qd, theta, thetad)?;
        self.forces("tau", tau.ok_or_else(|| errors::missing_torques("tau"))?, &mut w.tau)?;
        self.load_or_none(tau_ext, &mut w.tau_ext)
    }

    /// Positions and velocities of joints and motors.
    pub(crate) fn state(
        &self,
        w: &mut Workspace,
        q: &Bound<'_, PyAny>,
        qd: &Bound<'_, PyAny>,
        theta: Option<&Bound<'_, PyAny>>,
        thetad: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        self.positions(q, &mut w.q)?;
        self.velocities("qd", qd, &mut w.qd)?;
        self.motors("theta", theta, w.elastic, &mut w.theta)?;
        self.motors("thetad", thetad, w.elastic, &mut w.thetad)
    }

    /// An array over the motors, seen from the link side; zeros where it is neither given nor needed.
    pub(crate) fn motors(
        &self,
        name: &str,
        value: Option<&Bound<'_, PyAny>>,
        needed: bool,
        out: &mut [f64],
    ) -> PyResult<()> {
        match value {
            Some(value) => self.forces(name, value, out),
            None if needed => Err(errors::missing_of_elastic(name)),
            None => {
                out.fill(0.0);
                Ok(())
            }
        }
    }

    /// Refuses an array over motors or forces of which a floating root's six entries could be missing or just as many modes.
    pub(crate) fn refuse_two_readings(&self, name: &str, given: usize) -> PyResult<()> {
        if !(self.floating && self.modes == ROOT && given + ROOT == self.nv) {
            return Ok(());
        }
        let problem = format!("{given} entries are given, and the root's six can be missing or the modes");
        Err(errors::shape(name, problem, format!("give all {}, or the joints alone", self.nv)))
    }

    /// Motor torques or generalised forces; a floating root's six may be left out.
    pub(crate) fn forces(&self, name: &str, value: &Bound<'_, PyAny>, out: &mut [f64]) -> PyResult<()> {
        self.refuse_two_readings(name, value.len().unwrap_or_default())?;
        let skip = if self.floating { ROOT } else { 0 };
        arrays::read_fitting(name, value, self.given(value, out), self.fit(skip, VELOCITIES))
    }

    /// Generalised forces from outside; zeros for none.
    pub(crate) fn load_or_none(&self, value: Option<&Bound<'_, PyAny>>, room: &mut [f64]) -> PyResult<()> {
        match value {
            Some(value) => self.forces("tau_ext", value, room),
            None => {
                room.fill(0.0);
                Ok(())
            }
        }
    }

    /// Generalised forces from outside as the algorithms take them: an empty slice for none.
    pub(crate) fn load<'w>(&self, value: Option<&Bound<'_, PyAny>>, room: &'w mut [f64]) -> PyResult<&'w [f64]> {
        match value {
            Some(value) => {
                self.forces("tau_ext", value, room)?;
                Ok(room)
            }
            None => Ok(&[]),
        }
    }
}

/// The model of that name.
pub(crate) fn fidelity(name: &str) -> PyResult<Fidelity> {
    choice("model", name, &Fidelity::ALL.map(|f| (f.name(), f)))
}

/// What to do with joints that mimic another one.
pub(crate) fn mimic(name: &str) -> PyResult<Mimic> {
    choice("mimic", name, &[("refuse", Mimic::Refuse), ("independent", Mimic::Independent)])
}

/// The choice of that name.
pub(crate) fn choice<T: Copy>(argument: &str, name: &str, known: &[(&str, T)]) -> PyResult<T> {
    known.iter().find(|(n, _)| *n == name).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|(n, _)| *n).collect();
        let near = nearest(name, names.iter().copied()).unwrap_or_default();
        let remedy = format!("the nearest known one is `{near}`; known: {}", names.join(", "));
        errors::argument(argument, format!("`{name}` is not a choice"), remedy)
    })
}
