//! Laws of the inverse dynamics of elastic robots.

use crate::oracles::{self, series_by_sweeps};
use gyroflex::dynamics::{InverseError, JointOrders, MAX_COEFFICIENTS, VANISHING};
use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::reference::{Case, number, numbers};
use gyroflex_testkit::tolerance::{assert_close, assert_close_above, norm};
use gyroflex_tests::{Core, LinkMotion, MotorMotion, random_motion, settling, smoothness};

const ELASTIC: [Fidelity; 2] = [Fidelity::Complete, Fidelity::Reduced];

/// Few enough bodies that undamped ones stay within the coefficients there is code for.
fn robots() -> Options {
    Options { bodies: 1..=8, ..Options::default() }
}

/// The state that the inverse says the robot is in.
fn state(motion: &LinkMotion, motors: &MotorMotion) -> State {
    State {
        q: motion.q.clone(),
        qd: motion.derivatives[0].clone(),
        qdd: motion.derivatives[1].clone(),
        theta: motors.theta[0].clone(),
        thetad: motors.theta[1].clone(),
        thetadd: motors.theta[2].clone(),
        tau: motors.tau[0].clone(),
        tau_ext: motion.tau_ext[0].clone(),
        wrenches: motion.wrenches[0].clone(),
    }
}

/// The torque that the inverse finds, applied to the state it finds, accelerates links and motors as asked: friction, tables, cubic
/// springs, transmission errors, loads, floating roots and rigid joints among elastic ones.
#[test]
fn forward_dynamics_of_the_inverse_returns_the_motion() {
    let (mut trials, mut sharp) = (0, 0);
    for seed in 0..400 {
        let robot = settling(RandomRobot::new(seed, &robots()));
        for fidelity in ELASTIC {
            let orders = smoothness(&robot.spec(), fidelity, 0, VANISHING);
            let core = Core::<f64>::new(&robot.spec(), fidelity).with_dirty_scratch();
            let motion = random_motion(&robot, &core.model(), &orders, 0);
            let motors = core.elastic_inverse(&orders, 0, &motion).expect("random springs can be inverted");
            let s = state(&motion, &motors);
            let got = core.forward(&s);
            let context = format!("seed {seed}, model {}", fidelity.name());
            // Forward dynamics takes small differences of positions and of torques: what it loses there is not the inverse's.
            let floor = oracles::rounding_of_forward(&core.model(), &s, &motors.tau_j[0]) / 1e-9;
            assert_close_above("qdd", &context, &got.qdd, &s.qdd, 1e-9, floor);
            let thetadd = oracles::at_motors(&core.model(), &got.thetadd, &s.thetadd);
            assert_close_above("thetadd", &context, &thetadd, &s.thetadd, 1e-9, floor);
            trials += 1;
            sharp += u32::from(floor < 1e3);
        }
    }
    assert!(sharp * 4 > trials * 3, "only {sharp} of {trials} trials are sharp");
}

/// Undamped arms of 2 to 7 joints against an inverse of another kind.
#[test]
fn undamped_inverse_equals_repeated_sweeps_of_rnea_on_whole_series() {
    let options =
        Options { floating: 0.0, damping: 0.0, bodies: 2..=7, driven: 1.0, elastic: 0.9, ..Options::default() };
    for seed in 0..60 {
        let robot = RandomRobot::new(seed, &options);
        for fidelity in ELASTIC {
            let orders = smoothness(&robot.spec(), fidelity, 0, VANISHING);
            let core = Core::<f64>::new(&robot.spec(), fidelity);
            let motion = random_motion(&robot, &core.model(), &orders, 0);
            let got = core.elastic_inverse(&orders, 0, &motion).expect("random springs can be inverted");
            let [theta, thetad, thetadd, tau_j, tau] = series_by_sweeps(&core.model(), &motion);
            let context = format!("seed {seed}, model {}", fidelity.name());
            let at_motors = |x: &[f64], want: &[f64]| oracles::at_motors(&core.model(), x, want);
            assert_close("theta", &context, &at_motors(&got.theta[0], &theta), &theta, 1e-8);
            assert_close("thetad", &context, &at_motors(&got.theta[1], &thetad), &thetad, 1e-8);
            assert_close("thetadd", &context, &at_motors(&got.theta[2], &thetadd), &thetadd, 1e-8);
            assert_close("tau_j", &context, &got.tau_j[0], &tau_j, 1e-8);
            assert_close("tau", &context, &got.tau[0], &tau, 1e-8);
        }
    }
}

/// Motor motions and torques that symbolic Lagrangian derivations in another program gave. The rotors of `r6_gyro` are tilted against
/// all axes, which takes as many derivatives as there can be; those of `r2` take what perturbing single derivatives in 60 digits
/// showed there.
#[test]
fn inverse_along_the_reference_trajectories() {
    for case in Case::of_kind("inverse_trajectory") {
        let known: [usize; 2] = if case.name.starts_with("r2") { [6, 4] } else { [14, 4] };
        for ((fidelity, label), known) in
            ELASTIC.into_iter().zip(["complete_consistent", "reduced_consistent"]).zip(known)
        {
            let orders = smoothness(&case.spec(), fidelity, 0, VANISHING);
            let context = format!("{}, {label}", case.name);
            let highest = orders.iter().map(|o| usize::from(o.position)).max();
            assert_eq!(highest, Some(known), "{context}");
            let core = Core::<f64>::new(&case.spec(), fidelity);
            for sample in case.samples() {
                let (q, derivatives) = case.trajectory(number(&sample["t"]), known);
                let motion = LinkMotion { q, derivatives, ..LinkMotion::default() };
                let got = core.elastic_inverse(&orders, 0, &motion).expect("the case can be inverted");
                let want = case.expected(sample, label);
                let motor = |key: &str| case.reflect(&numbers(&want[key]));
                assert_close("theta", &context, &got.theta[0], &motor("theta_m"), 1e-12);
                assert_close("thetad", &context, &got.theta[1], &motor("thetad_m"), 1e-10);
                assert_close("thetadd", &context, &got.theta[2], &motor("thetadd_m"), 1e-10);
                assert_close("tau_j", &context, &got.tau_j[0], &numbers(&want["tau_J"]), 1e-10);
                assert_close("tau", &context, &got.tau[0], &case.reflect_torque(&numbers(&want["u"])), 1e-10);
            }
        }
    }
}

/// Time derivatives of the torques, and of the motor positions, against differences of the torques along the motion.
#[test]
fn torque_derivatives_are_the_rates_of_the_torques() {
    let options = Options { floating: 0.0, damping: 0.0, bodies: 1..=4, table: 0.0, ..Options::default() };
    for seed in 0..60 {
        let robot = RandomRobot::new(seed, &options);
        for fidelity in ELASTIC {
            let orders = smoothness(&robot.spec(), fidelity, 2, VANISHING);
            let core = Core::<f64>::new(&robot.spec(), fidelity);
            let motion = random_motion(&robot, &core.model(), &orders, 0);
            let at =
                |t: f64| core.elastic_inverse(&orders, 2, &oracles::later(&motion, t)).expect("it can be inverted");
            let (now, h) = (at(0.0), 1e-5);
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| at(k * h));
            let context = format!("seed {seed}, model {}", fidelity.name());
            let rate = |of: fn(&MotorMotion) -> &Vec<Vec<f64>>, row: usize| -> Vec<f64> {
                let entry = |m: &MotorMotion, i: usize| of(m)[row][i];
                let n = of(&a)[row].len();
                (0..n)
                    .map(|i| (entry(&a, i) - 8.0 * entry(&b, i) + 8.0 * entry(&c, i) - entry(&d, i)) / (12.0 * h))
                    .collect()
            };
            for row in 0..2 {
                let floor = |x: &[f64]| 1e3 * norm(x);
                let tau = |m: &MotorMotion| m.tau[row].clone();
                assert_close_above("tau", &context, &now.tau[row + 1], &rate(|m| &m.tau, row), 1e-6, floor(&tau(&now)));
                let got = &now.tau_j[row + 1];
                assert_close_above("tau_j", &context, got, &rate(|m| &m.tau_j, row), 1e-6, floor(&now.tau_j[row]));
                let want = rate(|m| &m.theta, row + 2);
                assert_close_above("theta", &context, &now.theta[row + 3], &want, 1e-6, floor(&now.theta[row + 2]));
            }
        }
    }
}

/// Single precision against double, from the same numbers.
#[test]
fn single_precision_follows_double() {
    let options = Options { bodies: 1..=5, ..Options::default() };
    for seed in 0..100 {
        let robot = settling(RandomRobot::new(seed, &options));
        for fidelity in ELASTIC {
            let orders = smoothness(&robot.spec(), fidelity, 0, VANISHING);
            let double = Core::<f64>::new(&robot.spec(), fidelity);
            let single = Core::<f32>::new(&robot.spec(), fidelity);
            let motion = oracles::rounded(random_motion(&robot, &double.model(), &orders, 0));
            let want = double.elastic_inverse(&orders, 0, &motion).expect("it can be inverted");
            // Numbers that single precision cannot hold are refused, not returned.
            let Ok(got) = single.elastic_inverse(&orders, 0, &motion) else {
                assert!(norm(&want.theta[2]) > 1e15, "seed {seed}");
                continue;
            };
            let context = format!("seed {seed}, model {}", fidelity.name());
            assert_close("tau", &context, &got.tau[0], &want.tau[0], 2e-3);
            assert_close("tau_j", &context, &got.tau_j[0], &want.tau_j[0], 2e-3);
            assert_close("theta", &context, &got.theta[0], &want.theta[0], 1e-5);
        }
    }
}

/// The deflection of a damped transmission whose torque is a polynomial in time has a closed form; a step of any length meets it.
#[test]
fn one_step_of_the_deflection_is_exact_for_straight_springs() {
    // A joint about a vertical axis at rest in all but its acceleration: τ_J = I q̈, to third order.
    let inertia = 2.0;
    for (stiffness, damping) in [(1e4, 15.0), (1e4, 0.5), (50.0, 300.0), (1e6, 1.0)] {
        let bodies = [oracles::turntable(inertia, stiffness, 0.0, damping)];
        let spec = oracles::spec(&bodies);
        let orders = smoothness(&spec, Fidelity::Complete, 2, VANISHING);
        let core = Core::<f64>::new(&spec, Fidelity::Complete);
        for step in [1e-5, 1e-4, 1e-3, 1e-2, 0.3] {
            // τ = τ₀ + τ₁ t + τ₂ t² / 2 + τ₃ t³ / 6
            let torque = [3.0, -40.0, 500.0, 8e3];
            let derivatives = std::iter::once(0.0).chain(torque.map(|t| t / inertia)).map(|x| vec![x]).collect();
            let start = -2e-3;
            let motion =
                LinkMotion { q: vec![0.4], derivatives, deflection: vec![start], step, ..LinkMotion::default() };
            let got = core.elastic_inverse(&orders, 2, &motion).expect("it can be inverted").deflection[0];
            let want = oracles::damped_deflection(&torque, stiffness, damping, start, step);
            let context = format!("K {stiffness}, D {damping}, step {step}");
            assert_close("deflection", &context, &[got], &[want], 1e-9);
        }
    }
}

/// With a spring that stiffens, halving the step divides the error of the deflection after a given time by four.
#[test]
fn steps_of_the_deflection_are_of_second_order_for_stiffening_springs() {
    let (inertia, stiffness, cubic, damping) = (2.0, 1e3, 5e7, 10.0);
    let bodies = [oracles::turntable(inertia, stiffness, cubic, damping)];
    let spec = oracles::spec(&bodies);
    let orders = smoothness(&spec, Fidelity::Complete, 0, VANISHING);
    let core = Core::<f64>::new(&spec, Fidelity::Complete);
    let omega: f64 = 20.0;
    let amplitude = 6.0 / inertia;
    let after = |steps: usize| {
        let (step, mut deflection) = (0.2 / steps as f64, vec![0.0]);
        for i in 0..steps {
            let t = i as f64 * step;
            // q̈ = A sin ωt
            let row = |k: usize| {
                let quarter = (k as f64 - 2.0) * std::f64::consts::FRAC_PI_2;
                vec![amplitude * omega.powi(k as i32 - 2) * (omega * t + quarter).sin()]
            };
            let motion = LinkMotion {
                q: vec![0.0],
                derivatives: (1..=3).map(row).collect(),
                deflection,
                step,
                ..LinkMotion::default()
            };
            deflection = core.elastic_inverse(&orders, 0, &motion).expect("it can be inverted").deflection;
        }
        deflection[0]
    };
    let exact = after(100_000);
    let errors = [40, 80, 160].map(|steps| (after(steps) - exact).abs());
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.0..6.0).contains(&ratio), "errors {errors:?}");
    }
}

/// What cannot be computed is said, joint and reason.
#[test]
fn impossible_inverses_are_refused() {
    let bodies = [oracles::turntable(2.0, 1e3, 0.0, 0.0)];
    let spec = oracles::spec(&bodies);
    let orders = smoothness(&spec, Fidelity::Complete, 0, VANISHING);
    let core = Core::<f64>::new(&spec, Fidelity::Complete);
    let motion = |rows: usize, size: f64| LinkMotion {
        q: vec![0.0],
        derivatives: vec![vec![size]; rows],
        ..LinkMotion::default()
    };
    let run = |motion| core.elastic_inverse(&orders, 0, &motion).map(|m| m.tau[0][0]);
    assert!(run(motion(4, 1.0)).is_ok());
    assert_eq!(run(motion(3, 1.0)), Err(InverseError::NotSmooth { body: 0, needed: 4, given: 3 }));
    assert_eq!(run(motion(4, 1e308)), Err(InverseError::Overflow { body: 0 }));
    assert_eq!(run(motion(4, f64::NAN)), Err(InverseError::Overflow { body: 0 }));
    // A spring so curved that no search finds where it carries this torque.
    let bodies = [oracles::turntable(2.0, 1e-3, 1e12, 0.0)];
    let spec = oracles::spec(&bodies);
    let core = Core::<f64>::new(&spec, Fidelity::Complete);
    let stiff = core.elastic_inverse(&orders, 0, &motion(4, 1e6)).map(|m| m.tau[0][0]);
    assert_eq!(stiff, Err(InverseError::Transmission { body: 0 }));
    // More coefficients than there are.
    let many: Vec<_> = orders.iter().map(|o| JointOrders { motion: 40, ..*o }).collect();
    let refused = core.elastic_inverse(&many, 0, &motion(42, 0.0)).map(|m| m.tau[0][0]);
    assert_eq!(refused, Err(InverseError::TooManyDerivatives { needed: 41, compiled: MAX_COEFFICIENTS }));
}
