//! One instant of a run, and the check every recorder makes before it takes one.

use super::RunInfo;
use super::columns::{PER_JOINT, PER_MODE, WHOLE};
use crate::bending::Tip;
use crate::error::{Error, ErrorKind};
use gyroflex::spatial::Transform;

/// One instant. Vectors run over [`RunInfo::joints`]; torques and motor positions are reflected to the link side.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// Simulated time [s].
    pub t: f64,
    /// Pose of a floating root `x y z qx qy qz qw` in the world.
    pub base_pose: Option<[f64; 7]>,
    /// Twist of a floating root in its own frame, angular part first.
    pub base_twist: Option<[f64; 6]>,
    /// Link positions [rad or m].
    pub q: Vec<f64>,
    /// Link velocities.
    pub qd: Vec<f64>,
    /// Link accelerations.
    pub qdd: Vec<f64>,
    /// Reflected motor positions `θ` [rad or m]; `q` where there is no elastic transmission.
    pub theta: Vec<f64>,
    /// Reflected motor velocities.
    pub thetad: Vec<f64>,
    /// Reflected motor accelerations.
    pub thetadd: Vec<f64>,
    /// Transmission deflection `δ` [rad or m].
    pub deflection: Vec<f64>,
    /// Torque through the transmission `τ_J` [N m or N].
    pub tau_j: Vec<f64>,
    /// Motor torque `τ` [N m or N].
    pub tau: Vec<f64>,
    /// Torque on each link joint that the rotors' coupling causes, `S θ̈ + C₁ θ̇` [N m or N].
    pub gyroscopic: Vec<f64>,
    /// Friction on both sides, reflected [N m or N].
    pub friction: Vec<f64>,
    /// Reference position [rad or m].
    pub reference: Vec<f64>,
    /// Reference minus link position [rad or m].
    pub tracking_error: Vec<f64>,
    /// Kinetic energy of links and rotors [J].
    pub kinetic_energy: f64,
    /// Potential energy of gravity [J].
    pub gravity_energy: f64,
    /// Energy stored in the transmissions [J].
    pub elastic_energy: f64,
    /// Power put in by the motors and external loads [W].
    pub power_in: f64,
    /// Power lost in friction and damping [W], ≥ 0.
    pub dissipation: f64,
    /// Significance ratio `r_s` of the gyroscopic coupling (Zhao et al. 2015, eq. 12); NaN-free: zero at rest.
    pub significance: f64,
    /// Pose of every link frame relative to its parent frame, in the order of [`RunInfo::frames`].
    pub frames: Vec<Transform<f64>>,
    /// What holds the robot; only where something beside its joints does.
    pub footing: Option<Footing>,
    /// Modal coordinates of links that bend, in the order of [`RunInfo::modes`] [m, in torsion rad].
    pub eta: Vec<f64>,
    /// Their rates.
    pub etad: Vec<f64>,
    /// Their accelerations.
    pub etadd: Vec<f64>,
    /// Deflections of the tips of links that bend, in the order of [`RunInfo::tips`].
    pub tips: Vec<Tip>,
}

/// What holds a robot beside its joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Footing {
    /// One entry per contact point, in the order of [`RunInfo::contacts`].
    pub contacts: Vec<Touch>,
    /// Centre of mass of the whole robot in the world [m].
    pub center_of_mass: [f64; 3],
    /// Point of the ground about which its forces have no moment along the ground, ahead and to the left [m]; below the centre of mass where
    /// the ground carries nothing.
    pub zero_moment_point: [f64; 2],
    /// Largest error of position of all that is held so far [m or rad].
    pub drift: f64,
}

/// One contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Touch {
    /// Force of the ground on it, world axes [N].
    pub force: [f64; 3],
    /// Height above the ground [m].
    pub gap: f64,
    /// 0 off the ground, 1 held by it, 2 slipping on it.
    pub mode: f64,
}

/// An impact of contact points with the ground. It takes no time: positions stay, velocities jump.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impact {
    /// When [s].
    pub t: f64,
    /// The points that took part, those that were on the ground already among them.
    pub struck: Vec<Struck>,
    /// Kinetic energy before less that after [J].
    pub energy_lost: f64,
}

/// A point that takes part in an impact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Struck {
    /// Its index in [`RunInfo::contacts`].
    pub contact: usize,
    /// Impulse of the ground on it, world axes [N s].
    pub impulse: [f64; 3],
    /// Its velocity before, world axes [m/s].
    pub before: [f64; 3],
    /// Its velocity after, world axes [m/s].
    pub after: [f64; 3],
}

impl Impact {
    /// Checks the impact against the run it belongs to, as [`Sample::check`] does a sample.
    ///
    /// # Errors
    /// Names what does not fit, and the time.
    pub fn check(&self, info: &RunInfo, previous: Option<f64>) -> Result<(), Error> {
        check_time(self.t, previous)?;
        if self.struck.iter().any(|struck| struck.contact >= info.contacts.len()) {
            return Err(shape("contacts", format!("an impact at t = {} s is of a point that the run has not", self.t)));
        }
        let all = self.struck.iter().flat_map(|s| s.impulse.into_iter().chain(s.before).chain(s.after));
        finite(self.t, format_args!("an impact"), &all.chain([self.energy_lost]).collect::<Vec<_>>())
    }
}

impl Footing {
    /// All its numbers in the order of the columns.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        let contacts = self.contacts.iter().flat_map(|c| c.force.into_iter().chain([c.gap, c.mode]));
        contacts.chain(self.center_of_mass).chain(self.zero_moment_point).chain([self.drift])
    }
}

/// ROS 2 counts seconds in an `int32`.
const LAST_TIME: f64 = i32::MAX as f64;

impl Sample {
    /// Checks the sample against the run it belongs to: lengths, finite numbers, and a time that does not run back
    /// behind `previous` [s].
    ///
    /// # Errors
    /// Names the quantity, the joint and the time.
    pub fn check(&self, info: &RunInfo, previous: Option<f64>) -> Result<(), Error> {
        check_time(self.t, previous)?;
        for quantity in PER_JOINT {
            let values = (quantity.get)(self);
            if values.len() != info.joints.len() {
                let problem = format!("{} values for {} joints", values.len(), info.joints.len());
                return Err(shape(quantity.key, problem));
            }
            for (joint, &value) in info.joints.iter().zip(values) {
                self.finite(format_args!("{} of joint `{joint}`", quantity.key), &[value])?;
            }
        }
        for quantity in PER_MODE {
            let values = (quantity.get)(self);
            if values.len() != info.modes.len() {
                return Err(shape(quantity.key, format!("{} values for {} modes", values.len(), info.modes.len())));
            }
            for (mode, &value) in info.modes.iter().zip(values) {
                self.finite(format_args!("{} of mode `{mode}`", quantity.key), &[value])?;
            }
        }
        if self.tips.len() != info.tips.len() {
            return Err(shape("tip", format!("{} deflections for {} links", self.tips.len(), info.tips.len())));
        }
        for (link, tip) in info.tips.iter().zip(&self.tips) {
            self.finite(format_args!("deflection of link `{link}`"), &[tip.displacement, tip.rotation].concat())?;
        }
        for quantity in WHOLE {
            self.finite(format_args!("{}", quantity.key), &[(quantity.get)(self)])?;
        }
        if self.base_pose.is_some() != info.floating || self.base_twist.is_some() != info.floating {
            return Err(shape("base", "a floating root, and no other, has a pose and a twist".to_owned()));
        }
        self.finite(format_args!("pose of the floating root"), &self.base_pose.unwrap_or_default())?;
        self.finite(format_args!("twist of the floating root"), &self.base_twist.unwrap_or_default())?;
        let footing = self.footing.as_ref();
        if footing.is_some() != info.held || footing.is_some_and(|f| f.contacts.len() != info.contacts.len()) {
            return Err(shape("contacts", "a robot that something holds, and no other, has them all".to_owned()));
        }
        if let Some(footing) = footing {
            self.finite(format_args!("what holds the robot"), &footing.numbers().collect::<Vec<_>>())?;
        }
        if self.frames.len() != info.frames.len() {
            return Err(shape("frames", format!("{} poses for {} links", self.frames.len(), info.frames.len())));
        }
        for ((link, _), frame) in info.frames.iter().zip(&self.frames) {
            let [a, b, c] = frame.rot.rows;
            for v in [frame.pos, a, b, c] {
                self.finite(format_args!("pose of link `{link}`"), &[v.x, v.y, v.z])?;
            }
        }
        Ok(())
    }

    fn finite(&self, what: std::fmt::Arguments<'_>, values: &[f64]) -> Result<(), Error> {
        finite(self.t, what, values)
    }
}

fn finite(t: f64, what: std::fmt::Arguments<'_>, values: &[f64]) -> Result<(), Error> {
    match values.iter().find(|v| !v.is_finite()) {
        None => Ok(()),
        Some(value) => Err(Error {
            kind: ErrorKind::Diverged,
            file: String::new(),
            element: what.to_string(),
            problem: format!("is {value} at t = {t} s"),
            remedy: "the record holds the run up to here; use a smaller step or a stiff integrator".to_owned(),
        }),
    }
}

fn check_time(t: f64, previous: Option<f64>) -> Result<(), Error> {
    if !(0.0..LAST_TIME).contains(&t) {
        return Err(shape("time", format!("{t} s is not a time a log can hold")));
    }
    match previous.filter(|&p| p > t) {
        Some(previous) => Err(shape("time", format!("runs back from {previous} s to {t} s"))),
        None => Ok(()),
    }
}

fn shape(element: &str, problem: String) -> Error {
    let (file, remedy) =
        (String::new(), "give every sample the joints and links of its run, in order of time".to_owned());
    Error { kind: ErrorKind::Shape, file, element: element.to_owned(), problem, remedy }
}
