//! The robot and the pose that the commands about linear models are told.

use super::load;
use crate::args::Pose;
use crate::failure::{Failure, say};
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::linearize::{KeptFriction, Linearizer, OperatingPoint};

/// Entries of a floating root in `q`.
const ROOT: usize = 7;

/// The robot, ready to be linearized.
pub fn linearizer(pose: &Pose, quiet: bool) -> Result<Linearizer, Failure> {
    let robot = load(&pose.robot, pose.floating, &pose.set, quiet)?;
    let fidelity = pose.model.map_or(robot.fidelity, Into::into);
    let linearizer = Linearizer::new(&robot, fidelity, pose.friction.into())?;
    warn_of_dry_friction(&linearizer, pose.friction.into(), quiet);
    Ok(linearizer)
}

/// Says which joints dry friction holds, at standstill.
fn warn_of_dry_friction(linearizer: &Linearizer, kept: KeptFriction, quiet: bool) {
    let stuck = kept.dry_joints(linearizer.robot());
    if !(stuck.is_empty() || quiet) {
        say(&format!(
            "warning: dry friction all but locks {} at standstill; `--friction viscous` shows the robot as it is in motion",
            stuck.join(", ")
        ));
    }
}

/// The equilibrium at the pose given, and a warning if a floating robot has none.
pub fn equilibrium(linearizer: &mut Linearizer, pose: &Pose, quiet: bool) -> Result<OperatingPoint, Failure> {
    let q = positions(linearizer, pose)?;
    let point = linearizer.equilibrium_at(&q)?;
    let wrench = point.root_wrench(linearizer.layout().floating());
    if wrench > 1e-9 && !quiet {
        say(&format!(
            "warning: nothing holds a floating root: its weight, up to {wrench:.4} N or N m, is taken to be held by a constant wrench \
             in the root's own axes"
        ));
    }
    Ok(point)
}

/// `--q` as the algorithms take it.
pub fn positions(linearizer: &Linearizer, pose: &Pose) -> Result<Vec<f64>, Error> {
    let mut q = linearizer.zero_position();
    let Some(text) = &pose.q else { return Ok(q) };
    let root = if linearizer.layout().floating() { ROOT } else { 0 };
    match values(linearizer, "--q", text)? {
        Values::All(list) if [q.len(), q.len() + linearizer.layout().modes()].contains(&list.len()) => q = list,
        Values::All(list) => {
            let all = joint_count(linearizer, "--q", list.len())?;
            q[root..root + all].copy_from_slice(&list);
        }
        Values::Named(list) => list.into_iter().for_each(|(joint, value)| q[root + joint] = value),
    }
    Ok(q)
}

/// `--tau`, one entry a velocity coordinate.
pub fn torques(linearizer: &Linearizer, text: &str) -> Result<Vec<f64>, Error> {
    let layout = linearizer.layout();
    let mut tau = vec![0.0; layout.nv()];
    match values(linearizer, "--tau", text)? {
        Values::All(list) => {
            joint_count(linearizer, "--tau", list.len())?;
            layout.inputs().iter().zip(list).for_each(|(k, value)| tau[*k] = value);
        }
        Values::Named(list) => list.into_iter().for_each(|(joint, value)| tau[layout.inputs()[joint]] = value),
    }
    Ok(tau)
}

/// A list as the user writes it.
enum Values {
    /// One number after the other.
    All(Vec<f64>),
    /// Numbers of joints, by their place among the joints.
    Named(Vec<(usize, f64)>),
}

fn values(linearizer: &Linearizer, option: &str, text: &str) -> Result<Values, Error> {
    let number = |text: &str| match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(fault(
            option,
            format!("`{}` is not a number", text.trim()),
            "write `0,0.5,-1` or `joint2=0.5,joint3=-1`".to_owned(),
        )),
    };
    let parts: Vec<&str> = text.split(',').collect();
    if !text.contains('=') {
        return parts.into_iter().map(number).collect::<Result<_, _>>().map(Values::All);
    }
    let layout = linearizer.layout();
    let mut named: Vec<(usize, f64)> = Vec::new();
    for part in parts {
        let Some((name, value)) = part.split_once('=') else {
            let remedy = "name every joint, or none".to_owned();
            return Err(fault(option, format!("`{part}` has no name, but others have"), remedy));
        };
        let k = layout.find(name.trim()).map_err(|e| Error { element: option.to_owned(), ..e })?;
        let joint = layout.inputs().iter().position(|i| *i == k).unwrap_or(0);
        if named.iter().any(|(j, _)| *j == joint) {
            return Err(fault(option, format!("joint `{}` is given twice", name.trim()), "give it once".to_owned()));
        }
        named.push((joint, number(value)?));
    }
    Ok(Values::Named(named))
}

/// Refuses a list that is not one number a joint.
fn joint_count(linearizer: &Linearizer, option: &str, given: usize) -> Result<usize, Error> {
    let layout = linearizer.layout();
    let names: Vec<&str> = layout.inputs().iter().map(|k| layout.joint(*k)).collect();
    if given == names.len() {
        return Ok(given);
    }
    let problem = format!("{given} numbers are given, but the robot has {} joints", names.len());
    Err(fault(
        option,
        problem,
        format!(
            "give one a joint, in this order: {}; or name them, `{}=0.5`",
            names.join(", "),
            names.first().unwrap_or(&"joint")
        ),
    ))
}

fn fault(option: &str, problem: String, remedy: String) -> Error {
    Error { kind: ErrorKind::Shape, file: String::new(), element: option.to_owned(), problem, remedy }
}
