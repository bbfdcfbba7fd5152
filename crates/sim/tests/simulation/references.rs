//! Laws of references and shapers as scenarios name them.

use crate::arm::{STIFFNESS, arm, flying_arm, linear, run, scenario, simulation, with_transmissions};
use gyroflex::control::{Mode, Shaper, ShaperKind};
use gyroflex::model::{Fidelity, TransmissionError};
use gyroflex_sim::linearize::{KeptFriction, Linearizer, ModeKind, Output, natural_modes};
use gyroflex_sim::load::Disk;
use gyroflex_sim::{ErrorKind, Robot, ScenarioFile, Simulation};
use std::f64::consts::TAU;
use std::path::Path;

const REFERENCES: [(&str, Option<usize>); 6] = [
    ("{type: quintic, from: 0.2, to: 1.2, duration: 0.5}", Some(3)),
    ("{type: polynomial, from: 0.2, to: 1.2, duration: 0.5, order: 4}", Some(5)),
    ("{type: filtered_step, from: 0.2, to: 1.2, start: 0.1, order: 6, cutoff: 8}", Some(6)),
    ("{type: minimum_time, from: 0.2, to: 1.2, limits: [3, 20, 300, 9e3]}", Some(4)),
    ("{type: waypoints, times: [0, 0.3, 0.8], positions: [0.2, 0.9, 1.2], degree: 7}", Some(7)),
    ("{type: waypoints, times: [0, 0.8], positions: [0.2, 1.2]}", Some(5)),
];

#[test]
fn references_lead_from_where_to_where_they_say_as_smoothly_as_they_say() {
    for (reference, smoothness) in REFERENCES {
        let yaml = format!("duration: 2\nreference: {{joint2: {reference}}}");
        let simulation = simulation(&arm(2), &yaml);
        let references = simulation.references();
        assert_eq!(references.len(), 2);
        for (t, q) in [(-0.1, 0.2), (0.0, 0.2), (2.0, 1.2)] {
            let point = references.point(1, t);
            assert!((point.q - q).abs() < 1e-9 && point.qd.abs() < 1e-6, "{reference} at {t}: {point:?}");
        }
        assert_eq!((references.smoothness(0), references.smoothness(1)), (None, smoothness));
        assert_eq!(simulation.initial_state().q[1], references.point(1, 0.0).q);
    }
}

#[test]
fn numbers_that_make_no_motion_and_no_shaper_are_refused_with_their_key() {
    let shaper = |text: &str| format!("shaper: {{{text}}}");
    let reference = |text: &str| format!("reference: {{joint1: {{from: 0, to: 1, {text}}}}}");
    let mode = "modes: [{frequency: 3, damping_ratio: 0.1}]";
    let cases = [
        (reference("type: polynomial, duration: 0, order: 3"), "reference.joint1.duration"),
        (reference("type: polynomial, duration: 1, order: 0"), "reference.joint1.order"),
        (reference("type: polynomial, duration: 1, order: 16"), "reference.joint1.order"),
        (reference("type: filtered_step, order: 0, cutoff: 1"), "reference.joint1.order"),
        (reference("type: filtered_step, order: 3, cutoff: 0"), "reference.joint1.cutoff"),
        (reference("type: minimum_time, limits: []"), "reference.joint1.limits"),
        (reference("type: minimum_time, limits: [1, 0]"), "reference.joint1.limits"),
        ("reference: {j: {type: waypoints, times: [0, 1], positions: [0]}}".to_owned(), "reference.j.times"),
        ("reference: {j: {type: waypoints, times: [0], positions: [0]}}".to_owned(), "reference.j.times"),
        ("reference: {j: {type: waypoints, times: [0, 0], positions: [0, 1]}}".to_owned(), "reference.j.times"),
        (
            "reference: {j: {type: waypoints, times: [0, 1], positions: [0, 1], degree: 4}}".to_owned(),
            "reference.j.degree",
        ),
        ("reference: {csv: a.csv, degree: 2}".to_owned(), "reference.degree"),
        ("reference: {degree: 5}".to_owned(), "reference.degree"),
        (shaper(&format!("type: zv, {mode}, tolerance: 0.1")), "shaper.tolerance"),
        (shaper(&format!("type: ei, {mode}, tolerance: 1")), "shaper.tolerance"),
        (shaper(&format!("type: zv, {mode}, count: 1")), "shaper.count"),
        (shaper(&format!("type: zv, {mode}, motors: free")), "shaper.motors"),
        (shaper("type: zv, modes: linearized, count: 0"), "shaper.count"),
        (shaper("type: zv, modes: linearized, count: 5"), "shaper.count"),
        (shaper("type: zv, modes: []"), "shaper.modes"),
        (shaper("type: zv, modes: [{frequency: 0}]"), "shaper.modes[0].frequency"),
        (shaper("type: zv, modes: [{frequency: 1, damping_ratio: 1}]"), "shaper.modes[0].damping_ratio"),
    ];
    for (yaml, key) in cases {
        let yaml = format!("robot: r\nduration: 1\n{yaml}");
        let error = ScenarioFile::parse(&yaml, Path::new("s.yaml")).unwrap_err();
        assert_eq!((error.kind, error.element.as_str()), (ErrorKind::Scenario, key), "{error}");
        assert!(error.file == "s.yaml:3" && !error.remedy.is_empty(), "{error}");
    }
}

#[test]
fn unknown_kinds_of_shapers_and_modes_are_refused() {
    for (text, words) in [
        ("type: zvz, modes: linearized", "`zv`"),
        ("type: zv, modes: linearised", "linearized"),
        ("type: zv, modes: linearized, cuont: 1", "`count`"),
        ("type: zv", "add `modes`"),
    ] {
        let yaml = format!("robot: r\nduration: 1\nshaper: {{{text}}}");
        let error = ScenarioFile::parse(&yaml, Path::new("s.yaml")).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn a_shaped_reference_is_the_sum_of_its_delayed_shares() {
    for (reference, _) in REFERENCES {
        let yaml = format!("duration: 2\nreference: {{joint2: {reference}}}");
        let plain = simulation(&arm(2), &yaml);
        let modes = "modes: [{frequency: 4, damping_ratio: 0.05}, {frequency: 9}]";
        let shaped = simulation(&arm(2), &format!("{yaml}\nshaper: {{type: zvd, {modes}}}"));
        // Its impulses, by the shaper of the core.
        let mode = |frequency, damping_ratio| Mode { frequency, damping_ratio };
        let shaper = Shaper::<f64, 9>::new(ShaperKind::Zvd, mode(4.0, 0.05)).unwrap();
        let shaper = shaper.and(ShaperKind::Zvd, mode(9.0, 0.0)).unwrap();
        for t in [0.1, 0.33, 0.7, 1.1] {
            let mut sum = [0.0; 5];
            for impulse in shaper.impulses() {
                let mut part = [0.0; 5];
                plain.references().derivatives(1, t - impulse.delay, &mut part);
                sum.iter_mut().zip(part).for_each(|(sum, x)| *sum += impulse.amplitude * x);
            }
            let mut own = [f64::NAN; 5];
            shaped.references().derivatives(1, t, &mut own);
            for (k, (own, sum)) in own.iter().zip(sum).enumerate() {
                assert!((own - sum).abs() < 1e-12 * 100f64.powi(k as i32), "{reference}, {k} at {t}");
            }
            // Of a joint without a motion nothing changes.
            assert_eq!(shaped.references().point(0, t), plain.references().point(0, t));
        }
        assert_eq!(shaped.references().smoothness(1), plain.references().smoothness(1));
    }
}

#[test]
fn linearized_modes_are_those_of_the_robot_where_the_references_end() {
    let robot = with_transmissions(arm(2), linear(STIFFNESS), 4.0, TransmissionError::none());
    let motion = "{type: quintic, from: 0, to: 1.5, duration: 1}";
    let yaml = format!("duration: 2\nreference: {{joint1: {motion}, joint2: {motion}}}");
    let shaped =
        simulation(&robot, &format!("{yaml}\nshaper: {{type: zv, modes: linearized, motors: free, count: 2}}"));

    let mut linearizer = Linearizer::new(&robot, Fidelity::Complete, KeptFriction::Viscous).unwrap();
    let point = linearizer.equilibrium_at(&[1.5, 1.5]).unwrap();
    let modes = natural_modes(&linearizer.linearize(&point, &Output::defaults()).unwrap()).unwrap();
    let swings: Vec<_> = modes.iter().filter(|m| m.kind == ModeKind::Oscillation).collect();
    for (i, mode) in swings.iter().enumerate() {
        let damping_ratio = mode.damping_ratio.unwrap();
        let left = shaped.references().shaper().residual(Mode { frequency: mode.frequency, damping_ratio });
        assert!(if i < 2 { left < 1e-9 } else { left > 1e-3 }, "mode {i}: {left}");
    }
}

#[test]
fn modes_that_are_not_there_are_refused() {
    let yaml = |more: &str| format!("duration: 1\nshaper: {{type: zv, modes: linearized}}\n{more}");
    let refused = |robot: &Robot, yaml: &str, words: &str| {
        let error = Simulation::new(robot, &scenario(yaml)).unwrap_err();
        assert!(error.kind == ErrorKind::Scenario && error.problem.contains(words), "{error}");
        assert!(error.element == "shaper.modes" && error.file == "test.yaml:3" && !error.remedy.is_empty(), "{error}");
    };
    // Without gravity nothing swings about rigid gears.
    refused(&arm(2), &yaml("model: rigid\ngravity: [0, 0, 0]"), "has 0 oscillating modes");
    refused(&flying_arm(2), &yaml(""), "floats");
    assert!(Simulation::new(&arm(2), &scenario(&yaml("gravity: [0, 0, 0]"))).is_ok());
}

#[test]
fn a_shaper_leaves_a_link_on_a_held_motor_nearly_still() {
    // Behind a motor that is held stiffly, the link swings with its spring alone: its inertia is 0.03·3 + 3·0.2² kg m².
    let frequency = (STIFFNESS / 0.21).sqrt() / TAU;
    let vibration = |shaper: &str| {
        let yaml = format!(
            "duration: 0.6\ngravity: [0, 0, 0]\nreference: {{joint1: {{type: polynomial, from: 0, to: 0.5, duration: 0.1, order: 3}}}}\n\
             controller: {{type: pd, rate: 10000, kp: 1e6, kd: 2e3, gravity_compensation: false}}\n\
             integrator: {{method: rk4, step: 1e-4}}\n{shaper}"
        );
        let (_, samples, _) = run(&arm(1), &yaml);
        samples.iter().filter(|s| s.t > 0.3).map(|s| (s.q[0] - 0.5).abs()).fold(0.0, f64::max)
    };
    let plain = vibration("");
    for (kind, share) in [("zv", 0.1), ("zvd", 0.05), ("ei", 0.08)] {
        let shaped = vibration(&format!("shaper: {{type: {kind}, modes: [{{frequency: {frequency}}}]}}"));
        // The linear model finds the same mode.
        let linearized = vibration(&format!("shaper: {{type: {kind}, modes: linearized}}"));
        assert!((linearized - shaped).abs() < 1e-6 * plain, "{kind}: {linearized} and {shaped}");
        assert!(plain > 0.01 && shaped < share * plain, "{kind}: {shaped} of {plain}");
    }
}

#[test]
fn a_csv_file_may_ask_for_a_smoother_spline() {
    let folder = std::env::temp_dir().join(format!("gyroflex-degree-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let rows: String = (0..=20).map(|i| format!("{},{}\n", 0.05 * i as f64, (0.3 * i as f64).sin())).collect();
    std::fs::write(folder.join("way.csv"), format!("time,joint1\n{rows}")).unwrap();
    let simulation = |degree: &str| {
        let path = folder.join("s.yaml");
        std::fs::write(&path, format!("robot: r\nduration: 1\nreference: {{csv: way.csv{degree}}}")).unwrap();
        Simulation::new(&arm(1), &ScenarioFile::load(&Disk, &path).unwrap()).unwrap()
    };
    let error = |simulation: &Simulation| {
        let points = (0..100).map(|i| 0.01 * i as f64 + 0.005);
        points.map(|t| (simulation.references().point(0, t).qdd + 36.0 * (6.0 * t).sin()).abs()).fold(0.0, f64::max)
    };
    let (plain, named, smooth) = (simulation(""), simulation(", degree: 3"), simulation(", degree: 7"));
    assert_eq!(plain.references().point(0, 0.33), named.references().point(0, 0.33));
    assert_eq!((plain.references().smoothness(0), smooth.references().smoothness(0)), (Some(3), Some(7)));
    assert!(error(&smooth) < 0.01 * error(&plain), "{} of {}", error(&smooth), error(&plain));
    std::fs::remove_dir_all(&folder).unwrap();
}
