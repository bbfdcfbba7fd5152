//! Laws of regulators that hold robots.

use crate::{apart, arm, numbers, radius};
use gyroflex::dynamics::External;
use gyroflex_sim::linearize::{KeptFriction, Linearizer};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::lqr::{Deviations, Regulator};
use gyroflex_sim::simulate::StateVec;
use gyroflex_sim::{Dynamics, Fidelity};
use nalgebra::DVector;
use std::path::Path;

const ROBOTS: [&str; 6] = [
    "iiwa14/robot.yaml",
    "lwr/robot.yaml",
    "lwr/loaded.yaml",
    "lwr/undamped.yaml",
    "manutec_r3/robot.yaml",
    "puma560/robot.yaml",
];

#[test]
fn the_projects_robots_are_held_in_every_model_and_the_equation_is_solved() {
    for name in ROBOTS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name);
        let mut robot = load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        for model in Fidelity::ALL {
            robot.fidelity = model;
            for seed in 0..4 {
                let q = numbers(seed, robot.joints.len());
                let context = format!("{name}, {}, pose {seed}", model.name());
                let deviations = Deviations::default();
                let regulator =
                    Regulator::new(&robot, &q, 1000.0, &deviations).unwrap_or_else(|e| panic!("{context}: {e}"));
                assert!(regulator.residual < 1e-9, "{context}: {}", regulator.residual);
                let Regulator { a, b, cost: x, gain, .. } = &regulator;
                let closed = radius(&(a - b * gain));
                assert!(closed < 1.0 && (closed - regulator.radius).abs() < 1e-6, "{context}: {closed}");
                // Bellman: the cost from here is that of this sample and from the next state.
                let layout = Linearizer::new(&robot, model, KeptFriction::Viscous).expect("physical").layout().clone();
                let start = DVector::from_fn(a.nrows(), |i, _| {
                    let size = if i < layout.positions() { 1e-3 } else { 0.1 };
                    size * numbers(seed + 50, a.nrows())[i]
                });
                let u = -(gain * &start);
                let next = a * &start + b * &u;
                let weigh = |x: &DVector<f64>, i: usize| if i < layout.positions() { x[i] / 1e-3 } else { x[i] / 0.1 };
                let now: f64 =
                    (0..start.len()).map(|i| weigh(&start, i).powi(2)).sum::<f64>() + (u / 10.0).norm_squared();
                let (here, there) = (start.dot(&(x * &start)), next.dot(&(x * &next)));
                assert!((here - there - now).abs() < 1e-8 * here, "{context}: {here} {there} {now}");
            }
        }
    }
}

/// The arm itself, not its linear model, falls back to the pose, at the cost that the Riccati equation says.
#[test]
fn the_lightweight_arm_is_brought_back_at_the_cost_foretold() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/lwr/loaded.yaml");
    let robot = load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let deviations = Deviations::default();
    let regulator = Regulator::new(&robot, &[0.3, 0.8, -0.4, 0.9, 0.2, -0.7, 0.5], 1000.0, &deviations).expect("held");
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity).expect("physical"));
    let mut state = regulator.point.state.clone();
    for (i, x) in numbers(7, 7).iter().enumerate() {
        state.q[i] += 1e-4 * x;
        state.theta[i] += 1e-4 * x;
        state.thetad[i] += 1e-2 * x;
    }
    let from = |state: &StateVec| {
        let parts =
            |s: &StateVec| [&s.q, &s.theta, &s.qd, &s.thetad].into_iter().flatten().copied().collect::<Vec<_>>();
        DVector::from_vec(parts(state)) - DVector::from_vec(parts(&regulator.point.state))
    };
    let start = from(&state);
    let foretold = start.dot(&(&regulator.cost * &start));
    let mut paid = 0.0;
    for _ in 0..3000 {
        let x = from(&state);
        let u = -(&regulator.gain * &x);
        let tau: Vec<f64> = regulator.point.tau.iter().zip(u.iter()).map(|(hold, u)| hold + u).collect();
        paid +=
            (x.rows(0, 14) / 1e-3).norm_squared() + (x.rows(14, 14) / 0.1).norm_squared() + (&u / 10.0).norm_squared();
        // The last link and its damper ask for a step below 1.5e-4 s.
        for _ in 0..20 {
            dynamics.rk4(state.view_mut(), &tau, External::none(), regulator.step / 20.0).expect("slices fit");
        }
    }
    assert!(from(&state).amax() < 1e-3 * start.amax(), "it is back: {}", from(&state).amax());
    assert!((paid / foretold - 1.0).abs() < 1e-3, "{paid} was to be {foretold}");
}

#[test]
fn every_deviation_counts_and_those_that_make_no_sense_are_refused() {
    let robot = arm::arm(false);
    let q = [0.7, -0.5, 0.2];
    let gain = |deviations: &Deviations| Regulator::new(&robot, &q, 1000.0, deviations).map(|r| r.gain);
    let plain = gain(&Deviations::default()).expect("it can be held");
    let keys: [fn(&mut Deviations) -> &mut f64; 5] = [
        |d| &mut d.link_position,
        |d| &mut d.link_velocity,
        |d| &mut d.motor_position,
        |d| &mut d.motor_velocity,
        |d| &mut d.torque,
    ];
    for key in keys {
        let with = |x: f64| {
            let mut deviations = Deviations::default();
            *key(&mut deviations) = x;
            gain(&deviations)
        };
        let default = *key(&mut Deviations::default());
        assert!(apart(&with(3.0 * default).expect("it can be held"), &plain) > 1e-3);
        for bad in [0.0, -1.0, f64::NAN] {
            with(bad).expect_err("it makes no sense");
        }
    }
    let free = Deviations { link_velocity: f64::INFINITY, motor_velocity: f64::INFINITY, ..Deviations::default() };
    gain(&free).expect("positions are enough");
    for rate in [0.0, -1.0, f64::INFINITY] {
        Regulator::new(&robot, &q, rate, &Deviations::default()).expect_err("it makes no sense");
    }
    let at = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.7, -0.5, 0.2];
    let floating = Regulator::new(&arm::arm(true), &at, 1000.0, &Deviations::default());
    assert!(floating.expect_err("no motor holds the root").problem.contains("root floats"));
}
