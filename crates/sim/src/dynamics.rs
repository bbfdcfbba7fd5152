//! A model together with the scratch its algorithms need: allocated once, nothing per call.

mod bending;
mod bending_matrices;
mod constrained;
mod derivatives;
mod matrices;

use crate::error::{Error, ErrorKind};
use crate::robot::OwnedModel;
pub(crate) use bending::Direction;
use bending::{Bending, Storage};
use constrained::ConstraintStorage;
use gyroflex::dynamics::{
    self, AbaScratch, Acceleration, CrbaScratch, DerivativeScratch, Energy, External, FlexibleMatrices, Forward,
    ForwardScratch, Inverse, JointSpaceScratch, Power, RneaScratch, State,
};
use gyroflex::integrate::{self, StateMut};
use gyroflex::model::{Model, SizeError};
use gyroflex::spatial::{Motion, Transform, Vec3};

/// The algorithms of the core over one model, with storage of their own.
#[derive(Clone, Debug)]
pub struct Dynamics {
    model: OwnedModel,
    aba: Vec<AbaScratch<f64>>,
    joint_space: Vec<JointSpaceScratch<f64>>,
    matrix: Vec<f64>,
    rnea: Vec<RneaScratch<f64>>,
    crba: Vec<CrbaScratch<f64>>,
    moving: Vec<(Transform<f64>, Motion<f64>)>,
    work: Vec<f64>,
    derivative: Vec<DerivativeScratch<f64>>,
    derivative_matrix: Vec<f64>,
    operational: Vec<f64>,
    held: ConstraintStorage,
    bending: Option<Box<Bending>>,
}

impl Dynamics {
    /// Takes the model and allocates for it.
    pub fn new(model: OwnedModel) -> Self {
        let view = model.view();
        let n = view.bodies().len();
        let work = integrate::rk4_len(&view).max(integrate::euler_len(&view));
        let matrix = dynamics::matrix_len(&view);
        Self {
            aba: vec![AbaScratch::new(); n],
            joint_space: vec![JointSpaceScratch::new(); dynamics::joint_space_len(&view)],
            matrix: vec![0.0; matrix],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            moving: vec![(Transform::identity(), Motion::zero()); n],
            work: vec![0.0; work],
            derivative: vec![DerivativeScratch::new(); n],
            derivative_matrix: vec![0.0; dynamics::derivative_matrix_len(&view)],
            operational: Vec::new(),
            held: ConstraintStorage::default(),
            bending: model.flexible().map(|model| Box::new(Bending::new(&model))),
            model,
        }
    }

    /// The model, of the robot whose links do not bend.
    pub fn model(&self) -> Model<'_, f64> {
        self.model.view()
    }

    /// Sets gravity in world axes [m/s²].
    pub fn set_gravity(&mut self, gravity: Vec3<f64>) {
        self.model.set_gravity(gravity);
    }

    /// The model and what it was lowered as.
    pub fn owned_model(&self) -> &OwnedModel {
        &self.model
    }

    /// Length of `q`: of the joints, then of the modes of links that bend.
    pub fn nq(&self) -> usize {
        self.model.nq()
    }

    /// Length of every other vector over the joints, then the modes.
    pub fn nv(&self) -> usize {
        self.model.nv()
    }

    /// Accelerations and transmission torques; see [`dynamics::forward_dynamics`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn forward(
        &mut self,
        state: State<f64>,
        tau: &[f64],
        ext: External<f64>,
        out: Forward<f64>,
    ) -> Result<(), Error> {
        if let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) {
            return Ok(dynamics::flexible_aba(&model, state, tau, ext, bending.scratch.lend(), out)?);
        }
        let scratch =
            ForwardScratch { bodies: &mut self.aba, joint_space: &mut self.joint_space, matrix: &mut self.matrix };
        Ok(dynamics::forward_dynamics(&self.model.view(), state, tau, ext, scratch, out)?)
    }

    /// Torques that make the robot accelerate as asked; see [`dynamics::rnea`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn inverse(
        &mut self,
        state: State<f64>,
        accel: Acceleration<f64>,
        ext: External<f64>,
        out: Inverse<f64>,
    ) -> Result<(), Error> {
        if let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) {
            return Ok(dynamics::flexible_rnea(&model, state, accel, ext, bending.scratch.lend(), out)?);
        }
        Ok(dynamics::rnea(&self.model.view(), state, accel, ext, &mut self.rnea, out)?)
    }

    /// `M_l(q)`, `nv × nv` by rows; see [`dynamics::crba`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn mass_matrix(&mut self, q: &[f64], m: &mut [f64]) -> Result<(), Error> {
        if let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) {
            let out = FlexibleMatrices { mass: m, coupling: &mut bending.unasked };
            return Ok(dynamics::flexible_mass_matrix(&model, q, bending.scratch.lend(), out)?);
        }
        Ok(dynamics::crba(&self.model.view(), q, &mut self.crba, m)?)
    }

    /// `S(q)`, `nv × nv` by rows; see [`dynamics::coupling`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn coupling(&mut self, q: &[f64], s: &mut [f64]) -> Result<(), Error> {
        if let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) {
            let out = FlexibleMatrices { mass: &mut bending.unasked, coupling: s };
            return Ok(dynamics::flexible_mass_matrix(&model, q, bending.scratch.lend(), out)?);
        }
        Ok(dynamics::coupling(&self.model.view(), q, &mut self.crba, s)?)
    }

    /// Diagonal of `B`, `nv` entries; see [`dynamics::reflected_inertia`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn reflected_inertia(&self, b: &mut [f64]) -> Result<(), Error> {
        // A mode has no motor.
        let joints = b.len() - self.modes().min(b.len());
        b[joints..].fill(0.0);
        Ok(dynamics::reflected_inertia(&self.model.view(), &mut b[..joints])?)
    }

    /// Kinetic, gravity and elastic energy [J].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn energy(&mut self, state: State<f64>) -> Result<Energy<f64>, Error> {
        if let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) {
            return Ok(dynamics::flexible_energy(&model, state, bending.scratch.lend())?);
        }
        Ok(dynamics::energy(&self.model.view(), state, &mut self.moving)?)
    }

    /// Power supplied and dissipated [W].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn power(&mut self, state: State<f64>, tau: &[f64], ext: External<f64>) -> Result<Power<f64>, Error> {
        if let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) {
            return Ok(dynamics::flexible_power(&model, state, tau, ext, bending.scratch.lend())?);
        }
        Ok(dynamics::power(&self.model.view(), state, tau, ext, &mut self.moving)?)
    }

    /// Transform from the world to every body's link frame, one entry per body; see [`dynamics::placements`]. Where links bend, this allocates.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn placements(&self, q: &[f64], out: &mut [Transform<f64>]) -> Result<(), Error> {
        if let Some(model) = self.model.flexible() {
            return Self::flexible_placements(&model, q, out);
        }
        Ok(dynamics::placements(&self.model.view(), q, out)?)
    }

    /// Spatial velocity of every body in its link frame, angular part first, one entry per body; see [`dynamics::velocities`].
    /// Where links bend, this allocates.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn velocities(&self, q: &[f64], qd: &[f64], out: &mut [Motion<f64>]) -> Result<(), Error> {
        if let Some(model) = self.model.flexible() {
            return Ok(dynamics::flexible_velocities(&model, q, qd, Storage::new(&model).lend(), out)?);
        }
        Ok(dynamics::velocities(&self.model.view(), q, qd, out)?)
    }

    /// One step of the classical Runge-Kutta scheme; see [`integrate::rk4`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn rk4(&mut self, state: StateMut<f64>, tau: &[f64], ext: External<f64>, step: f64) -> Result<(), Error> {
        if self.bending.is_some() {
            return self.flexible_rk4(state, tau, ext, step);
        }
        let view = self.model.view();
        let scratch =
            ForwardScratch { bodies: &mut self.aba, joint_space: &mut self.joint_space, matrix: &mut self.matrix };
        let work = &mut self.work[..integrate::rk4_len(&view)];
        Ok(integrate::rk4(&view, state, tau, ext, step, scratch, work)?)
    }

    /// One step of semi-implicit Euler; see [`integrate::semi_implicit_euler`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn semi_implicit_euler(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
    ) -> Result<(), Error> {
        if self.bending.is_some() {
            return self.flexible_euler(state, tau, ext, step);
        }
        let view = self.model.view();
        let scratch =
            ForwardScratch { bodies: &mut self.aba, joint_space: &mut self.joint_space, matrix: &mut self.matrix };
        let work = &mut self.work[..integrate::euler_len(&view)];
        Ok(integrate::semi_implicit_euler(&view, state, tau, ext, step, scratch, work)?)
    }
}

impl From<SizeError> for Error {
    fn from(e: SizeError) -> Self {
        Self {
            kind: ErrorKind::Shape,
            file: String::new(),
            element: e.argument.to_string(),
            problem: e.to_string(),
            remedy: "pass an array with one entry per coordinate, in the order of `gyroflex info`".to_string(),
        }
    }
}
