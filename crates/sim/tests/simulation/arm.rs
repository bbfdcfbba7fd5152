//! A small robot described in code, and short ways to run scenarios with it.

use gyroflex::model::{
    BodySpec, DriveSpec, Fidelity, Friction, JointKind, MountSpec, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex_sim::record::{MemoryRecorder, Sample};
use gyroflex_sim::robot::{Joint, Link};
use gyroflex_sim::{Robot, ScenarioFile, Simulation, Summary};
use std::ops::ControlFlow;
use std::path::Path;

/// Length of a link [m].
pub const LENGTH: f64 = 0.4;
/// Reflected rotor inertia of every drive [kg m²].
pub const REFLECTED: f64 = 1.0;
/// Spring of every transmission unless changed [N m/rad].
pub const STIFFNESS: f64 = 1000.0;

/// An elastic drive on the joint's parent.
pub fn drive(parent: Option<usize>, placement: Transform<f64>, axis: Vec3<f64>) -> DriveSpec {
    DriveSpec {
        rotor: RotorSpec { inertia: 1e-4, body: None, mount: MountSpec { body: parent, placement, axis } },
        gear_ratio: 100.0,
        transmission: TransmissionSpec::Elastic {
            spring: SpringSpec::Polynomial { stiffness: STIFFNESS, cubic: 0.0 },
            damping: 0.0,
            error: TransmissionError::none(),
        },
        friction: Friction::none(),
    }
}

/// A chain of `n` links along their x axes that turn about y and z in turn, every joint with an elastic drive and no losses.
pub fn arm(n: usize) -> Robot {
    let mut robot = Robot {
        name: "arm".to_owned(),
        joints: Vec::new(),
        bodies: Vec::new(),
        spring_tables: Vec::new(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        fidelity: Fidelity::Complete,
        links: vec![Link { name: "base".to_owned(), body: None, placement: Transform::identity(), parent: None }],
        table: Vec::new(),
        warnings: Vec::new(),
        sources: Vec::new(),
        payload: None,
        contacts: Vec::new(),
        held: Vec::new(),
        flexible: gyroflex_sim::flexible::Flexible::default(),
    };
    for i in 0..n {
        let parent = i.checked_sub(1);
        let offset = if i == 0 { 0.0 } else { LENGTH };
        let placement = Transform::from_pose(Mat3::identity(), Vec3::new(offset, 0.0, 0.0));
        let axis = if i % 2 == 0 { Vec3::new(0.0, 1.0, 0.0) } else { Vec3::new(0.0, 0.0, 1.0) };
        let mass = 3.0 / (i + 1) as f64;
        let about_com = SymMat3::diagonal(0.01, 0.03, 0.03).scale(mass);
        robot.bodies.push(BodySpec {
            parent,
            joint: JointKind::Revolute,
            axis,
            placement,
            inertia: SpatialInertia::from_com(mass, Vec3::new(LENGTH / 2.0, 0.0, 0.0), about_com),
            friction: Friction::none(),
            drive: Some(drive(parent, placement, axis)),
        });
        let link = |i: usize| if i == 0 { "base".to_owned() } else { format!("link{i}") };
        robot.joints.push(Joint {
            name: format!("joint{}", i + 1),
            urdf_type: "revolute".to_owned(),
            parent_link: link(i),
            child_link: link(i + 1),
            limits: None,
            max_velocity: None,
            max_torque: None,
        });
        robot.links.push(Link {
            name: link(i + 1),
            body: Some(i),
            placement: Transform::identity(),
            parent: Some(link(i)),
        });
    }
    robot
}

/// The same chain flying free: its first link is a floating root.
pub fn flying_arm(n: usize) -> Robot {
    let mut robot = arm(n);
    let root = &mut robot.bodies[0];
    (root.joint, root.drive) = (JointKind::Floating, None);
    robot.joints[0].name = "root".to_owned();
    robot.joints[0].urdf_type = "floating".to_owned();
    robot
}

/// Changes the drive of every joint that has one.
pub fn with_drives(mut robot: Robot, change: impl Fn(&mut DriveSpec)) -> Robot {
    robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()).for_each(change);
    robot
}

/// Gives every drive this spring and damper.
pub fn with_transmissions(robot: Robot, spring: SpringSpec, damping: f64, error: TransmissionError<f64>) -> Robot {
    with_drives(robot, |drive| drive.transmission = TransmissionSpec::Elastic { spring, damping, error })
}

/// A linear spring.
pub fn linear(stiffness: f64) -> SpringSpec {
    SpringSpec::Polynomial { stiffness, cubic: 0.0 }
}

/// The scenario of some YAML, for whatever robot.
pub fn scenario(yaml: &str) -> ScenarioFile {
    ScenarioFile::parse(&format!("robot: arm.yaml\n{yaml}"), Path::new("test.yaml")).unwrap()
}

/// A run that is ready to start.
pub fn simulation(robot: &Robot, yaml: &str) -> Simulation {
    Simulation::new(robot, &scenario(yaml)).unwrap_or_else(|e| panic!("{e}"))
}

/// Runs to the end and keeps everything.
pub fn run(robot: &Robot, yaml: &str) -> (Summary, Vec<Sample>, Simulation) {
    run_file(robot, &scenario(yaml))
}

/// The same for a scenario from a file.
pub fn run_file(robot: &Robot, file: &ScenarioFile) -> (Summary, Vec<Sample>, Simulation) {
    let mut simulation = Simulation::new(robot, file).unwrap_or_else(|e| panic!("{e}"));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut memory, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|e| panic!("{e}"));
    (summary, memory.samples().to_vec(), simulation)
}

/// Largest distance between the entries of two slices.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}
