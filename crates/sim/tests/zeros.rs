//! Laws of invariant zeros and of the inverses they belong to.

mod arm;

use gyroflex::model::{SpringSpec, TransmissionError, TransmissionSpec};
use gyroflex_sim::linearize::{KeptFriction, Linearizer, Output};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::zeros::{InverseOutput, InverseStability, Verdict, zeros};
use gyroflex_sim::{Fidelity, Robot};
use nalgebra::{Complex, DMatrix};
use std::path::Path;

fn robot(name: &str) -> Robot {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name);
    load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Gives joint `i` the spring `K δ + K₃ δ³` and the damping `damping(i)`.
fn with_transmissions(mut robot: Robot, cubic: f64, damping: impl Fn(usize) -> f64) -> Robot {
    for (i, body) in robot.bodies.iter_mut().enumerate() {
        let Some(drive) = body.drive.as_mut() else { continue };
        let TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, error, .. } =
            drive.transmission
        else {
            continue;
        };
        let spring = SpringSpec::Polynomial { stiffness, cubic };
        drive.transmission = TransmissionSpec::Elastic { spring, damping: damping(i), error };
    }
    robot
}

/// Robots whose zeros are all different: stiffening springs, transmission errors, rotors that couple, mixed gears.
fn robots() -> Vec<(String, Robot, Vec<f64>)> {
    let spread = |i: usize| 4.0 + 3.0 * i as f64;
    let lwr = with_transmissions(robot("lwr/loaded.yaml"), 1e7, spread);
    let puma = with_transmissions(robot("puma560/robot.yaml"), 0.0, spread);
    let arms =
        [("arm", arm::arm(false)), ("lwr", lwr), ("puma560", puma), ("manutec_r3", robot("manutec_r3/robot.yaml"))];
    let mut all = Vec::new();
    for (name, robot) in arms {
        for model in [Fidelity::Complete, Fidelity::Reduced] {
            let mut robot = robot.clone();
            robot.fidelity = model;
            let q = (0..robot.joints.len()).map(|i| 0.7 * (1.3 * i as f64 + 0.5).sin()).collect();
            all.push((format!("{name}, {}", model.name()), robot, q));
        }
    }
    all
}

const OUTPUTS: [(InverseOutput, Output); 2] =
    [(InverseOutput::Link, Output::LinkPosition), (InverseOutput::Motor, Output::MotorPosition)];

/// Smallest singular value of `[A − s 1, B; C, D]`, rows and columns scaled to one size.
fn least(linearizer: &mut Linearizer, q: &[f64], output: &Output, s: [f64; 2]) -> f64 {
    let point = linearizer.equilibrium_at(q).expect("it fits");
    let linear = linearizer.linearize(&point, std::slice::from_ref(output)).expect("it is finite");
    let (n, m) = linear.b.shape();
    let mut r = DMatrix::<Complex<f64>>::zeros(n + m, n + m);
    let mut put = |i: usize, j: usize, part: &DMatrix<f64>| {
        r.view_mut((i, j), part.shape()).copy_from(&part.map(|x| Complex::new(x, 0.0)));
    };
    put(0, 0, &linear.a);
    put(0, n, &linear.b);
    put(n, 0, &linear.c);
    put(n, n, &linear.d);
    (0..n).for_each(|i| r[(i, i)] -= Complex::new(s[0], s[1]));
    for _ in 0..20 {
        for mut row in r.row_iter_mut() {
            let size = row.norm().sqrt();
            row.unscale_mut(size);
        }
        for mut column in r.column_iter_mut() {
            let size = column.norm().sqrt();
            column.unscale_mut(size);
        }
    }
    r.singular_values().min()
}

#[test]
fn the_system_matrix_loses_rank_at_every_zero_and_nowhere_else() {
    for (name, robot, q) in robots() {
        let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::Viscous).expect("physical");
        let elastic = linearizer.layout().elastic().len();
        for (output, rows) in &OUTPUTS {
            let found = zeros(&mut linearizer, &q, *output).expect("physical");
            let count: usize = found.iter().map(|z| if z.value[1] > 0.0 { 2 } else { 1 }).sum();
            assert_eq!(count, if *output == InverseOutput::Link { elastic } else { 2 * elastic }, "{name}, {output:?}");
            for zero in &found {
                let context = format!("{name}, {output:?}, {zero:?}");
                let at = least(&mut linearizer, &q, rows, zero.value);
                for factor in [0.97, 1.03] {
                    let beside = least(&mut linearizer, &q, rows, zero.value.map(|x| factor * x));
                    assert!(at < 1e-6 * beside, "{context}: {at:e} beside {beside:e}");
                }
            }
        }
    }
}

/// A pendulum on a spring: `I q̈ + D q̇ + (K − m g l sin q) q = 0`, level at 0, hanging at π/2.
#[test]
fn a_link_with_its_motor_held_is_a_pendulum_on_a_spring() {
    let (k, d, gravity) = (20.0, 0.7, 9.81);
    let urdf = "<robot name='p'><link name='b'/><link name='l'><inertial><origin xyz='0.5 0 0'/><mass value='3'/>\
                <inertia ixx='0.1' iyy='0.2' izz='0.2' ixy='0' ixz='0' iyz='0'/></inertial></link>\
                <joint name='j' type='revolute'><parent link='b'/><child link='l'/><axis xyz='0 1 0'/>\
                <limit lower='-3' upper='3' effort='0' velocity='0'/></joint></robot>";
    let inertia = 0.2 + 3.0 * 0.25;
    for damping in [0.0, d] {
        let drives = format!(
            "urdf: p.urdf\ndrives: {{j: {{rotor: {{inertia: 1.0e-4}}, gear_ratio: 100, \
             transmission: {{stiffness: {k}, damping: {damping}}}}}}}"
        );
        let robot = gyroflex_sim::load::load_urdf_text(urdf, "p.urdf", Some(&drives), &LoadOptions::default());
        let robot = robot.unwrap_or_else(|e| panic!("{e}"));
        let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).expect("physical");
        for q in [-1.5, -0.4, 0.6, 1.5_f64] {
            // The axis is y: positive angles point the link down.
            let stiffness = k + 3.0 * gravity * 0.5 * q.sin();
            let square = damping * damping - 4.0 * inertia * stiffness;
            let found = zeros(&mut linearizer, &[q], InverseOutput::Motor).expect("physical");
            let largest = found.iter().map(|z| z.value[0]).fold(f64::NEG_INFINITY, f64::max);
            let want = (-damping + square.max(0.0).sqrt()) / (2.0 * inertia);
            assert!((largest - want).abs() < 1e-9 * k, "at {q}: {largest} is not {want}");
            let swing = found.iter().map(|z| z.value[1]).fold(0.0, f64::max);
            assert!((swing - (-square).max(0.0).sqrt() / (2.0 * inertia)).abs() < 1e-9 * k, "at {q}: {swing}");
        }
        let of = |output| InverseStability::of(&robot, output, 50).expect("physical");
        // `m g l` is less than `K` here, so that it takes no damping for a verdict.
        let want = if damping > 0.0 { Verdict::Stable } else { Verdict::Undamped };
        assert_eq!(of(InverseOutput::Motor).verdict, want);
        assert_eq!(of(InverseOutput::Link).verdict, want);
        assert_eq!(of(InverseOutput::Link).slowest.map(|at| at.zero.value), (damping > 0.0).then_some([-k / d, 0.0]));

        let weak = with_stiffness(&robot, 10.0);
        let report = InverseStability::of(&weak, InverseOutput::Motor, 50).expect("physical");
        assert_eq!(report.verdict, Verdict::Unstable, "{report:?}");
        assert!(report.reason.contains("`j`") && report.reason.contains("q = ["), "{}", report.reason);
        assert!(report.slowest.is_some_and(|at| at.q[0] < 0.0), "it stands on its head above the level");
    }
}

fn with_stiffness(robot: &Robot, stiffness: f64) -> Robot {
    let mut robot = robot.clone();
    let transmission = &mut robot.bodies[0].drive.as_mut().expect("it has one").transmission;
    if let TransmissionSpec::Elastic { spring, .. } = transmission {
        *spring = SpringSpec::Polynomial { stiffness, cubic: 0.0 };
    }
    robot
}

/// `k'(δ) = K + 3 K₃ δ²`, `δ` what gravity bends.
#[test]
fn a_stiffening_spring_makes_the_inverse_faster_where_it_carries_more() {
    let robot = with_transmissions(robot("lwr/loaded.yaml"), 1e8, |i| 10.0 + i as f64);
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::Viscous).expect("physical");
    let q = [0.3, 0.8, -0.4, 0.9, 0.2, -0.7, 0.5];
    let bent = linearizer.equilibrium_at(&q).expect("it fits").state.theta;
    let found = zeros(&mut linearizer, &q, InverseOutput::Link).expect("physical");
    assert!((bent[1] - q[1]).abs() > 2e-3, "it carries the load");
    for (i, joint) in robot.joints.iter().enumerate() {
        let want = -(1e4 + 3e8 * (bent[i] - q[i]).powi(2)) / (10.0 + i as f64);
        let got = found.iter().find(|z| z.joint == joint.name).expect("one a joint").value;
        assert!((got[0] / want - 1.0).abs() < 1e-9 && got[1] == 0.0, "{}: {got:?} is not {want}", joint.name);
    }
}

#[test]
fn the_lightweight_arm_has_a_stable_inverse_if_it_is_damped() {
    let lwr = InverseStability::of(&robot("lwr/robot.yaml"), InverseOutput::Link, 20).expect("physical");
    assert_eq!((lwr.verdict, lwr.poses, lwr.joints.len()), (Verdict::Stable, 20, 7));
    for at in [&lwr.slowest, &lwr.fastest].into_iter().chain(lwr.joints.iter().map(|j| &j.slowest)) {
        let value = at.as_ref().expect("one a joint").zero.value;
        assert!((value[0] + 1e4 / 15.0).abs() < 1e-9, "K/D: {value:?}");
    }
    let undamped = robot("lwr/undamped.yaml");
    let links = InverseStability::of(&undamped, InverseOutput::Link, 20).expect("physical");
    assert_eq!((links.verdict, links.slowest), (Verdict::Undamped, None));
    assert!(links.reason.contains("`joint1`"), "{}", links.reason);
    let motors = InverseStability::of(&undamped, InverseOutput::Motor, 20).expect("physical");
    assert_eq!(motors.verdict, Verdict::Undamped, "{}", motors.reason);
    let motors = InverseStability::of(&robot("lwr/robot.yaml"), InverseOutput::Motor, 20).expect("physical");
    assert_eq!(motors.verdict, Verdict::Stable, "{}", motors.reason);
}

#[test]
fn a_rigid_robot_has_no_internal_dynamics_and_a_floating_one_no_inverse() {
    let mut rigid = robot("lwr/robot.yaml");
    rigid.fidelity = Fidelity::Rigid;
    for (output, _) in OUTPUTS {
        let report = InverseStability::of(&rigid, output, 3).expect("physical");
        assert_eq!((report.verdict, report.slowest, report.joints.len()), (Verdict::Stable, None, 0));
        InverseStability::of(&rigid, output, 0).expect_err("no pose says nothing");
        let floating = InverseStability::of(&arm::arm(true), output, 3).expect_err("no motor leads the root");
        assert!(floating.problem.contains("floats"), "{floating}");
    }
}

/// The error of a gear scales what motors do to links, and cancels.
#[test]
fn an_error_of_the_gear_leaves_the_zeros_of_the_links_motion() {
    let with = |amplitude: f64| {
        let mut robot = with_transmissions(robot("lwr/robot.yaml"), 0.0, |_| 15.0);
        for body in &mut robot.bodies {
            let transmission = &mut body.drive.as_mut().expect("it has one").transmission;
            if let TransmissionSpec::Elastic { error, .. } = transmission {
                *error = TransmissionError { amplitude, cycles_per_rotor_turn: 2.0, phase: 0.3 };
            }
        }
        let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::Viscous).expect("physical");
        let q = [0.3, 0.8, -0.4, 0.9, 0.2, -0.7, 0.5];
        zeros(&mut linearizer, &q, InverseOutput::Link).expect("physical")
    };
    for (a, b) in with(0.0).iter().zip(&with(1e-4)) {
        assert!((a.value[0] - b.value[0]).abs() < 1e-9, "{a:?} {b:?}");
    }
}
