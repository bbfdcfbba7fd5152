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
        info.urdf = robot.sources.first().map(|s| s.text.clone()).unwrap_or_default();
        info.attachments = robot.sources.iter().map(|s| (s.name.clone(), s.text.clone())).collect();
        info
    }
}

fn is_elastic(drive: &DriveSpec) -> bool {
    matches!(drive.transmission, TransmissionSpec::Elastic { .. })
}
