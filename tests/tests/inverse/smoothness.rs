//! How many derivatives of a motion the inverse needs: known values, bounds, and what perturbing single derivatives shows.

use gyroflex::dynamics::{JointOrders, VANISHING};
use gyroflex::model::{
    BodySpec, DriveSpec, Fidelity, Friction, JointKind, MountSpec, RobotSpec, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::reference::Case;
use gyroflex_tests::{Core, LinkMotion, smoothness};

/// An arm whose joints turn about the given axes, its rotors in the joints, with damped transmissions or without.
fn arm(axes: &[[f64; 3]], damping: f64) -> Vec<BodySpec> {
    let link = |(i, axis): (usize, &[f64; 3])| {
        let parent = i.checked_sub(1);
        let placement = Transform::from_pose(Mat3::identity(), [0.03, 0.01, 0.25].into());
        let com = [0.02, -0.03, 0.1].into();
        BodySpec {
            parent,
            joint: JointKind::Revolute,
            axis: Vec3::from(*axis),
            placement,
            inertia: SpatialInertia::from_com(2.0, com, SymMat3::diagonal(0.03, 0.02, 0.015)),
            friction: Friction::none(),
            drive: Some(DriveSpec {
                rotor: RotorSpec {
                    inertia: 1e-4,
                    body: None,
                    mount: MountSpec { body: parent, placement, axis: Vec3::from(*axis) },
                },
                gear_ratio: 100.0,
                transmission: TransmissionSpec::Elastic {
                    spring: SpringSpec::Polynomial { stiffness: 1e4, cubic: 0.0 },
                    damping,
                    error: TransmissionError::none(),
                },
                friction: Friction::none(),
            }),
        }
    };
    axes.iter().enumerate().map(link).collect()
}

fn orders(bodies: &[BodySpec], fidelity: Fidelity) -> Vec<JointOrders> {
    let spec = RobotSpec { bodies, spring_tables: &[], gravity: [0.0, 0.0, -9.81].into() };
    smoothness(&spec, fidelity, 0, VANISHING)
}

fn highest(bodies: &[BodySpec], fidelity: Fidelity) -> u8 {
    orders(bodies, fidelity).iter().map(|o| o.position).max().unwrap_or(0)
}

/// Thümmel, Otter & Bals, table 1, for the arm with damping; PHYSICS §4 for the one without.
#[test]
fn seven_perpendicular_axes_need_what_is_published() {
    let axes: Vec<_> = (0..7).map(|i| if i % 2 == 0 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] }).collect();
    assert_eq!(highest(&arm(&axes, 15.0), Fidelity::Complete), 6);
    assert_eq!(highest(&arm(&axes, 15.0), Fidelity::Reduced), 3);
    assert_eq!(highest(&arm(&axes, 0.0), Fidelity::Complete), 10);
    assert_eq!(highest(&arm(&axes, 0.0), Fidelity::Reduced), 4);
    // Rigid robots need accelerations, whatever their drives.
    assert_eq!(highest(&arm(&axes, 15.0), Fidelity::Rigid), 2);
    assert_eq!(highest(&arm(&axes, 15.0), Fidelity::RigidReflected), 2);
}

/// De Luca & Tomei 1996: `2 (n + 1)` without damping and `n + 2` with it, which parallel axes reach.
#[test]
fn parallel_axes_reach_the_upper_bounds() {
    for n in 1..=9 {
        let axes = vec![[0.0, 1.0, 0.0]; n];
        assert_eq!(usize::from(highest(&arm(&axes, 0.0), Fidelity::Complete)), 2 * (n + 1));
        assert_eq!(usize::from(highest(&arm(&axes, 15.0), Fidelity::Complete)), n + 2);
    }
}

#[test]
fn no_robot_exceeds_the_upper_bounds() {
    for seed in 0..200 {
        for damping in [0.0, 1.0] {
            let options = Options { damping, ..Options::default() };
            let robot = RandomRobot::new(seed, &options);
            let n = robot.bodies.len() as u8;
            let bound = if damping > 0.0 { n + 2 } else { 2 * (n + 1) };
            for order in smoothness(&robot.spec(), Fidelity::Complete, 0, VANISHING) {
                assert!(order.position <= bound, "seed {seed}: {order:?} exceeds {bound}");
            }
            let reduced = if damping > 0.0 { 3 } else { 4 };
            for order in smoothness(&robot.spec(), Fidelity::Reduced, 0, VANISHING) {
                assert!(order.position <= reduced, "seed {seed}: {order:?} exceeds {reduced}");
            }
        }
    }
}

/// What the reference program found for the six-joint arm with its rotors in the joints.
#[test]
fn rotors_in_the_joints_of_the_reference_arm() {
    let case = Case::load("r6_gyro_undamped__inverse_trajectory");
    let mut bodies = case.spec().bodies.to_vec();
    for body in &mut bodies {
        let (parent, placement, axis) = (body.parent, body.placement, body.axis);
        if let Some(drive) = &mut body.drive {
            drive.rotor.mount = MountSpec { body: parent, placement, axis };
        }
    }
    assert_eq!(highest(&bodies, Fidelity::Complete), 9);
    for drive in bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        if let TransmissionSpec::Elastic { damping, .. } = &mut drive.transmission {
            *damping = 10.0;
        }
    }
    assert_eq!(highest(&bodies, Fidelity::Complete), 5);
}

/// Perturbs single derivatives of single joints: the torques must feel the highest one named for a joint, and not the next. The
/// inverse is run with orders that no structure has lowered, so that nothing is cut off.
fn assert_orders_are_exact(name: &str, spec: &RobotSpec<'_>, fidelity: Fidelity) {
    let exact = smoothness(spec, fidelity, 0, VANISHING);
    let bound = exact.iter().map(|o| o.position).max().unwrap_or(2) + 1;
    let generous: Vec<_> =
        exact.iter().map(|o| JointOrders { torque: bound - 2, force: bound - 2, motion: bound - 2, ..*o }).collect();
    let core = Core::<f64>::new(spec, fidelity);
    let n = spec.bodies.len();
    let row = |k: usize| (0..n).map(|i| (1.3 * (k * n + i) as f64).sin() * 3f64.powi(k as i32)).collect();
    let motion =
        LinkMotion { q: row(0), derivatives: (1..=usize::from(bound)).map(row).collect(), ..LinkMotion::default() };
    let torques =
        |motion: &LinkMotion| core.elastic_inverse(&generous, 0, motion).expect("the arm can be inverted").tau;
    let plain = torques(&motion);
    for (joint, order) in exact.iter().enumerate() {
        for (derivative, felt) in [(order.position, true), (order.position + 1, false)] {
            let mut perturbed = motion.clone();
            // Large enough to be felt through springs and small coupling.
            let change = 1e8 * perturbed.derivatives[usize::from(derivative) - 1][joint].abs().max(1.0);
            perturbed.derivatives[usize::from(derivative) - 1][joint] += change;
            let changed = torques(&perturbed);
            let most = plain[0].iter().zip(&changed[0]).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
            let size = plain[0].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let context = format!("{name}, {}: derivative {derivative} of joint {joint}", fidelity.name());
            if felt {
                assert!(most > 1e-9 * size, "{context} changes no torque: {most:e} of {size:e}");
            } else {
                assert!(most == 0.0, "{context} changes torques by {most:e} of {size:e}");
            }
        }
    }
}

#[test]
fn perturbing_the_highest_derivative_is_felt_and_the_next_is_not() {
    for name in ["puma560", "manutec_r3"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../robots/{name}/robot.yaml"));
        let robot = gyroflex_sim::load::load(&path, &Default::default()).expect("the robot loads");
        let spec = RobotSpec { bodies: &robot.bodies, spring_tables: &robot.spring_tables, gravity: robot.gravity };
        for fidelity in [Fidelity::Complete, Fidelity::Reduced] {
            println!("{name} {}: {:?}", fidelity.name(), smoothness(&spec, fidelity, 0, VANISHING));
            assert_orders_are_exact(name, &spec, fidelity);
        }
    }
    let axes: Vec<_> = (0..5).map(|i| if i % 2 == 0 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] }).collect();
    for damping in [0.0, 15.0] {
        let bodies = arm(&axes, damping);
        let spec = RobotSpec { bodies: &bodies, spring_tables: &[], gravity: [0.0, 0.0, -9.81].into() };
        assert_orders_are_exact("five perpendicular axes", &spec, Fidelity::Complete);
    }
}

#[path = "../../../embedded/firmware/src/orders.rs"]
mod firmware;

/// The table that the firmware holds is that of its arm.
#[test]
fn the_orders_in_the_firmware_are_those_of_its_arm() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/iiwa14/robot.yaml");
    let robot = gyroflex_sim::load::load(&path, &Default::default()).expect("the robot loads");
    let spec = RobotSpec { bodies: &robot.bodies, spring_tables: &robot.spring_tables, gravity: robot.gravity };
    assert_eq!(smoothness(&spec, Fidelity::Complete, 0, VANISHING), firmware::ORDERS);
}
