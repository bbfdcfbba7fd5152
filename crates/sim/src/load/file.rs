//! What a robot YAML may contain: the drives that a URDF has no words for.

use super::held::{ConstraintFile, ContactFile, CouplingFile};
use super::{FlexibleLinkFile, PayloadFile};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

/// A robot: a URDF and the drives of its joints. All units are SI.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotFile {
    /// The URDF, relative to this file.
    pub urdf: String,
    /// The model that commands use unless told otherwise; default: complete.
    #[serde(default)]
    pub model: ModelName,
    /// Acceleration of gravity in world axes [m/s²]; default: [0, 0, -9.81].
    #[serde(default)]
    pub gravity: Option<[f64; 3]>,
    /// Whether the root link moves freely; default: it is fixed to the world.
    #[serde(default)]
    pub floating: bool,
    /// What to do with joints that mimic another one; default: refuse the robot.
    #[serde(default)]
    pub mimic: Option<Mimic>,
    /// A load fixed to a link, added to what the URDF says; default: none.
    #[serde(default)]
    pub payload: Option<PayloadFile>,
    /// Points of links that may touch the ground, by name; a scenario's `ground` makes use of them.
    #[serde(default)]
    pub contacts: BTreeMap<String, ContactFile>,
    /// Frames held to the world or to other links all the time, by name: loops, which the URDF's tree cannot have.
    #[serde(default)]
    pub constraints: BTreeMap<String, ConstraintFile>,
    /// Joints that follow other joints, by name.
    #[serde(default)]
    pub couplings: BTreeMap<String, CouplingFile>,
    /// Links that bend, by name: beams in assumed modes, in place of the URDF's inertia of the link.
    #[serde(default)]
    pub flexible_links: BTreeMap<String, FlexibleLinkFile>,
    /// The drives by joint name. Joints without an entry have what the URDF itself says.
    #[serde(default)]
    pub drives: BTreeMap<String, DriveFile>,
}

/// Which physics of the rotors a model keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelName {
    /// Every rotor a body of its own, elastic transmissions (Zhao, Yu, Wang, Tomizuka 2015).
    #[default]
    Complete,
    /// Elastic transmissions, but a rotor's kinetic energy is that of its own spin alone (Spong 1987).
    Reduced,
    /// Every transmission rigid, with the full gyroscopics of the rotors.
    Rigid,
    /// Every transmission rigid, rotors only as reflected inertia ("armature").
    RigidReflected,
}

/// What to do with joints that mimic another one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mimic {
    /// Refuse the robot, since the coupling would be lost.
    #[default]
    Refuse,
    /// Drop the coupling, as most dynamics libraries do: the joint moves on its own.
    Independent,
}

/// The drive of one joint.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriveFile {
    /// The rotor, motor side, as in a data sheet.
    #[serde(default)]
    pub rotor: Option<RotorFile>,
    /// Rotor turns per joint turn [-], or rotor radians per metre for a prismatic joint; either sign, not zero; default: 1.
    #[serde(default)]
    pub gear_ratio: Option<f64>,
    /// The transmission between gear and link; default: rigid.
    #[serde(default)]
    pub transmission: Option<TransmissionFile>,
    /// Friction of both sides; default: none, on the link side what `<dynamics>` of the URDF says.
    #[serde(default)]
    pub friction: FrictionFile,
    /// The largest torque the controller may ask for, link side [N m, or N for a prismatic joint]; default: the URDF's effort limit.
    #[serde(default)]
    pub max_torque: Option<f64>,
    /// Say true where this file's gear ratio is meant to differ from the one in the URDF, which is an error otherwise.
    #[serde(default)]
    pub override_urdf: bool,
}

/// A balanced rotor, symmetric about its spin axis.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotorFile {
    /// Inertia about the spin axis, motor side [kg m²]; default: what the URDF says.
    #[serde(default)]
    pub inertia: Option<f64>,
    /// Mass [kg]. Given: mass and inertias are added to the mount link. Absent: the URDF's link already contains the rotor at rest.
    #[serde(default)]
    pub mass: Option<f64>,
    /// Inertia about axes across the spin axis [kg m²]; only with `mass`; default: half of `inertia`.
    #[serde(default)]
    pub transverse_inertia: Option<f64>,
    /// The place of the rotor; default: on the parent link, at the joint, along the joint axis.
    #[serde(default)]
    pub mount: Option<MountFile>,
}

/// The place and direction of a rotor. Without `link`, `xyz` and `rpy`, the mount frame is the joint frame on the parent link.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MountFile {
    /// The link that carries the rotor: the joint's parent link or one further in; default: the parent link.
    #[serde(default)]
    pub link: Option<String>,
    /// Origin of the mount frame, the rotor's centre, in the frame of `link` [m].
    #[serde(default)]
    pub xyz: Option<[f64; 3]>,
    /// Roll, pitch, yaw of the mount frame in the frame of `link`, as in a URDF [rad].
    #[serde(default)]
    pub rpy: Option<[f64; 3]>,
    /// Spin axis in the mount frame; default: the joint axis, where the mount frame is the joint frame.
    #[serde(default)]
    pub axis: Option<[f64; 3]>,
}

/// A rigid gear, or an elastic transmission.
#[derive(Clone, Debug)]
pub enum TransmissionFile {
    /// Written `rigid`.
    Rigid,
    /// Written as a mapping.
    Elastic(ElasticFile),
}

/// An elastic transmission, link side: either `stiffness` (and `cubic`) or `table`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticFile {
    /// Stiffness K > 0 [N m/rad, or N/m for a prismatic joint].
    #[serde(default)]
    pub stiffness: Option<f64>,
    /// Stiffening K3 >= 0, so that the torque is K d + K3 d³ [N m/rad³]; default: 0.
    #[serde(default)]
    pub cubic: Option<f64>,
    /// Measured points [deflection, torque], both strictly increasing; from [0, 0] on it is continued oddly. Instead of `stiffness`.
    #[serde(default)]
    pub table: Option<Vec<[f64; 2]>>,
    /// Damping D >= 0 beside the spring [N m s/rad]; default: 0.
    #[serde(default)]
    pub damping: Option<f64>,
    /// Periodic error of the gear; default: none.
    #[serde(default)]
    pub error: Option<GearErrorFile>,
}

/// Periodic error of a gear: amplitude · sin(cycles_per_rotor_turn · rotor angle + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GearErrorFile {
    /// Amplitude, link side [rad].
    pub amplitude: f64,
    /// Cycles per turn of the rotor [-].
    pub cycles_per_rotor_turn: f64,
    /// Phase [rad]; default: 0.
    #[serde(default)]
    pub phase: f64,
}

/// Friction of both sides.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionFile {
    /// In rotor velocity and motor torque.
    #[serde(default)]
    pub motor: ShaftFile,
    /// In joint velocity and joint torque; what is absent here is taken from `<dynamics>` of the URDF.
    #[serde(default)]
    pub link: ShaftFile,
}

/// Friction of one shaft: viscous v + (coulomb + stribeck exp(-(v/stribeck_velocity)²)) tanh(v/smoothing_velocity).
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShaftFile {
    /// Viscous coefficient >= 0 [N m s/rad]; default: 0.
    #[serde(default)]
    pub viscous: Option<f64>,
    /// Coulomb torque >= 0 [N m]; default: 0.
    #[serde(default)]
    pub coulomb: Option<f64>,
    /// Velocity over which the sign of the dry torque turns [rad/s]; default: 0.01.
    #[serde(default)]
    pub smoothing_velocity: Option<f64>,
    /// Breakaway torque in excess of `coulomb` [N m]; default: 0.
    #[serde(default)]
    pub stribeck: Option<f64>,
    /// Velocity at which that excess has faded to 1/e [rad/s]; default: 0.1.
    #[serde(default)]
    pub stribeck_velocity: Option<f64>,
}

impl<'de> Deserialize<'de> for TransmissionFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RigidOrElastic)
    }
}

/// Tells the word from the mapping without serde's untagged buffering, which would lose lines and key names.
struct RigidOrElastic;

impl<'de> Visitor<'de> for RigidOrElastic {
    type Value = TransmissionFile;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("`rigid`, or a mapping with `stiffness` and `damping`")
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<TransmissionFile, E> {
        match word {
            "rigid" => Ok(TransmissionFile::Rigid),
            _ => Err(E::unknown_variant(word, &["rigid"])),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TransmissionFile, A::Error> {
        ElasticFile::deserialize(MapAccessDeserializer::new(map)).map(TransmissionFile::Elastic)
    }
}

impl JsonSchema for TransmissionFile {
    fn schema_name() -> Cow<'static, str> {
        "TransmissionFile".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let elastic = generator.subschema_for::<ElasticFile>();
        json_schema!({
            "description": "`rigid` for a gear that does not give, or an elastic transmission.",
            "anyOf": [{ "const": "rigid" }, elastic],
        })
    }
}

impl From<ModelName> for gyroflex::model::Fidelity {
    fn from(name: ModelName) -> Self {
        match name {
            ModelName::Complete => Self::Complete,
            ModelName::Reduced => Self::Reduced,
            ModelName::Rigid => Self::Rigid,
            ModelName::RigidReflected => Self::RigidReflected,
        }
    }
}

/// The JSON Schema of a robot YAML.
pub fn robot_schema() -> serde_json::Value {
    schemars::schema_for!(RobotFile).to_value()
}
