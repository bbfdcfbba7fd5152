//! The simulated robot where it is not the one its controller knows.

use crate::error::{Error, ErrorKind};
use crate::load::nearest::nearest;
use crate::load::yaml::Keys;
use crate::robot::{Payload, Robot};
use crate::scenario::{Factors, Plant, fault};
use gyroflex::model::{SpringSpec, TransmissionSpec};

/// The robot with the plant's factors and load; `keys` are those of the scenario.
///
/// # Errors
/// Joints and links that the robot does not have, and factors that change nothing on it.
pub(super) fn plant(nominal: &Robot, plant: &Plant, keys: &Keys) -> Result<Robot, Error> {
    let mut robot = nominal.clone();
    if let Some(factors) = &plant.stiffness {
        let key = "plant.stiffness";
        scale(&mut robot, factors, keys, key, "elastic transmission", |robot, body, factor| {
            match elastic(robot, body) {
                Some((SpringSpec::Polynomial { stiffness, cubic }, _)) => {
                    *stiffness *= factor;
                    *cubic *= factor;
                }
                Some((&mut SpringSpec::Table { first, len }, _)) => {
                    robot.spring_tables[first..first + len].iter_mut().for_each(|point| point[1] *= factor);
                }
                None => return false,
            }
            true
        })?;
    }
    if let Some(factors) = &plant.damping {
        scale(&mut robot, factors, keys, "plant.damping", "damping of a transmission", |robot, body, factor| {
            let damping = elastic(robot, body).map(|(_, damping)| damping).filter(|d| **d > 0.0);
            damping.map(|d| *d *= factor).is_some()
        })?;
    }
    if let Some(factors) = &plant.mass {
        scale(&mut robot, factors, keys, "plant.mass", "mass", Robot::scale_mass)?;
    }
    if let Some(payload) = &plant.payload {
        let put = payload.put_on(&mut robot, keys, "plant.payload");
        put.map_err(|e| Error { kind: ErrorKind::Scenario, ..e })?;
    }
    if let Some(factor) = plant.payload_factor {
        let Some(Payload { link, inertia, .. }) = robot.payload else {
            let problem = "the robot carries no load, so that the factor changes nothing";
            return Err(fault(keys, "plant.payload_factor", problem, "give the robot a `payload`, or remove it"));
        };
        robot.set_payload(Some((link, inertia.map(|x| x * factor))));
    }
    Ok(robot)
}

/// Spring and damping of a joint's transmission, if it is elastic in the robot's model.
fn elastic(robot: &mut Robot, body: usize) -> Option<(&mut SpringSpec, &mut f64)> {
    if !robot.fidelity.is_elastic() {
        return None;
    }
    match &mut robot.bodies[body].drive.as_mut()?.transmission {
        TransmissionSpec::Elastic { spring, damping, .. } => Some((spring, damping)),
        TransmissionSpec::Rigid => None,
    }
}

/// Applies the factor of every joint. `apply` says whether the joint has `what` the factor is for.
fn scale(
    robot: &mut Robot,
    factors: &Factors,
    keys: &Keys,
    key: &str,
    what: &str,
    mut apply: impl FnMut(&mut Robot, usize, f64) -> bool,
) -> Result<(), Error> {
    let names: Vec<String> = robot.joints.iter().map(|j| j.name.clone()).collect();
    if let Factors::Named(map) = factors
        && let Some(unknown) = map.keys().find(|name| *name != "default" && !names.contains(name))
    {
        let remedy = match nearest(unknown, names.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "remove it: the robot has no joints".to_owned(),
        };
        return Err(fault(keys, &format!("{key}.{unknown}"), format!("the robot has no joint `{unknown}`"), remedy));
    }
    let idle = |key: &str, who: String| {
        let problem = format!("{who} has no {what} in this model, so that the factor changes nothing");
        Err(fault(keys, key, problem, "remove it"))
    };
    let mut any = false;
    for (body, name) in names.iter().enumerate() {
        let (factor, named) = factors.of(name);
        let has = apply(robot, body, factor);
        if named && !has {
            return idle(&format!("{key}.{name}"), format!("joint `{name}`"));
        }
        any |= has;
    }
    if any { Ok(()) } else { idle(key, "the robot".to_owned()) }
}
