//! Which coordinate is what in a term.

use crate::robot::Robot;
use core::ops::Range;
use gyroflex::model::{Body, JointKind, Model};

/// Sine of the angle between two axes below which they are parallel [–].
const PARALLEL: f64 = 1e-14;

/// What an input of the expanded expressions is: a position, or a parameter that is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// An angle, only ever inside sines and cosines; its place among all angles.
    Angle(usize),
    /// Something of which powers are taken; its place among all of those.
    Variable(usize),
}

/// The order of angles and variables in a term.
///
/// Angles of joints whose axes are always parallel stand side by side and form a group: planar robots come out as
/// `cos(q₁ + q₂)`, everything else as products over the groups.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// What the inputs are: coordinates first, then parameters that are kept.
    pub inputs: Vec<Input>,
    /// The groups of angles.
    pub groups: Vec<Range<usize>>,
    /// Which coordinate an angle is.
    pub angles: Vec<usize>,
    /// Which input a variable is.
    pub variables: Vec<usize>,
    /// The modal coordinates among the variables: small, and counted where series are truncated.
    pub modal: Range<usize>,
}

impl Layout {
    /// Of a robot without a floating root, of which so many parameters are kept.
    pub(super) fn of(robot: &Robot, kept: usize) -> Self {
        let (model, nv) = (robot.model, robot.nv());
        let (mut inputs, mut groups) = (vec![Input::Variable(0); nv + kept], Vec::new());
        let (mut angles, mut variables) = (Vec::new(), Vec::new());
        let group = groups_of(&model);
        for g in 0..model.bodies().len() {
            let first = angles.len();
            for (i, body) in model.bodies().iter().enumerate().filter(|(i, _)| group[*i] == Some(g)) {
                debug_assert_eq!(body.joint, JointKind::Revolute, "body {i}");
                inputs[body.v_index()] = Input::Angle(angles.len());
                angles.push(body.v_index());
            }
            if angles.len() > first {
                groups.push(first..angles.len());
            }
        }
        for body in model.bodies().iter().filter(|body| body.joint == JointKind::Prismatic) {
            variables.push(body.v_index());
        }
        let modal = variables.len()..variables.len() + nv - model.nv();
        variables.extend(model.nv()..nv + kept);
        for (v, input) in variables.iter().enumerate() {
            inputs[*input] = Input::Variable(v);
        }
        Self { inputs, groups, angles, variables, modal }
    }

    /// Numbers that a term is told apart by: multiples of angles, sine or cosine of groups, powers.
    pub(super) fn width(&self) -> usize {
        self.angles.len() + self.groups.len() + self.variables.len()
    }

    /// Where the powers of variables begin among them.
    pub(super) fn first_power(&self) -> usize {
        self.angles.len() + self.groups.len()
    }

    /// The group of an angle.
    pub(super) fn group_of(&self, angle: usize) -> usize {
        self.groups.iter().position(|group| group.contains(&angle)).expect("every angle is in a group")
    }
}

/// The first body of the group that the joint of every body is in; none of those that slide.
fn groups_of(model: &Model<f64>) -> Vec<Option<usize>> {
    let bodies = model.bodies();
    let mut group: Vec<Option<usize>> = vec![None; bodies.len()];
    for (i, body) in bodies.iter().enumerate() {
        if body.joint != JointKind::Revolute {
            continue;
        }
        // Joints that slide along the same direction do not turn it.
        let (mut before, mut parallel) = (body.parent(), is_parallel(body));
        while let Some(p) = before.filter(|p| parallel && bodies[*p].joint == JointKind::Prismatic) {
            parallel = is_parallel(&bodies[p]);
            before = bodies[p].parent();
        }
        let joined = before.filter(|_| parallel).and_then(|p| group[p]);
        group[i] = Some(joined.unwrap_or(i));
    }
    group
}

/// Whether a joint's axis has the direction of its parent's z-axis, which is that of the parent's joint.
fn is_parallel(body: &Body<f64>) -> bool {
    body.placement.alpha.sin.abs() <= PARALLEL
}
