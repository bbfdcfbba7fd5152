//! The columns of a record: every number of a sample under a stable name, with its unit.
//!
//! | columns | names |
//! |---|---|
//! | simulated time | `time` |
//! | one a joint, grouped by quantity | `<quantity>.<joint>`, quantities as in [`Sample`]: `q`, `qd`, …, `tracking_error` |
//! | one a run | `kinetic_energy`, `gravity_energy`, `elastic_energy`, `power_in`, `dissipation`, `significance` |
//! | floating root, in the world; twist in its own frame | `base.x y z qx qy qz qw`, `base.wx wy wz vx vy vz` |
//! | each contact point, where there is ground | `contact.<point>.fx fy fz gap mode` |
//! | whole robot, where something holds it | `center_of_mass.x y z`, `zero_moment_point.x y`, `constraint_drift` |
//! | each mode of a link that bends, grouped by quantity | `eta.<mode>`, `etad.<mode>`, `etadd.<mode>` |
//! | tip of each link that bends beside the link at rest, link axes | `tip.<link>.x y z rx ry rz` |
//! | pose of each link in its parent link | `frame.<link>.x y z qx qy qz qw` |

use super::quaternion::quaternion;
use super::{RunInfo, Sample};

/// Name and unit of one column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Stable name, e.g. `tau_j.joint1`.
    pub name: String,
    /// SI unit in ASCII, e.g. `N m` or `rad/s^2`; `-` for a pure number.
    pub unit: &'static str,
}

/// A quantity each joint has.
pub(super) struct PerJoint {
    pub(super) key: &'static str,
    /// Unit of a turning and of a sliding joint.
    units: [&'static str; 2],
    pub(super) get: fn(&Sample) -> &Vec<f64>,
}

/// A quantity of the whole robot.
pub(super) struct Whole {
    pub(super) key: &'static str,
    unit: &'static str,
    pub(super) get: fn(&Sample) -> f64,
}

macro_rules! per_joint {
    ($($field:ident $units:expr),* $(,)?) => {
        &[$(PerJoint { key: stringify!($field), units: $units, get: |s| &s.$field }),*]
    };
}

macro_rules! whole {
    ($($field:ident $unit:literal),* $(,)?) => {
        &[$(Whole { key: stringify!($field), unit: $unit, get: |s| s.$field }),*]
    };
}

const POSITION: [&str; 2] = ["rad", "m"];
const VELOCITY: [&str; 2] = ["rad/s", "m/s"];
const ACCELERATION: [&str; 2] = ["rad/s^2", "m/s^2"];
const EFFORT: [&str; 2] = ["N m", "N"];

pub(super) const PER_JOINT: &[PerJoint] = per_joint![
    q POSITION,
    qd VELOCITY,
    qdd ACCELERATION,
    theta POSITION,
    thetad VELOCITY,
    thetadd ACCELERATION,
    deflection POSITION,
    tau_j EFFORT,
    tau EFFORT,
    gyroscopic EFFORT,
    friction EFFORT,
    reference POSITION,
    tracking_error POSITION,
];

pub(super) const PER_MODE: &[PerJoint] = per_joint![
    eta ["rad", "m"],
    etad VELOCITY,
    etadd ACCELERATION,
];

/// Deflection of a tip beside the link at rest, in the link's axes.
const TIP: [(&str, &str); 6] = [("x", "m"), ("y", "m"), ("z", "m"), ("rx", "rad"), ("ry", "rad"), ("rz", "rad")];

pub(super) const WHOLE: &[Whole] = whole![
    kinetic_energy "J",
    gravity_energy "J",
    elastic_energy "J",
    power_in "W",
    dissipation "W",
    significance "-",
];

const POSE: [(&str, &str); 7] =
    [("x", "m"), ("y", "m"), ("z", "m"), ("qx", "-"), ("qy", "-"), ("qz", "-"), ("qw", "-")];
const TWIST: [(&str, &str); 6] =
    [("wx", "rad/s"), ("wy", "rad/s"), ("wz", "rad/s"), ("vx", "m/s"), ("vy", "m/s"), ("vz", "m/s")];

const TOUCH: [(&str, &str); 5] = [("fx", "N"), ("fy", "N"), ("fz", "N"), ("gap", "m"), ("mode", "-")];
const FOOTING: [(&str, &str); 6] = [
    ("center_of_mass.x", "m"),
    ("center_of_mass.y", "m"),
    ("center_of_mass.z", "m"),
    ("zero_moment_point.x", "m"),
    ("zero_moment_point.y", "m"),
    ("constraint_drift", "-"),
];

/// The columns of a run, in the order of every record.
pub fn columns(info: &RunInfo) -> Vec<Column> {
    let mut columns = vec![Column { name: "time".to_owned(), unit: "s" }];
    let mut push = |name: String, unit| columns.push(Column { name, unit });
    for quantity in PER_JOINT {
        for (joint, &prismatic) in info.joints.iter().zip(&info.prismatic) {
            push(format!("{}.{joint}", quantity.key), quantity.units[usize::from(prismatic)]);
        }
    }
    for quantity in WHOLE {
        push(quantity.key.to_owned(), quantity.unit);
    }
    if info.floating {
        for (key, unit) in POSE.into_iter().chain(TWIST) {
            push(format!("base.{key}"), unit);
        }
    }
    if info.held {
        for contact in &info.contacts {
            for (key, unit) in TOUCH {
                push(format!("contact.{contact}.{key}"), unit);
            }
        }
        for (key, unit) in FOOTING {
            push(key.to_owned(), unit);
        }
    }
    for quantity in PER_MODE {
        for (mode, &turns) in info.modes.iter().zip(&info.turning) {
            push(format!("{}.{mode}", quantity.key), quantity.units[usize::from(!turns)]);
        }
    }
    for link in &info.tips {
        for (key, unit) in TIP {
            push(format!("tip.{link}.{key}"), unit);
        }
    }
    for (link, _) in &info.frames {
        for (key, unit) in POSE {
            push(format!("frame.{link}.{key}"), unit);
        }
    }
    columns
}

/// Appends the numbers of a sample to `row`, in the order of [`columns`].
pub(super) fn row(sample: &Sample, row: &mut Vec<f64>) {
    row.push(sample.t);
    for quantity in PER_JOINT {
        row.extend_from_slice((quantity.get)(sample));
    }
    row.extend(WHOLE.iter().map(|w| (w.get)(sample)));
    row.extend(sample.base_pose.into_iter().flatten());
    row.extend(sample.base_twist.into_iter().flatten());
    row.extend(sample.footing.iter().flat_map(|footing| footing.numbers()));
    for quantity in PER_MODE {
        row.extend_from_slice((quantity.get)(sample));
    }
    row.extend(sample.tips.iter().flat_map(|tip| tip.displacement.into_iter().chain(tip.rotation)));
    for frame in &sample.frames {
        row.extend([frame.pos.x, frame.pos.y, frame.pos.z]);
        row.extend(quaternion(frame.rotation()));
    }
}

/// Named columns of numbers, all of the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Name and unit of each column.
    pub columns: Vec<Column>,
    /// The numbers of each column, one a sample.
    pub values: Vec<Vec<f64>>,
}

impl Table {
    /// An empty table for a run.
    pub(super) fn new(info: &RunInfo) -> Self {
        let columns = columns(info);
        Self { values: vec![Vec::new(); columns.len()], columns }
    }

    /// Appends a sample.
    pub(super) fn push(&mut self, sample: &Sample) {
        let mut numbers = Vec::with_capacity(self.columns.len());
        row(sample, &mut numbers);
        for (column, number) in self.values.iter_mut().zip(numbers) {
            column.push(number);
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The column of that name.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let i = self.columns.iter().position(|c| c.name == name)?;
        Some(&self.values[i])
    }
}
