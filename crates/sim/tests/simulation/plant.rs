//! Laws of a simulated robot that is not the one its controller knows.

use crate::arm::{LENGTH, STIFFNESS, arm, linear, run, scenario, simulation, with_drives, with_transmissions};
use gyroflex::model::{SpringSpec, TransmissionError, TransmissionSpec};
use gyroflex_sim::record::Sample;
use gyroflex_sim::{Fidelity, Robot, Simulation};

const MOVES: &str = "duration: 0.2\nreference: {default: {type: sine, amplitude: 0.3, frequency: 1.0}}
controller: {type: pd, kp: 400, kd: 30}\nlog: {rate: 100}\n";

fn damped(n: usize) -> Robot {
    let spring = SpringSpec::Polynomial { stiffness: STIFFNESS, cubic: 1e5 };
    with_transmissions(arm(n), spring, 2.0, TransmissionError::none())
}

/// Every number of a run.
fn numbers(samples: &[Sample]) -> Vec<[Vec<f64>; 5]> {
    samples.iter().map(|s| [&s.q, &s.qd, &s.theta, &s.thetad, &s.tau].map(Clone::clone)).collect()
}

fn moves(robot: &Robot, plant: &str) -> Vec<[Vec<f64>; 5]> {
    numbers(&run(robot, &format!("{MOVES}{plant}")).1)
}

#[test]
fn factors_of_one_and_the_robots_own_load_change_nothing_to_the_last_bit() {
    let load = "{link: link3, mass: 2.5, xyz: [0.1, 0.2, -0.3], inertia: [0.03, 0.03, 0.04, 0.001, 0, 0]}";
    let loaded = simulation(&damped(3), &format!("{MOVES}plant: {{payload: {load}}}")).robot().clone();
    let plain = moves(&loaded, "");
    assert_ne!(plain, moves(&damped(3), ""));
    let ones = "stiffness: 1, damping: {joint1: 1}, mass: {default: 1}";
    assert_eq!(plain, moves(&loaded, &format!("plant: {{{ones}}}")));
    assert_eq!(plain, moves(&loaded, &format!("plant: {{{ones}, payload: {load}}}")));
    let bare = simulation(&loaded, &format!("{MOVES}plant: {{payload: {{link: link1, mass: 0}}}}"));
    for (bare, want) in bare.robot().bodies.iter().zip(&damped(3).bodies) {
        assert_eq!(bare.inertia, want.inertia, "the load taken off");
    }
}

/// Gravity turns the link about y: x forward and level at 0, positive angles point it down.
#[test]
fn a_static_load_bends_the_transmission_by_the_stiffness_of_the_plant_while_the_controller_feeds_its_own() {
    let (q, k, f, m) = (0.4_f64, STIFFNESS, 1.6, 2.0);
    let weight = |mass: f64, at: f64| -mass * 9.81 * at * q.cos();
    let own = weight(3.0, LENGTH / 2.0);
    for (plant, torque, stiffness) in [
        (format!("{{stiffness: {f}}}"), own, f * k),
        (format!("{{stiffness: {{joint1: {f}}}, mass: 1.5}}"), 1.5 * own, f * k),
        (format!("{{payload: {{link: link1, mass: {m}, xyz: [{LENGTH}, 0, 0]}}}}"), own + weight(m, LENGTH), k),
        ("{}".to_owned(), own, k),
    ] {
        let yaml =
            format!("duration: 0.001\ninitial: {{q: [{q}]}}\ncontroller: {{type: pd, kp: 70, kd: 3}}\nplant: {plant}");
        let first = &run(&arm(1), &yaml).1[0];
        let bent = first.theta[0] - first.q[0];
        assert!((bent - torque / stiffness).abs() < 1e-12, "{plant}: {bent}");
        let asked = own + 70.0 * (q + own / k - (q + torque / stiffness));
        assert!((first.tau[0] - asked).abs() < 1e-10, "{plant}: {} is not {asked}", first.tau[0]);
    }
}

#[test]
fn without_a_controller_the_plant_is_a_robot_of_its_own_numbers() {
    let falls = |robot: &Robot, plant: &str| {
        numbers(&run(robot, &format!("duration: 0.3\ninitial: {{q: [0.1, 0.2]}}\nlog: {{rate: 50}}\n{plant}")).1)
    };
    let mut written = damped(2);
    let (k, k3, d) = (STIFFNESS * 0.75, 1e5 * 0.75, 2.0 * 3.0);
    let spring = SpringSpec::Polynomial { stiffness: k, cubic: k3 };
    written.bodies[1].drive.as_mut().unwrap().transmission =
        TransmissionSpec::Elastic { spring, damping: d, error: TransmissionError::none() };
    written.bodies[0].inertia = written.bodies[0].inertia.map(|x| x * 1.25);
    let plant = "plant: {stiffness: {joint2: 0.75}, damping: {joint2: 3}, mass: {joint1: 1.25}}";
    assert_eq!(falls(&damped(2), plant), falls(&written, ""));
    assert_ne!(falls(&damped(2), plant), falls(&damped(2), ""));
}

#[test]
fn a_table_of_a_spring_is_scaled_in_its_torques() {
    let table = [[0.0, 0.0], [0.01, 8.0], [0.02, 30.0]];
    let with = |table: [[f64; 2]; 3]| {
        let mut robot = arm(1);
        robot.spring_tables.extend(table);
        with_transmissions(robot, SpringSpec::Table { first: 0, len: 3 }, 1.0, TransmissionError::none())
    };
    let scaled = moves(&with(table), "plant: {stiffness: 2}");
    let written = with(table.map(|[x, t]| [x, 2.0 * t]));
    assert_ne!(scaled, moves(&written, ""), "the controller knows the softer spring");
    let mut free = [MOVES.replace("type: pd, kp: 400, kd: 30", "type: none"), String::new()];
    free[1] = format!("{}plant: {{stiffness: 2}}", free[0]);
    assert_eq!(numbers(&run(&with(table), &free[1]).1), numbers(&run(&written, &free[0]).1));
}

#[test]
fn controller_and_plant_are_told_apart() {
    let simulation = simulation(&arm(2), &format!("{MOVES}plant: {{stiffness: {{joint2: 0.5}}}}"));
    let stiffness = |robot: &Robot, body: usize| match robot.bodies[body].drive.unwrap().transmission {
        TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. } => stiffness,
        _ => f64::NAN,
    };
    let all = |robot: &Robot| [stiffness(robot, 0), stiffness(robot, 1)];
    assert_eq!(all(simulation.nominal()), [STIFFNESS; 2]);
    assert_eq!(all(simulation.robot()), [STIFFNESS, 0.5 * STIFFNESS]);
    let told = simulation.run_info().metadata;
    assert!(told.contains(&("plant.stiffness.joint2".to_owned(), "0.5".to_owned())), "{told:?}");
}

#[test]
fn plants_that_make_no_sense_or_no_difference_are_refused() {
    let mut rigid = arm(2);
    rigid.fidelity = Fidelity::Rigid;
    let geared = with_drives(arm(2), |d| d.transmission = TransmissionSpec::Rigid);
    let undamped = with_transmissions(arm(2), linear(1e3), 0.0, TransmissionError::none());
    for (robot, plant, key, word) in [
        (&arm(2), "{stiffness: {jiont2: 2}}", "plant.stiffness.jiont2", "`joint2`"),
        (&arm(2), "{payload: {link: lnik2, mass: 1}}", "plant.payload.link", "`link2`"),
        (&rigid, "{stiffness: 2}", "plant.stiffness", "changes nothing"),
        (&geared, "{stiffness: {joint1: 2}}", "plant.stiffness.joint1", "changes nothing"),
        (&undamped, "{damping: 2}", "plant.damping", "changes nothing"),
    ] {
        let error = Simulation::new(robot, &scenario(&format!("duration: 1\nplant: {plant}"))).unwrap_err();
        assert_eq!((error.element.as_str(), error.file.as_str()), (key, "test.yaml:3"), "{error}");
        assert!(error.to_string().contains(word), "{error}");
    }
    for (plant, key) in [
        ("{stiffness: 0}", "plant.stiffness"),
        ("{damping: {joint1: -1}}", "plant.damping.joint1"),
        ("{mass: -1}", "plant.mass"),
        ("{payload: {link: l, mass: -1}}", "plant.payload.mass"),
        ("{stiffnes: 2}", "plant.stiffnes"),
    ] {
        let text = format!("robot: r.yaml\nduration: 1\nplant: {plant}");
        let error = gyroflex_sim::ScenarioFile::parse(&text, std::path::Path::new("test.yaml")).unwrap_err();
        assert_eq!(error.element, key, "{error}");
    }
}
