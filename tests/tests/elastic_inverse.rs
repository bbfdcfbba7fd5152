//! Laws of the inverse dynamics of elastic robots.

mod elastic;

use elastic::{random_motion, series_by_sweeps};
use gyroflex::dynamics::VANISHING;
use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::reference::{Case, number, numbers};
use gyroflex_testkit::tolerance::{assert_close, assert_close_above};
use gyroflex_tests::{Core, LinkMotion, MotorMotion, smoothness};

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
        let robot = elastic::settling(RandomRobot::new(seed, &robots()));
        for fidelity in ELASTIC {
            let orders = smoothness(&robot.spec(), fidelity, 0, VANISHING);
            let core = Core::<f64>::new(&robot.spec(), fidelity).with_dirty_scratch();
            let motion = random_motion(&robot, &core.model(), &orders, 0);
            let motors = core.elastic_inverse(&orders, 0, &motion).expect("random springs can be inverted");
            let s = state(&motion, &motors);
            let got = core.forward(&s);
            let context = format!("seed {seed}, model {}", fidelity.name());
            // Forward dynamics takes small differences of positions and of torques: what it loses there is not the inverse's.
            let floor = elastic::rounding_of_forward(&core.model(), &s, &motors.tau_j[0]) / 1e-9;
            assert_close_above("qdd", &context, &got.qdd, &s.qdd, 1e-9, floor);
            let thetadd = elastic::at_motors(&core.model(), &got.thetadd, &s.thetadd);
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
            let at_motors = |x: &[f64], want: &[f64]| elastic::at_motors(&core.model(), x, want);
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
