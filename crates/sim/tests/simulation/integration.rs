//! Laws of integration in time.

use crate::arm::{arm, distance, flying_arm, linear, run, with_transmissions};
use gyroflex::model::{Fidelity, TransmissionError};
use gyroflex_sim::Robot;
use gyroflex_sim::simulate::StateVec;

const SWING: &str = "duration: 0.5\ninitial: {q: {joint2: 0.4}, qd: {joint2: 1.0, joint3: -2.0}}\nlog: {rate: 10}\n";

fn end(robot: &Robot, integrator: &str) -> StateVec {
    let (_, _, simulation) = run(robot, &format!("{SWING}integrator: {integrator}"));
    simulation.state().clone()
}

fn apart(a: &StateVec, b: &StateVec) -> f64 {
    let parts = [(&a.q, &b.q), (&a.qd, &b.qd), (&a.theta, &b.theta), (&a.thetad, &b.thetad)];
    parts.into_iter().map(|(x, y)| distance(x, y)).fold(0.0, f64::max)
}

#[test]
fn rk4_converges_at_fourth_order() {
    let robot = arm(3);
    let exact = end(&robot, "{method: rk4, step: 5e-5}");
    let [coarse, fine] = [1e-3, 5e-4].map(|h| apart(&end(&robot, &format!("{{method: rk4, step: {h}}}")), &exact));
    let order = (coarse / fine).log2();
    assert!((order - 4.0).abs() < 0.3, "order {order}");
}

#[test]
fn semi_implicit_euler_converges_at_first_order() {
    let robot = arm(3);
    let exact = end(&robot, "{method: rk4, step: 1e-4}");
    let euler = |h: f64| apart(&end(&robot, &format!("{{method: semi_implicit_euler, step: {h}}}")), &exact);
    let order = (euler(1e-4) / euler(5e-5)).log2();
    assert!((order - 1.0).abs() < 0.1, "order {order}");
}

#[test]
fn lossless_motion_keeps_its_energy() {
    for robot in [arm(3), flying_arm(3)] {
        for fidelity in Fidelity::ALL {
            let robot = Robot { fidelity, ..robot.clone() };
            let (summary, ..) = run(&robot, &format!("{SWING}integrator: {{method: rk4, step: 2e-4}}"));
            let drift = summary.energy_drift.unwrap();
            assert!(drift < 1e-7, "{}: {drift}", fidelity.name());
        }
    }
}

#[test]
fn damped_motion_reports_no_energy_drift() {
    let robot = with_transmissions(arm(3), linear(1e3), 1.0, TransmissionError::none());
    let (summary, ..) = run(&robot, SWING);
    assert_eq!(summary.energy_drift, None);
}

#[test]
fn adaptive_methods_agree_with_rk4() {
    for robot in [arm(3), flying_arm(3)] {
        let reference = end(&robot, "{method: rk4, step: 1e-4}");
        for method in ["dopri5", "dop853", "kvaerno5"] {
            let state = end(&robot, &format!("{{method: {method}, rtol: 1e-9, atol: 1e-11}}"));
            let error = apart(&state, &reference);
            assert!(error < 1e-6, "{method}: {error}");
        }
    }
}

#[test]
fn tighter_tolerances_come_closer() {
    let robot = arm(3);
    let reference = end(&robot, "{method: rk4, step: 6.25e-5}");
    for method in ["dopri5", "dop853", "kvaerno5"] {
        let error = |tol: f64| {
            let state = end(&robot, &format!("{{method: {method}, rtol: {tol:e}, atol: {tol:e}}}"));
            apart(&state, &reference)
        };
        assert!(error(1e-9) < 0.1 * error(1e-5), "{method}");
    }
}

/// As K grows the elastic robot moves as the rigid one does; its transmissions are then far too fast for explicit schemes.
#[test]
fn stiff_method_reaches_the_rigid_limit() {
    let stiff = with_transmissions(arm(3), linear(1e7), 1e4, TransmissionError::none());
    let elastic = end(&stiff, "{method: kvaerno5, rtol: 1e-7, atol: 1e-9}");
    let rigid = end(&Robot { fidelity: Fidelity::Rigid, ..stiff }, "{method: rk4, step: 1e-4}");
    assert!(distance(&elastic.q, &rigid.q) < 1e-4, "{elastic:?} {rigid:?}");
    assert!(distance(&elastic.qd, &rigid.qd) < 1e-3, "{elastic:?} {rigid:?}");
}

#[test]
fn same_scenario_gives_the_same_bits() {
    for method in ["{method: rk4, step: 1e-3}", "{method: dopri5}", "{method: kvaerno5, rtol: 1e-6, atol: 1e-8}"] {
        assert_eq!(end(&arm(3), method), end(&arm(3), method));
    }
    let yaml = "duration: 0.1\ninitial: {q: [0.5, 0.5]}\ncontroller: {type: pd, kp: 10, kd: 1}\nlog: {rate: 100}";
    let (_, first, mut simulation) = run(&arm(2), yaml);
    let mut memory = gyroflex_sim::record::MemoryRecorder::new(simulation.run_info());
    simulation.run(&mut memory, &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
    for (a, b) in first.iter().zip(memory.samples()) {
        assert_eq!((&a.q, &a.theta, &a.tau), (&b.q, &b.theta, &b.tau), "a second run starts afresh");
    }
}
