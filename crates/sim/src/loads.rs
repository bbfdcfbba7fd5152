//! External wrenches of a scenario, turned into wrenches on bodies.

use crate::bending::CrossSection;
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::load::nearest::nearest;
use crate::load::yaml::Keys;
use crate::robot::Robot;
use crate::scenario::{Wrench, WrenchFrame, fault};
use gyroflex::dynamics::External;
use gyroflex::spatial::{Force, Transform, Vec3};

/// One wrench of the scenario, on its body.
#[derive(Clone, Debug)]
struct Load {
    body: usize,
    /// Where it acts, in the body's link frame [m].
    point: Vec3<f64>,
    /// Force and couple: in the axes of the body's link frame, or of the world.
    force: Vec3<f64>,
    torque: Vec3<f64>,
    frame: WrenchFrame,
    start: f64,
    end: f64,
    active: bool,
    /// The cross-section of a link that bends that it acts on.
    section: Option<CrossSection>,
}

/// All wrenches of a scenario, and what they amount to on each body.
#[derive(Clone, Debug)]
pub struct Loads {
    loads: Vec<Load>,
    wrenches: Vec<Force<f64>>,
    placements: Vec<Transform<f64>>,
    /// Couples of the ground on bodies that a controller asks for: body, and the couple in world axes [N m].
    couple: Option<(usize, Vec3<f64>)>,
    /// Generalised forces of all coordinates, where links bend; else none.
    modal: Vec<f64>,
    /// Where those of the modes begin.
    joints: usize,
}

impl Loads {
    /// The wrenches of a scenario.
    ///
    /// # Errors
    /// Links that the robot does not have, or that do not move.
    pub fn new(wrenches: &[Wrench], robot: &Robot, keys: &Keys) -> Result<Self, Error> {
        let mut loads = Vec::with_capacity(wrenches.len());
        for (i, wrench) in wrenches.iter().enumerate() {
            let key = format!("wrenches[{i}].link");
            let Some(index) = robot.links.iter().position(|l| l.name == wrench.link) else {
                let remedy = match nearest(&wrench.link, robot.links.iter().map(|l| l.name.as_str())) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "remove it".to_owned(),
                };
                return Err(fault(keys, &key, format!("the robot has no link `{}`", wrench.link), remedy));
            };
            let link = &robot.links[index];
            let Some(body) = link.body else {
                let problem = format!("link `{}` is fixed to the world: a wrench on it does nothing", wrench.link);
                return Err(fault(keys, &key, problem, "name a link that moves, or remove the wrench"));
            };
            if let Some(problem) = beside_the_root(robot, &wrench.link, wrench.point) {
                return Err(fault(keys, &format!("wrenches[{i}].point"), problem, NAME_A_FIXED_LINK));
            }
            // Link axes become axes of the body's link frame once and for all.
            let turn = |v: [f64; 3]| match wrench.frame {
                WrenchFrame::World => Vec3::from(v),
                WrenchFrame::Link => link.placement.rotation() * Vec3::from(v),
            };
            loads.push(Load {
                body,
                point: link.placement.point(Vec3::from(wrench.point)),
                force: turn(wrench.force),
                torque: turn(wrench.torque),
                frame: wrench.frame,
                start: wrench.start,
                end: wrench.end.unwrap_or(f64::INFINITY),
                active: false,
                section: CrossSection::of_link(robot, index),
            });
        }
        let bodies = if loads.is_empty() { 0 } else { robot.bodies.len() };
        let (wrenches, placements) = (vec![Force::zero(); bodies], vec![Transform::identity(); bodies]);
        let (modes, floating) = (robot.flexible.modes(), usize::from(robot.is_floating()));
        let joints = robot.joints.len() + 5 * floating;
        let modal = if modes > 0 && !loads.is_empty() { vec![0.0; joints + modes] } else { Vec::new() };
        Ok(Self { loads, wrenches, placements, couple: None, modal, joints })
    }

    /// Whether there are none at all.
    pub fn is_empty(&self) -> bool {
        self.loads.is_empty() && self.couple.is_none()
    }

    /// A couple on a body in world axes [N m], in place of the one before; of a robot with so many bodies.
    pub fn set_couple(&mut self, couple: Option<(usize, Vec3<f64>)>, bodies: usize) {
        self.couple = couple;
        if couple.is_some() {
            self.wrenches.resize(bodies, Force::zero());
            self.placements.resize(bodies, Transform::identity());
        } else if self.loads.is_empty() {
            self.wrenches.clear();
        }
    }

    /// That couple [N m], zero without one.
    pub fn couple(&self) -> Vec3<f64> {
        self.couple.map_or(Vec3::zero(), |(_, couple)| couple)
    }

    /// Times at which a wrench starts or ends [s].
    pub fn edges(&self) -> impl Iterator<Item = f64> {
        self.loads.iter().flat_map(|l| [l.start, l.end]).filter(|t| t.is_finite())
    }

    /// Keeps the wrenches of time `t`: from their start on, up to their end.
    pub fn set_time(&mut self, t: f64) {
        for load in &mut self.loads {
            load.active = load.start <= t && t < load.end;
        }
    }

    /// Turns them to the pose `q`.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn update(&mut self, dynamics: &Dynamics, q: &[f64]) -> Result<(), Error> {
        if self.is_empty() {
            return Ok(());
        }
        dynamics.placements(q, &mut self.placements)?;
        self.wrenches.fill(Force::zero());
        if let Some((body, couple)) = self.couple {
            self.wrenches[body] += Force::couple(self.placements[body].rot * couple);
        }
        self.modal.fill(0.0);
        let eta = dynamics.eta(q);
        for load in self.loads.iter().filter(|l| l.active) {
            let carried = load.section.as_ref().map(|section| section.pose(eta));
            let turn = |v: Vec3<f64>| match load.frame {
                WrenchFrame::World => {
                    let v = self.placements[load.body].rot * v;
                    carried.map_or(v, |pose| pose.rot * v)
                }
                WrenchFrame::Link => v,
            };
            let (force, torque) = (turn(load.force), turn(load.torque));
            // About the origin of the link frame: the couple, and the moment of the force.
            let wrench = Force { ang: torque + load.point.cross(force), lin: force };
            self.wrenches[load.body] += match &load.section {
                Some(section) => section.carry(eta, wrench, &mut self.modal[self.joints..]),
                None => wrench,
            };
        }
        Ok(())
    }

    /// What they are now, for the algorithms.
    pub fn external(&self) -> External<'_, f64> {
        External { tau: &self.modal, wrenches: &self.wrenches }
    }
}

/// A wrench on a link that bends acts on its root; what is wrong with one that acts elsewhere.
pub(crate) fn beside_the_root(robot: &Robot, link: &str, point: [f64; 3]) -> Option<String> {
    let bends = robot.flexible.links.iter().any(|l| l.name == link);
    let problem = || {
        format!(
            "link `{link}` bends, and a wrench on it acts on its root, not at {point:?}: which cross-section carries it is not said"
        )
    };
    (bends && point != [0.0; 3]).then(problem)
}

/// The remedy.
pub(crate) const NAME_A_FIXED_LINK: &str =
    "name a link that a fixed joint holds to it where the wrench acts, or leave `point` out";
