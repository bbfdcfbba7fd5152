//! Laws of controllers.

use crate::arm::{LENGTH, STIFFNESS, arm, run, scenario, with_drives};
use gyroflex::dynamics::{External, Forward, State};
use gyroflex::model::{Fidelity, Friction};
use gyroflex_sim::controller::{Control, Tick};
use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::reference::{Point, References, Trajectory};
use gyroflex_sim::{Dynamics, Robot, Simulation};

fn torque(robot: &Robot, yaml: &str, reference: &[Point], state: State<f64>) -> Vec<f64> {
    let file = scenario(&format!("duration: 1\n{yaml}"));
    let joints = Coordinates::of(robot);
    let references = References::new(reference.iter().map(|point| Trajectory::Hold(point.q)).collect());
    let mut control = Control::new(&file.scenario.controller, robot, &joints, &references, 1.0, &file.keys).unwrap();
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
    let mut tau = vec![0.0; dynamics.nv()];
    let at = Tick { t: 0.0, references: &references, points: reference };
    control.tick(&mut dynamics, at, state, &mut tau).unwrap();
    tau
}

#[test]
fn pd_is_its_law_on_the_motor_side() {
    let (q, qd, theta, thetad) = ([9.0], [9.0], [0.3], [-0.2]);
    let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
    let reference = [Point { q: 0.5, qd: 0.7, qdd: 0.0 }];
    let yaml = "controller: {type: pd, kp: 50, kd: {joint1: 4}}";
    // Gravity at the reference turns the link about y: x forward and level at 0, positive angles point it down.
    let g = -3.0 * 9.81 * LENGTH / 2.0 * 0.5f64.cos();
    let want = g + 50.0 * (0.5 + g / STIFFNESS - 0.3) + 4.0 * (0.7 + 0.2);
    let got = torque(&arm(1), yaml, &reference, state)[0];
    assert!((got - want).abs() < 1e-12, "{got} is not {want}");

    let plain = "controller: {type: pd, kp: 50, kd: 4, gravity_compensation: false}";
    let want = 50.0 * (0.5 - 0.3) + 4.0 * (0.7 + 0.2);
    let got = torque(&arm(1), plain, &reference, state)[0];
    assert!((got - want).abs() < 1e-12, "{got} is not {want}");
}

#[test]
fn no_controller_gives_no_torque() {
    let zero = [0.4];
    let state = State { q: &zero, qd: &zero, theta: &zero, thetad: &zero };
    assert_eq!(torque(&arm(1), "controller: {type: none}", &[Point::default()], state), [0.0]);
}

/// On the very robot it inverts, computed torque leaves `q̈ = q̈_r + k_d ė + k_p e`.
#[test]
fn computed_torque_makes_a_rigid_robot_linear() {
    let mut robot = with_drives(arm(3), |d| d.friction = Friction::viscous(1e-4));
    robot.fidelity = Fidelity::Rigid;
    let (q, qd) = ([0.3, -0.8, 0.6], [1.0, -2.0, 0.5]);
    let state = State { q: &q, qd: &qd, theta: &q, thetad: &qd };
    let reference: Vec<Point> = (0..3).map(|i| Point { q: 0.1 * i as f64, qd: 0.2, qdd: 1.0 - i as f64 }).collect();
    let tau = torque(&robot, "controller: {type: computed_torque, kp: 100, kd: 20}", &reference, state);
    let mut dynamics = Dynamics::new(robot.model(Fidelity::Rigid).unwrap());
    let (mut qdd, mut thetadd, mut tau_j) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    dynamics.forward(state, &tau, External::none(), out).unwrap();
    for i in 0..3 {
        let want = reference[i].qdd + 100.0 * (reference[i].q - q[i]) + 20.0 * (reference[i].qd - qd[i]);
        assert!((qdd[i] - want).abs() < 1e-9, "{} is not {want}", qdd[i]);
    }
}

#[test]
fn computed_torque_tracks_with_elastic_joints() {
    let robot = with_drives(arm(3), |d| d.friction = Friction::viscous(1e-4));
    let robot = crate::arm::with_transmissions(
        robot,
        crate::arm::linear(2e4),
        20.0,
        gyroflex::model::TransmissionError::none(),
    );
    let yaml =
        "duration: 2\nreference: {default: {type: sine, amplitude: 0.3, frequency: 0.5, phase: 1.5707963267948966}}
controller: {type: computed_torque, rate: 1000, kp: 400, kd: 40}\nlog: {rate: 100}";
    let (summary, ..) = run(&robot, yaml);
    for joint in &summary.joints {
        assert!(joint.peak_tracking_error < 0.02, "{joint:?}");
    }
}

#[test]
fn torque_never_exceeds_what_the_drive_can_give() {
    let mut robot = arm(2);
    robot.joints[0].max_torque = Some(3.0);
    let yaml = "duration: 0.2\ninitial: {q: [0.5, 0.5]}\nreference: {default: {type: hold, at: 0.0}}
controller: {type: pd, kp: 500, kd: 20}\nlog: {rate: 1000}";
    let (summary, samples, _) = run(&robot, yaml);
    assert!(samples.iter().all(|s| s.tau[0].abs() <= 3.0));
    assert!(samples.iter().any(|s| s.tau[0].abs() == 3.0));
    assert_eq!(summary.joints[0].peak_torque, 3.0);
    assert!(summary.joints[0].saturation > 0.5 && summary.joints[0].saturation <= 1.0, "{summary:?}");
    assert!(summary.joints[1].peak_torque > 3.0 && summary.joints[1].saturation == 0.0);
}

#[test]
fn torque_is_held_between_ticks() {
    let yaml = "duration: 0.1\ninitial: {q: [0.5, 0.5]}\nreference: {default: {type: hold, at: 0.0}}
controller: {type: pd, rate: 50, kp: 100, kd: 5}\nlog: {rate: 1000}";
    let (_, samples, _) = run(&arm(2), yaml);
    for (k, pair) in samples.windows(2).enumerate() {
        let tick = (k + 1) % 20 == 0;
        assert_eq!(pair[0].tau != pair[1].tau, tick, "sample {}", k + 1);
    }
}

#[test]
fn every_joint_needs_a_gain() {
    let named = "controller: {type: pd, kp: {joint1: 5}, kd: 1}";
    let error = Simulation::new(&arm(2), &scenario(&format!("duration: 1\n{named}"))).unwrap_err();
    assert!(error.problem.contains("joint2"), "{error}");
    assert_eq!(error.file, "test.yaml:3");
    let unknown = "controller: {type: pd, kp: {default: 5, jiont1: 4}, kd: 1}";
    let error = Simulation::new(&arm(2), &scenario(&format!("duration: 1\n{unknown}"))).unwrap_err();
    assert!(error.remedy.contains("`joint1`"), "{error}");
}

#[test]
fn computed_torque_refuses_a_floating_root() {
    let yaml = "duration: 1\ncontroller: {type: computed_torque, kp: 1, kd: 1}";
    let error = Simulation::new(&crate::arm::flying_arm(2), &scenario(yaml)).unwrap_err();
    assert!(error.problem.contains("floating"), "{error}");
}
