//! What can be wrong with a scenario before any robot is loaded.

use super::{Controller, Gains, Initial, Integrator, JointValues, Plant, Scenario, Wrench, fault};
use crate::error::{Error, ErrorKind};
use crate::load::yaml::Keys;

impl Scenario {
    /// Checks every number: finite, and positive where it must be. `keys` are the places of the file's keys.
    ///
    /// # Errors
    /// Names the first key whose value makes no sense.
    pub fn validate(&self, keys: &Keys) -> Result<(), Error> {
        let check = Check { keys };
        check.positive("duration", self.duration)?;
        check.finite("gravity", self.gravity.iter().flatten())?;
        check.positive("log.rate", self.log.rate)?;
        check.initial(&self.initial)?;
        check.references(&self.reference)?;
        self.shaper.iter().try_for_each(|shaper| check.shaper(shaper))?;
        check.controller(&self.controller)?;
        if let Some(plant) = &self.plant {
            check.plant(plant)?;
        }
        for (i, wrench) in self.wrenches.iter().enumerate() {
            check.wrench(&format!("wrenches[{i}]"), wrench)?;
        }
        if let Some(ground) = &self.ground {
            check.finite("ground.height", [&ground.height])?;
            check.not_negative("ground.friction", ground.friction)?;
            check.not_negative("ground.resting_speed", ground.resting_speed)?;
            if !(0.0..=1.0).contains(&ground.restitution) {
                let problem = format!("{} is not between 0 and 1", ground.restitution);
                return check.fail(
                    "ground.restitution",
                    problem,
                    "give 0 for a plastic impact, 1 for one that loses nothing",
                );
            }
        }
        check.integrator(&self.integrator)
    }
}

/// Checks of one file.
pub(super) struct Check<'a> {
    keys: &'a Keys,
}

impl Check<'_> {
    pub(super) fn fail(&self, key: &str, problem: String, remedy: &str) -> Result<(), Error> {
        Err(fault(self.keys, key, problem, remedy))
    }

    pub(super) fn finite<'a>(&self, key: &str, values: impl IntoIterator<Item = &'a f64>) -> Result<(), Error> {
        match values.into_iter().find(|v| !v.is_finite()) {
            Some(v) => self.fail(key, format!("{v} is not a finite number"), "give a finite number"),
            None => Ok(()),
        }
    }

    pub(super) fn positive(&self, key: &str, value: f64) -> Result<(), Error> {
        if value.is_finite() && value > 0.0 {
            return Ok(());
        }
        self.fail(key, format!("{value} is not a positive number"), "give a number above zero")
    }

    fn not_negative(&self, key: &str, value: f64) -> Result<(), Error> {
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        self.fail(key, format!("{value} is negative or not finite"), "give zero or a number above it")
    }

    fn joint_values(&self, key: &str, values: &JointValues) -> Result<(), Error> {
        match values {
            JointValues::Named(map) => {
                map.iter().try_for_each(|(name, value)| self.finite(&format!("{key}.{name}"), [value]))
            }
            JointValues::Ordered(list) => self.finite(key, list),
        }
    }

    fn initial(&self, initial: &Initial) -> Result<(), Error> {
        self.joint_values("initial.q", &initial.q)?;
        self.joint_values("initial.qd", &initial.qd)?;
        self.joint_values("initial.theta", &initial.theta)?;
        self.joint_values("initial.thetad", &initial.thetad)?;
        self.joint_values("initial.eta", &initial.eta)?;
        self.joint_values("initial.etad", &initial.etad)?;
        if let Some(base) = &initial.base {
            self.finite("initial.base.xyz", &base.xyz)?;
            self.finite("initial.base.rpy", &base.rpy)?;
            self.finite("initial.base.twist", &base.twist)?;
        }
        Ok(())
    }

    fn controller(&self, controller: &Controller) -> Result<(), Error> {
        match controller {
            Controller::None {} => Ok(()),
            Controller::Pd { rate, kp, kd, .. } | Controller::ComputedTorque { rate, kp, kd, .. } => {
                self.positive("controller.rate", *rate)?;
                self.gains("controller.kp", kp)?;
                self.gains("controller.kd", kd)
            }
            Controller::TwoDegreeOfFreedom { rate, kp, kd, inverse } => {
                self.positive("controller.rate", *rate)?;
                self.gains("controller.kp", kp)?;
                self.gains("controller.kd", kd)?;
                self.not_negative("controller.inverse.damping", inverse.damping)
            }
            Controller::Lqr { rate, deviations: d, inverse } => {
                self.positive("controller.rate", *rate)?;
                for (key, value) in [
                    ("link_position", d.link_position),
                    ("link_velocity", d.link_velocity),
                    ("motor_position", d.motor_position),
                    ("motor_velocity", d.motor_velocity),
                    ("torque", d.torque),
                ] {
                    self.positive(&format!("controller.deviations.{key}"), value)?;
                }
                self.not_negative("controller.inverse.damping", inverse.damping)
            }
            Controller::FeedbackLinearization { rate, bandwidth } => {
                self.positive("controller.rate", *rate)?;
                self.gains("controller.bandwidth", bandwidth)
            }
            Controller::Walk(walk) => {
                self.positive("controller.rate", walk.rate)?;
                self.positive("controller.believes.mass", walk.believes.mass)?;
                self.positive("controller.believes.length", walk.believes.length)?;
                self.not_negative("controller.damping", walk.damping)?;
                self.finite("controller.rear_share", &walk.rear_share)?;
                for (key, law) in [("single", walk.single), ("double", walk.double)] {
                    self.positive(&format!("controller.{key}.lambda"), law.lambda)?;
                    self.positive(&format!("controller.{key}.alpha"), law.alpha)?;
                    self.not_negative(&format!("controller.{key}.sigma"), law.sigma)?;
                    self.not_negative(&format!("controller.{key}.eta"), law.eta)?;
                }
                Ok(())
            }
        }
    }

    fn gains(&self, key: &str, gains: &Gains) -> Result<(), Error> {
        match gains {
            Gains::All(value) => self.not_negative(key, *value),
            Gains::Named(map) => map.iter().try_for_each(|(n, v)| self.not_negative(&format!("{key}.{n}"), *v)),
        }
    }

    fn plant(&self, plant: &Plant) -> Result<(), Error> {
        plant.payload_factor.map_or(Ok(()), |factor| self.positive("plant.payload_factor", factor))?;
        for (key, factors) in [("plant.stiffness", &plant.stiffness), ("plant.mass", &plant.mass)] {
            let all = factors.iter().flat_map(|f| f.numbers(key));
            all.into_iter().try_for_each(|(key, factor)| self.positive(&key, factor))?;
        }
        let damping = plant.damping.iter().flat_map(|f| f.numbers("plant.damping"));
        damping.into_iter().try_for_each(|(key, factor)| self.not_negative(&key, factor))?;
        let payload = plant.payload.as_ref().map_or(Ok(()), |p| p.check(self.keys, "plant.payload"));
        payload.map_err(|e| Error { kind: ErrorKind::Scenario, ..e })
    }

    fn wrench(&self, key: &str, wrench: &Wrench) -> Result<(), Error> {
        let numbers = wrench.force.iter().chain(&wrench.torque).chain(&wrench.point).chain([&wrench.start]);
        self.finite(key, numbers)?;
        let Some(end) = wrench.end else { return Ok(()) };
        if end > wrench.start {
            return Ok(());
        }
        let problem = format!("it ends at {end} s, but starts at {} s", wrench.start);
        self.fail(&format!("{key}.end"), problem, "let it end after it starts, or leave `end` out for never")
    }

    fn integrator(&self, integrator: &Integrator) -> Result<(), Error> {
        match *integrator {
            Integrator::SemiImplicitEuler { step } | Integrator::Rk4 { step } => self.positive("integrator.step", step),
            Integrator::Dopri5 { rtol, atol }
            | Integrator::Dop853 { rtol, atol }
            | Integrator::Kvaerno5 { rtol, atol } => {
                self.positive("integrator.rtol", rtol)?;
                self.positive("integrator.atol", atol)
            }
        }
    }
}
