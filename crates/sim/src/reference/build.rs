//! From a scenario's words to one trajectory per joint.

use super::{Trajectory, csv};
use crate::coordinates::Coordinates;
use crate::error::{Error, Warning};
use crate::scenario::{JointReference, ScenarioFile, SineTerm, fault};

/// One trajectory per joint in coordinate order. `initial_q` holds the positions the scenario starts from where it gives any.
///
/// # Errors
/// Unknown joints, joints with two references, and CSV files that cannot be used.
pub fn references(
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
        (Some(source), _) => csv::read(source, joints)?,
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
            (Some(spline), None) => {
                let (first, last) = spline.span();
                let duration = file.scenario.duration;
                if first > 0.0 || last < duration {
                    warnings.push(Warning {
                        file: keys.locate("reference.csv"),
                        element: format!("reference.csv, column `{}`", joint.name),
                        message: format!("covers {first} s to {last} s of 0 s to {duration} s; it holds outside"),
                    });
                }
                Trajectory::Spline(spline)
            }
            (None, named) => named.or(default).map_or(Trajectory::Hold(start), |r| trajectory(r, start)),
        });
    }
    Ok(out)
}

fn trajectory(reference: &JointReference, start: f64) -> Trajectory {
    match reference {
        JointReference::Hold { at } => Trajectory::Hold(at.unwrap_or(start)),
        &JointReference::Sine { amplitude, frequency, phase, offset } => {
            Trajectory::Sines { offset, terms: vec![SineTerm { amplitude, frequency, phase }] }
        }
        JointReference::Sines { offset, terms } => Trajectory::Sines { offset: *offset, terms: terms.clone() },
        &JointReference::Zhao { amplitude, omega, offset } => Trajectory::Zhao { offset, amplitude, omega },
        &JointReference::Quintic { from, to, start, duration } => Trajectory::Quintic { from, to, start, duration },
    }
}
