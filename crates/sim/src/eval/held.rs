//! What holds the robot while a line is answered, by the names of its file, and how its forces are shared and told.

use super::input::{Distribution, Query, fault};
use super::layout::Layout;
use super::output::{Answer, HeldAnswer};
use crate::contact::{SHARED, STABILISATION, THRESHOLD, is_shared, may_share};
use crate::error::Error;
use crate::load::nearest::nearest;
use crate::robot::Robot;
use gyroflex::dynamics::{
    Anchor, Constrained, Constraint, Directions, Frame, Hold, Regularisation, Solved, TorqueDistribution,
    constraint_rows,
};
use gyroflex::spatial::{Force, Transform};

/// What forces cost beside torques: next to nothing, but enough to determine all of them.
const NEXT_TO_NOTHING: f64 = 1e-6;

/// What is held, and room for its forces.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    names: Vec<String>,
    constraints: Vec<Constraint<f64>>,
    /// Whether contacts with the ground are among them.
    stands: bool,
    multipliers: Vec<f64>,
    wrenches: Vec<Force<f64>>,
}

impl Held {
    /// What `names` say, or what always holds the robot. `poses` are those of the bodies in the world: contacts are held where they are.
    pub(super) fn of(robot: &Robot, names: Option<&[String]>, poses: &[Transform<f64>]) -> Result<Self, Error> {
        let mut held = Self::default();
        match names {
            None => robot.held.iter().for_each(|part| held.add(&part.name, part.hold, part.stabilisation)),
            Some(names) => {
                for (i, name) in names.iter().enumerate() {
                    held.add_by_name(robot, i, name, poses)?;
                }
            }
        }
        held.multipliers = vec![0.0; constraint_rows(&held.constraints)];
        held.wrenches = vec![Force::zero(); held.constraints.len()];
        Ok(held)
    }

    fn add_by_name(&mut self, robot: &Robot, i: usize, name: &str, poses: &[Transform<f64>]) -> Result<(), Error> {
        let place = format!("held[{i}]");
        if self.names.iter().any(|known| known == name) {
            return Err(fault(&place, format!("`{name}` is named twice"), "name it once"));
        }
        if let Some(part) = robot.held.iter().find(|part| part.name == name) {
            self.add(name, part.hold, part.stabilisation);
            return Ok(());
        }
        let Some(contact) = robot.contacts.iter().find(|contact| contact.name == name) else {
            let known =
                robot.held.iter().map(|p| p.name.as_str()).chain(robot.contacts.iter().map(|c| c.name.as_str()));
            let remedy = match nearest(name, known) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "name `constraints`, `couplings` or `contacts` in the robot's YAML".to_owned(),
            };
            return Err(fault(&place, format!("the robot has no constraint, coupling or contact `{name}`"), remedy));
        };
        let placement = Transform { pos: contact.point, ..Transform::identity() };
        let here = Transform { pos: poses[contact.body].point(contact.point), ..Transform::identity() };
        let (frame, anchor) = (Frame { body: contact.body, placement }, Anchor { body: None, placement: here });
        self.add(name, Hold::Frame { frame, anchor, directions: Directions::POINT }, STABILISATION);
        self.stands = true;
        Ok(())
    }

    fn add(&mut self, name: &str, hold: Hold<f64>, stabilisation: f64) {
        self.names.push(name.to_owned());
        self.constraints.push(Constraint { hold, stabilisation, contact: None });
    }

    pub(super) fn is_empty(&self) -> bool {
        self.constraints.is_empty()
    }

    pub(super) fn rows(&self) -> usize {
        self.multipliers.len()
    }

    /// Solves for the forces as in a run: contacts that hold more than they need to share the load.
    pub(super) fn solve(
        &mut self,
        mut solve: impl FnMut(&[Constraint<f64>], Regularisation<f64>, Constrained<f64>) -> Result<Solved<f64>, Error>,
    ) -> Result<Solved<f64>, Error> {
        let Self { constraints, stands, multipliers, wrenches, .. } = self;
        let mut with = |regularisation| solve(constraints, regularisation, Constrained { multipliers, wrenches });
        let solved = with(Regularisation::rank_revealing(THRESHOLD))?;
        if *stands && may_share(&solved) && !is_shared(&with(SHARED)?) {
            return with(Regularisation::rank_revealing(THRESHOLD));
        }
        Ok(solved)
    }

    /// Solves once, without a second look at how the load is shared.
    pub(super) fn solve_once(
        &mut self,
        solve: impl FnOnce(&[Constraint<f64>], Regularisation<f64>, Constrained<f64>) -> Result<Solved<f64>, Error>,
    ) -> Result<Solved<f64>, Error> {
        let forces = Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches };
        solve(&self.constraints, Regularisation::rank_revealing(THRESHOLD), forces)
    }

    /// Tells of the forces that were solved for last.
    pub(super) fn tell(&self, solved: &Solved<f64>, answer: &mut Answer) {
        let mut rest = self.multipliers.as_slice();
        let mut told = Vec::with_capacity(self.names.len());
        for ((name, constraint), wrench) in self.names.iter().zip(&self.constraints).zip(&self.wrenches) {
            let (own, others) = rest.split_at(constraint.rows());
            rest = others;
            let is_frame = matches!(constraint.hold, Hold::Frame { .. });
            told.push(HeldAnswer {
                name: name.clone(),
                force: is_frame.then(|| wrench.lin.to_array()),
                moment: is_frame.then(|| wrench.ang.to_array()),
                multipliers: own.to_vec(),
            });
        }
        answer.held = Some(told);
        answer.dependent = Some(solved.dependent as usize);
    }
}

/// How motors and constraints share the load, with everything in its place.
pub(super) struct Sharing {
    torques: Vec<f64>,
    pub(super) passive: Vec<usize>,
    multipliers: Vec<f64>,
    wanted: Vec<f64>,
}

impl Sharing {
    pub(super) fn of(given: Option<&Distribution>, layout: &Layout, rows: usize) -> Result<Self, Error> {
        let nothing = Distribution::default();
        let given = given.unwrap_or(&nothing);
        let (nv, root) = (layout.nv(), layout.root());
        let mut sharing = Self {
            torques: vec![1.0; nv],
            passive: (0..root).collect(),
            multipliers: vec![NEXT_TO_NOTHING; rows],
            wanted: vec![0.0; rows],
        };
        for (i, name) in given.passive.iter().enumerate() {
            let known = &layout.joints[root..];
            let Some(at) = known.iter().position(|joint| joint == name) else {
                let near = nearest(name, known.iter().map(String::as_str)).unwrap_or("none");
                let problem = format!("the robot has no joint `{name}`");
                return Err(fault(&format!("distribution.passive[{i}]"), problem, format!("did you mean `{near}`?")));
            };
            if !sharing.passive.contains(&(root + at)) {
                sharing.passive.push(root + at);
            }
        }
        if let Some(weights) = &given.torques {
            let lead = if weights.len() + root == nv { root } else { 0 };
            sized("distribution.torques", weights, nv - lead, "one weight per joint, in the order of `gyroflex info`")?;
            sharing.torques[lead..].copy_from_slice(weights);
            let wrong = |k: &usize| !sharing.passive.contains(k) && sharing.torques[*k] <= 0.0;
            if let Some(k) = (0..nv).find(wrong) {
                let key = format!("distribution.torques[{}]", k - lead);
                return Err(fault(
                    &key,
                    format!("{} is not above zero", sharing.torques[k]),
                    "give a weight above zero",
                ));
            }
        }
        if let Some(weights) = &given.multipliers {
            sized("distribution.multipliers", weights, rows, "one weight per held direction, in the order of `held`")?;
            if let Some(k) = weights.iter().position(|x| *x < 0.0) {
                let key = format!("distribution.multipliers[{k}]");
                return Err(fault(&key, format!("{} is below zero", weights[k]), "give a weight of zero or more"));
            }
            sharing.multipliers.copy_from_slice(weights);
        }
        if let Some(wanted) = &given.wanted {
            sized("distribution.wanted", wanted, rows, "one force per held direction, in the order of `held`")?;
            sharing.wanted.copy_from_slice(wanted);
        }
        Ok(sharing)
    }

    pub(super) fn view(&self) -> TorqueDistribution<'_, f64> {
        let Self { torques, passive, multipliers, wanted } = self;
        TorqueDistribution { torques, passive, multipliers, wanted }
    }
}

fn sized(key: &str, given: &[f64], expected: usize, what: &str) -> Result<(), Error> {
    if given.len() == expected {
        return Ok(());
    }
    let problem = format!("{} entries are given, but {expected} are expected", given.len());
    Err(fault(key, problem, format!("give {what}")))
}

/// A share of a load makes sense only where there is one.
pub(super) fn refuse_without_effect(query: &Query, inverse: bool, held: &Held) -> Result<(), Error> {
    if query.distribution.is_none() || (inverse && !held.is_empty()) {
        return Ok(());
    }
    let (problem, remedy) = match inverse {
        true => ("it has no effect where nothing holds the robot", "name what does under `held`, or leave it out"),
        false => ("it has no effect on forward dynamics", "leave it out, or give `qdd` instead of `tau`"),
    };
    Err(fault("distribution", problem, remedy))
}
