//! Dynamics with something held: storage that grows with the constraints, and nothing per call once it has.

use super::Dynamics;
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{
    self, AbaScratch, Constrained, ConstrainedScratch, Constraint, ConstraintError, ConstraintMotion,
    ConstraintScratch, External, Forward, Impact, JointSpaceScratch, PropagatedScratch, Regularisation, Solved, State,
    SupportScratch,
};
use gyroflex::model::Model;

/// Scratch for the constraints seen last; it keeps nothing between calls but its size.
#[derive(Clone, Debug, Default)]
pub(super) struct ConstraintStorage {
    supports: Vec<SupportScratch<f64>>,
    constraints: Vec<ConstraintScratch<f64>>,
    propagated: Vec<PropagatedScratch<f64>>,
    matrix: Vec<f64>,
    joint_matrix: Vec<f64>,
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
