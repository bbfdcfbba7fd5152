//! From a scenario's words to the references of all joints.

use super::{Ends, References, SmoothSpline, Trajectory, csv, shaping};
use crate::coordinates::Coordinates;
use crate::error::{Error, Warning};
use crate::robot::Robot;
use crate::scenario::{JointReference, ScenarioFile, SineTerm, fault};
use gyroflex::control::reference::{MinimumTime, PointToPoint, Step};

impl References {
    /// The references of a scenario. `robot` has the scenario's gravity and model; `initial_q` holds the positions the scenario starts
    /// from where it gives any.
    ///
    /// # Errors
    /// Unknown joints, joints with two references, CSV files that cannot be used, and modes for the shaper that are not there.
    pub fn of(
        file: &ScenarioFile,
        robot: &Robot,
        joints: &Coordinates,
        initial_q: &[Option<f64>],
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, Error> {
        let plain = Self::new(trajectories(file, joints, initial_q, warnings)?);
        let shaper = shaping::shaper(file, robot, joints, &plain)?;
        Ok(plain.with_shaper(shaper))
    }
}

/// One trajectory per joint in coordinate order.
fn trajectories(
    file: &ScenarioFile,
    joints: &Coordinates,
    initial_q: &[Option<f64>],
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Trajectory>, Error> {
    let (references, keys) = (&file.scenario.reference, &file.keys);
    let default = references.joints.get("default");
    let mut named = vec![None; joints.len()];
    for (name, reference) in references.joints.iter().filter(|(name, _)| *name != "default") {
        named[joints.find(name, keys, &format!("reference.{name}"))?] = Some(reference);
    }
    let mut splines = match (&file.csv, &references.csv) {
        (Some(source), _) => csv::read(source, joints, references.degree.unwrap_or(3))?,
        (None, Some(name)) => {
            let problem = format!("the file `{name}` was not read with the scenario");
            return Err(fault(keys, "reference.csv", problem, "load the scenario from its file"));
        }
        (None, None) => vec![None; joints.len()],
    };
    let mut out = Vec::with_capacity(joints.len());
    for (i, joint) in joints.joints.iter().enumerate() {
        let start = initial_q.get(i).copied().flatten().unwrap_or(0.0);
        out.push(match (splines[i].take(), named[i]) {
            (Some(_), Some(_)) => {
                let problem = "the CSV file has a column for this joint too";
                return Err(fault(keys, &format!("reference.{}", joint.name), problem, "remove one of the two"));
            }
            (Some(column), None) => {
                let (first, last) = column.span;
                let duration = file.scenario.duration;
                if first > 0.0 || last < duration {
                    warnings.push(Warning {
                        file: keys.locate("reference.csv"),
                        element: format!("reference.csv, column `{}`", joint.name),
                        message: format!("covers {first} s to {last} s of 0 s to {duration} s; it holds outside"),
                    });
                }
                column.trajectory
            }
            (None, named) => match named.or(default) {
                None => Trajectory::Hold(start),
                Some(reference) => trajectory(reference, start).ok_or_else(|| {
                    let problem = format!("no motion of joint `{}` can be made of these numbers", joint.name);
                    fault(
                        keys,
                        &format!("reference.{}", joint.name),
                        problem,
                        "`gyroflex schema scenario` has their ranges",
                    )
                })?,
            },
        });
    }
    Ok(out)
}

/// `None` if the numbers are out of their ranges, which the scenario's validation finds first.
fn trajectory(reference: &JointReference, start: f64) -> Option<Trajectory> {
    Some(match reference {
        JointReference::Hold { at } => Trajectory::Hold(at.unwrap_or(start)),
        &JointReference::Sine { amplitude, frequency, phase, offset } => {
            Trajectory::Sines { offset, terms: vec![SineTerm { amplitude, frequency, phase }] }
        }
        JointReference::Sines { offset, terms } => Trajectory::Sines { offset: *offset, terms: terms.clone() },
        &JointReference::Zhao { amplitude, omega, offset } => Trajectory::Zhao { offset, amplitude, omega },
        &JointReference::Quintic { from, to, start, duration } => {
            Trajectory::Polynomial(PointToPoint::new(from, to, start, duration, 2)?)
        }
        &JointReference::Polynomial { from, to, start, duration, order } => {
            Trajectory::Polynomial(PointToPoint::new(from, to, start, duration, order)?)
        }
        &JointReference::FilteredStep { from, to, start, order, cutoff } => {
            Trajectory::FilteredStep { from, step: Step { time: start, to }, order, cutoff }
        }
        JointReference::MinimumTime { from, to, start, limits } => {
            Trajectory::MinimumTime(Box::new(MinimumTime::new(*from, *to, *start, limits)?))
        }
        JointReference::Waypoints { times, positions, degree } => {
            Trajectory::SmoothSpline(SmoothSpline::new(times, positions, *degree, Ends::Rest)?)
        }
    })
}
