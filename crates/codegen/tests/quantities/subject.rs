//! Random robots as generation takes them, and generated functions at their states.

use gyroflex::model::{BodySpec, Fidelity, FlexibleModel, RobotSpec};
use gyroflex::spatial::Vec3;
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options, Quantity, function};
use gyroflex_codegen::robot::Robot;
use gyroflex_sim::robot::OwnedModel;
use gyroflex_testkit::flexible::LoweredFlexible;
use gyroflex_testkit::random::{
    FlexibleOptions, Options as Grown, RandomFlexible, RandomRobot, random_point, with_random_modes,
};
use gyroflex_testkit::tolerance::{Real, assert_close_above};
use gyroflex_testkit::{Lowered, State};
use std::fmt;

/// A robot in one of its models, with names, at a state.
pub struct Subject {
    pub seed: u64,
    pub fidelity: Fidelity,
    pub bodies: Vec<BodySpec>,
    spring_tables: Vec<[f64; 2]>,
    gravity: Vec3<f64>,
    pub rigid: Lowered<f64>,
    bending: Option<Bending>,
    joints: Vec<String>,
    links: Vec<String>,
    pub state: State,
}

/// Records of links that bend.
enum Bending {
    Random(LoweredFlexible<f64>),
    Loaded(OwnedModel),
}

impl Bending {
    fn view(&self) -> FlexibleModel<'_, f64> {
        match self {
            Self::Random(model) => model.view(),
            Self::Loaded(model) => model.flexible().expect("a link bends"),
        }
    }
}

/// Robots that have everything, of a size that a law can be shown for many of them.
pub fn grown() -> Grown {
    Grown { bodies: 1..=9, ..Grown::default() }
}

/// The same with links that bend.
pub fn grown_bending() -> FlexibleOptions {
    let robot = Grown { bodies: 1..=4, remote_rigid: false, ..Grown::default() };
    FlexibleOptions { robot, modes: 1..=3, ..FlexibleOptions::default() }
}

impl Subject {
    pub fn of(robot: &RandomRobot, fidelity: Fidelity) -> Self {
        let names = |what: &str| (0..robot.bodies.len()).map(|i| format!("{what}{i}")).collect();
        Self {
            seed: robot.seed,
            fidelity,
            bodies: robot.bodies.clone(),
            spring_tables: robot.spring_tables.clone(),
            gravity: robot.gravity,
            rigid: Lowered::new(&robot.spec(), fidelity).expect("a random robot is valid"),
            bending: None,
            joints: names("joint"),
            links: names("link"),
            state: robot.state(0),
        }
    }

    pub fn bending(robot: &RandomFlexible, fidelity: Fidelity) -> Self {
        let bending = robot.lower(fidelity).expect("a random robot is valid");
        let state = robot.state(0);
        Self { bending: Some(Bending::Random(bending)), state, ..Self::of(&robot.robot, fidelity) }
    }

    /// A robot from files, in the model that they ask for.
    pub fn loaded(robot: &gyroflex_sim::Robot) -> Self {
        let loaded = robot.model(robot.fidelity).expect("a loaded robot is valid");
        let RobotSpec { bodies, spring_tables, gravity } = robot.spec();
        let seen = RandomRobot { seed: 0, bodies: bodies.into(), spring_tables: spring_tables.into(), gravity };
        let bending = loaded.flexible().is_some().then_some(Bending::Loaded(loaded));
        Self { bending, ..Self::of(&seen, robot.fidelity) }
    }

    /// Goes to another state, of numbers that both scalars have.
    pub fn go(&mut self, index: u64) {
        let state = random_point(&self.bodies, &self.spring_tables, index);
        let modes = self.robot().flexible.map_or(0, |model| model.modes());
        self.state = with_random_modes(state, modes, !index).rounded_to_f32();
    }

    pub fn robot(&self) -> Robot<'_> {
        Robot {
            name: "random",
            joints: &self.joints,
            links: &self.links,
            spec: RobotSpec { bodies: &self.bodies, spring_tables: &self.spring_tables, gravity: self.gravity },
            fidelity: self.fidelity,
            model: self.rigid.view(),
            flexible: self.bending.as_ref().map(Bending::view),
            payload: None,
        }
    }

    /// What a function gives at this state, in a scalar; by the names of its outputs.
    pub fn evaluate<T: Real>(&self, function: &Function, more: &[(&str, &[f64])]) -> Vec<(String, Vec<f64>)> {
        let s = &self.state;
        let state = [
            ("q", &s.q),
            ("qd", &s.qd),
            ("theta", &s.theta),
            ("thetad", &s.thetad),
            ("qdd", &s.qdd),
            ("thetadd", &s.thetadd),
            ("tau", &s.tau),
        ];
        let all: Vec<(&str, &[f64])> =
            more.iter().copied().chain(state.iter().map(|(name, x)| (*name, x.as_slice()))).collect();
        let mut inputs = Vec::new();
        for argument in &function.arguments {
            let Some((_, x)) = all.iter().find(|(name, _)| *name == argument.name) else {
                panic!("{} takes `{}`, of which the law knows nothing", function.name, argument.name)
            };
            assert_eq!(x.len(), argument.len, "length of `{}`", argument.name);
            inputs.extend(x.iter().map(|x| T::from_f64(*x)));
        }
        let results = function.evaluate(&inputs);
        let named = function.outputs.iter().zip(results);
        named.map(|(output, x)| (output.name.clone(), x.into_iter().map(Real::to_f64).collect())).collect()
    }

    /// Asserts that a function gives what the library does: every output, nothing but rounding apart.
    pub fn assert_equal<T: Real>(&self, function: &Function, want: &[Known], more: &[(&str, &[f64])], tolerance: f64) {
        for (name, got) in self.evaluate::<T>(function, more) {
            let Some(want) = want.iter().find(|want| want.name == name) else {
                panic!("{} gives `{name}`, of which the law knows nothing", function.name)
            };
            let what = format!("{}, {name} in {}", function.name, T::NAME);
            assert_close_above(&what, self, &got, &want.value, tolerance, want.floor);
        }
    }

    /// Rounds the state to single precision, so that both sides start from the same numbers: deflections are small differences of
    /// positions. Whether that is enough: single precision does not know the phase of a gear's error, hundreds of radians.
    pub fn round(&mut self) -> bool {
        self.state = self.state.rounded_to_f32();
        let elastic = self.rigid.view().bodies().iter().filter_map(|body| body.drive?.elastic);
        elastic.filter(|elastic| elastic.error.is_some()).count() == 0
    }

    pub fn gravity(&self) -> Vec3<f64> {
        self.gravity
    }

    pub fn function(&self, quantity: Quantity) -> Option<Function> {
        function(&self.robot(), quantity, &Options::default()).ok()
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bends = if self.bending.is_some() { ", links bend" } else { "" };
        write!(f, "seed {}, {} bodies, model {}{bends}", self.seed, self.bodies.len(), self.fidelity.name())
    }
}

/// What the library gives under a name, relative to at least `floor`: the size of what it is the sum of.
pub struct Known {
    pub name: &'static str,
    pub value: Vec<f64>,
    pub floor: f64,
}

impl Known {
    pub fn new(name: &'static str, value: Vec<f64>) -> Self {
        Self { name, value, floor: 0.0 }
    }

    pub fn above(self, floor: f64) -> Self {
        Self { floor, ..self }
    }
}

/// Relative tolerances of generated code.
pub const DOUBLE: f64 = 1e-12;
pub const SINGLE: f64 = 1e-5;

/// Shows that a quantity of `count` random robots in all models is what the library gives, in both scalars.
pub fn equals_library(count: u64, options: &Grown, quantity: Quantity, library: impl Fn(&Subject) -> Vec<Known>) {
    let mut shown = 0;
    for seed in 0..count {
        let robot = RandomRobot::new(seed, options);
        for fidelity in Fidelity::ALL {
            shown += usize::from(equals(Subject::of(&robot, fidelity), quantity, &library));
        }
    }
    assert!(shown > count as usize / 2, "{shown} robots have `{}`", quantity.name());
}

/// The same of robots with links that bend.
pub fn bending_equals_library(count: u64, quantity: Quantity, library: impl Fn(&Subject) -> Vec<Known>) {
    let mut shown = 0;
    for seed in 0..count {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &grown_bending().in_model(fidelity));
            shown += usize::from(equals(Subject::bending(&robot, fidelity), quantity, &library));
        }
    }
    assert!(shown > count as usize / 2, "{shown} robots have `{}`", quantity.name());
}

/// Whether the robot has the quantity.
fn equals(mut subject: Subject, quantity: Quantity, library: impl Fn(&Subject) -> Vec<Known>) -> bool {
    let Some(function) = subject.function(quantity) else { return false };
    subject.assert_equal::<f64>(&function, &library(&subject), &[], DOUBLE);
    if subject.round() {
        subject.assert_equal::<f32>(&function, &library(&subject), &[], SINGLE);
    }
    true
}
