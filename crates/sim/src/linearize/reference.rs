//! Operating points along the reference of a scenario.

use super::{KeptFriction, Linearizer, OperatingPoint};
use crate::coordinates::Coordinates;
use crate::equilibrium::motor_position;
use crate::error::{Error, ErrorKind, Warning};
use crate::reference::References;
use crate::robot::Robot;
use crate::scenario::ScenarioFile;
use crate::simulate::StateVec;
use gyroflex::dynamics::{Acceleration, External, Inverse};
use gyroflex::model::Fidelity;
use gyroflex::spatial::Vec3;

/// Half the width of the differences in time that give the velocities and accelerations of the motors [s].
const DT: f64 = 1e-4;

/// A robot on the reference motion of a scenario.
///
/// Links that bend are deflected as the motion asks for at that instant, without swings of their own. Motors are where the transmissions need
/// them: `θ = q + e + k⁻¹(τ_J)`, with the `τ_J` that moves the links, rotors taken to
/// turn with the joints. What that leaves out, the torque of the dampers and of the deflections' own accelerations, is small
/// against the deflection itself, and what it moves in `A` and `B` smaller still.
#[derive(Clone, Debug)]
pub struct ReferenceMotion {
    linearizer: Linearizer,
    joints: Coordinates,
    references: References,
    duration: f64,
    /// What the user should know.
    pub warnings: Vec<Warning>,
}

/// Motor positions and torques at one instant.
struct Instant {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    theta: Vec<f64>,
}

impl ReferenceMotion {
    /// The robot with the scenario's gravity and, unless `fidelity` is given, its model.
    ///
    /// # Errors
    /// A reference that does not fit the robot, and a floating root, which has none.
    pub fn new(
        robot: &Robot,
        file: &ScenarioFile,
        fidelity: Option<Fidelity>,
        kept: KeptFriction,
    ) -> Result<Self, Error> {
        let mut robot = robot.clone();
        if let Some(gravity) = file.scenario.gravity {
            robot.gravity = Vec3::from(gravity);
        }
        if robot.is_floating() {
            return Err(fault("a reference moves joints only, but the robot's root floats", "fix the root"));
        }
        let joints = Coordinates::of(&robot);
        let mut warnings = Vec::new();
        let q0 = joints.spread(&file.scenario.initial.q, &file.keys, "initial.q")?;
        // A shaper's modes are those of the scenario's own model.
        robot.fidelity = file.scenario.model.map_or(robot.fidelity, Into::into);
        let references = References::of(file, &robot, &joints, &q0, &mut warnings)?;
        if !file.scenario.wrenches.is_empty() {
            warnings.push(Warning {
                file: file.keys.locate("wrenches"),
                element: "wrenches".to_owned(),
                message: "they do not act on the linear model".to_owned(),
            });
        }
        if file.scenario.plant.is_some() {
            warnings.push(Warning {
                file: file.keys.locate("plant"),
                element: "plant".to_owned(),
                message: "it is not in the linear model, which is of the robot as its controller knows it".to_owned(),
            });
        }
        let linearizer = Linearizer::new(&robot, fidelity.unwrap_or(robot.fidelity), kept)?;
        Ok(Self { linearizer, joints, references, duration: file.scenario.duration, warnings })
    }

    /// The robot, ready to be linearized.
    pub fn linearizer(&mut self) -> &mut Linearizer {
        &mut self.linearizer
    }

    /// State and motor torques at time `t` [s].
    ///
    /// # Errors
    /// A time outside of the scenario.
    pub fn at(&mut self, t: f64) -> Result<OperatingPoint, Error> {
        if !(0.0..=self.duration).contains(&t) {
            let remedy = format!("give times from 0 to {} s", self.duration);
            return Err(fault(&format!("{t} s is not a time of the scenario"), &remedy));
        }
        let [before, now, after] = [self.instant(t - DT)?, self.instant(t)?, self.instant(t + DT)?];
        let nv = now.qd.len();
        let (mut thetad, mut thetadd) = (now.qd.clone(), now.qdd.clone());
        let (mut qd, mut qdd) = (now.qd.clone(), now.qdd.clone());
        for k in nv - self.linearizer.layout.modes()..nv {
            qd[k] = (after.q[k] - before.q[k]) / (2.0 * DT);
            qdd[k] = (after.q[k] - 2.0 * now.q[k] + before.q[k]) / (DT * DT);
            (thetad[k], thetadd[k]) = (qd[k], qdd[k]);
        }
        for &k in self.linearizer.layout.elastic() {
            thetad[k] = (after.theta[k] - before.theta[k]) / (2.0 * DT);
            thetadd[k] = (after.theta[k] - 2.0 * now.theta[k] + before.theta[k]) / (DT * DT);
        }
        let state = StateVec { q: now.q, qd, theta: now.theta, thetad };
        let (mut tau_j, mut tau) = (vec![0.0; nv], vec![0.0; nv]);
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        self.linearizer.dynamics.inverse(state.view(), accel, External::none(), out)?;
        Ok(OperatingPoint { time: Some(t), ..self.linearizer.point(state, tau)? })
    }

    fn instant(&mut self, t: f64) -> Result<Instant, Error> {
        let nv = self.linearizer.layout.nv();
        let zeros = || vec![0.0; nv];
        let (mut q, mut qd, mut qdd) = (zeros(), zeros(), zeros());
        for (i, joint) in self.joints.joints.iter().enumerate() {
            let point = self.references.point(i, t);
            (q[joint.q], qd[joint.v], qdd[joint.v]) = (point.q, point.qd, point.qdd);
        }
        self.linearizer.dynamics.settle_in_motion(&mut q, &qd, &qdd, External::none())?;
        let (mut tau_j, mut tau) = (zeros(), zeros());
        let state = StateVec { theta: q.clone(), thetad: qd.clone(), q, qd };
        let accel = Acceleration { qdd: &qdd, thetadd: &qdd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        self.linearizer.dynamics.inverse(state.view(), accel, External::none(), out)?;
        let StateVec { q, qd, mut theta, .. } = state;
        let model = self.linearizer.dynamics.model();
        for body in model.bodies().iter().filter(|b| b.is_elastic()) {
            let (i, k) = (body.q_index(), body.v_index());
            let Some(drive) = &body.drive else { continue };
            theta[k] = motor_position(drive, model.knots(), q[i], tau_j[k]).0;
        }
        Ok(Instant { q, qd, qdd, theta })
    }
}

fn fault(problem: &str, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Scenario,
        file: String::new(),
        element: "reference".to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
