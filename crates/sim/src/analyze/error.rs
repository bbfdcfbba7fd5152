//! The torque error of the reduced model, instant by instant.

use super::report::{JointReport, Report, Side, SignificanceRange};
use super::{Motion, Options, bounds, significance};
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::{Error, ErrorKind};
use crate::robot::Robot;
use gyroflex::dynamics::{Acceleration, External, Inverse, State};
use gyroflex::model::Fidelity;

/// Sums over the instants for one torque of one joint.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    peak: f64,
    squares: f64,
    error_max: f64,
    error_squares: f64,
}

impl Tally {
    fn add(&mut self, torque: f64, error: f64) {
        self.peak = self.peak.max(torque.abs());
        self.squares += torque * torque;
        self.error_max = self.error_max.max(error.abs());
        self.error_squares += error * error;
    }

    fn side(&self, samples: f64) -> Side {
        let error_rms = (self.error_squares / samples).sqrt();
        // A joint that carries nothing has no error to speak of, or nothing but error.
        let whole = self.peak.max(self.error_max);
        let percent = |x: f64| if whole > 0.0 { 100.0 * x / whole } else { 0.0 };
        Side {
            peak: self.peak,
            rms: (self.squares / samples).sqrt(),
            error_max: self.error_max,
            error_rms,
            error_max_percent: percent(self.error_max),
            error_rms_percent: percent(error_rms),
        }
    }
}

/// Compares the two models along the motions.
pub(super) fn compare(robot: &Robot, motions: &[Motion], options: &Options) -> Result<Report, Error> {
    robot.refuse_bending("the comparison of models", crate::bending::RIGID)?;
    let mut complete = Dynamics::new(robot.model(Fidelity::Complete)?);
    let mut reduced = Dynamics::new(robot.model(Fidelity::Reduced)?);
    let coordinates = Coordinates::of(robot);
    let (n, nv) = (coordinates.len(), complete.nv());
    let mut tallies = vec![[Tally::default(); 2]; n];
    let mut speeds = vec![0.0_f64; n];
    let mut range = SignificanceRange::default();
    let mut ours = [vec![0.0; nv], vec![0.0; nv]];
    let mut theirs = ours.clone();
    for motion in motions {
        inverse(&mut complete, motion, &mut ours)?;
        inverse(&mut reduced, motion, &mut theirs)?;
        let torques = motion.torques.as_ref().unwrap_or(&ours);
        for (i, joint) in coordinates.joints.iter().enumerate() {
            let k = joint.v;
            speeds[i] = speeds[i].max(motion.qd[k].abs());
            for side in 0..2 {
                let (torque, error) = (torques[side][k], ours[side][k] - theirs[side][k]);
                if !(torque.is_finite() && error.is_finite()) {
                    return Err(not_finite(&joint.name, motion.t));
                }
                tallies[i][side].add(torque, error);
            }
        }
        widen(&mut range, &mut complete, motion)?;
    }

    let samples = (motions.len() as f64).max(1.0);
    let joints = coordinates.joints.iter().enumerate().map(|(i, joint)| {
        let [tau_j, tau] = tallies[i].map(|t| t.side(samples));
        let slides = robot.joints[joint.body].urdf_type == "prismatic";
        let mut report = JointReport {
            name: joint.name.clone(),
            slides,
            top_speed: speeds[i],
            tau_j,
            tau,
            ..JointReport::default()
        };
        // The error grows with the square of the speed.
        let share = (options.threshold / report.worst_percent()).sqrt();
        report.threshold_speed = (share < 1.0).then_some(share * speeds[i]);
        report.verdict = match report.threshold_speed {
            None => "reduced is enough".to_owned(),
            Some(speed) => format!("reduced up to {}", report.speed_text(speed)),
        };
        report
    });
    let mut report = Report {
        robot: robot.name.clone(),
        samples: motions.len(),
        threshold_percent: options.threshold,
        joints: joints.collect(),
        significance: range,
        bounds: if options.bounds { Some(bounds(robot, options)?) } else { None },
        ..Report::default()
    };
    judge(&mut report);
    if robot.bodies.iter().all(|b| b.drive.is_none()) {
        report.notes.push(
            "the robot has no drives, so there are no rotors that could matter; give them in a robot YAML".to_owned(),
        );
    }
    Ok(report)
}

/// `τ_J` and `τ` that a motion asks for.
fn inverse(dynamics: &mut Dynamics, m: &Motion, out: &mut [Vec<f64>; 2]) -> Result<(), Error> {
    let state = State { q: &m.q, qd: &m.qd, theta: &m.theta, thetad: &m.thetad };
    let [tau_j, tau] = out;
    let accel = Acceleration { qdd: &m.qdd, thetadd: &m.thetadd };
    dynamics.inverse(state, accel, External::none(), Inverse { tau_j, tau })
}

/// Takes the significance of one instant into the range.
fn widen(range: &mut SignificanceRange, complete: &mut Dynamics, motion: &Motion) -> Result<(), Error> {
    let s = significance(complete, &motion.q, Some(&motion.qd))?;
    let largest = |r: &SignificanceRange| r.r_s_max.max(-r.r_s_min);
    if range.at.is_empty() || s.r_s_max.max(-s.r_s_min) > largest(range) {
        range.at.clone_from(&motion.q);
    }
    let r_s = s.r_s.unwrap_or(0.0);
    range.r_s_lowest = range.r_s_lowest.min(r_s);
    range.r_s_highest = range.r_s_highest.max(r_s);
    range.r_s_min = range.r_s_min.min(s.r_s_min);
    range.r_s_max = range.r_s_max.max(s.r_s_max);
    range.bound_singular_values = range.bound_singular_values.max(s.bound_singular_values);
    Ok(())
}

/// The verdict over all joints: the first to pass the threshold decides.
fn judge(report: &mut Report) {
    let threshold = report.threshold_percent;
    let worst = report.joints.iter().max_by(|a, b| a.worst_percent().total_cmp(&b.worst_percent()));
    let share = worst.map_or(1.0, |j| (threshold / j.worst_percent()).sqrt().min(1.0));
    report.reduced_is_enough = share >= 1.0;
    report.enough_up_to = share;
    report.verdict = match worst {
        Some(joint) if share < 1.0 => {
            let speed = joint.speed_text(share * joint.top_speed);
            let top = joint.speed_text(joint.top_speed);
            format!(
                "the reduced model is enough (below {threshold} % of peak torque) up to {:.0} % of these speeds; {} passes first, at \
                 {speed} of {top}, and comes to {:.2} % at full speed",
                100.0 * share,
                joint.name,
                joint.worst_percent()
            )
        }
        Some(joint) => format!(
            "the reduced model is enough: its torque errors stay below {threshold} % of peak torque at all these speeds (largest {:.2} %, \
             {})",
            joint.worst_percent(),
            joint.name
        ),
        None => "the robot has no joints, so any model is enough".to_owned(),
    };
}

fn not_finite(joint: &str, t: f64) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: format!("joint `{joint}`"),
        problem: format!("its torque is not a finite number at sample {t}"),
        remedy: "check the size of the speeds and of the robot's numbers".to_owned(),
    }
}
