//! Loads on links, gathered into one wrench per body.

use super::input::{Wrench, WrenchAxes, fault};
use crate::bending::CrossSection;
use crate::error::Error;
use crate::load::nearest::nearest;
use crate::loads::{NAME_A_FIXED_LINK, beside_the_root};
use crate::robot::Robot;
use gyroflex::spatial::{Force, Transform, Vec3};

/// Adds up the wrenches on each body, in its link frame about its origin. `poses` are those of the bodies in the
/// world; what acts on cross-sections of links that bend is added to the forces on their modes.
pub(super) fn gather(
    robot: &Robot,
    wrenches: &[Wrench],
    poses: &[Transform<f64>],
    eta: &[f64],
    out: &mut [Force<f64>],
    modal: &mut [f64],
) -> Result<(), Error> {
    out.fill(Force::zero());
    for (i, wrench) in wrenches.iter().enumerate() {
        let place = format!("wrenches[{i}].link");
        let Some(index) = robot.links.iter().position(|l| l.name == wrench.link) else {
            let remedy = match nearest(&wrench.link, robot.links.iter().map(|l| l.name.as_str())) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "leave the wrench out: the robot has no links".to_owned(),
            };
            return Err(fault(&place, format!("the robot has no link `{}`", wrench.link), remedy));
        };
        let link = &robot.links[index];
        let Some(body) = link.body else {
            let problem = format!("the link `{}` does not move, so the wrench has no effect", wrench.link);
            return Err(fault(&place, problem, "leave the wrench out, or put the root on a floating joint"));
        };
        if let Some(problem) = beside_the_root(robot, &wrench.link, wrench.point) {
            return Err(fault(&format!("wrenches[{i}].point"), problem, NAME_A_FIXED_LINK));
        }
        let section = CrossSection::of_link(robot, index);
        let carried = section.as_ref().map_or(poses[body], |section| section.pose(eta).after(poses[body]));
        let (mut torque, mut force) = (Vec3::from(wrench.torque), Vec3::from(wrench.force));
        if wrench.axes == WrenchAxes::World {
            let to_link = link.placement.after(carried).rot;
            (torque, force) = (to_link * torque, to_link * force);
        }
        // From the point of attack to the link's origin, and from there to the body's.
        let at_origin = Force { ang: torque + Vec3::from(wrench.point).cross(force), lin: force };
        let at_body = link.placement.inv_force(at_origin);
        out[body] += section.map_or(at_body, |section| section.carry(eta, at_body, modal));
    }
    Ok(())
}
