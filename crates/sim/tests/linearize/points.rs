//! Laws of operating points.

use crate::{arms, assert_close, pose, single_link};
use gyroflex::dynamics::{External, Forward};
use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::linearize::{KeptFriction, OperatingPoint, Output, ReferenceMotion};
use gyroflex_sim::load::{Disk, LoadOptions, load};
use gyroflex_sim::reference::References;
use gyroflex_sim::scenario::{Factors, Plant};
use gyroflex_sim::{Dynamics, ErrorKind, Fidelity, Robot, ScenarioFile};
use std::path::Path;

fn accelerations(dynamics: &mut Dynamics, point: &OperatingPoint) -> [Vec<f64>; 2] {
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; dynamics.nv()]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    dynamics.forward(point.state.view(), &point.tau, External::none(), out).expect("slices fit");
    [qdd, thetadd]
}

#[test]
fn the_pose_found_for_given_torques_is_held_by_them() {
    for (name, mut linearizer, mut dynamics) in arms() {
        if linearizer.layout().floating() {
            continue;
        }
        let q = pose(&linearizer);
        let there = linearizer.equilibrium_at(&q).expect("it fits");
        let start: Vec<f64> = q.iter().zip([0.02, -0.03, 0.02]).map(|(q, d)| q + d).collect();
        let found = linearizer.equilibrium_for(&there.tau, &start).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_close(&name, &found.tau, &there.tau, 1e-9);
        for a in accelerations(&mut dynamics, &found).iter().flatten() {
            assert!(a.abs() < 1e-6, "{name}: {a}");
        }
    }
}

#[test]
fn torques_hold_a_pendulum_at_the_angle_whose_sine_they_ask_for() {
    let mut link = single_link::linearizer(Fidelity::Complete, KeptFriction::All, true);
    let tau = 0.5 * single_link::WEIGHT;
    let point = link.equilibrium_for(&[tau], &[0.1]).expect("it can be held");
    let q = (0.5_f64).asin();
    assert_close("link", &point.state.q, &[q], 1e-9);
    assert_close("motor", &point.state.theta, &[q + tau / single_link::STIFFNESS], 1e-9);
}

#[test]
fn torques_that_nothing_can_hold_are_refused_with_the_joint() {
    let mut link = single_link::linearizer(Fidelity::Complete, KeptFriction::All, true);
    let error = link.equilibrium_for(&[2.0 * single_link::WEIGHT], &[0.1]).expect_err("twice its weight");
    assert_eq!((error.kind, error.element.as_str()), (ErrorKind::Diverged, "tau"));
    assert!(error.problem.contains("joint1") && !error.remedy.is_empty(), "{error}");
    for (name, mut linearizer, dynamics) in arms() {
        if linearizer.layout().floating() {
            let (q, tau) = (pose(&linearizer), vec![0.0; dynamics.nv()]);
            let error = linearizer.equilibrium_for(&tau, &q).expect_err(&name);
            assert!(error.problem.contains("floating"), "{error}");
        }
    }
}

#[test]
fn vectors_that_do_not_fit_are_refused_with_their_names() {
    for (name, mut linearizer, dynamics) in arms() {
        let q = pose(&linearizer);
        let mut bad = q.clone();
        bad[0] = f64::NAN;
        for (element, error) in [
            ("q", linearizer.equilibrium_at(&q[1..]).expect_err(&name)),
            ("q", linearizer.equilibrium_at(&bad).expect_err(&name)),
            ("tau", linearizer.equilibrium_for(&[1.0], &q).expect_err(&name)),
            ("qd", {
                let mut state = linearizer.equilibrium_at(&q).expect("it fits").state;
                state.qd.push(0.0);
                linearizer.point(state, vec![0.0; dynamics.nv()]).expect_err(&name)
            }),
        ] {
            assert_eq!((error.kind, error.element.as_str()), (ErrorKind::Shape, element), "{name}: {error}");
        }
        let point = linearizer.equilibrium_at(&q).expect("it fits");
        assert!(linearizer.linearize(&point, &[]).is_err(), "{name}: nothing is asked for");
    }
}

/// The PUMA 560, and the scenario in which it tracks a reference.
fn tracking() -> (Robot, ScenarioFile) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/puma560/track.yaml");
    let file = ScenarioFile::load(&Disk, &path).expect("it is a scenario");
    let robot = load(&file.robot_path(), &LoadOptions::default()).expect("it is a robot");
    (robot, file)
}

#[test]
fn on_a_reference_a_robot_accelerates_as_the_reference_does() {
    let (robot, file) = tracking();
    let joints = Coordinates::of(&robot);
    let q0 = joints.spread(&file.scenario.initial.q, &file.keys, "initial.q").expect("it fits");
    let reference = References::of(&file, &robot, &joints, &q0, &mut Vec::new()).expect("it fits");
    // With elastic joints but for the dampers, which the motors' positions leave out.
    for (model, tolerance) in [(Fidelity::Rigid, 1e-9), (Fidelity::RigidReflected, 1e-9), (Fidelity::Complete, 0.05)] {
        let mut motion = ReferenceMotion::new(&robot, &file, Some(model), KeptFriction::All).expect("it fits");
        let mut dynamics = Dynamics::new(robot.model(model).expect("it is physical"));
        for t in [0.4, 0.9, 1.5] {
            let point = motion.at(t).expect("it is within");
            let [qdd, _] = accelerations(&mut dynamics, &point);
            let now: Vec<_> = (0..joints.len()).map(|i| reference.point(i, t)).collect();
            assert_close("q", &point.state.q, now.iter().map(|p| &p.q), 1e-15);
            assert_close("qd", &point.state.qd, now.iter().map(|p| &p.qd), 1e-15);
            assert_close(&format!("{model:?} at {t} s"), &qdd, now.iter().map(|p| &p.qdd), tolerance);
        }
    }
}

#[test]
fn a_time_outside_of_the_scenario_is_refused() {
    let (robot, file) = tracking();
    let mut motion = ReferenceMotion::new(&robot, &file, None, KeptFriction::All).expect("it fits");
    for t in [-0.1, 1e9, f64::NAN] {
        let error = motion.at(t).expect_err("it is outside");
        assert!(error.remedy.contains("from 0 to"), "{error}");
    }
}

/// A linear model along a reference is of the robot that the controller knows.
#[test]
fn the_plant_of_a_scenario_does_not_act_on_the_linear_model_and_the_user_learns_of_it() {
    let (robot, file) = tracking();
    let mut with = file.clone();
    with.scenario.plant = Some(Plant { stiffness: Some(Factors::All(0.5)), ..Plant::default() });
    let at = |file: &ScenarioFile| {
        let mut motion = ReferenceMotion::new(&robot, file, None, KeptFriction::All).expect("it fits");
        let point = motion.at(0.4).expect("it is within");
        let linear = motion.linearizer().linearize(&point, &Output::defaults()).expect("it fits");
        (linear, motion.warnings.iter().any(|w| w.element == "plant"))
    };
    let ((plain, silent), (linear, told)) = (at(&file), at(&with));
    assert_eq!(plain, linear);
    assert_eq!((silent, told), (false, true));
}
