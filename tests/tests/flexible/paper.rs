//! Cetinkunt & Book 1988, equation by equation: against Lagrange's equations of their own kinematics, and beside ours.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::flexible::lagrange::equations;
use gyroflex_testkit::flexible::paper::{AsPoints, CetinkuntBook};
use gyroflex_testkit::random::RandomFlexible;
use gyroflex_testkit::tolerance::{assert_close_above, norm, relative_error};
use gyroflex_tests::FlexibleCore;
use nalgebra::DVector;

/// Equations (32) to (35), with the slips of the print put right, are Lagrange's of equations (1) to (9).
#[test]
fn the_papers_equations_are_those_of_its_kinematics() {
    for seed in 0..40 {
        let robot = RandomFlexible::beams(seed, 1 + seed as usize % 3, false);
        let (arm, s) = (CetinkuntBook::new(&robot), robot.state(0));
        let want = equations(&AsPoints(&arm), &s.q, &DVector::from_column_slice(&s.qd));
        let context = format!("seed {seed}");
        assert_close_above("M", &context, arm.inertia(&s.q).as_slice(), want.mass.as_slice(), 1e-12, 0.0);
        let got = arm.centrifugal(&s.q, &s.qd) + arm.gravity(&s.q) + arm.elastic(&s.q);
        assert_close_above("C + G + K q", &context, got.as_slice(), want.bias.as_slice(), 1e-11, 0.0);
    }
}

/// Straight and with links that do not move yet, an arm is the same by the paper as by us, elastic joints (eq. 46) included: what differs,
/// differs by a deflection.
#[test]
fn the_papers_straight_arm_is_ours() {
    for seed in 0..60 {
        let elastic = seed % 2 == 0;
        let robot = RandomFlexible::beams(seed, 1 + seed as usize % 4, elastic);
        let (arm, joints) = (CetinkuntBook::new(&robot), robot.robot.nv());
        let mut s = State { tau_ext: Vec::new(), wrenches: Vec::new(), ..robot.state(0) };
        for x in [&mut s.q, &mut s.qd, &mut s.tau] {
            x[joints..].fill(0.0);
        }
        let context = format!("seed {seed}");
        let core = FlexibleCore::<f64>::new(&robot, Fidelity::Reduced);
        assert_close_above("M", &context, &core.matrices(&s)[0], arm.inertia(&s.q).as_slice(), 1e-12, 0.0);
        let (ours, [links, motors]) = (core.forward(&s), arm.forward(&s));
        assert_close_above("accelerations", &context, &ours.qdd, &links, 1e-9, 0.0);
        if elastic {
            assert_close_above("of motors", &context, &ours.thetadd[..joints], &motors, 1e-11, 0.0);
        }
    }
}

/// How far ours is from the paper's in the same state, deflections and modal velocities, and accelerations if asked, scaled by `small`.
fn differences(robot: &RandomFlexible, small: f64) -> [f64; 3] {
    let (arm, joints) = (CetinkuntBook::new(robot), robot.robot.nv());
    let mut s = State { tau_ext: Vec::new(), wrenches: Vec::new(), ..robot.state(0) };
    s.tau[joints..].fill(0.0);
    for x in [&mut s.q, &mut s.qd, &mut s.qdd] {
        x[joints..].iter_mut().for_each(|x| *x *= small);
    }
    let core = FlexibleCore::<f64>::new(robot, Fidelity::RigidReflected);
    let (ours, [theirs, _]) = (core.forward(&s), arm.forward(&s));
    let (needed, asked) = (core.inverse(&s).tau, arm.inverse(&s));
    [
        relative_error(&ours.qdd, &theirs, 0.0),
        relative_error(&needed[..joints], &asked[..joints], norm(&asked)),
        relative_error(&needed[joints..], &asked[joints..], norm(&asked)),
    ]
}

/// The paper's ends of links turn by `1 + θ~`, ours by a rotation that differs from it by `½ θ~²`: places differ in second order, and so do
/// the torques of joints that are asked to move. What a mode moves, `∂r/∂η`, and with it inertia and weight on the modes, differs in
/// *first* order already: a model linear in the deflections is one order too short for its own modes (premature linearisation).
#[test]
fn the_paper_agrees_with_ours_to_the_order_of_its_kinematics() {
    let mut ratios = [const { Vec::new() }; 3];
    for seed in 0..40 {
        let robot = RandomFlexible::beams(seed, 2 + seed as usize % 3, false);
        let (far, near) = (differences(&robot, 2e-3), differences(&robot, 1e-3));
        for ((ratios, far), near) in ratios.iter_mut().zip(far).zip(near) {
            // Neither rounding nor far from the limit.
            assert!((1e-9..0.05).contains(&near), "seed {seed}: {near}");
            ratios.push(far / near);
        }
    }
    let expected = [("accelerations", 2.0), ("torques of joints", 4.0), ("forces on modes", 2.0)];
    for ((what, order), ratios) in expected.into_iter().zip(&ratios) {
        let (low, high) = ratios.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), r| (l.min(*r), h.max(*r)));
        let band = 0.9 * order..1.1 * order;
        assert!(
            band.contains(&low) && band.contains(&high),
            "{what}: differences fall {low} to {high} times, not {order} times"
        );
    }
}
