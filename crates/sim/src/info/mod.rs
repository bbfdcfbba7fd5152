//! What a robot ended up with, for people and for programs.

mod text;

use crate::beam::Boundary;
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::flexible::Flexure;
use crate::inverse::SmoothnessTable;
use crate::modes::{Modes, modes};
use crate::robot::Robot;
use gyroflex::model::{BodySpec, DriveSpec, Friction, MountSpec, SpringSpec, TransmissionSpec};
use serde::Serialize;

/// Everything about a loaded robot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Info {
    /// Name of the robot.
    pub name: String,
    /// The model commands use unless told otherwise.
    pub model: &'static str,
    /// Acceleration of gravity in world axes [m/s²].
    pub gravity: [f64; 3],
    /// Length of `q`.
    pub nq: usize,
    /// Length of `qd`, `tau` and all other vectors over the joints.
    pub nv: usize,
    /// Mass of everything that moves, rotors included [kg].
    pub moving_mass: f64,
    /// The joints in coordinate order, a floating root first.
    pub joints: Vec<JointInfo>,
    /// Links that bend; their modes follow the joints in `q`, `qd` and all others.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub flexible_links: Vec<FlexibleLinkInfo>,
    /// Every link of the URDF.
    pub links: Vec<LinkInfo>,
    /// Every number of every joint, and where it came from.
    pub table: Vec<EntryInfo>,
    /// Natural modes of the transmissions and of links that bend at the zero pose, unloaded, in the robot's own model; `None` without
    /// either, or where the inertia matrix has no inverse.
    pub modes: Option<Modes>,
    /// How many derivatives of the joints' positions the inverse of the elastic models needs; `None` if no joint is elastic: accelerations
    /// are enough then; nor where links bend.
    pub smoothness: Option<SmoothnessTable>,
    /// What was ignored or assumed.
    pub warnings: Vec<String>,
}

/// One joint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointInfo {
    /// Name; `root` for a floating root.
    pub name: String,
    /// URDF type: `revolute`, `continuous`, `prismatic` or `floating`.
    #[serde(rename = "type")]
    pub kind: String,
    /// Name of the parent link; `world` for a floating root.
    pub parent: String,
    /// Name of the link it moves.
    pub child: String,
    /// Index of its first entry in `q`.
    pub q_index: usize,
    /// Index of its first entry in `qd`, `tau`, …
    pub v_index: usize,
    /// Lower and upper position limit [rad or m].
    pub limits: Option<[f64; 2]>,
    /// Largest velocity [rad/s or m/s].
    pub max_velocity: Option<f64>,
    /// Largest torque, link side [N m or N].
    pub max_torque: Option<f64>,
    /// Mass of the link with everything fused to it, without rotors added to it [kg].
    pub link_mass: f64,
    /// Friction on the link side; `None` if there is none.
    pub friction: Option<FrictionInfo>,
    /// Its drive; `None` for a plain joint.
    pub drive: Option<DriveInfo>,
}

/// Friction of one side, in that side's velocity and torque.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrictionInfo {
    /// [N m s/rad].
    pub viscous: f64,
    /// [N m].
    pub coulomb: f64,
    /// Velocity over which the sign of the Coulomb torque turns [rad/s].
    pub smoothing_velocity: f64,
    /// Breakaway torque in excess of `coulomb` [N m].
    pub stribeck: f64,
    /// Velocity at which that excess has faded [rad/s].
    pub stribeck_velocity: f64,
}

/// The drive of a joint, keys as in the drives YAML.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DriveInfo {
    /// `N`: rotor turns per joint turn.
    pub gear_ratio: f64,
    /// The rotor, motor side.
    pub rotor: RotorInfo,
    /// `B = N² J`, link side [kg m²].
    pub reflected_inertia: f64,
    /// The transmission; `None` is a rigid gear.
    pub transmission: Option<TransmissionInfo>,
    /// Friction on the motor side; `None` if there is none.
    pub friction: Option<FrictionInfo>,
}

/// A rotor, motor side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorInfo {
    /// `J`: about the spin axis [kg m²].
    pub inertia: f64,
    /// Mass added to the mount link [kg]; `None` if that link contains the rotor.
    pub mass: Option<f64>,
    /// `J_t`: about axes across the spin axis [kg m²].
    pub transverse_inertia: Option<f64>,
    /// The link that carries it; `world` for a fixed base.
    pub mount_link: String,
    /// Place of its centre in that link's frame [m].
    pub mount_xyz: [f64; 3],
    /// Its spin axis in that link's frame.
    pub spin_axis: [f64; 3],
}

/// An elastic transmission, link side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransmissionInfo {
    /// `K` [N m/rad]; `None` where a table describes the spring.
    pub stiffness: Option<f64>,
    /// `K₃` [N m/rad³].
    pub cubic: Option<f64>,
    /// Points deflection, torque of the spring.
    pub table: Option<Vec<[f64; 2]>>,
    /// `D` [N m s/rad].
    pub damping: f64,
    /// Amplitude of the transmission error [rad].
    pub error_amplitude: f64,
}

/// A link that bends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlexibleLinkInfo {
    /// Its name.
    pub link: String,
    /// Length of its beam [m].
    pub length: f64,
    /// Whether a bent beam is shorter than a straight one.
    pub geometric_stiffening: bool,
    /// Its modes, in the order of the modal coordinates.
    pub modes: Vec<ModeInfo>,
}

/// An assumed mode on its own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeInfo {
    /// Its name.
    pub name: String,
    /// Whose eigenfunction it is; `None` for a shape from a table.
    pub boundary: Option<&'static str>,
    /// Stiffness `K_jj` [N/m, in torsion N m/rad].
    pub stiffness: f64,
    /// Modal mass, with what its boundary has at the tip [kg, in torsion kg m²].
    pub mass: f64,
    /// Natural frequency of the two [Hz].
    pub frequency: f64,
    /// Damping ratio [–].
    pub damping_ratio: f64,
}

impl FlexibleLinkInfo {
    fn of(link: &Flexure) -> Self {
        let modes = link.modes.iter().map(|mode| ModeInfo {
            name: mode.name.clone(),
            boundary: mode.boundary.map(Boundary::name),
            stiffness: mode.figures.stiffness,
            mass: mode.figures.total_mass,
            frequency: mode.figures.frequency,
            damping_ratio: mode.figures.damping_ratio,
        });
        Self {
            link: link.name.clone(),
            length: link.beam.length,
            geometric_stiffening: link.beam.stiffening,
            modes: modes.collect(),
        }
    }
}

/// One link of the URDF: a frame of a moving body or of the world.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkInfo {
    /// Name.
    pub name: String,
    /// Name of its parent link.
    pub parent: Option<String>,
    /// The joint that moves it, directly or through fixed joints; `None` if it does not move.
    pub moved_by: Option<String>,
}

/// One number and its origin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EntryInfo {
    /// Joint name.
    pub joint: String,
    /// Key as in the drives YAML.
    pub key: String,
    /// Value.
    pub value: String,
    /// Unit.
    pub unit: &'static str,
    /// File and line, or rule.
    pub source: String,
}

impl Info {
    /// Describes a robot.
    ///
    /// # Errors
    /// A robot that is not physical.
    pub fn of(robot: &Robot) -> Result<Self, Error> {
        let model = robot.model(robot.fidelity)?;
        let view = model.view();
        let joints = robot.joints.iter().zip(&robot.bodies).zip(view.bodies()).map(|((joint, spec), body)| JointInfo {
            name: joint.name.clone(),
            kind: joint.urdf_type.clone(),
            parent: joint.parent_link.clone(),
            child: joint.child_link.clone(),
            q_index: body.q_index(),
            v_index: body.v_index(),
            limits: joint.limits,
            max_velocity: joint.max_velocity,
            max_torque: joint.max_torque,
            link_mass: spec.inertia.mass,
            friction: friction(&spec.friction),
            drive: spec.drive.as_ref().map(|d| drive(robot, d)),
        });
        Ok(Self {
            name: robot.name.clone(),
            model: robot.fidelity.name(),
            gravity: robot.gravity.to_array(),
            nq: model.nq(),
            nv: model.nv(),
            moving_mass: robot.bodies.iter().map(|b| b.inertia.mass + moving_rotor_mass(b)).sum(),
            joints: joints.collect(),
            flexible_links: robot.flexible.links.iter().map(FlexibleLinkInfo::of).collect(),
            links: robot.links.iter().map(|l| link(robot, l)).collect(),
            table: robot.table.iter().map(entry).collect(),
            modes: modes_at_zero(robot)?,
            smoothness: smoothness(robot)?,
            warnings: robot.warnings.iter().map(ToString::to_string).collect(),
        })
    }

    /// The same as indented JSON.
    ///
    /// # Errors
    /// When a text cannot be written as JSON.
    pub fn to_json(&self) -> Result<String, Error> {
        serde_json::to_string_pretty(self).map_err(Error::from)
    }
}

fn modes_at_zero(robot: &Robot) -> Result<Option<Modes>, Error> {
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity)?);
    if dynamics.modes() == 0 && !dynamics.model().bodies().iter().any(|b| b.is_elastic()) {
        return Ok(None);
    }
    let mut q = vec![0.0; dynamics.nq()];
    if robot.is_floating() {
        q[6] = 1.0;
    }
    let theta = vec![0.0; dynamics.nv()];
    // A pose at which the inertia matrix is singular has no modes to show; everything else about the robot still does.
    Ok(modes(&mut dynamics, &Coordinates::of(robot), &q, &theta).ok())
}

fn smoothness(robot: &Robot) -> Result<Option<SmoothnessTable>, Error> {
    let mut drives = robot.bodies.iter().filter_map(|b| b.drive.as_ref());
    let elastic = drives.any(|d| matches!(d.transmission, TransmissionSpec::Elastic { .. }));
    (elastic && robot.flexible.is_empty()).then(|| SmoothnessTable::of(robot)).transpose()
}

fn moving_rotor_mass(body: &BodySpec) -> f64 {
    let carried = body.drive.as_ref().filter(|d| d.rotor.mount.body.is_some());
    carried.and_then(|d| d.rotor.body).map_or(0.0, |r| r.mass)
}

fn friction(f: &Friction<f64>) -> Option<FrictionInfo> {
    let some = f.viscous != 0.0 || f.coulomb != 0.0 || f.stribeck != 0.0;
    some.then_some(FrictionInfo {
        viscous: f.viscous,
        coulomb: f.coulomb,
        smoothing_velocity: f.smoothing_velocity,
        stribeck: f.stribeck,
        stribeck_velocity: f.stribeck_velocity,
    })
}

fn drive(robot: &Robot, d: &DriveSpec) -> DriveInfo {
    let MountSpec { body, placement, axis } = d.rotor.mount;
    let carrier = body.and_then(|b| robot.joints.get(b));
    DriveInfo {
        gear_ratio: d.gear_ratio,
        rotor: RotorInfo {
            inertia: d.rotor.inertia,
            mass: d.rotor.body.map(|b| b.mass),
            transverse_inertia: d.rotor.body.map(|b| b.transverse_inertia),
            mount_link: carrier.map_or_else(|| "world".to_owned(), |j| j.child_link.clone()),
            mount_xyz: placement.pos.to_array(),
            spin_axis: placement.rot.transpose_mul(axis).to_array(),
        },
        reflected_inertia: d.gear_ratio * d.gear_ratio * d.rotor.inertia,
        transmission: transmission(robot, &d.transmission),
        friction: friction(&d.friction),
    }
}

fn transmission(robot: &Robot, t: &TransmissionSpec) -> Option<TransmissionInfo> {
    let TransmissionSpec::Elastic { spring, damping, error } = t else { return None };
    let (stiffness, cubic, table) = match *spring {
        SpringSpec::Polynomial { stiffness, cubic } => (Some(stiffness), Some(cubic), None),
        SpringSpec::Table { first, len } => {
            (None, None, robot.spring_tables.get(first..first + len).map(<[[f64; 2]]>::to_vec))
        }
    };
    Some(TransmissionInfo { stiffness, cubic, table, damping: *damping, error_amplitude: error.amplitude })
}

fn link(robot: &Robot, l: &crate::robot::Link) -> LinkInfo {
    let moved_by = l.body.and_then(|b| robot.joints.get(b)).map(|j| j.name.clone());
    LinkInfo { name: l.name.clone(), parent: l.parent.clone(), moved_by }
}

fn entry(e: &crate::robot::Entry) -> EntryInfo {
    EntryInfo {
        joint: e.joint.clone(),
        key: e.key.clone(),
        value: e.value.clone(),
        unit: e.unit,
        source: e.source.clone(),
    }
}
