//! The drive and the friction of one joint, from YAML and URDF.

use super::dialects::{Tagged, Tags};
use super::file::{DriveFile, ElasticFile, ShaftFile, TransmissionFile};
use super::merge::{Merge, agreed, same};
use super::mount::{self, Places};
use super::tree::JointElement;
use crate::error::Error;
use gyroflex::model::{DriveSpec, Friction, RotorBody, RotorSpec, SpringSpec, TransmissionError, TransmissionSpec};
use urdf_rs::JointType;

/// Units of a joint: those that turn, and those that slide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units {
    torque: &'static str,
    velocity: &'static str,
    viscous: &'static str,
    stiffness: &'static str,
    cubic: &'static str,
    ratio: &'static str,
    angle: &'static str,
}

const TURNING: Units = Units {
    torque: "N m",
    velocity: "rad/s",
    viscous: "N m s/rad",
    stiffness: "N m/rad",
    cubic: "N m/rad³",
    ratio: "",
    angle: "rad",
};
const SLIDING: Units = Units {
    torque: "N",
    velocity: "m/s",
    viscous: "N s/m",
    stiffness: "N/m",
    cubic: "N/m³",
    ratio: "rad/m",
    angle: "m",
};

/// What a joint ends up with.
#[derive(Debug)]
pub(crate) struct Driven {
    pub(crate) drive: Option<DriveSpec>,
    pub(crate) friction: Friction<f64>,
    pub(crate) max_torque: Option<f64>,
}

/// Merges what is known about one joint: the YAML's entry over the URDF's tags over defaults.
pub(crate) fn merge(
    merge: &mut Merge<'_>,
    joint: &JointElement,
    file: &DriveFile,
    tags: &Tags,
    places: &Places<'_>,
    spring_tables: &mut Vec<[f64; 2]>,
) -> Result<Driven, Error> {
    let units = if joint.kind == JointType::Prismatic { SLIDING } else { TURNING };
    let drive = drive(merge, joint, file, tags, places, units, spring_tables)?;

    let dynamics = joint.dynamics.as_ref();
    let tag = |value: f64, key: &str| Tagged { value, source: format!("{} <dynamics {key}>", joint.dynamics_at) };
    let damping = dynamics.map(|d| tag(d.damping, "damping"));
    let coulomb = dynamics.map(|d| tag(d.friction, "friction"));
    let friction = shaft(merge, "friction.link", &file.friction.link, [damping, coulomb], units)?;

    let effort = joint.limit.as_ref().map(|l| l.effort).filter(|e| e.is_finite() && *e > 0.0);
    let effort = effort.map(|value| Tagged { value, source: format!("{} <limit effort>", joint.at) });
    let max_torque = merge.choose("max_torque", units.torque, file.max_torque, effort.as_ref());
    if max_torque.is_some_and(|m| m <= 0.0) {
        return Err(merge.fault(
            "max_torque",
            "it must be positive",
            "give the largest torque, link side, or leave it out",
        ));
    }
    Ok(Driven { drive, friction, max_torque })
}

fn drive(
    merge: &mut Merge<'_>,
    joint: &JointElement,
    file: &DriveFile,
    tags: &Tags,
    places: &Places<'_>,
    units: Units,
    spring_tables: &mut Vec<[f64; 2]>,
) -> Result<Option<DriveSpec>, Error> {
    let rotor = file.rotor.clone().unwrap_or_default();
    let inertia_tag = agreed("rotor inertia", merge.joint, &tags.rotor_inertia, rotor.inertia.is_some())?;
    // Drake's default, zero, means that there is no rotor.
    let inertia_tag = inertia_tag.filter(|t| t.value != 0.0);
    if rotor.inertia.is_none() && inertia_tag.is_none() {
        let idle = [
            ("rotor", file.rotor.is_some()),
            ("gear_ratio", file.gear_ratio.is_some()),
            ("transmission", file.transmission.is_some()),
            ("friction.motor", file.friction.motor.is_given()),
        ];
        return match idle.into_iter().find(|(_, given)| *given) {
            None => Ok(None),
            Some((key, _)) => {
                let problem = "a drive needs the inertia of its rotor, and neither this file nor the URDF gives it";
                Err(merge.fault(key, problem, "add `rotor: {inertia: …}`, motor side, in kg m²"))
            }
        };
    }
    let overruled = file.override_urdf && file.gear_ratio.is_some();
    let ratio_tag = agreed("gear ratio", merge.joint, &tags.gear_ratio, overruled)?;
    if let (Some(yaml), Some(tag), false) = (file.gear_ratio, ratio_tag, overruled)
        && !same(yaml, tag.value)
    {
        let problem = format!("the gear ratio is {yaml} here, but {} at {}", tag.value, tag.source);
        let remedy = "correct the wrong one, or say `override_urdf: true` beside it if this one is meant to count";
        return Err(merge.fault("gear_ratio", problem, remedy));
    }

    let inertia = merge.choose("rotor.inertia", "kg m²", rotor.inertia, inertia_tag).unwrap_or_default();
    let body = match (rotor.mass, rotor.transverse_inertia) {
        (Some(mass), transverse) => {
            let mass = merge.given("rotor.mass", mass, "kg");
            let transverse_inertia = merge.or_default("rotor.transverse_inertia", "kg m²", transverse, 0.5 * inertia);
            Some(RotorBody { mass, transverse_inertia })
        }
        (None, Some(_)) => {
            let problem = "it has no effect without `rotor.mass`: the URDF's link already contains the rotor at rest";
            return Err(merge.fault("rotor.transverse_inertia", problem, "give `rotor.mass` too, or take it out"));
        }
        (None, None) => None,
    };
    let mount = mount::place(merge, joint, rotor.mount.as_ref(), places)?;
    let gear_ratio = match merge.choose("gear_ratio", units.ratio, file.gear_ratio, ratio_tag) {
        Some(ratio) => ratio,
        None => merge.or_default("gear_ratio", units.ratio, None, 1.0),
    };
    let transmission = match &file.transmission {
        None => {
            merge.row("transmission", "rigid", "", "default");
            TransmissionSpec::Rigid
        }
        Some(TransmissionFile::Rigid) => {
            let source = merge.at("transmission");
            merge.row("transmission", "rigid", "", source);
            TransmissionSpec::Rigid
        }
        Some(TransmissionFile::Elastic(file)) => elastic(merge, file, units, spring_tables)?,
    };
    let friction = shaft(merge, "friction.motor", &file.friction.motor, [None, None], TURNING)?;
    Ok(Some(DriveSpec { rotor: RotorSpec { inertia, body, mount }, gear_ratio, transmission, friction }))
}

fn elastic(
    merge: &mut Merge<'_>,
    file: &ElasticFile,
    units: Units,
    spring_tables: &mut Vec<[f64; 2]>,
) -> Result<TransmissionSpec, Error> {
    let spring = match (file.stiffness, &file.table) {
        (Some(stiffness), None) => SpringSpec::Polynomial {
            stiffness: merge.given("transmission.stiffness", stiffness, units.stiffness),
            cubic: merge.or_default("transmission.cubic", units.cubic, file.cubic, 0.0),
        },
        (None, Some(points)) => {
            if file.cubic.is_some() {
                return Err(merge.fault("transmission.cubic", "it has no effect beside `table`", "take it out"));
            }
            let source = merge.at("transmission.table");
            merge.row("transmission.table", format!("{} points", points.len()), "", source);
            let first = spring_tables.len();
            spring_tables.extend(points);
            SpringSpec::Table { first, len: points.len() }
        }
        (Some(_), Some(_)) => {
            let problem = "`stiffness` and `table` both give the law of the spring";
            return Err(merge.fault("transmission.table", problem, "keep one of the two"));
        }
        (None, None) => {
            let problem = "an elastic transmission needs its `stiffness` or a `table`";
            return Err(merge.fault(
                "transmission",
                problem,
                "add `stiffness`, link side, or write `transmission: rigid`",
            ));
        }
    };
    let damping = merge.or_default("transmission.damping", units.viscous, file.damping, 0.0);
    let error = match &file.error {
        None => TransmissionError { amplitude: 0.0, cycles_per_rotor_turn: 0.0, phase: 0.0 },
        Some(e) => TransmissionError {
            amplitude: merge.given("transmission.error.amplitude", e.amplitude, units.angle),
            cycles_per_rotor_turn: merge.given("transmission.error.cycles_per_rotor_turn", e.cycles_per_rotor_turn, ""),
            phase: merge.given("transmission.error.phase", e.phase, "rad"),
        },
    };
    Ok(TransmissionSpec::Elastic { spring, damping, error })
}

/// Friction of one shaft, quantity by quantity. Rows appear for what is given only.
fn shaft(
    merge: &mut Merge<'_>,
    side: &str,
    file: &ShaftFile,
    [damping, friction]: [Option<Tagged>; 2],
    units: Units,
) -> Result<Friction<f64>, Error> {
    let none = Friction::<f64>::none();
    let key = |name: &str| format!("{side}.{name}");
    let viscous = merge.choose(&key("viscous"), units.viscous, file.viscous, damping.as_ref()).unwrap_or(0.0);
    let coulomb = merge.choose(&key("coulomb"), units.torque, file.coulomb, friction.as_ref()).unwrap_or(0.0);
    let stribeck = file.stribeck.map_or(0.0, |s| merge.given(&key("stribeck"), s, units.torque));
    let dry = coulomb != 0.0 || stribeck != 0.0;
    let dry_given = dry || file.coulomb.is_some() || file.stribeck.is_some();
    let mut velocity = |name: &str, given: Option<f64>, default: f64, possible: bool, used: bool| match given {
        Some(_) if !possible => {
            let problem = "it has no effect without the torque it belongs to";
            Err(merge.fault(&key(name), problem, "give `coulomb` or `stribeck` too, or take it out"))
        }
        None if !used => Ok(default),
        given => Ok(merge.or_default(&key(name), units.velocity, given, default)),
    };
    let smoothing = velocity("smoothing_velocity", file.smoothing_velocity, none.smoothing_velocity, dry_given, dry)?;
    let fades = stribeck != 0.0;
    let stribeck_given = file.stribeck.is_some();
    let fading = velocity("stribeck_velocity", file.stribeck_velocity, none.stribeck_velocity, stribeck_given, fades)?;
    Ok(Friction::coulomb(viscous, coulomb, smoothing).with_stribeck(stribeck, fading))
}

impl ShaftFile {
    fn is_given(&self) -> bool {
        let all = [self.viscous, self.coulomb, self.smoothing_velocity, self.stribeck, self.stribeck_velocity];
        all.iter().any(Option::is_some)
    }
}
