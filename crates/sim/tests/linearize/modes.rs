//! Laws of modes.

use crate::single_link::{FRICTION, LINK, ROTOR, STIFFNESS, WEIGHT, linearizer};
use crate::{arm, arms, assert_close, numbers, pose};
use gyroflex::model::Friction;
use gyroflex::spatial::Vec3;
use gyroflex_sim::coordinates::Coordinates;
use gyroflex_sim::linearize::{KeptFriction, Linearizer, ModeKind, NaturalMode, Output, natural_modes};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::{Dynamics, Fidelity, Robot};
use nalgebra::{Complex, DVector};
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn modes(linearizer: &mut Linearizer, q: &[f64]) -> Vec<NaturalMode> {
    let point = linearizer.equilibrium_at(q).expect("it fits");
    natural_modes(&linearizer.linearize(&point, &Output::defaults()).expect("it fits")).expect("they are found")
}

fn of_kind(modes: &[NaturalMode], kind: ModeKind) -> Vec<&NaturalMode> {
    modes.iter().filter(|m| m.kind == kind).collect()
}

/// The arm without gravity, friction and damping.
fn undamped(floating: bool) -> Robot {
    let mut robot = arm::arm(floating);
    robot.gravity = Vec3::zero();
    for body in &mut robot.bodies {
        body.friction = Friction::none();
        if let Some(drive) = &mut body.drive {
            drive.friction = Friction::none();
            if let gyroflex::model::TransmissionSpec::Elastic { damping, .. } = &mut drive.transmission {
                *damping = 0.0;
            }
        }
    }
    robot
}

#[test]
fn a_free_link_and_its_rotor_swing_against_each_other_like_two_masses() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::None, false);
    let modes = modes(&mut link, &[0.3]);
    assert_eq!(modes.len(), 2);
    let (rigid, swing) = (&modes[0], &modes[1]);
    assert_eq!((rigid.kind, rigid.damping_ratio), (ModeKind::Rigid, None));
    assert_close("rigid shape", rigid.shape.as_flattened(), &[1.0, 0.0, 1.0, 0.0], 1e-12);
    let frequency = (STIFFNESS * (1.0 / LINK + 1.0 / ROTOR)).sqrt() / TAU;
    assert_close("frequency", &[swing.frequency], &[frequency], 1e-12);
    // The centre of mass rests: the lighter rotor moves more.
    assert_eq!((swing.kind, swing.moves_most.as_str()), (ModeKind::Oscillation, "theta.joint1"));
    assert_close("shape", swing.shape.as_flattened(), &[-ROTOR / LINK, 0.0, 1.0, 0.0], 1e-12);
}

#[test]
fn under_gravity_frequencies_solve_the_quadratic_of_the_hanging_link() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::None, true);
    let (p, q) = ((STIFFNESS + WEIGHT) / LINK + STIFFNESS / ROTOR, STIFFNESS * WEIGHT / (LINK * ROTOR));
    let root = (p * p - 4.0 * q).sqrt();
    let want = [(0.5 * (p - root)).sqrt() / TAU, (0.5 * (p + root)).sqrt() / TAU];
    let got: Vec<f64> = modes(&mut link, &[0.0]).iter().map(|m| m.frequency).collect();
    assert_close("frequencies", &got, &want, 1e-12);
}

#[test]
fn a_damped_pendulum_has_the_damping_ratio_of_the_textbook() {
    let mut link = linearizer(Fidelity::Rigid, KeptFriction::All, true);
    let modes = modes(&mut link, &[0.0]);
    assert_eq!(modes.len(), 1);
    assert_close("frequency", &[modes[0].frequency], &[(WEIGHT / (LINK + ROTOR)).sqrt() / TAU], 1e-12);
    let ratio = FRICTION / (2.0 * (WEIGHT * (LINK + ROTOR)).sqrt());
    assert_close("damping ratio", &[modes[0].damping_ratio.expect("it swings")], &[ratio], 1e-12);
}

#[test]
fn a_pendulum_on_its_head_falls_at_the_rate_of_the_quadratic() {
    let mut link = linearizer(Fidelity::Rigid, KeptFriction::All, true);
    let modes = modes(&mut link, &[PI]);
    let inertia = LINK + ROTOR;
    let root = (FRICTION * FRICTION + 4.0 * inertia * WEIGHT).sqrt();
    let (fall, rise) = (of_kind(&modes, ModeKind::Growth), of_kind(&modes, ModeKind::Decay));
    assert_eq!((fall.len(), rise.len(), modes.len()), (1, 1, 2));
    assert_close("falling", &fall[0].eigenvalue, &[(root - FRICTION) / (2.0 * inertia), 0.0], 1e-12);
    assert_close("rising", &rise[0].eigenvalue, &[-(root + FRICTION) / (2.0 * inertia), 0.0], 1e-12);
}

#[test]
fn every_shape_is_an_eigenvector_of_the_accelerations() {
    for (name, mut linearizer, _) in arms() {
        let q = pose(&linearizer);
        let point = linearizer.equilibrium_at(&q).expect("it fits");
        let linear = linearizer.linearize(&point, &Output::defaults()).expect("it fits");
        let half = linear.a.nrows() / 2;
        let a = linear.a.map(|x| Complex::new(x, 0.0));
        for mode in natural_modes(&linear).expect("they are found") {
            let lambda = Complex::new(mode.eigenvalue[0], mode.eigenvalue[1]);
            let x = DVector::from_iterator(half, mode.shape.iter().map(|[re, im]| Complex::new(*re, *im)));
            let state = DVector::from_iterator(2 * half, x.iter().copied().chain(x.iter().map(|x| lambda * x)));
            let residual = (&a * &state - state * lambda).norm() / linear.a.norm();
            assert!(residual < 1e-10, "{name}, {} Hz: {residual}", mode.frequency);
            let largest = x.iter().map(|x| x.norm()).fold(0.0, f64::max);
            assert_close(&name, &[largest], &[1.0], 1e-12);
        }
    }
}

/// Asserts that all eigenvalues are found: their sum is the trace.
fn assert_trace(name: &str, linearizer: &mut Linearizer, q: &[f64]) {
    let point = linearizer.equilibrium_at(q).expect("it fits");
    let linear = linearizer.linearize(&point, &Output::defaults()).expect("it fits");
    let modes = natural_modes(&linear).unwrap_or_else(|e| panic!("{name}, {q:?}: {e}"));
    let twice = |m: &NaturalMode| if m.kind == ModeKind::Oscillation { 2.0 } else { 1.0 };
    let sum: f64 = modes.iter().map(|m| twice(m) * m.eigenvalue[0]).sum();
    let size = modes.iter().map(|m| m.eigenvalue[0].hypot(m.eigenvalue[1])).fold(0.0, f64::max);
    assert!((sum - linear.a.trace()).abs() <= 1e-9 * size, "{name}, {q:?}: {sum} instead of {}", linear.a.trace());
}

#[test]
fn every_eigenvalue_is_in_one_mode() {
    for (name, mut linearizer, _) in arms() {
        let q = pose(&linearizer);
        assert_trace(&name, &mut linearizer, &q);
    }
}

#[test]
fn the_projects_robots_have_all_their_modes_at_any_pose_fixed_and_floating() {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let mut count = 0;
    for name in ["iiwa14", "lwr", "manutec_r3", "planar_3r", "puma560", "single_link"] {
        for floating in [false, true] {
            let options = LoadOptions { floating, ..LoadOptions::default() };
            // Most bases are too light to float with their motors.
            let Ok(robot) = load(&robots.join(name).join("robot.yaml"), &options) else { continue };
            for model in Fidelity::ALL {
                let mut linearizer = Linearizer::new(&robot, model, KeptFriction::Viscous).expect("it is physical");
                let joints = linearizer.layout().inputs().len();
                for seed in 0..10 {
                    let mut q = linearizer.zero_position();
                    let first = q.len() - joints;
                    q[first..]
                        .iter_mut()
                        .zip(numbers(seed, joints))
                        .for_each(|(q, x)| *q = 3.0 * x * seed.min(1) as f64);
                    assert_trace(&format!("{name}, {model:?}, floating: {floating}"), &mut linearizer, &q);
                    count += 1;
                }
            }
        }
    }
    assert_eq!(count, 8 * 4 * 10);
}

#[test]
fn undamped_modes_are_those_of_the_generalised_symmetric_problem() {
    for (floating, model) in [(false, Fidelity::Complete), (false, Fidelity::Reduced), (true, Fidelity::Complete)] {
        let robot = undamped(floating);
        let mut linearizer = Linearizer::new(&robot, model, KeptFriction::All).expect("it is physical");
        let q = pose(&linearizer);
        let found = modes(&mut linearizer, &q);
        let point = linearizer.equilibrium_at(&q).expect("it fits");
        let mut dynamics = Dynamics::new(robot.model(model).expect("it is physical"));
        let joints = Coordinates::of(&robot);
        let want = gyroflex_sim::modes::modes(&mut dynamics, &joints, &q, &point.state.theta).expect("it is physical");
        let got: Vec<f64> = of_kind(&found, ModeKind::Oscillation).iter().map(|m| m.frequency).collect();
        assert_close("frequencies", &got, &want.modes.iter().map(|m| m.frequency).collect::<Vec<_>>(), 1e-9);
        // What does not swing stays wherever it is put: all joints, in the sense of link and motor together, and the root.
        assert_eq!(of_kind(&found, ModeKind::Rigid).len(), dynamics.nv(), "{model:?}, floating: {floating}");
        for mode in of_kind(&found, ModeKind::Oscillation) {
            assert!(mode.damping_ratio.is_some_and(|z| z.abs() < 1e-9), "{mode:?}");
        }
    }
}

#[test]
fn a_robot_that_nothing_brings_back_has_rigid_modes_and_those_that_friction_brakes() {
    let free = modes(&mut linearizer(Fidelity::Rigid, KeptFriction::None, false), &[0.3]);
    assert_eq!((of_kind(&free, ModeKind::Rigid).len(), free.len()), (1, 1));
    let braked = modes(&mut linearizer(Fidelity::Rigid, KeptFriction::All, false), &[0.3]);
    assert_eq!((of_kind(&braked, ModeKind::Rigid).len(), braked.len()), (1, 2));
    assert_close("decay", &of_kind(&braked, ModeKind::Decay)[0].eigenvalue, &[-FRICTION / (LINK + ROTOR), 0.0], 1e-12);

    // A floating one can be put anywhere and turned at will; held against its weight it falls sideways once it is tilted.
    for (gravity, rigid) in [(Vec3::zero(), 9), (Vec3::new(0.0, 0.0, -9.81), 4)] {
        let robot = Robot { gravity, ..undamped(true) };
        let mut linearizer = Linearizer::new(&robot, Fidelity::Rigid, KeptFriction::All).expect("it is physical");
        let q = pose(&linearizer);
        let found = modes(&mut linearizer, &q);
        assert_eq!(of_kind(&found, ModeKind::Rigid).len(), rigid, "{found:?}");
    }
}

#[test]
fn modes_of_a_sampled_model_are_refused() {
    let mut link = linearizer(Fidelity::Complete, KeptFriction::All, true);
    let point = link.equilibrium_at(&[0.0]).expect("it fits");
    let linear = link.linearize(&point, &Output::defaults()).expect("it fits");
    let sampled = gyroflex_sim::linearize::zero_order_hold_of(&linear, 0.01).expect("it is finite");
    assert!(natural_modes(&sampled).is_err());
}
