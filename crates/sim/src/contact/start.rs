//! Where a run begins: what is on the ground, what the first state misses, and motors in equilibrium with the forces of what is held.

use super::points::SLOW;
use super::{Contacts, Mode};
use crate::dynamics::Dynamics;
use crate::equilibrium::Equilibrium;
use crate::error::{Error, Warning};
use crate::load::yaml::Keys;
use crate::loads::Loads;
use crate::scenario::fault;
use crate::simulate::StateVec;
use gyroflex::spatial::Vec3;

/// Points that start this near to the ground are on it [m].
const ON_GROUND: f64 = 1e-6;
/// Constraints that start farther off than this are not kept [m or rad].
const START: f64 = 1e-3;

impl Contacts {
    /// Begins at a state at time 0: points on the ground that do not move away are closed.
    ///
    /// # Errors
    /// A point below the ground, with its name and depth, and constraints that the state does not keep, that contradict each other or that leave
    /// no way to move.
    pub fn start(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        (tau, loads): (&[f64], &mut Loads),
        keys: &Keys,
        warnings: &mut Vec<Warning>,
    ) -> Result<(), Error> {
        self.events.clear();
        self.impacts.clear();
        self.closed.clear();
        self.largest_drift = 0.0;
        self.refresh();
        self.measure(dynamics, state.view())?;
        let mut row = 0;
        for (name, constraint) in self.names.iter().zip(&self.permanent) {
            for _ in 0..constraint.rows() {
                let error = self.errors[row];
                if error.is_nan() || error.abs() > START {
                    let problem = format!("the initial state misses it by {error:.4} m or rad");
                    let remedy = "choose `initial` so that all constraints are kept, or move the constraint";
                    return Err(fault(keys, &format!("constraint `{name}` of the robot"), problem, remedy));
                }
                row += 1;
            }
        }
        self.start_on_ground(dynamics, state, keys)?;
        // Velocities that the constraints do not allow are taken out, as by an impact that nobody heard.
        self.refresh();
        if !self.constraints.is_empty() {
            self.blow(dynamics, state, false)?;
        }
        let solved = self.settle(dynamics, state, (tau, loads), 0.0)?;
        self.events.clear();
        self.impacts.clear();
        if solved.contradiction > 1e-6 * (1.0 + self.fastest()) {
            let problem = format!(
                "{} constrained directions depend on others and contradict them by {:.3e} m/s² or rad/s²",
                solved.dependent, solved.contradiction
            );
            return Err(fault(keys, "constraints of the robot", problem, "take out what is held twice"));
        }
        if solved.dependent > 0.0 {
            let message = format!(
                "{} constrained directions depend on others: motion is as it must be, but how they share the load is a choice",
                solved.dependent
            );
            let file = keys.locate("robot");
            warnings.push(Warning { file, element: "constraints of the robot".to_owned(), message });
        }
        Ok(())
    }

    fn fastest(&self) -> f64 {
        self.motion[0].iter().fold(0.0, |m, a| a.abs().max(m))
    }

    fn start_on_ground(&mut self, dynamics: &mut Dynamics, state: &StateVec, keys: &Keys) -> Result<(), Error> {
        let Some(ground) = self.ground else { return Ok(()) };
        dynamics.placements(&state.q, &mut self.poses)?;
        for (i, point) in self.points.iter_mut().enumerate() {
            let at = point.place(&self.poses);
            let gap = at.z - ground.height;
            if gap < -START {
                let problem = format!("contact `{}` is {:.4} m below the ground", point.name, -gap);
                return Err(fault(keys, "initial", problem, "raise the robot, or lower `ground.height`"));
            }
            point.mode = Mode::Open;
            point.armed = gap.min(0.0);
            if gap <= ON_GROUND {
                // What is farther below than numbers in files are rounded is drawn up.
                point.close(if gap < -ON_GROUND { Vec3::new(at.x, at.y, ground.height) } else { at });
                self.closed.push(i);
            }
        }
        self.refresh();
        self.measure(dynamics, state.view())?;
        // What moves off is not held, and what slides is not stopped.
        let rest = ground.resting_speed.max(SLOW);
        for i in self.closed.clone() {
            let velocity = self.along_ground(i);
            let speed = velocity.norm();
            if self.off_ground(i) > rest {
                self.points[i].mode = Mode::Open;
            } else if speed > rest {
                self.points[i].slip(velocity.scale(1.0 / speed));
                self.points[i].heed(velocity);
            }
        }
        let points = &self.points;
        self.closed.retain(|i| points[*i].mode != Mode::Open);
        Ok(())
    }

    /// Motors at which the robot stands as it is held at a state, in `state.theta`: equilibrium with the forces of its constraints, and of the ground
    /// where it rests on it. `false`, and nothing changed, where nothing holds it, or where what holds it cannot keep it at rest.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn equilibrium(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        loads: &Loads,
        equilibrium: &mut Equilibrium,
    ) -> Result<bool, Error> {
        self.closed.clear();
        dynamics.placements(&state.q, &mut self.poses)?;
        if let Some(ground) = self.ground.filter(|_| state.qd.iter().all(|v| *v == 0.0)) {
            for (i, point) in self.points.iter_mut().enumerate() {
                let at = point.place(&self.poses);
                if (-START..=ON_GROUND).contains(&(at.z - ground.height)) {
                    point.close(at);
                    self.closed.push(i);
                }
            }
        }
        self.refresh();
        if self.constraints.is_empty() {
            return Ok(false);
        }
        let held = (self.constraints.as_slice(), self.multipliers.as_mut_slice());
        let motors = equilibrium.held(dynamics, &state.q, loads.external(), held)?;
        let (ground, permanent) = (self.ground, self.permanent_rows());
        let stays = |force: &[f64]| match (ground, force) {
            (Some(ground), [along @ .., normal]) => {
                let friction = along.iter().fold(0.0, |sum: f64, x| sum.hypot(*x));
                *normal >= 0.0 && friction <= ground.friction * *normal
            }
            _ => true,
        };
        let width = self.rows_of(0).1;
        let stands = motors.is_some() && self.multipliers[permanent..].chunks(width).all(stays);
        if let Some(theta) = motors.filter(|_| stands) {
            state.theta.copy_from_slice(theta);
        }
        Ok(stands)
    }
}
