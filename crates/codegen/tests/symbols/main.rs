//! Laws of parameters that stay symbols: a generated function at other values is the library on another robot.

mod described;
mod library;
#[path = "../quantities/scratch.rs"]
mod scratch;

use described::Described;
use gyroflex::model::{Fidelity, JointKind};
use gyroflex_codegen::quantity::{Options, Quantity, function};
use gyroflex_codegen::robot::Parameter;
use gyroflex_testkit::State as Point;
use gyroflex_testkit::random::{FlexibleOptions, Options as Grown, RandomFlexible, RandomRobot};
use gyroflex_testkit::tolerance::{assert_close_above, norm};
use library::{evaluate, library};

const SEEN_IN: [Quantity; 5] =
    [Quantity::Inverse, Quantity::MassMatrix, Quantity::Coupling, Quantity::ReflectedInertia, Quantity::Energy];

/// All parameters at once, each changed by a factor of its own, and the state at which all that depends on them is looked at.
fn follows_the_description(nominal: &Described, state: &Point) {
    let records = nominal.lower();
    let robot = nominal.robot(&records);
    let kept = Parameter::all(&robot);
    // A rotor within a link may become lighter, not heavier than the link.
    let value = |(k, p): (usize, &Parameter)| {
        let factor = 1.0 - 0.3 * ((k as f64 * 0.618_033_988_7).fract() + 0.1);
        if p.nominal() == 0.0 { factor } else { p.nominal() * factor }
    };
    let values: Vec<f64> = kept.iter().enumerate().map(value).collect();
    let mut changed = nominal.clone();
    for (parameter, value) in kept.iter().zip(&values) {
        changed.change(parameter.name(), *value);
    }
    let after = changed.lower();
    let nominals: Vec<f64> = kept.iter().map(Parameter::nominal).collect();
    let options = Options { kept, ..Options::default() };
    for quantity in SEEN_IN {
        let Ok(function) = function(&robot, quantity, &options) else { continue };
        let last = function.arguments.last().expect("parameters are an argument");
        assert_eq!((last.name.as_str(), last.len), ("parameters", values.len()));
        for (when, records, parameters) in [("as described", &records, &nominals), ("changed", &after, &values)] {
            let want = library(records, state);
            for (name, got) in evaluate(&function, state, parameters) {
                let (_, want, floor) = want.iter().find(|(of, ..)| *of == name).expect("the library gives it");
                assert_close_above(&format!("{name}, {when}"), nominal, &got, want, 1e-12, *floor);
            }
        }
    }
}

#[test]
fn generated_functions_of_parameters_equal_the_library_on_the_changed_robot() {
    for seed in 0..60 {
        let robot = RandomRobot::new(seed, &Grown { bodies: 1..=6, ..Grown::default() });
        for fidelity in Fidelity::ALL {
            follows_the_description(&Described::new(&robot, fidelity, None), &robot.state(0));
        }
    }
}

#[test]
fn so_do_those_of_robots_with_links_that_bend() {
    let robot = Grown { bodies: 2..=4, remote_rigid: false, ..Grown::default() };
    let options = FlexibleOptions { robot, modes: 1..=2, flexible: 0.4, ..FlexibleOptions::default() };
    for seed in 0..40 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &options.in_model(fidelity));
            // The load is on a link that does not bend; what the description says of those that do is left alone.
            let bending = Some((robot.links.clone(), robot.seats.clone()));
            follows_the_description(&Described::new(&robot.robot, fidelity, bending), &robot.state(0));
        }
    }
}

/// One parameter after the other, so that none hides behind another; in torques that forward dynamics gives back.
#[test]
fn every_parameter_by_itself_moves_forward_dynamics_as_the_description_does() {
    for seed in 0..12 {
        let options = Grown { bodies: 1..=4, remote_rigid: false, ..Grown::default() };
        let robot = RandomRobot::new(seed, &options);
        for fidelity in Fidelity::ALL {
            let nominal = Described::new(&robot, fidelity, None);
            let records = nominal.lower();
            for parameter in Parameter::all(&nominal.robot(&records)) {
                let value = if parameter.nominal() == 0.0 { 0.3 } else { 0.8 * parameter.nominal() };
                let mut changed = nominal.clone();
                changed.change(parameter.name(), value);
                let name = parameter.name().to_owned();
                let options = Options { kept: vec![parameter], ..Options::default() };
                let function = function(&nominal.robot(&records), Quantity::Forward, &options).expect("it is there");
                let got = evaluate(&function, &robot.state(0), &[value]);
                let of = |name: &str| got.iter().find(|(of, _)| of == name).map(|(_, x)| x.clone());
                let qdd = of("qdd").expect("it is there");
                let thetadd = of("thetadd").unwrap_or(qdd.clone());
                // The changed robot, accelerated so, needs the torques that were given.
                let state = Point { qdd: qdd.clone(), thetadd, ..robot.state(0) };
                let want = library(&changed.lower(), &state);
                let find = |name: &str| &want.iter().find(|(of, ..)| *of == name).expect("it is there").1;
                let size = norm(find("m")) * norm(&qdd);
                let what = format!("torques with {name}");
                assert_close_above(&what, &nominal, find("tau"), &state.tau, 1e-12, size.max(norm(find("tau_j"))));
            }
        }
    }
}

#[test]
fn unknown_names_are_answered_with_the_nearest_and_all() {
    let robot =
        RandomRobot::new(1, &Grown { bodies: 4..=4, floating: 0.0, driven: 1.0, elastic: 1.0, ..Grown::default() });
    let described = Described::new(&robot, Fidelity::Complete, None);
    let records = described.lower();
    let robot = described.robot(&records);
    for parameter in Parameter::all(&robot) {
        assert_eq!(Parameter::of(parameter.name(), &robot), Ok(parameter.clone()));
    }
    let no = Parameter::of("joint2.dampign", &robot).expect_err("it is misspelt");
    assert_eq!(no.nearest.as_deref(), Some("joint2.damping"));
    assert!(no.known.contains(&"gravity".to_owned()) && no.to_string().contains("payload.mass"));
}

#[test]
fn a_rigid_model_has_no_transmissions_to_keep() {
    let robot = RandomRobot::new(2, &Grown { driven: 1.0, elastic: 1.0, ..Grown::default() });
    let described = Described::new(&robot, Fidelity::Rigid, None);
    let records = described.lower();
    let all = Parameter::all(&described.robot(&records));
    assert!(all.iter().any(|p| p.name().ends_with(".gear_ratio")));
    assert!(!all.iter().any(|p| p.name().ends_with(".stiffness") || p.name().ends_with(".damping")));
    let floating = robot.bodies[0].joint == JointKind::Floating;
    assert_eq!(all.iter().any(|p| p.name() == "joint0.viscous"), !floating);
}

/// Whether a transmission is damped decides of what the inverse is made; of anything else it is not.
#[test]
fn an_elastic_inverse_keeps_no_damping_that_is_zero() {
    let options = Grown { bodies: 3..=3, floating: 0.0, driven: 1.0, elastic: 1.0, damping: 0.0, ..Grown::default() };
    let described = Described::new(&RandomRobot::new(5, &options), Fidelity::Reduced, None);
    let records = described.lower();
    let robot = described.robot(&records);
    let keeping = |name: &str| {
        let kept = vec![Parameter::of(name, &robot).expect("the robot has it")];
        function(&robot, Quantity::ElasticInverse, &Options { kept, ..Options::default() })
    };
    let no = keeping("joint1.damping").expect_err("it is zero");
    assert!(no.reason.contains("joint1.damping"), "{no}");
    assert!(keeping("joint1.gear_ratio").is_ok() && keeping("link1.mass").is_ok());
}
