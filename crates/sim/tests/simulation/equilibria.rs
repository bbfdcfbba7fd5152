//! Laws of static equilibrium and of natural modes.

use crate::arm::{LENGTH, REFLECTED, STIFFNESS, arm, linear, simulation, with_transmissions};
use gyroflex::dynamics::{External, Forward, State};
use gyroflex::model::{SpringSpec, TransmissionError, TransmissionSpec};
use gyroflex::spatial::{Force, Vec3};
use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::equilibrium::Equilibrium;
use gyroflex_sim::modes::modes;
use gyroflex_sim::scenario::Integrator;
use gyroflex_sim::{Dynamics, Robot};
use std::f64::consts::TAU;

const TABLE: [[f64; 2]; 4] = [[0.0, 0.0], [0.004, 3.0], [0.01, 12.0], [0.02, 40.0]];

fn robots() -> Vec<(&'static str, Robot)> {
    let none = TransmissionError::none();
    let error = TransmissionError { amplitude: 2e-4, cycles_per_rotor_turn: 2.0, phase: 0.3 };
    let cubic = SpringSpec::Polynomial { stiffness: 800.0, cubic: 4e6 };
    let mut table = arm(3);
    for (i, body) in table.bodies.iter_mut().enumerate() {
        let spring = SpringSpec::Table { first: i * TABLE.len(), len: TABLE.len() };
        body.drive.as_mut().unwrap().transmission = TransmissionSpec::Elastic { spring, damping: 1.0, error: none };
        table.spring_tables.extend(TABLE);
    }
    vec![
        ("linear", with_transmissions(arm(3), linear(1e4), 3.0, none)),
        ("cubic", with_transmissions(arm(3), cubic, 0.0, none)),
        ("table", table),
        ("transmission error", with_transmissions(arm(3), linear(5e3), 1.0, error)),
    ]
}

#[test]
fn equilibrium_has_no_acceleration() {
    let q = [0.4, -0.7, 1.1];
    for (name, robot) in robots() {
        let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
        let wrench = Force { ang: Vec3::new(1.0, -2.0, 0.5), lin: Vec3::new(5.0, 3.0, -8.0) };
        let wrenches = [Force::zero(), Force::zero(), wrench];
        let ext = External { tau: &[], wrenches: &wrenches };
        let (mut theta, mut tau, rest) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        Equilibrium::new(3).solve(&mut dynamics, &q, ext, &mut theta, &mut tau).unwrap();
        let (mut qdd, mut thetadd, mut tau_j) = ([1.0; 3], [1.0; 3], [0.0; 3]);
        let state = State { q: &q, qd: &rest, theta: &theta, thetad: &rest };
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        dynamics.forward(state, &tau, ext, out).unwrap();
        for a in qdd.iter().chain(&thetadd) {
            assert!(a.abs() < 1e-9, "{name}: {a}");
        }
        assert!(tau_j.iter().any(|t| t.abs() > 1.0), "{name}: the load is no load");
    }
}

#[test]
fn equilibrium_at_rest_stays_at_rest() {
    let yaml =
        "duration: 0.5\ninitial: {q: [0.4, -0.7, 1.1]}\ncontroller: {type: pd, kp: 500, kd: 20}\nlog: {rate: 100}";
    for (name, robot) in robots() {
        let (_, samples, _) = crate::arm::run(&robot, yaml);
        for sample in &samples {
            assert!(sample.tracking_error.iter().all(|e| e.abs() < 1e-9), "{name} at {}", sample.t);
        }
    }
}

/// A link alone about its y axis, and its motor: `ω² = K (1/M + 1/B)`.
fn one_link() -> (Robot, f64) {
    let mass = 3.0;
    let inertia = 0.03 * mass + mass * LENGTH * LENGTH / 4.0;
    (arm(1), (STIFFNESS * (1.0 / inertia + 1.0 / REFLECTED)).sqrt())
}

#[test]
fn mode_of_one_link_is_the_closed_form() {
    let (robot, omega) = one_link();
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
    let found = modes(&mut dynamics, &Coordinates::of(&robot), &[0.2], &[0.2]).unwrap();
    assert_eq!(found.modes.len(), 1);
    let mode = found.fastest().unwrap();
    assert!((mode.frequency * TAU / omega - 1.0).abs() < 1e-12);
    assert_eq!((mode.joint.as_str(), found.decay.as_ref()), ("joint1", None));
}

#[test]
fn decay_of_one_link_is_the_closed_form() {
    let (robot, omega) = one_link();
    let damping = 7.0;
    let robot = with_transmissions(robot, linear(STIFFNESS), damping, TransmissionError::none());
    let found = simulation(&robot, "duration: 1").modes().clone();
    // The damper sits beside the spring: λ/D = ω²/K.
    let rate = damping * omega * omega / STIFFNESS;
    assert!((found.decay.unwrap().rate / rate - 1.0).abs() < 1e-12);
}

#[test]
fn transmissions_add_one_mode_each() {
    let robot = arm(4);
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
    let (q, theta) = ([0.3, -0.5, 0.8, 0.1], [0.3, -0.5, 0.8, 0.1]);
    let found = modes(&mut dynamics, &Coordinates::of(&robot), &q, &theta).unwrap();
    assert_eq!(found.modes.len(), 4);
    assert!(found.modes.windows(2).all(|m| m[0].frequency <= m[1].frequency));
    let rigid = Dynamics::new(robot.model(gyroflex::model::Fidelity::Rigid).unwrap());
    assert!(modes(&mut rigid.clone(), &Coordinates::of(&robot), &q, &theta).unwrap().modes.is_empty());
}

/// Steps of the linear oscillator without gravity: bounded at the limit of stability, unbounded beyond.
#[test]
fn largest_step_is_the_limit_of_stability() {
    let (mut robot, _) = one_link();
    robot.gravity = Vec3::new(0.0, 0.0, 0.0);
    for integrator in [Integrator::Rk4 { step: 1.0 }, Integrator::SemiImplicitEuler { step: 1.0 }] {
        let largest = simulation(&robot, "duration: 1").modes().largest_step(&integrator).unwrap();
        let peak = |step: f64| {
            let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
            let mut state = gyroflex_sim::simulate::StateVec::zeros(1, 1);
            state.theta[0] = 1e-3;
            let mut peak: f64 = 0.0;
            for _ in 0..2000 {
                let view = state.view_mut();
                match integrator {
                    Integrator::Rk4 { .. } => dynamics.rk4(view, &[0.0], External::none(), step).unwrap(),
                    _ => dynamics.semi_implicit_euler(view, &[0.0], External::none(), step).unwrap(),
                }
                peak = peak.max((state.theta[0] - state.q[0]).abs());
            }
            peak
        };
        assert!(peak(0.99 * largest) < 0.1, "{}", integrator.name());
        assert!(peak(1.03 * largest) > 1.0, "{}", integrator.name());
    }
}
