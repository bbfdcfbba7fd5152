//! Functions of random robots, points to run them at, and what comes out.

use super::robots::Subject;
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Head, Precision};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::optimise::optimise;
use gyroflex_codegen::quantity::{Options, Quantity, available, function};
use gyroflex_testkit::State;
use gyroflex_testkit::random::{FlexibleOptions, Options as Grown, RandomFlexible, RandomRobot};
use gyroflex_testkit::tolerance::assert_close_above;

/// Relative tolerances of generated code.
const DOUBLE: f64 = 1e-12;
const SINGLE: f64 = 1e-5;

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
    let exact = |values: Vec<Vec<f64>>| values.into_iter().map(|value| Known { value, floor: 0.0 }).collect();
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
    // Some results may vanish beside others, which they have terms in common with.
    let values = traced.evaluate::<f64>(point);
    let floor = values.iter().flatten().fold(1.0, |m: f64, x| m.max(x.abs()));
    values.into_iter().map(|value| Known { value, floor }).collect()
}

impl Case {
    pub fn head(&self) -> Head {
        Head { robot: self.stem.clone(), model: self.about.clone(), command: "a test".to_owned() }
    }

    /// Asserts that a function gives at its points what it should.
    pub fn assert_equal(&self, language: &str, f: usize, precision: Precision, got: &[Vec<f64>]) {
        let (function, points) = (&self.functions[f], &self.points[f]);
        assert_eq!(got.len(), points.inputs.len(), "{language}, {}: points", function.name);
        let tolerance = match precision {
            Precision::Double => DOUBLE,
            Precision::Single => SINGLE,
        };
        for (k, (got, want)) in got.iter().zip(&points.want).enumerate() {
            let mut rest = got.as_slice();
            for (output, want) in function.outputs.iter().zip(want) {
                let (value, more) = rest.split_at(output.entries.len());
                rest = more;
                let what = format!("{language}, {}, {} of point {k}", function.name, output.name);
                assert_close_above(&what, &self.about, value, &want.value, tolerance, want.floor);
            }
            assert!(rest.is_empty(), "{language}, {}: more than its outputs", function.name);
        }
    }
}
