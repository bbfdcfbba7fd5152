//! A robot small enough to be written down: an elastic shoulder, a rigidly geared elbow, a plain sliding tip.

use gyroflex::model::{
    BodySpec, DriveSpec, Fidelity, Friction, JointKind, MountSpec, RotorBody, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex_sim::Robot;
use gyroflex_sim::robot::{Joint, Link};

/// Gear ratios of shoulder and elbow.
pub(crate) const RATIOS: [f64; 2] = [-90.0, 60.0];

/// The arm, its root link on a floating joint if asked for.
pub(crate) fn arm(floating: bool) -> Robot {
    let mut robot = Robot {
        name: "arm".to_owned(),
        joints: Vec::new(),
        bodies: Vec::new(),
        spring_tables: Vec::new(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        fidelity: Fidelity::Complete,
        links: vec![link("base", None, None)],
        table: Vec::new(),
        warnings: Vec::new(),
        sources: Vec::new(),
        payload: None,
        contacts: Vec::new(),
        held: Vec::new(),
        flexible: gyroflex_sim::flexible::Flexible::default(),
    };
    let mut parent = None;
    if floating {
        robot.links[0].body = Some(0);
        add(&mut robot, ("root", "floating", "world", "base"), body(None, JointKind::Floating, Vec3::z_axis(), None));
        parent = Some(0);
    }
    let first = robot.bodies.len();
    let shoulder = body(parent, JointKind::Revolute, Vec3::new(0.0, 0.6, 0.8), Some(drive(RATIOS[0], parent, true)));
    add(&mut robot, ("shoulder", "revolute", "base", "upper"), shoulder);
    let elbow =
        body(Some(first), JointKind::Revolute, Vec3::new(1.0, 0.0, 0.0), Some(drive(RATIOS[1], Some(first), false)));
    add(&mut robot, ("elbow", "continuous", "upper", "lower"), elbow);
    add(
        &mut robot,
        ("slide", "prismatic", "lower", "tip"),
        body(Some(first + 1), JointKind::Prismatic, Vec3::z_axis(), None),
    );
    let mut tool = link("tool", Some(first + 2), Some("tip"));
    tool.placement = Transform::from_pose(Mat3::from_rpy(0.3, -0.4, 0.5), Vec3::new(0.1, 0.2, 0.3));
    robot.links.push(link("upper", Some(first), Some("base")));
    robot.links.push(link("lower", Some(first + 1), Some("upper")));
    robot.links.push(link("tip", Some(first + 2), Some("lower")));
    robot.links.push(tool);
    robot
}

fn add(robot: &mut Robot, (name, kind, parent, child): (&str, &str, &str, &str), body: BodySpec) {
    robot.joints.push(Joint {
        name: name.to_owned(),
        urdf_type: kind.to_owned(),
        parent_link: parent.to_owned(),
        child_link: child.to_owned(),
        limits: None,
        max_velocity: None,
        max_torque: None,
    });
    robot.bodies.push(body);
}

fn link(name: &str, body: Option<usize>, parent: Option<&str>) -> Link {
    Link { name: name.to_owned(), body, placement: Transform::identity(), parent: parent.map(str::to_owned) }
}

fn body(parent: Option<usize>, joint: JointKind, axis: Vec3<f64>, drive: Option<DriveSpec>) -> BodySpec {
    BodySpec {
        parent,
        joint,
        axis,
        placement: match joint {
            JointKind::Floating => Transform::identity(),
            _ => Transform::from_pose(Mat3::from_rpy(0.1, 0.2, 0.3), Vec3::new(0.05, 0.1, 0.4)),
        },
        inertia: SpatialInertia::from_com(2.0, Vec3::new(0.02, 0.03, 0.2), SymMat3::diagonal(0.05, 0.06, 0.03)),
        friction: if joint == JointKind::Floating { Friction::none() } else { Friction::viscous(0.3) },
        drive,
    }
}

fn drive(gear_ratio: f64, mount: Option<usize>, elastic: bool) -> DriveSpec {
    let spring = SpringSpec::Polynomial { stiffness: 900.0, cubic: 4.0e4 };
    let error = TransmissionError { amplitude: 1e-4, cycles_per_rotor_turn: 2.0, phase: 0.4 };
    DriveSpec {
        rotor: RotorSpec {
            inertia: 2e-4,
            body: Some(RotorBody { mass: 0.4, transverse_inertia: 1.2e-4 }),
            mount: MountSpec { body: mount, placement: Transform::identity(), axis: Vec3::new(0.0, 0.6, 0.8) },
        },
        gear_ratio,
        transmission: match elastic {
            true => TransmissionSpec::Elastic { spring, damping: 3.0, error },
            false => TransmissionSpec::Rigid,
        },
        friction: Friction::viscous(1e-4),
    }
}
