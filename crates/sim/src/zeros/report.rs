//! Whether an inverse of a robot can be run, over poses within the limits of its joints.

use super::{InverseOutput, Zero, fault, zeros};
use crate::analyze::{Options, motions, ranges};
use crate::error::{Error, ErrorKind};
use crate::linearize::{KeptFriction, Linearizer};
use crate::robot::Robot;

/// A real part below this, as part of the fastest zero of a pose, is rounding.
const ROUNDING: f64 = 1e-9;

/// What becomes of the internal dynamics of an inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// They fade at every pose looked at, or there are none.
    Stable,
    /// Some do not fade: for the links' motion a transmission without damping, whose inverse has no state but needs more derivatives of the
    /// motion; for the motors' motion a link that goes on swinging.
    Undamped,
    /// Some grow at some pose: there the inverse can be run for moments only.
    Unstable,
}

/// A zero and where it is met.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct AtPose {
    /// The zero.
    pub zero: Zero,
    /// Link positions, `nq` entries.
    pub q: Vec<f64>,
}

/// The zeros of one joint with an elastic transmission.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct JointZeros {
    /// Name of the joint.
    pub joint: String,
    /// Damping `D` of its transmission [N m s/rad].
    pub damping: f64,
    /// That of the largest real part; `None` where no zero is the joint's.
    pub slowest: Option<AtPose>,
    /// That of the largest size.
    pub fastest: Option<AtPose>,
}

/// The internal dynamics of an inverse over sampled poses.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct InverseStability {
    /// What the inverse is given.
    pub output: InverseOutput,
    /// Number of poses looked at.
    pub poses: usize,
    /// The zero of the largest real part: `−1/Re s` is how long the inverse remembers [s]. `None` without internal dynamics.
    pub slowest: Option<AtPose>,
    /// The zero of the largest size: what a step of the inverse has to follow.
    pub fastest: Option<AtPose>,
    /// The joints with an elastic transmission, in coordinate order.
    pub joints: Vec<JointZeros>,
    /// What becomes of them.
    pub verdict: Verdict,
    /// Whether they are those of links that bend.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub bends: bool,
    /// The joint, and where it depends on it the pose, that the verdict is due to.
    pub reason: String,
}

impl InverseStability {
    /// For a robot in its own model at rest at `poses` quasi-random poses within its joints' limits (the same ones every time), without
    /// dry friction.
    ///
    /// # Errors
    /// No pose at all, a floating root, and a robot whose accelerations are not finite.
    pub fn of(robot: &Robot, output: InverseOutput, poses: usize) -> Result<Self, Error> {
        if poses == 0 {
            return Err(fault("poses", "there must be at least one", "give a number of at least 1"));
        }
        let mut linearizer = Linearizer::new(robot, robot.fidelity, KeptFriction::Viscous)?;
        let options = Options { samples: poses, ..Options::default() };
        let mut all: Vec<(AtPose, f64)> = Vec::new();
        for motion in motions(robot, &ranges(robot, &options), &options) {
            let at = |e: Error| Error { problem: format!("at q = {:?}: {}", motion.q, e.problem), ..e };
            let here = zeros(&mut linearizer, &motion.q, output).map_err(at)?;
            let fastest = here.iter().map(Zero::size).fold(0.0, f64::max);
            all.extend(here.into_iter().map(|zero| (AtPose { zero, q: motion.q.clone() }, ROUNDING * fastest)));
        }
        if all.iter().any(|(at, _)| !at.zero.size().is_finite()) {
            let problem = "its internal dynamics are not finite";
            let error = fault("robot", problem, "check inertias, stiffnesses and the size of the numbers given");
            return Err(Error { kind: ErrorKind::Diverged, ..error });
        }
        let layout = linearizer.layout().clone();
        let model = linearizer.dynamics.model();
        let joints = layout.elastic().iter().map(|&k| {
            let joint = layout.joint(k).to_owned();
            let body = model.bodies().iter().find(|b| b.v_index() == k);
            let damping = body.and_then(|b| b.drive?.elastic).map_or(0.0, |e| e.damping);
            let own = || all.iter().map(|(at, _)| at).filter(|at| at.zero.joint == joint);
            JointZeros { slowest: slowest(own()), fastest: fastest(own()), joint, damping }
        });
        let joints: Vec<JointZeros> = joints.collect();
        let bends = layout.modes() > 0;
        let (verdict, reason) = if bends { judge_modes(&all) } else { judge(output, &all, &joints) };
        let every = || all.iter().map(|(at, _)| at);
        Ok(Self { output, poses, slowest: slowest(every()), fastest: fastest(every()), joints, verdict, bends, reason })
    }
}

fn slowest<'a>(all: impl Iterator<Item = &'a AtPose>) -> Option<AtPose> {
    all.max_by(|a, b| a.zero.value[0].total_cmp(&b.zero.value[0])).cloned()
}

fn fastest<'a>(all: impl Iterator<Item = &'a AtPose>) -> Option<AtPose> {
    all.max_by(|a, b| a.zero.size().total_cmp(&b.zero.size())).cloned()
}

/// The verdict on links that bend while their joints are on their way.
fn judge_modes(all: &[(AtPose, f64)]) -> (Verdict, String) {
    let Some(AtPose { zero, q }) = slowest(all.iter().map(|(at, _)| at)) else {
        return (Verdict::Stable, "there are no internal dynamics".to_owned());
    };
    let (rate, rounding) = (zero.value[0], all.iter().map(|(_, rounding)| *rounding).fold(0.0, f64::max));
    match rate {
        _ if rate > rounding => (
            Verdict::Unstable,
            format!(
                "mode `{}` falls away with {rate:.3e} 1/s at q = {q:?}: gravity beats the link's stiffness",
                zero.joint
            ),
        ),
        _ if rate >= -rounding => {
            (Verdict::Undamped, format!("mode `{}` swings on without damping, at q = {q:?}", zero.joint))
        }
        _ => (Verdict::Stable, format!("the slowest fades with {:.3e} 1/s, mode `{}`, q = {q:?}", -rate, zero.joint)),
    }
}

/// The verdict and its reason; every zero comes with what is rounding beside it.
fn judge(output: InverseOutput, all: &[(AtPose, f64)], joints: &[JointZeros]) -> (Verdict, String) {
    let beyond = |(at, rounding): &&(AtPose, f64)| at.zero.value[0] > *rounding;
    let within = |(at, rounding): &&(AtPose, f64)| at.zero.value[0].abs() <= *rounding;
    let unstable = slowest(all.iter().filter(beyond).map(|(at, _)| at));
    if let Some(AtPose { zero, q }) = unstable {
        let rate = zero.value[0];
        let reason =
            format!("joint `{}` falls away with {rate:.3e} 1/s at q = {q:?}: gravity beats its spring", zero.joint);
        return (Verdict::Unstable, reason);
    }
    if let (InverseOutput::Link, Some(free)) = (output, joints.iter().find(|j| j.damping == 0.0)) {
        let reason = format!(
            "the transmission of joint `{}` has no damping: no state of the inverse, but more derivatives of the motion",
            free.joint
        );
        return (Verdict::Undamped, reason);
    }
    if let Some((AtPose { zero, q }, _)) = all.iter().find(within) {
        let reason = format!("joint `{}` does not come to rest with its motor held, at q = {q:?}", zero.joint);
        return (Verdict::Undamped, reason);
    }
    match slowest(all.iter().map(|(at, _)| at)) {
        None => (Verdict::Stable, "there are no internal dynamics: no transmission gives".to_owned()),
        Some(AtPose { zero, q }) => {
            let rate = -zero.value[0];
            (Verdict::Stable, format!("the slowest fades with {rate:.3e} 1/s, at joint `{}`, q = {q:?}", zero.joint))
        }
    }
}
