//! The core's algorithms with storage of their own: one object per thread, nothing allocated after its making.

use crate::error::{Error, ErrorKind};
use crate::robot::OwnedModel;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, Energy, External, Forward, ForwardScratch, Inverse, Power, RneaScratch,
    State, coupling, crba, energy, forward_dynamics, matrix_len, placements, power, reflected_inertia, rnea,
};
use gyroflex::integrate::{self, StateMut};
use gyroflex::model::{Model, SizeError};
use gyroflex::spatial::{Motion, Transform, Vec3};

/// A model and scratch for every algorithm.
#[derive(Clone, Debug)]
pub struct Dynamics {
    model: OwnedModel,
    aba: Vec<AbaScratch<f64>>,
    matrix: Vec<f64>,
    rnea: Vec<RneaScratch<f64>>,
    crba: Vec<CrbaScratch<f64>>,
    moving: Vec<(Transform<f64>, Motion<f64>)>,
    work: Vec<f64>,
}

impl Dynamics {
    /// Storage for one model.
    pub fn new(model: OwnedModel) -> Self {
        let view = model.view();
        let n = view.bodies().len();
        Self {
            aba: vec![AbaScratch::new(); n],
            matrix: vec![0.0; matrix_len(&view)],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            moving: vec![(Transform::identity(), Motion::zero()); n],
            work: vec![0.0; integrate::rk4_len(&view).max(integrate::euler_len(&view))],
            model,
        }
    }

    /// The model.
    pub fn model(&self) -> Model<'_, f64> {
        self.model.view()
    }

    /// Sets gravity in world axes [m/s²].
    pub fn set_gravity(&mut self, gravity: Vec3<f64>) {
        self.model.set_gravity(gravity);
    }

    /// See [`forward_dynamics`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn forward(
        &mut self,
        state: State<f64>,
        tau: &[f64],
        ext: External<f64>,
        out: Forward<f64>,
    ) -> Result<(), Error> {
        let scratch = ForwardScratch { bodies: &mut self.aba, matrix: &mut self.matrix };
        forward_dynamics(&self.model.view(), state, tau, ext, scratch, out).map_err(Error::from)
    }

    /// See [`rnea`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn inverse(
        &mut self,
        state: State<f64>,
        accel: Acceleration<f64>,
        ext: External<f64>,
        out: Inverse<f64>,
    ) -> Result<(), Error> {
        rnea(&self.model.view(), state, accel, ext, &mut self.rnea, out).map_err(Error::from)
    }

    /// See [`crba`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn mass_matrix(&mut self, q: &[f64], m: &mut [f64]) -> Result<(), Error> {
        crba(&self.model.view(), q, &mut self.crba, m).map_err(Error::from)
    }

    /// See [`coupling`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn coupling(&mut self, q: &[f64], s: &mut [f64]) -> Result<(), Error> {
        coupling(&self.model.view(), q, &mut self.crba, s).map_err(Error::from)
    }

    /// See [`reflected_inertia`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn reflected_inertia(&self, b: &mut [f64]) -> Result<(), Error> {
        reflected_inertia(&self.model.view(), b).map_err(Error::from)
    }

    /// See [`energy`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn energy(&mut self, state: State<f64>) -> Result<Energy<f64>, Error> {
        energy(&self.model.view(), state, &mut self.moving).map_err(Error::from)
    }

    /// See [`power`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn power(&mut self, state: State<f64>, tau: &[f64], ext: External<f64>) -> Result<Power<f64>, Error> {
        power(&self.model.view(), state, tau, ext, &mut self.moving).map_err(Error::from)
    }

    /// See [`placements`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn placements(&self, q: &[f64], out: &mut [Transform<f64>]) -> Result<(), Error> {
        placements(&self.model.view(), q, out).map_err(Error::from)
    }

    /// See [`integrate::rk4`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn rk4(&mut self, state: StateMut<f64>, tau: &[f64], ext: External<f64>, step: f64) -> Result<(), Error> {
        let model = self.model.view();
        let scratch = ForwardScratch { bodies: &mut self.aba, matrix: &mut self.matrix };
        let work = &mut self.work[..integrate::rk4_len(&model)];
        integrate::rk4(&model, state, tau, ext, step, scratch, work).map_err(Error::from)
    }

    /// See [`integrate::semi_implicit_euler`].
    ///
    /// # Errors
    /// A slice of the wrong length.
    pub fn semi_implicit_euler(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
    ) -> Result<(), Error> {
        let model = self.model.view();
        let scratch = ForwardScratch { bodies: &mut self.aba, matrix: &mut self.matrix };
        let work = &mut self.work[..integrate::euler_len(&model)];
        integrate::semi_implicit_euler(&model, state, tau, ext, step, scratch, work).map_err(Error::from)
    }
}

impl From<SizeError> for Error {
    fn from(e: SizeError) -> Self {
        Self {
            kind: ErrorKind::Shape,
            file: String::new(),
            element: e.argument.to_string(),
            problem: format!("{} entries given, but the robot needs {}", e.given, e.expected),
            remedy: "give one entry per coordinate, in the order `gyroflex info` lists".to_string(),
        }
    }
}
