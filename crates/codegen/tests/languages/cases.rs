//! Functions of random robots, points to run them at, and what comes out.

use super::robots::Subject;
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Head, Precision};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::optimise::optimise;
use gyroflex_codegen::quantity::{Options, Quantity, available, function};
use gyroflex_codegen::robot::Robot;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_testkit::State;
use gyroflex_testkit::random::{
    FlexibleOptions, Options as Grown, RandomFlexible, RandomRobot, random_point, with_random_modes,
};
use gyroflex_testkit::tolerance::{assert_close_above, relative_error};
use std::path::Path;

/// Relative tolerances of generated code.
const DOUBLE: f64 = 1e-12;
const SINGLE: f64 = 1e-5;

/// Robots that ship with the project, one for each kind there is.
pub const SHIPPED: [&str; 5] = ["puma560", "iiwa14", "manutec_r3", "biped5", "book_two_link"];

/// How many points forward and inverse dynamics are shown at.
const POINTS: u64 = 1000;
/// How many everything else is.
const FEWER: u64 = 50;

/// The functions of a robot, and points for each.
pub struct Case {
    pub stem: String,
    pub about: String,
    pub functions: Vec<Function>,
    pub points: Vec<Points>,
}

/// What a function takes at some points, and what it gives: all arguments and all results in a row.
pub struct Points {
    pub inputs: Vec<Vec<f64>>,
    want: Vec<Vec<Known>>,
}

/// A result, known relative to at least the size of what it is a sum of.
struct Known {
    value: Vec<f64>,
    floor: f64,
    /// How far off the graph itself is in single precision: accelerations are as uncertain as inertia matrices are ill-conditioned.
    single: f64,
}

/// An arm of seven elastic joints.
pub fn arm(fidelity: Fidelity) -> Case {
    let grown = Grown {
        bodies: 7..=7,
        floating: 0.0,
        prismatic: 0.0,
        branching: 0.0,
        driven: 1.0,
        elastic: 1.0,
        remote_rigid: false,
        transmission_error: 0.0,
        ..Grown::default()
    };
    let robot = RandomRobot::new(7, &grown);
    let subject = Subject::of(robot.clone(), fidelity);
    case("arm", 7, subject, &|k| robot.state(k), &[Quantity::Forward, Quantity::Inverse, Quantity::MassMatrix])
}

/// Robots that have everything, and all that is generated for them.
pub fn mixed(seeds: std::ops::Range<u64>) -> Vec<Case> {
    let grown = Grown { bodies: 2..=4, transmission_error: 0.0, ..Grown::default() };
    let rigid = seeds.clone().map(|seed| {
        let robot = RandomRobot::new(seed, &grown);
        let subject = Subject::of(robot.clone(), Fidelity::ALL[seed as usize % Fidelity::ALL.len()]);
        case("mixed", seed, subject, &|k| robot.state(k), Quantity::ALL)
    });
    let bending = seeds.take(1).map(|seed| {
        let robot = Grown { bodies: 1..=3, remote_rigid: false, transmission_error: 0.0, ..Grown::default() };
        let fidelity = Fidelity::ALL[3];
        let options = FlexibleOptions { robot, modes: 1..=2, ..FlexibleOptions::default() }.in_model(fidelity);
        let robot = RandomFlexible::new(seed, &options);
        case("bending", seed, Subject::bending(&robot, fidelity), &|k| robot.state(k), Quantity::ALL)
    });
    rigid.chain(bending).collect()
}

/// A robot that ships with the project, in its own model, and all that is generated for it; a thousand points for each.
pub fn shipped(name: &str) -> Case {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name).join("robot.yaml");
    let loaded = load(&file, &LoadOptions::default()).expect("it ships");
    let model = loaded.model(loaded.fidelity).expect("it is valid");
    let names: Vec<String> = loaded.joints.iter().map(|joint| joint.name.clone()).collect();
    let robot = Robot {
        name,
        joints: &names,
        links: &names,
        spec: loaded.spec(),
        fidelity: loaded.fidelity,
        model: model.view(),
        flexible: model.flexible(),
        payload: None,
    };
    let modes = robot.flexible.map_or(0, |model| model.modes());
    let torques = function(&robot, Quantity::Inverse, &Options::default()).expect("every robot has it");
    let (mut functions, mut points) = (Vec::new(), Vec::new());
    for quantity in available(&robot, &Options::default()) {
        let traced = function(&robot, quantity, &Options::default()).expect("it is available");
        let count = if traced.inputs() == 0 { 1 } else { POINTS };
        let (mut inputs, mut want) = (Vec::new(), Vec::new());
        for k in 0..count {
            let state = with_random_modes(random_point(&loaded.bodies, &loaded.spring_tables, k), modes, !k);
            let state = state.rounded_to_f32();
            let point = inputs_of(&traced, &state, k);
            let mut of_it = of_graph(&traced, &point);
            if quantity == Quantity::InverseDerivatives {
                // Torques are sums that turn with the angles: their derivatives have terms of their size.
                let torques = of_graph(&torques, &inputs_of(&torques, &state, k));
                of_it.iter_mut().for_each(|known| known.floor = known.floor.max(torques[0].floor));
            }
            want.push(of_it);
            inputs.push(point);
        }
        functions.push(optimise(&traced));
        points.push(Points { inputs, want });
    }
    Case { stem: name.to_owned(), about: format!("{name}, {}", loaded.fidelity.name()), functions, points }
}

fn case(name: &str, seed: u64, subject: Subject, state: &dyn Fn(u64) -> State, quantities: &[Quantity]) -> Case {
    let about = subject.about();
    let stem = format!("{name}_{seed}_{}", subject.robot().fidelity.name().replace('-', "_"));
    let has = available(&subject.robot(), &Options::default());
    let (mut functions, mut points) = (Vec::new(), Vec::new());
    for quantity in quantities.iter().copied().filter(|q| has.contains(q)) {
        let traced = function(&subject.robot(), quantity, &Options::default()).expect("it is available");
        let count = match quantity {
            _ if traced.inputs() == 0 => 1,
            Quantity::Forward | Quantity::Inverse => POINTS,
            _ => FEWER,
        };
        let (mut inputs, mut want) = (Vec::new(), Vec::new());
        for k in 0..count {
            let state = state(k).rounded_to_f32();
            let point = inputs_of(&traced, &state, k);
            want.push(known(&subject, &state, quantity, &traced, &point));
            inputs.push(point);
        }
        functions.push(optimise(&traced));
        points.push(Points { inputs, want });
    }
    Case { stem, about, functions, points }
}

/// Arguments by their names; of what a state does not have, derivatives of higher order, numbers of size one.
fn inputs_of(function: &Function, s: &State, index: u64) -> Vec<f64> {
    let mut inputs = Vec::new();
    for a in &function.arguments {
        let known = match a.name.as_str() {
            "q" => &s.q,
            "qd" => &s.qd,
            "theta" => &s.theta,
            "thetad" => &s.thetad,
            "qdd" => &s.qdd,
            "thetadd" => &s.thetadd,
            "tau" => &s.tau,
            "step" => &vec![f64::from(1e-3_f32)],
            _ => &(0..a.len).map(|k| f64::from((k as f64 + 0.7 * index as f64).sin() as f32)).collect(),
        };
        assert_eq!(known.len(), a.len, "length of `{}`", a.name);
        inputs.extend(known);
    }
    inputs
}

/// What the library gives, in the order of the outputs.
fn known(subject: &Subject, s: &State, quantity: Quantity, traced: &Function, point: &[f64]) -> Vec<Known> {
    let exact =
        |values: Vec<Vec<f64>>| values.into_iter().map(|value| Known { value, floor: 0.0, single: 0.0 }).collect();
    if subject.bending.is_none() {
        match quantity {
            Quantity::Inverse => return exact(subject.inverse(s).into()),
            Quantity::MassMatrix => return exact(vec![subject.mass_matrix(s)]),
            Quantity::Forward => {
                let all = ["qdd", "thetadd", "tau_j"].into_iter().zip(subject.forward(s));
                let given = all.filter(|(name, _)| traced.outputs.iter().any(|o| o.name == *name));
                return exact(given.map(|(_, value)| value).collect());
            }
            _ => {}
        }
    }
    of_graph(traced, point)
}

/// What the graph gives. Some results may vanish beside others, which they have terms in common with.
fn of_graph(traced: &Function, point: &[f64]) -> Vec<Known> {
    let values = traced.evaluate::<f64>(point);
    let floor = values.iter().flatten().fold(1.0, |m: f64, x| m.max(x.abs()));
    let single = traced.evaluate(&point.iter().map(|x| *x as f32).collect::<Vec<f32>>());
    let known = |(value, single): (Vec<f64>, Vec<f32>)| {
        let single: Vec<f64> = single.into_iter().map(f64::from).collect();
        Known { single: relative_error(&single, &value, floor), value, floor }
    };
    values.into_iter().zip(single).map(known).collect()
}

impl Case {
    pub fn head(&self) -> Head {
        Head { robot: self.stem.clone(), model: self.about.clone(), command: "a test".to_owned() }
    }

    /// Asserts that a function gives at its points what it should.
    pub fn assert_equal(&self, language: &str, f: usize, precision: Precision, got: &[Vec<f64>]) {
        let (function, points) = (&self.functions[f], &self.points[f]);
        assert_eq!(got.len(), points.inputs.len(), "{language}, {}: points", function.name);
        let tolerance = |output: usize| match precision {
            Precision::Double => DOUBLE,
            Precision::Single => points.want.iter().fold(SINGLE, |worst, known| worst.max(2.0 * known[output].single)),
        };
        let tolerances: Vec<f64> = (0..function.outputs.len()).map(tolerance).collect();
        for (k, (got, want)) in got.iter().zip(&points.want).enumerate() {
            let mut rest = got.as_slice();
            for ((output, want), tolerance) in function.outputs.iter().zip(want).zip(&tolerances) {
                let (value, more) = rest.split_at(output.entries.len());
                rest = more;
                let what = format!("{language}, {}, {} of point {k}", function.name, output.name);
                assert_close_above(&what, &self.about, value, &want.value, *tolerance, want.floor);
            }
            assert!(rest.is_empty(), "{language}, {}: more than its outputs", function.name);
        }
    }
}
