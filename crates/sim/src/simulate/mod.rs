//! A scenario come alive: everything is checked and set up first, then it runs from instant to instant.

mod checks;
mod clock;
mod plant;
mod run;
mod sampler;
mod start;
mod summary;

pub use start::StateVec;
pub use summary::{JointSummary, Summary};

use crate::contact::{Contacts, Event};
use crate::controller::Control;
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::{Error, Warning};
use crate::loads::Loads;
use crate::modes::{self, Modes};
use crate::ode::Adaptive;
use crate::record::RunInfo;
use crate::reference::{Point, References};
use crate::robot::Robot;
use crate::scenario::{Integrator, JointValues, ScenarioFile, fault};
use gyroflex::spatial::Vec3;
pub(crate) use sampler::Sampler;

/// A run that is ready to start, or has been run.
#[derive(Clone, Debug)]
pub struct Simulation {
    robot: Robot,
    file: ScenarioFile,
    joints: Coordinates,
    dynamics: Dynamics,
    /// The robot as its controller knows it, where that is not the simulated one.
    nominal: Option<Nominal>,
    references: References,
    points: Vec<Point>,
    control: Control,
    loads: Loads,
    contacts: Contacts,
    sampler: Sampler,
    adaptive: Option<Adaptive>,
    modes: Modes,
    initial: StateVec,
    state: StateVec,
    tau: Vec<f64>,
    half_step: Vec<f64>,
    halfway: Vec<f64>,
    warnings: Vec<Warning>,
    /// How many of them were there before the run.
    setup_warnings: usize,
}

/// A robot that is not simulated.
#[derive(Clone, Debug)]
struct Nominal {
    robot: Robot,
    dynamics: Dynamics,
}

impl Simulation {
    /// Sets up a run of `file` with `robot`, which the scenario's own model and gravity override, and refuses it if it cannot
    /// go well. The controller knows that robot; what is simulated has the scenario's `plant` beside it.
    ///
    /// # Errors
    /// Everything in the scenario that does not fit the robot, and a step too large for the robot's fastest mode.
    pub fn new(robot: &Robot, file: &ScenarioFile) -> Result<Self, Error> {
        let scenario = &file.scenario;
        let mut robot = robot.clone();
        if let Some(gravity) = scenario.gravity {
            robot.gravity = Vec3::from(gravity);
        }
        if let Some(model) = scenario.model {
            robot.fidelity = model.into();
        }
        let mut warnings = Vec::new();
        let joints = Coordinates::of(&robot);
        let q0 = joints.spread(&scenario.initial.q, &file.keys, "initial.q")?;
        let references = References::of(file, &robot, &joints, &q0, &mut warnings)?;
        let mut control =
            Control::new(&scenario.controller, &robot, &joints, &references, scenario.duration, &file.keys)?;
        let nominal = match &scenario.plant {
            None => None,
            Some(differences) => {
                let dynamics = Dynamics::new(robot.model(robot.fidelity)?);
                let changed = plant::plant(&robot, differences, &file.keys)?;
                warnings.extend_from_slice(&changed.warnings[robot.warnings.len()..]);
                Some(Nominal { robot: std::mem::replace(&mut robot, changed), dynamics })
            }
        };
        let mut dynamics = Dynamics::new(robot.model(robot.fidelity)?);
        let mut loads = Loads::new(&scenario.wrenches, &robot, &file.keys)?;
        let motors = control.start(&references)?;
        if !robot.held.is_empty() || scenario.ground.is_some() {
            let remedy = "take `ground` out of the scenario and constraints and couplings off the robot, or the link out of `flexible_links`";
            robot.refuse_bending("what holds a robot beside its joints", remedy)?;
        }
        let mut contacts = Contacts::new(&robot, scenario.ground, &dynamics, &file.keys)?;
        let mut initial =
            start::initial_state(file, &joints, &references, motors, &mut dynamics, &mut loads, &mut contacts)?;
        if let Some(walking) = control.walking() {
            let given = [&scenario.initial.q, &scenario.initial.qd, &scenario.initial.theta, &scenario.initial.thetad];
            if given.into_iter().all(JointValues::is_empty) {
                walking.place(&robot, &mut initial)?;
            }
            if scenario.ground.is_none() {
                let problem = "`walk` has nothing to walk on";
                return Err(fault(&file.keys, "controller.type", problem, "add `ground: {friction: …, planar: true}`"));
            }
        }
        if !contacts.is_empty() {
            if !matches!(scenario.integrator, Integrator::Rk4 { .. }) {
                let problem =
                    format!("`{}` cannot hold a robot by constraints or contacts", scenario.integrator.name());
                return Err(fault(&file.keys, "integrator.method", problem, "use `rk4`"));
            }
            let rest = vec![0.0; dynamics.nv()];
            contacts.start(&mut dynamics, &mut initial, (&rest, &mut loads), &file.keys, &mut warnings)?;
        }
        let modes = modes::modes(&mut dynamics, &joints, &initial.q, &initial.theta)?;
        let sampler = Sampler::new(&robot, &joints, &dynamics)?;
        let adaptive =
            scenario.integrator.fixed_step().is_none().then(|| Adaptive::new(scenario.integrator, &dynamics));
        let mut simulation = Self {
            points: vec![Point::default(); joints.len()],
            state: initial.clone(),
            tau: vec![0.0; dynamics.nv()],
            half_step: vec![0.0; dynamics.nv()],
            halfway: vec![0.0; dynamics.nq()],
            file: file.clone(),
            robot,
            joints,
            dynamics,
            nominal,
            references,
            control,
            loads,
            contacts,
            sampler,
            adaptive,
            modes,
            initial,
            warnings,
            setup_warnings: 0,
        };
        simulation.check_step()?;
        simulation.check_controller();
        simulation.check_controller_on_bending_links()?;
        simulation.check_wrenches();
        simulation.setup_warnings = simulation.warnings.len();
        Ok(simulation)
    }

    /// The robot as it is simulated: with the scenario's model and gravity, and what its plant changes.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The robot as its controller knows it: with the scenario's model and gravity, without what its plant changes.
    pub fn nominal(&self) -> &Robot {
        self.nominal.as_ref().map_or(&self.robot, |n| &n.robot)
    }

    /// The joints of one degree of freedom, in the order of every vector that is logged.
    pub fn coordinates(&self) -> &Coordinates {
        &self.joints
    }

    /// What the joints are to follow.
    pub fn references(&self) -> &References {
        &self.references
    }

    /// Natural modes and decay at the initial pose.
    pub fn modes(&self) -> &Modes {
        &self.modes
    }

    /// The state at time 0.
    pub fn initial_state(&self) -> &StateVec {
        &self.initial
    }

    /// The state the last run came to; before any, the initial state.
    pub fn state(&self) -> &StateVec {
        &self.state
    }

    /// What happened to the robot's contacts in the last run, in order.
    pub fn events(&self) -> &[Event] {
        self.contacts.events()
    }

    /// What holds the robot beside its joints.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// What the user should know, so far.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// What a recorder must know before the first sample.
    pub fn run_info(&self) -> RunInfo {
        let mut info = RunInfo::new(&self.robot, self.robot.fidelity);
        info.held = !self.contacts.is_empty();
        info.contacts = self.contacts.names().map(str::to_owned).collect();
        for source in std::iter::once(&self.file.source).chain(&self.file.csv) {
            info.attachments.push((source.name.clone(), source.text.clone()));
        }
        let scenario = &self.file.scenario;
        let mut add = |key: &str, value: String| info.metadata.push((key.to_owned(), value));
        add("gyroflex", env!("CARGO_PKG_VERSION").to_owned());
        add("robot", self.robot.name.clone());
        add("scenario", self.file.source.name.clone());
        add("model", self.robot.fidelity.name().to_owned());
        add("gravity", format!("{:?}", self.robot.gravity.to_array()));
        add("duration", scenario.duration.to_string());
        add("integrator", scenario.integrator.name().to_owned());
        match scenario.integrator {
            Integrator::SemiImplicitEuler { step } | Integrator::Rk4 { step } => add("step", step.to_string()),
            Integrator::Dopri5 { rtol, atol }
            | Integrator::Dop853 { rtol, atol }
            | Integrator::Kvaerno5 { rtol, atol } => {
                add("rtol", rtol.to_string());
                add("atol", atol.to_string());
            }
        }
        if let Some(rate) = scenario.controller.rate() {
            add("control_rate", rate.to_string());
        }
        if let Some(plant) = &scenario.plant {
            let factors = [("stiffness", &plant.stiffness), ("damping", &plant.damping), ("mass", &plant.mass)];
            for (name, factors) in factors.into_iter().filter_map(|(name, factors)| Some((name, factors.as_ref()?))) {
                for (key, factor) in factors.numbers(&format!("plant.{name}")) {
                    add(&key, factor.to_string());
                }
            }
            if let Some(factor) = plant.payload_factor {
                add("plant.payload_factor", factor.to_string());
            }
            if let Some(load) = &plant.payload {
                add(
                    "plant.payload",
                    format!("{} kg on {}, at {:?}, {:?}", load.mass, load.link, load.xyz, load.inertia),
                );
            }
        }
        for (key, value) in self.file.overrides.iter() {
            add(&format!("override.{key}"), value.to_string());
        }
        add("log_rate", scenario.log.rate.to_string());
        if scenario.shaper.is_some() {
            let impulses = self.references.shaper().impulses().iter();
            let text: Vec<_> = impulses.map(|i| format!("{} at {} s", i.amplitude, i.delay)).collect();
            add("shaper_impulses", text.join(", "));
        }
        if let Some(mode) = self.modes.fastest() {
            add("fastest_mode_hz", mode.frequency.to_string());
        }
        info
    }
}
