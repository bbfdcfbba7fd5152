//! What is fixed for a whole run: names, frames, files, parameters.

use crate::robot::Robot;
use gyroflex::model::{DriveSpec, Fidelity, JointKind, TransmissionSpec};

/// What a recorder must know before the first sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunInfo {
    /// Names of the single-degree-of-freedom joints in coordinate order: the order of every vector in
    /// [`Sample`](super::Sample).
    pub joints: Vec<String>,
    /// For each of these joints whether it slides: its numbers are then in m and N instead of rad and N m.
    pub prismatic: Vec<bool>,
    /// For each of these joints whether it has a motor coordinate of its own.
    pub elastic: Vec<bool>,
    /// For each of these joints its gear ratio; `None` without a drive.
    pub gear_ratios: Vec<Option<f64>>,
    /// Name and parent name of every link, in the order of [`Sample::frames`](super::Sample::frames). Links without a
    /// parent hang on `world`.
    pub frames: Vec<(String, String)>,
    /// Whether the robot has a floating root.
    pub floating: bool,
    /// Whether something beside its joints may hold the robot.
    pub held: bool,
    /// Names of the points that the ground may hold.
    pub contacts: Vec<String>,
    /// Names of the modes of links that bend.
    pub modes: Vec<String>,
    /// For each of these whether its coordinate is an angle: its numbers are then in rad instead of m.
    pub turning: Vec<bool>,
    /// Names of the links that bend, whose tips are recorded.
    pub tips: Vec<String>,
    /// The robot's URDF, for `/robot_description`.
    pub urdf: String,
    /// Files to attach: name and content.
    pub attachments: Vec<(String, String)>,
    /// Parameters and versions of the run, for a metadata record; each key once.
    pub metadata: Vec<(String, String)>,
}

impl RunInfo {
    /// Name of the root frame of `/tf`.
    pub const WORLD: &'static str = "world";

    /// What `robot` says about a run of its model of the given fidelity. The robot's files are attached; the scenario's
    /// files and the parameters of the run are the caller's to add.
    pub fn new(robot: &Robot, fidelity: Fidelity) -> Self {
        let mut info = Self { floating: robot.is_floating(), ..Self::default() };
        for (joint, body) in robot.joints.iter().zip(&robot.bodies).skip(usize::from(info.floating)) {
            info.joints.push(joint.name.clone());
            info.prismatic.push(body.joint == JointKind::Prismatic);
            info.elastic.push(fidelity.is_elastic() && body.drive.as_ref().is_some_and(is_elastic));
            info.gear_ratios.push(body.drive.as_ref().map(|d| d.gear_ratio));
        }
        for link in &robot.links {
            let parent = link.parent.clone().unwrap_or_else(|| Self::WORLD.to_owned());
            info.frames.push((link.name.clone(), parent));
        }
        info.modes = robot.mode_names();
        info.turning = robot.flexible.turning();
        info.tips = robot.flexible.links.iter().map(|l| l.name.clone()).collect();
        info.urdf = robot.sources.first().map(|s| s.text.clone()).unwrap_or_default();
        info.attachments = robot.sources.iter().map(|s| (s.name.clone(), s.text.clone())).collect();
        info
    }
}

fn is_elastic(drive: &DriveSpec) -> bool {
    matches!(drive.transmission, TransmissionSpec::Elastic { .. })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Joint, Link, SourceFile};
    use gyroflex::model::{BodySpec, Friction, MountSpec, RotorSpec, SpringSpec, TransmissionError};
    use gyroflex::spatial::{SpatialInertia, Transform, Vec3};

    /// A floating root, an elastic turning joint, a sliding one without a drive, and a link fused to the last.
    fn robot() -> Robot {
        let mount = MountSpec { body: Some(0), placement: Transform::identity(), axis: Vec3::new(0.0, 0.0, 1.0) };
        let transmission = TransmissionSpec::Elastic {
            spring: SpringSpec::Polynomial { stiffness: 1.0, cubic: 0.0 },
            damping: 0.0,
            error: TransmissionError::none(),
        };
        let rotor = RotorSpec { inertia: 1.0, body: None, mount };
        let drive = DriveSpec { rotor, gear_ratio: -105.0, transmission, friction: Friction::none() };
        let kinds = [(JointKind::Floating, None), (JointKind::Revolute, Some(drive)), (JointKind::Prismatic, None)];
        let bodies = kinds.map(|(joint, drive)| BodySpec {
            parent: None,
            joint,
            axis: Vec3::new(0.0, 0.0, 1.0),
            placement: Transform::identity(),
            inertia: SpatialInertia::zero(),
            friction: Friction::none(),
            drive,
        });
        let joints = [("root", "floating"), ("turn", "revolute"), ("slide", "prismatic")].map(|(name, kind)| Joint {
            name: name.to_owned(),
            urdf_type: kind.to_owned(),
            parent_link: String::new(),
            child_link: String::new(),
            limits: None,
            max_velocity: None,
            max_torque: None,
        });
        let links = [("trunk", None), ("arm", Some("trunk")), ("tip", Some("arm")), ("tool", Some("tip"))];
        let links = links.map(|(name, parent)| Link {
            name: name.to_owned(),
            body: None,
            placement: Transform::identity(),
            parent: parent.map(str::to_owned),
        });
        let sources = [("robot.urdf", "<robot/>"), ("robot.yaml", "drives: {}")];
        Robot {
            name: "made up".to_owned(),
            joints: joints.to_vec(),
            bodies: bodies.to_vec(),
            spring_tables: Vec::new(),
            gravity: Vec3::zero(),
            fidelity: Fidelity::Complete,
            links: links.to_vec(),
            table: Vec::new(),
            warnings: Vec::new(),
            sources: sources.map(|(name, text)| SourceFile { name: name.to_owned(), text: text.to_owned() }).to_vec(),
            payload: None,
            contacts: Vec::new(),
            held: Vec::new(),
            flexible: crate::flexible::Flexible::default(),
        }
    }

    #[test]
    fn run_info_has_the_joints_of_one_degree_of_freedom_and_every_link() {
        let info = RunInfo::new(&robot(), Fidelity::Complete);
        assert!(info.floating);
        assert_eq!(info.joints, ["turn", "slide"]);
        assert_eq!(info.prismatic, [false, true]);
        assert_eq!(info.elastic, [true, false]);
        assert_eq!(info.gear_ratios, [Some(-105.0), None]);
        let frames: Vec<_> = info.frames.iter().map(|(link, parent)| (link.as_str(), parent.as_str())).collect();
        assert_eq!(frames, [("trunk", "world"), ("arm", "trunk"), ("tip", "arm"), ("tool", "tip")]);
        assert_eq!(info.urdf, "<robot/>");
        assert_eq!(info.attachments[1], ("robot.yaml".to_owned(), "drives: {}".to_owned()));
    }

    #[test]
    fn rigid_models_have_no_motor_coordinates() {
        assert_eq!(RunInfo::new(&robot(), Fidelity::Reduced).elastic, [true, false]);
        assert_eq!(RunInfo::new(&robot(), Fidelity::Rigid).elastic, [false, false]);
        assert_eq!(RunInfo::new(&robot(), Fidelity::RigidReflected).elastic, [false, false]);
    }
}
