//! Robots for the laws of explicit equations, and numbers for the arguments of their functions.
#![allow(dead_code, reason = "every test takes of it what it needs")]

pub mod document;
pub mod shipped;

use gyroflex::model::{DriveSpec, Fidelity, TransmissionSpec};
use gyroflex::spatial::{Mat3, Transform, Vec3};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::robot::Robot;
use gyroflex_testkit::flexible::LoweredFlexible;
use gyroflex_testkit::random::{FlexibleOptions, Options, RandomFlexible, RandomRobot, random_point};
use gyroflex_testkit::{Lowered, State};

/// Seeds of random robots; a failing law prints the one it failed with.
pub fn seeds(n: u64) -> std::ops::Range<u64> {
    0..n
}

/// Fixed robots without tables and errors of gears, of so many bodies; everything else mixed.
pub fn options(bodies: std::ops::RangeInclusive<usize>) -> Options {
    Options { bodies, floating: 0.0, table: 0.0, transmission_error: 0.0, ..Options::default() }
}

/// A robot with all that a [`Robot`] borrows.
pub struct Arm {
    pub seed: u64,
    pub name: String,
    pub fidelity: Fidelity,
    pub joints: Vec<String>,
    pub links: Vec<String>,
    pub random: RandomRobot,
    lowered: Lowered<f64>,
    bending: Option<(RandomFlexible, LoweredFlexible<f64>)>,
}

impl Arm {
    /// A random robot in one of the four models.
    pub fn new(seed: u64, options: &Options) -> Self {
        Self::in_model(seed, options, Fidelity::ALL[seed as usize % Fidelity::ALL.len()])
    }

    /// A random robot in a model.
    pub fn in_model(seed: u64, options: &Options, fidelity: Fidelity) -> Self {
        Self::of(RandomRobot::new(seed, options), fidelity)
    }

    /// Any robot in a model.
    pub fn of(random: RandomRobot, fidelity: Fidelity) -> Self {
        let lowered = Lowered::new(&random.spec(), fidelity).expect("the robot is physical");
        let names = |what: &str| (1..=random.bodies.len()).map(|i| format!("{what}{i}")).collect();
        Self {
            seed: random.seed,
            name: format!("random {}", random.seed),
            fidelity,
            joints: names("joint"),
            links: names("link"),
            lowered,
            bending: None,
            random,
        }
    }

    /// A random arm whose joints are all parallel, in one of the four models.
    pub fn planar(seed: u64, n: usize) -> Self {
        let mut random = RandomRobot::new(seed, &Options { prismatic: 0.0, branching: 0.0, ..options(n..=n) });
        for body in &mut random.bodies {
            body.axis = Vec3::new(0.0, 0.0, 1.0);
            body.placement = Transform::from_pose(Mat3::identity(), body.placement.pos);
        }
        Self::of(random, Fidelity::ALL[seed as usize % Fidelity::ALL.len()])
    }

    /// A random robot of which a link bends.
    pub fn bending(seed: u64) -> Self {
        let robot = Options { remote_rigid: false, ..options(1..=2) };
        let options = FlexibleOptions { robot, modes: 1..=2, ..FlexibleOptions::default() };
        let fidelity = Fidelity::ALL[seed as usize % Fidelity::ALL.len()];
        Self::of_bending(RandomFlexible::new(seed, &options.in_model(fidelity)), fidelity)
    }

    /// Any robot of which a link bends.
    pub fn of_bending(random: RandomFlexible, fidelity: Fidelity) -> Self {
        let lowered = random.lower(fidelity).expect("the robot is physical");
        Self { bending: Some((random.clone(), lowered)), ..Self::of(random.robot, fidelity) }
    }

    /// What code is generated for.
    pub fn robot(&self) -> Robot<'_> {
        Robot {
            name: &self.name,
            joints: &self.joints,
            links: &self.links,
            spec: self.random.spec(),
            fidelity: self.fidelity,
            model: self.lowered.view(),
            flexible: self.bending.as_ref().map(|(_, lowered)| lowered.view()),
            payload: None,
        }
    }

    /// A random state; `index` makes them differ.
    pub fn state(&self, index: u64) -> State {
        match &self.bending {
            Some((random, _)) => random.state(index),
            None => random_point(&self.random.bodies, &self.random.spring_tables, self.random.seed ^ (index + 1)),
        }
    }
}

/// A state of a robot whose modal coordinates are of this size.
pub fn at(arm: &Arm, index: u64, size: f64) -> State {
    let mut state = arm.state(index);
    let first = arm.random.bodies.len();
    // Random modal coordinates are up to a twentieth.
    state.q[first..].iter_mut().for_each(|eta| *eta *= size / 0.05);
    state
}

/// Numbers for the arguments of a function, by their names.
pub fn numbers(f: &Function, state: &State) -> Vec<f64> {
    let mut all = Vec::new();
    for argument in &f.arguments {
        let of = match argument.name.as_str() {
            "q" => &state.q,
            "qd" => &state.qd,
            "theta" => &state.theta,
            "thetad" => &state.thetad,
            "qdd" => &state.qdd,
            "thetadd" => &state.thetadd,
            "tau" => &state.tau,
            other => panic!("`{other}` is no argument of a state"),
        };
        assert_eq!(of.len(), argument.len, "`{}`", argument.name);
        all.extend(of);
    }
    all
}

/// A drive whose transmission is rigid.
pub fn is_rigid(drive: &DriveSpec) -> bool {
    matches!(drive.transmission, TransmissionSpec::Rigid)
}
