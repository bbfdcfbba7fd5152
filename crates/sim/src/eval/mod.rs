//! The dynamics calculator: one state in, accelerations or torques out, as JSON lines or as values.
//!
//! Arrays run over all joints in coordinate order. A line with `tau` asks for forward dynamics, one with `qdd` for inverse
//! dynamics; with neither, only what the [`Options`] ask for is computed. Motor positions and torques are reflected to the
//! link side unless [`Options::motor_side`] is set. What holds the robot beside its joints is in force as [`Query::held`] says. Modes of
//! links that bend have arrays of their own: `eta`, `etad`, `etadd`, `tau_eta`.

mod held;
mod input;
mod json;
mod layout;
mod output;
mod wrench;

pub use crate::analyze::{Significance, significance};
pub use input::{Distribution, Query, Wrench, WrenchAxes};
pub use layout::unit_quaternion;
pub use output::{Answer, EnergyAnswer, HeldAnswer, VelocityMatrices};

use crate::Dynamics;
use crate::error::Error;
use crate::robot::Robot;
use gyroflex::dynamics::{Acceleration, External, Forward, Inverse, State};
use gyroflex::model::Fidelity;
use gyroflex::spatial::{Force, Transform, Vec3};
use held::{Held, Sharing};
use layout::{Arrays, Layout};

/// What to compute, and how the numbers are given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Which physics of the motors; `None` is the robot's own choice.
    pub fidelity: Option<Fidelity>,
    /// Whether to add `M`, `S`, `B` and `g` to the answer, and with velocities `C`, `C1`, `C2`, `M_dot` and `S_dot`.
    pub matrices: bool,
    /// Whether to add the energies to the answer.
    pub energy: bool,
    /// Whether to add the significance of the gyroscopic coupling to the answer. It is always that of the complete model.
    pub significance: bool,
    /// Whether `theta`, `thetad`, `thetadd` and `tau` are rotor angles, velocities, accelerations and motor torques at
    /// joints with a drive, in and out, with `S` and `B` accordingly. `tau_j` and `tau_ext` stay on the link side.
    pub motor_side: bool,
}

/// A robot ready to answer any number of queries.
#[derive(Clone, Debug)]
pub struct Evaluator {
    robot: Robot,
    options: Options,
    layout: Layout,
    dynamics: Dynamics,
    /// The complete model, where the significance is asked for.
    complete: Option<Dynamics>,
    wrenches: Vec<Force<f64>>,
    poses: Vec<Transform<f64>>,
}

/// Which way a query goes.
enum Task<'a> {
    Forward(&'a [f64]),
    Inverse(&'a [f64]),
    Neither,
}

impl Evaluator {
    /// Prepares a robot.
    ///
    /// # Errors
    /// Names the joint that is not physical in the model asked for.
    pub fn new(robot: Robot, options: Options) -> Result<Self, Error> {
        let dynamics = Dynamics::new(robot.model(options.fidelity.unwrap_or(robot.fidelity))?);
        if options.significance {
            robot.refuse_bending("the significance of the gyroscopic coupling", crate::bending::RIGID)?;
        }
        let complete = match options.significance {
            true => Some(Dynamics::new(robot.model(Fidelity::Complete)?)),
            false => None,
        };
        let layout = Layout::of(&robot, &dynamics.model());
        let wrenches = vec![Force::zero(); robot.bodies.len()];
        let poses = vec![Transform::identity(); robot.bodies.len()];
        Ok(Self { robot, options, layout, dynamics, complete, wrenches, poses })
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Answers one line of JSON with one line of JSON, numbers in the shortest form that reads back to the same bits.
    ///
    /// # Errors
    /// Names the key, and what it holds and should hold. The caller knows the file and the line.
    pub fn evaluate_line(&mut self, line: &str) -> Result<String, Error> {
        let answer = self.evaluate(&Query::parse(line)?)?;
        serde_json::to_string(&answer).map_err(Error::from)
    }

    /// Answers one query.
    ///
    /// # Errors
    /// Names the key that is missing, contradictory, of the wrong length or not finite, or the joint whose result is not finite.
    pub fn evaluate(&mut self, query: &Query) -> Result<Answer, Error> {
        let task = match (&query.tau, &query.qdd) {
            (Some(_), Some(_)) => {
                let problem = "`tau` asks for forward dynamics, `qdd` for inverse dynamics, and both are given";
                return Err(input::fault("tau, qdd", problem, "leave one of the two out"));
            }
            (Some(tau), None) => Task::Forward(tau),
            (None, Some(qdd)) => Task::Inverse(qdd),
            (None, None) => Task::Neither,
        };
        self.refuse_what_has_no_effect(query, &task)?;
        let arrays = Arrays { layout: &self.layout, motor_side: self.options.motor_side };

        let joints = self.layout.nv();
        let eta = arrays.modes("eta", query.eta.as_deref())?;
        let etad = arrays.modes("etad", query.etad.as_deref())?;
        let with = |mut joints: Vec<f64>, modes: &[f64]| {
            joints.extend_from_slice(modes);
            joints
        };
        let q = with(arrays.positions(query.q.as_deref())?, &eta);
        let moves = self.options.energy || !matches!(task, Task::Neither);
        let qd = with(arrays.joints("qd", query.qd.as_deref(), moves)?, &etad);
        let motors = moves && self.layout.has_elastic();
        let theta = with(arrays.motors("theta", query.theta.as_deref(), motors)?, &eta);
        let thetad = with(arrays.motors("thetad", query.thetad.as_deref(), motors)?, &etad);
        let none = vec![0.0; eta.len()];
        let mut tau_ext = with(arrays.loads("tau_ext", query.tau_ext.as_deref())?, &none);
        let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };

        let gravity = query.gravity.map_or(self.robot.gravity, Vec3::from);
        self.dynamics.set_gravity(gravity);
        self.dynamics.placements(&q, &mut self.poses)?;
        let modal = &mut tau_ext[joints..];
        wrench::gather(&self.robot, &query.wrenches, &self.poses, &eta, &mut self.wrenches, modal)?;
        let ext = External { tau: &tau_ext, wrenches: &self.wrenches };

        let mut held = Held::of(&self.robot, query.held.as_deref(), &self.poses)?;
        held::refuse_without_effect(query, matches!(task, Task::Inverse(_)), &held)?;
        if !held.is_empty() {
            self.robot.refuse_bending(
                "what holds a robot beside its joints",
                "say `\"held\": []`, or take the link out of `flexible_links`",
            )?;
        }

        let (nv, bends) = (joints + eta.len(), !eta.is_empty());
        let zeros = || vec![0.0; nv];
        let mut answer = Answer::default();
        match task {
            Task::Forward(tau) => {
                let tau = with(arrays.torques("tau", tau)?, &arrays.modes("tau_eta", query.tau_eta.as_deref())?);
                let (mut qdd, mut thetadd, mut tau_j) = (zeros(), zeros(), zeros());
                let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
                if held.is_empty() {
                    self.dynamics.forward(state, &tau, ext, out)?;
                } else {
                    let Forward { qdd, thetadd, tau_j } = out;
                    let solved = held.solve(|constraints, regularisation, forces| {
                        let out = Forward { qdd: &mut *qdd, thetadd: &mut *thetadd, tau_j: &mut *tau_j };
                        self.dynamics.constrained_forward(state, &tau, ext, constraints, regularisation, out, forces)
                    })?;
                    held.tell(&solved, &mut answer);
                    answer.contradiction = Some(solved.contradiction);
                }
                answer.etadd = bends.then(|| qdd.split_off(joints));
                thetadd.truncate(joints);
                tau_j.truncate(joints);
                answer.qdd = Some(qdd);
                answer.thetadd = Some(arrays.times_ratio(thetadd));
                answer.tau_j = Some(tau_j);
            }
            Task::Inverse(qdd) => {
                let mut etadd = arrays.modes("etadd", query.etadd.as_deref())?;
                let qdd = with(arrays.joints("qdd", Some(qdd), true)?, &etadd);
                let thetadd = with(arrays.motors("thetadd", query.thetadd.as_deref(), motors)?, &etadd);
                let (mut tau_j, mut tau) = (zeros(), zeros());
                let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
                let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
                if held.is_empty() {
                    match bends && query.etadd.is_none() {
                        true => self.dynamics.hybrid(state, accel, ext, out, &mut etadd)?,
                        false => self.dynamics.inverse(state, accel, ext, out)?,
                    }
                } else {
                    let sharing = Sharing::of(query.distribution.as_ref(), &self.layout, held.rows())?;
                    let solved = held.solve_once(|constraints, regularisation, forces| {
                        let distribution = sharing.view();
                        let dynamics = &mut self.dynamics;
                        dynamics.constrained_inverse(
                            state,
                            accel,
                            ext,
                            constraints,
                            distribution,
                            regularisation,
                            out,
                            forces,
                        )
                    })?;
                    held.tell(&solved, &mut answer);
                    let unborne = sharing.passive.iter().map(|k| tau_j[*k].abs());
                    answer.unborne = unborne.reduce(f64::max);
                }
                let tau_eta = tau.split_off(joints);
                tau_j.truncate(joints);
                match bends && query.etadd.is_none() {
                    true => answer.etadd = Some(etadd),
                    false => answer.tau_eta = bends.then_some(tau_eta),
                }
                answer.tau_j = Some(tau_j);
                answer.tau = Some(arrays.over_ratio(tau));
            }
            Task::Neither => {}
        }
        if self.options.matrices {
            let (mut m, mut s, mut b) = (vec![0.0; nv * nv], vec![0.0; nv * nv], zeros());
            self.dynamics.mass_matrix(&q, &mut m)?;
            self.dynamics.coupling(&q, &mut s)?;
            self.dynamics.reflected_inertia(&mut b)?;
            answer.set_matrices(&arrays, &m, &s, &b);
            let mut g = zeros();
            self.dynamics.gravity_torques(&q, &mut g)?;
            answer.g = Some(g);
            if bends {
                let [k, d] = self.dynamics.modal_matrices();
                answer.k = Some(output::rows(eta.len(), |i, j| k[(i, j)]));
                answer.d = Some(output::rows(eta.len(), |i, j| d[(i, j)]));
            }
            if query.qd.is_some() && (query.thetad.is_some() || !self.layout.has_elastic()) {
                answer.velocity_matrices = Some(VelocityMatrices::at(&mut self.dynamics, state, &arrays)?);
            }
        }
        if self.options.energy {
            answer.energy = Some(EnergyAnswer::from(self.dynamics.energy(state)?));
        }
        if let Some(complete) = &mut self.complete {
            let qd = query.qd.as_ref().map(|_| qd.as_slice());
            answer.significance = Some(significance(complete, &q, qd)?);
        }
        answer.check_finite(&self.layout)?;
        Ok(answer)
    }

    /// What is given changes the answer, or is an error.
    fn refuse_what_has_no_effect(&self, query: &Query, task: &Task) -> Result<(), Error> {
        let o = &self.options;
        let forward = matches!(task, Task::Forward(_));
        if forward && query.thetadd.is_some() {
            let problem = "motor accelerations are given, but forward dynamics computes them";
            return Err(input::fault("thetadd", problem, "leave `thetadd` out, or give `qdd` instead of `tau`"));
        }
        if forward && query.etadd.is_some() {
            let problem = "accelerations of modes are given, but forward dynamics computes them";
            return Err(input::fault("etadd", problem, "leave `etadd` out, or give `qdd` instead of `tau`"));
        }
        if !forward && query.tau_eta.is_some() {
            let problem = "it has no effect without `tau`";
            let remedy = "leave `tau_eta` out, or give `tau` for forward dynamics";
            return Err(input::fault("tau_eta", problem, remedy));
        }
        if !matches!(task, Task::Neither) {
            return Ok(());
        }
        if !(o.matrices || o.energy || o.significance) {
            return Err(input::fault(
                "tau, qdd",
                "neither is given, so there is nothing to compute",
                "give `tau` for forward dynamics or `qdd` for inverse dynamics, or ask for matrices, energy or significance",
            ));
        }
        let without_effect = [
            ("thetadd", query.thetadd.is_some()),
            ("etadd", query.etadd.is_some()),
            ("tau_ext", query.tau_ext.is_some()),
            ("wrenches", !query.wrenches.is_empty()),
            ("held", query.held.is_some()),
            ("distribution", query.distribution.is_some()),
        ];
        match without_effect.iter().find(|(_, given)| *given) {
            Some((key, _)) => {
                let problem = "it has no effect without `tau` or `qdd`";
                Err(input::fault(key, problem, format!("leave `{key}` out, or give `tau` or `qdd`")))
            }
            None => Ok(()),
        }
    }
}
