//! Dynamics with something held: storage that grows with the constraints, and nothing per call once it has.

use super::Dynamics;
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{
    self, AbaScratch, Acceleration, Constrained, ConstrainedScratch, Constraint, ConstraintError, ConstraintMotion,
    ConstraintScratch, External, Forward, Hold, Impact, Inverse, JointSpaceScratch, PropagatedScratch, Regularisation,
    Solved, State, SupportScratch, TorqueDistribution,
};
use gyroflex::model::Model;
use gyroflex::spatial::{Force, Transform, Vec3};

/// Scratch for the constraints seen last; it keeps nothing between calls but its size.
#[derive(Clone, Debug, Default)]
pub(super) struct ConstraintStorage {
    supports: Vec<SupportScratch<f64>>,
    constraints: Vec<ConstraintScratch<f64>>,
    propagated: Vec<PropagatedScratch<f64>>,
    matrix: Vec<f64>,
    joint_matrix: Vec<f64>,
    inverse_matrix: Vec<f64>,
    poses: Vec<Transform<f64>>,
}

impl ConstraintStorage {
    fn fit(&mut self, model: &Model<f64>, held: &[Constraint<f64>]) {
        self.supports.resize(model.bodies().len(), SupportScratch::new());
        self.constraints.resize(held.len(), ConstraintScratch::new());
        self.propagated.resize(dynamics::propagated_len(model, held), PropagatedScratch::new());
        self.matrix.resize(dynamics::constraint_matrix_len(held), 0.0);
        self.joint_matrix.resize(dynamics::constrained_joint_matrix_len(model, held), 0.0);
    }

    fn lend<'a>(
        &'a mut self,
        bodies: &'a mut [AbaScratch<f64>],
        joint_space: &'a mut [JointSpaceScratch<f64>],
    ) -> ConstrainedScratch<'a, f64> {
        ConstrainedScratch {
            bodies,
            supports: &mut self.supports,
            constraints: &mut self.constraints,
            propagated: &mut self.propagated,
            matrix: &mut self.matrix,
            joint_space,
            joint_matrix: &mut self.joint_matrix,
        }
    }
}

impl Dynamics {
    /// Accelerations with something held, and the forces of it; see [`dynamics::constrained_forward_dynamics`].
    ///
    /// # Errors
    /// A slice or a constraint that does not fit the model.
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    pub fn constrained_forward(
        &mut self,
        state: State<f64>,
        tau: &[f64],
        ext: External<f64>,
        constraints: &[Constraint<f64>],
        regularisation: Regularisation<f64>,
        out: Forward<f64>,
        forces: Constrained<f64>,
    ) -> Result<Solved<f64>, Error> {
        self.model.refuse_bending("what holds a robot beside its joints")?;
        let model = self.model.view();
        self.held.fit(&model, constraints);
        let scratch = self.held.lend(&mut self.aba, &mut self.joint_space);
        let solved = dynamics::constrained_forward_dynamics(
            &model,
            state,
            tau,
            ext,
            constraints,
            regularisation,
            scratch,
            out,
            forces,
        );
        Ok(solved?)
    }

    /// Torques that make a motion with something held, and the forces of it; see [`dynamics::constrained_inverse_dynamics`].
    ///
    /// # Errors
    /// A slice or a constraint that does not fit the model.
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    pub fn constrained_inverse(
        &mut self,
        state: State<f64>,
        accel: Acceleration<f64>,
        ext: External<f64>,
        constraints: &[Constraint<f64>],
        distribution: TorqueDistribution<f64>,
        regularisation: Regularisation<f64>,
        out: Inverse<f64>,
        forces: Constrained<f64>,
    ) -> Result<Solved<f64>, Error> {
        let model = self.model.view();
        self.held.fit(&model, constraints);
        let entries = dynamics::constrained_inverse_len(&model, constraints, distribution.passive.len());
        self.held.inverse_matrix.resize(entries, 0.0);
        self.held.poses.resize(model.bodies().len(), Transform::identity());
        let Constrained { multipliers, wrenches } = forces;
        let solved = dynamics::constrained_inverse_dynamics(
            &model,
            state,
            accel,
            ext,
            constraints,
            distribution,
            regularisation,
            &mut self.rnea,
            &mut self.held.supports,
            &mut self.held.inverse_matrix,
            out,
            multipliers,
        )?;
        dynamics::placements(&model, state.q, &mut self.held.poses)?;
        let mut rest = &*multipliers;
        for (constraint, wrench) in constraints.iter().zip(wrenches) {
            let (own, others) = rest.split_at_checked(constraint.rows()).unwrap_or_default();
            (*wrench, rest) = (wrench_of(constraint, own, &self.held.poses), others);
        }
        Ok(solved)
    }

    /// Velocities after an impact, and the impulses of it; see [`dynamics::impact`].
    ///
    /// # Errors
    /// A slice or a constraint that does not fit the model.
    pub fn impact(
        &mut self,
        state: State<f64>,
        constraints: &[Constraint<f64>],
        release: bool,
        regularisation: Regularisation<f64>,
        out: Impact<f64>,
        forces: Constrained<f64>,
    ) -> Result<Solved<f64>, Error> {
        self.model.refuse_bending("what holds a robot beside its joints")?;
        let model = self.model.view();
        self.held.fit(&model, constraints);
        let scratch = self.held.lend(&mut self.aba, &mut self.joint_space);
        Ok(dynamics::impact(&model, state, constraints, release, regularisation, scratch, out, forces)?)
    }

    /// How far constraints are from being kept, and their Jacobian; see [`dynamics::constraint_motion`].
    ///
    /// # Errors
    /// A slice or a constraint that does not fit the model.
    pub fn constraint_motion(
        &mut self,
        q: &[f64],
        qd: &[f64],
        constraints: &[Constraint<f64>],
        out: ConstraintMotion<f64>,
    ) -> Result<(), Error> {
        self.model.refuse_bending("what holds a robot beside its joints")?;
        let model = self.model.view();
        self.held.fit(&model, constraints);
        Ok(dynamics::constraint_motion(&model, q, qd, constraints, &mut self.held.supports, out)?)
    }
}

/// Wrench of a constraint on its link about the origin of its frame, in world axes: multipliers count along the axes of what the frame is held to.
fn wrench_of(constraint: &Constraint<f64>, multipliers: &[f64], poses: &[Transform<f64>]) -> Force<f64> {
    let Hold::Frame { anchor, directions, .. } = &constraint.hold else { return Force::zero() };
    let pose = anchor.body.and_then(|b| poses.get(b)).map_or(anchor.placement, |pose| anchor.placement.after(*pose));
    let (mut along, mut held) = ([0.0; 6], multipliers.iter());
    for (k, force) in along.iter_mut().enumerate() {
        *force = if directions.contains(k) { held.next().copied().unwrap_or_default() } else { 0.0 };
    }
    let [mx, my, mz, fx, fy, fz] = along;
    let axes = pose.rotation();
    Force { ang: axes * Vec3::new(mx, my, mz), lin: axes * Vec3::new(fx, fy, fz) }
}

impl From<ConstraintError> for Error {
    fn from(e: ConstraintError) -> Self {
        match e {
            ConstraintError::Size(e) => e.into(),
            e => Self {
                kind: ErrorKind::Model,
                file: String::new(),
                element: "constraints".to_string(),
                problem: e.to_string(),
                remedy: "name bodies and joints of this robot".to_string(),
            },
        }
    }
}
