//! Where a robot is linearized.

use super::Linearizer;
use crate::equilibrium::Equilibrium;
use crate::error::{Error, ErrorKind};
use crate::eval::unit_quaternion;
use crate::simulate::StateVec;
use gyroflex::dynamics::External;

/// A state and the motor torques there.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatingPoint {
    /// The state.
    pub state: StateVec,
    /// Reflected motor torques, `nv` entries [N m or N]; of a floating root the wrench that acts on it, held constant in its frame.
    pub tau: Vec<f64>,
    /// The instant, on a motion [s].
    pub time: Option<f64>,
}

impl OperatingPoint {
    /// Size of the wrench on a floating root, its largest entry [N m or N]: what a robot in the air would have to be held with.
    pub fn root_wrench(&self, floating: bool) -> f64 {
        let root = if floating { 6 } else { 0 };
        self.tau.iter().take(root).fold(0.0, |most, x| most.max(x.abs()))
    }
}

impl Linearizer {
    /// Equilibrium at the positions `q` (`nq` entries). Where links bend, the modes may be left out: the links are then deflected as they
    /// hang at rest. Modes that are given are held where they are.
    ///
    /// # Errors
    /// Positions that do not fit the robot.
    pub fn equilibrium_at(&mut self, q: &[f64]) -> Result<OperatingPoint, Error> {
        let modes = self.layout.modes();
        let q = match q.len() + modes == self.dynamics.nq() && modes > 0 {
            true => {
                let mut q = self.checked_positions(&[q, &vec![0.0; modes]].concat())?;
                self.dynamics.settle(&mut q, External::none())?;
                q
            }
            false => self.checked_positions(q)?,
        };
        let nv = self.layout.nv();
        let mut state = StateVec { q, ..StateVec::zeros(0, nv) };
        let mut tau = vec![0.0; nv];
        Equilibrium::new(nv).solve(&mut self.dynamics, &state.q, External::none(), &mut state.theta, &mut tau)?;
        Ok(OperatingPoint { state, tau, time: None })
    }

    /// Any state with any motor torques (`nv` entries).
    ///
    /// # Errors
    /// Vectors that do not fit the robot.
    pub fn point(&self, state: StateVec, tau: Vec<f64>) -> Result<OperatingPoint, Error> {
        let q = self.checked_positions(&state.q)?;
        for (name, vector) in [("qd", &state.qd), ("theta", &state.theta), ("thetad", &state.thetad), ("tau", &tau)] {
            check(name, vector, self.layout.nv())?;
        }
        Ok(OperatingPoint { state: StateVec { q, ..state }, tau, time: None })
    }

    /// The zero position: joints at zero, a floating root at the world's origin; without the modes of links that bend.
    pub fn zero_position(&self) -> Vec<f64> {
        let mut q = vec![0.0; self.dynamics.nq() - self.layout.modes()];
        if self.layout.floating() {
            q[6] = 1.0;
        }
        q
    }

    pub(super) fn checked_positions(&self, q: &[f64]) -> Result<Vec<f64>, Error> {
        check("q", q, self.dynamics.nq())?;
        let mut q = q.to_vec();
        if self.layout.floating() {
            unit_quaternion(&mut q[3..7])?;
        }
        Ok(q)
    }
}

/// Refuses a vector of the wrong length or with numbers that are none.
pub(super) fn check(name: &str, vector: &[f64], expected: usize) -> Result<(), Error> {
    let fault = |problem: String, remedy: &str| Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: name.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    };
    if vector.len() != expected {
        let problem = format!("{} entries are given, but {expected} are expected", vector.len());
        return Err(fault(problem, "give one entry per coordinate, in the order of `gyroflex info`"));
    }
    match vector.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(fault(format!("{x} is not a finite number"), "give finite numbers")),
        None => Ok(()),
    }
}
