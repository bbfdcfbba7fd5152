//! What is found out about a run before it starts, and whether it left the sane world on its way.

use super::Simulation;
use crate::error::{Error, ErrorKind, Warning};
use crate::linearize::eigenvalues;
use crate::scenario::fault;
use nalgebra::DMatrix;

/// Beyond this speed [rad/s or m/s] or position [rad or m] a run is taken to have diverged.
const MAX_SPEED: f64 = 1e6;
const MAX_POSITION: f64 = 1e9;

impl Simulation {
    /// Refuses a fixed step at which the scheme is unstable.
    pub(super) fn check_step(&self) -> Result<(), Error> {
        let scenario = &self.file.scenario;
        let (Some(step), Some(largest)) =
            (scenario.integrator.fixed_step(), self.modes.largest_step(&scenario.integrator))
        else {
            return Ok(());
        };
        // Steps never reach beyond the next tick.
        let tick = scenario.controller.rate().unwrap_or(0.0).max(scenario.log.rate);
        if step.min(1.0 / tick) <= largest {
            return Ok(());
        }
        let mut causes = Vec::new();
        if let Some(mode) = self.modes.fastest() {
            let place = if mode.bends { "mode" } else { "joint" };
            causes.push(format!("its fastest mode is {:.4e} Hz at {place} `{}`", mode.frequency, mode.joint));
        }
        if let Some(decay) = &self.modes.decay {
            let text = "its fastest decay by damping and friction at standstill is";
            let place = if self.joints.modes.contains(&decay.joint) { "mode" } else { "joint" };
            causes.push(format!("{text} {:.4e} 1/s at {place} `{}`", decay.rate, decay.joint));
        }
        let problem = format!(
            "a step of {step:e} s makes `{}` unstable on this robot: {}",
            scenario.integrator.name(),
            causes.join(", and ")
        );
        // Rounded down, so that the number given works.
        let scale = 10f64.powi(largest.log10().floor() as i32 - 2);
        let usable = (largest / scale).floor() * scale;
        let remedy = format!("the largest usable step is {usable:.2e} s; or use the stiff method `kvaerno5`");
        Err(fault(&self.file.keys, "integrator.step", problem, remedy))
    }

    /// Warns of a sampled velocity loop that is unstable on a motor by itself: `kd / B` beyond twice the rate.
    pub(super) fn check_controller(&mut self) {
        let Some(rate) = self.file.scenario.controller.rate() else { return };
        for (i, joint) in self.joints.joints.iter().enumerate() {
            let model = self.dynamics.model();
            let body = &model.bodies()[joint.body];
            let Some(drive) = body.drive.as_ref().filter(|_| body.is_elastic()) else { continue };
            let damping = self.control.damping_rate(i, drive.rotor.reflected_inertia);
            if damping >= 2.0 * rate {
                self.warnings.push(Warning {
                    file: self.file.keys.locate("controller.kd"),
                    element: format!("controller.kd of joint `{}`", joint.name),
                    message: format!(
                        "the motor answers at {damping:.3e} 1/s, which a controller at {rate} Hz cannot hold stable; lower \
                         `kd` or raise `rate`"
                    ),
                });
            }
        }
    }

    /// The same where links bend: at once, a motor accelerates little more than what is at the root of its link, so that a loop that is
    /// calm on the rigid robot may be too fast. Its rates are the eigenvalues of `K_d (M⁻¹)`, over the joints without an elastic transmission.
    ///
    /// # Errors
    /// An inertia matrix that is not positive definite.
    pub(super) fn check_controller_on_bending_links(&mut self) -> Result<(), Error> {
        let Some(rate) = self.file.scenario.controller.rate().filter(|_| self.dynamics.modes() > 0) else {
            return Ok(());
        };
        let nv = self.dynamics.nv();
        let mut m = vec![0.0; nv * nv];
        self.dynamics.mass_matrix(&self.initial.q, &mut m)?;
        let m = DMatrix::from_row_slice(nv, nv, &m);
        let model = self.dynamics.model();
        let stiff: Vec<usize> =
            (0..self.joints.len()).filter(|i| !model.bodies()[self.joints.joints[*i].body].is_elastic()).collect();
        let places: Vec<usize> = stiff.iter().map(|i| self.joints.joints[*i].v).collect();
        let (Some(mobility), false) = (m.clone().try_inverse(), stiff.is_empty()) else { return Ok(()) };
        let block = |of: &DMatrix<f64>| of.select_rows(&places).select_columns(&places);
        let loops = self.control.velocity_feedback(&stiff, &block(&m)) * block(&mobility);
        let fastest = eigenvalues(&loops)?.iter().map(|l| l.norm()).fold(0.0, f64::max);
        if fastest < 2.0 * rate {
            return Ok(());
        }
        let joint = (0..stiff.len()).max_by(|a, b| loops[(*a, *a)].total_cmp(&loops[(*b, *b)])).unwrap_or(0);
        self.warnings.push(Warning {
            file: self.file.keys.locate("controller.kd"),
            element: format!("controller.kd of joint `{}`", self.joints.joints[stiff[joint]].name),
            message: format!(
                "the links bend away under it, so that its loop answers at {fastest:.3e} 1/s, which a controller at {rate} Hz cannot \
                 hold stable; lower `kd`, raise `rate`, or give the drive its rotor"
            ),
        });
        Ok(())
    }

    /// Warns of wrenches that never act.
    pub(super) fn check_wrenches(&mut self) {
        let duration = self.file.scenario.duration;
        for (i, wrench) in self.file.scenario.wrenches.iter().enumerate() {
            let ended = wrench.end.is_some_and(|end| end <= 0.0);
            let idle = wrench.force.iter().chain(&wrench.torque).all(|x| *x == 0.0);
            if ended || wrench.start >= duration || idle {
                self.warnings.push(Warning {
                    file: self.file.keys.locate(&format!("wrenches[{i}]")),
                    element: format!("wrenches[{i}]"),
                    message: "it never acts: it is zero, or outside of the run's time".to_owned(),
                });
            }
        }
    }

    /// Whether all numbers of the state are finite and sane.
    ///
    /// # Errors
    /// Names the joint and the time.
    pub(super) fn check_state(&self, t: f64) -> Result<(), Error> {
        let state = &self.state;
        let insane = |x: f64, bound: f64| x.is_nan() || x.abs() > bound;
        for joint in &self.joints.joints {
            let (q, k) = (joint.q, joint.v);
            let quantities = [
                ("position", state.q[q], MAX_POSITION),
                ("velocity", state.qd[k], MAX_SPEED),
                ("motor position", state.theta[k], MAX_POSITION),
                ("motor velocity", state.thetad[k], MAX_SPEED),
            ];
            if let Some((name, value, _)) = quantities.into_iter().find(|(_, x, bound)| insane(*x, *bound)) {
                return Err(self.diverged(&joint.name, t, &format!("its {name} is {value:e}")));
            }
        }
        let (modes, rates) = (state.q.iter().rev(), state.qd.iter().rev());
        for (name, (eta, etad)) in self.joints.modes.iter().rev().zip(modes.zip(rates)) {
            if insane(*eta, MAX_POSITION) || insane(*etad, MAX_SPEED) {
                let problem = format!("its coordinate is {eta:e}, its rate {etad:e}");
                return Err(Error { element: format!("mode `{name}`"), ..self.diverged(name, t, &problem) });
            }
        }
        if self.joints.floating {
            let (pose, twist) = (&state.q[..7], &state.qd[..6]);
            if pose.iter().any(|x| insane(*x, MAX_POSITION)) || twist.iter().any(|x| insane(*x, MAX_SPEED)) {
                return Err(self.diverged("root", t, "its pose or twist left all bounds"));
            }
        }
        Ok(())
    }

    /// The joint that moves fastest, to name one where a scheme gives up.
    pub(super) fn fastest_joint(&self) -> &str {
        let speed = |v: usize| self.state.qd[v].abs().max(self.state.thetad[v].abs());
        let joints = self.joints.joints.iter();
        joints.max_by(|a, b| speed(a.v).total_cmp(&speed(b.v))).map_or("root", |j| j.name.as_str())
    }

    /// The error of a run that left the finite numbers.
    pub(super) fn diverged(&self, joint: &str, t: f64, what: &str) -> Error {
        Error {
            kind: ErrorKind::Diverged,
            file: self.file.path.display().to_string(),
            element: format!("joint `{joint}`"),
            problem: format!("the simulation diverged at t = {t} s: {what}"),
            remedy:
                "use a smaller step or the stiff method `kvaerno5`, and check gains, stiffnesses and inertias; the log \
                     holds the run up to there"
                    .to_owned(),
        }
    }
}
