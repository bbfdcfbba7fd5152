//! The core's algorithms on owned vectors, with scratch as dirty as asked for.

use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, Energy, External, Forward, ForwardScratch, Inverse, JointSpaceScratch,
    Power, RneaScratch, State, aba, coupling, crba, energy, forward_dynamics, forward_in_joint_space, joint_space_len,
    matrix_len, power, reflected_inertia, rnea,
};
use gyroflex::integrate::{StateMut, rk4, rk4_len};
use gyroflex::model::{Fidelity, Model, RobotSpec, SizeError};
use gyroflex::spatial::{Force, Motion, Transform};
use gyroflex_testkit::dense::{Accelerations, Torques};
use gyroflex_testkit::tolerance::Real;
use gyroflex_testkit::{Lowered, State as Point};

/// A robot lowered to one model and scalar; states and results are `f64` at the border.
#[derive(Clone, Debug)]
pub struct Core<T: Real> {
    lowered: Lowered<T::Param>,
    pub(crate) dirty: bool,
}

impl<T: Real> Core<T> {
    /// Lowers a description that is known to be valid.
    ///
    /// # Panics
    /// If the core finds it is not; and in all that follows, if a state does not fit the robot.
    pub fn new(spec: &RobotSpec<'_>, fidelity: Fidelity) -> Self {
        Self { lowered: Lowered::new(spec, fidelity).expect("a random robot is valid"), dirty: false }
    }

    /// Runs every algorithm on NaN first, and then again in the scratch that is left.
    pub fn with_dirty_scratch(self) -> Self {
        Self { dirty: true, ..self }
    }

    /// The view the algorithms take.
    pub fn model(&self) -> Model<'_, T::Param> {
        self.lowered.view()
    }

    /// `forward_dynamics`, by whichever route the core picks.
    pub fn forward(&self, s: &Point) -> Accelerations {
        let model = self.model();
        let mut bodies = vec![AbaScratch::new(); model.bodies().len()];
        let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(&model)];
        let mut matrix = vec![nan(); matrix_len(&model)];
        self.write_forward(s, |x, out| {
            let scratch = ForwardScratch { bodies: &mut bodies, joint_space: &mut joint_space, matrix: &mut matrix };
            forward_dynamics(&model, x.state(), &x.tau, x.external(), scratch, out)
        })
    }

    /// `aba`, which is exact unless a rigid rotor sits away from its joint.
    pub fn aba(&self, s: &Point) -> Accelerations {
        let model = self.model();
        let mut bodies = vec![AbaScratch::new(); model.bodies().len()];
        self.write_forward(s, |x, out| aba(&model, x.state(), &x.tau, x.external(), &mut bodies, out))
    }

    /// Forward dynamics by the inertia matrix.
    pub fn forward_in_joint_space(&self, s: &Point) -> Accelerations {
        let model = self.model();
        let mut bodies = vec![JointSpaceScratch::new(); model.bodies().len()];
        let mut matrix = vec![nan(); model.nv() * model.nv()];
        self.write_forward(s, |x, out| {
            forward_in_joint_space(&model, x.state(), &x.tau, x.external(), &mut bodies, &mut matrix, out)
        })
    }

    fn write_forward(
        &self,
        s: &Point,
        mut run: impl FnMut(&Inputs<T>, Forward<'_, T>) -> Result<(), SizeError>,
    ) -> Accelerations {
        let nv = self.model().nv();
        let (mut qdd, mut thetadd, mut tau_j) = (vec![nan(); nv], vec![nan(); nv], vec![nan(); nv]);
        self.call(s, |x| run(x, Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j }));
        Accelerations { qdd: double(&qdd), thetadd: double(&thetadd), tau_j: double(&tau_j) }
    }

    /// `steps` steps of `rk4` with the state's motor torques and loads held.
    pub fn integrate(&self, s: &Point, step: f64, steps: usize) -> Point {
        let (model, mut x) = (self.model(), Inputs::<T>::new(s));
        let mut bodies = vec![AbaScratch::new(); model.bodies().len()];
        let mut joint_space = vec![JointSpaceScratch::new(); joint_space_len(&model)];
        let mut matrix = vec![nan(); matrix_len(&model)];
        let mut work = vec![nan(); rk4_len(&model)];
        for _ in 0..steps {
            let state = StateMut { q: &mut x.q, qd: &mut x.qd, theta: &mut x.theta, thetad: &mut x.thetad };
            let ext = External { tau: &x.tau_ext, wrenches: &x.wrenches };
            let scratch = ForwardScratch { bodies: &mut bodies, joint_space: &mut joint_space, matrix: &mut matrix };
            rk4(&model, state, &x.tau, ext, T::from_f64(step), scratch, &mut work).expect("slices fit the model");
        }
        let [q, qd, theta, thetad] = [x.q, x.qd, x.theta, x.thetad].map(|v| double(&v));
        Point { q, qd, theta, thetad, ..s.clone() }
    }

    /// `rnea`.
    pub fn inverse(&self, s: &Point) -> Torques {
        let model = self.model();
        let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
        let (mut tau_j, mut tau) = (vec![nan(); model.nv()], vec![nan(); model.nv()]);
        self.call(s, |x| {
            let accel = Acceleration { qdd: &x.qdd, thetadd: &x.thetadd };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            rnea(&model, x.state(), accel, x.external(), &mut scratch, out)
        });
        Torques { tau_j: double(&tau_j), tau: double(&tau) }
    }

    /// `crba`, by rows.
    pub fn mass_matrix(&self, s: &Point) -> Vec<f64> {
        self.write_matrix(s, crba)
    }

    /// `coupling`, by rows.
    pub fn coupling(&self, s: &Point) -> Vec<f64> {
        self.write_matrix(s, coupling)
    }

    fn write_matrix(
        &self,
        s: &Point,
        run: impl Fn(&Model<'_, T::Param>, &[T], &mut [CrbaScratch<T>], &mut [T]) -> Result<(), SizeError>,
    ) -> Vec<f64> {
        let model = self.model();
        let mut scratch = vec![CrbaScratch::new(); model.bodies().len()];
        let mut m = vec![nan(); model.nv() * model.nv()];
        self.call(s, |x| run(&model, &x.q, &mut scratch, &mut m));
        double(&m)
    }

    /// The diagonal of `B`.
    pub fn reflected_inertia(&self) -> Vec<f64> {
        let mut b = vec![T::Param::from_f64(f64::NAN); self.model().nv()];
        reflected_inertia(&self.model(), &mut b).expect("slices fit the model");
        b.into_iter().map(|x| T::from_param(x).to_f64()).collect()
    }

    /// `energy`.
    pub fn energy(&self, s: &Point) -> Energy<f64> {
        let model = self.model();
        let mut scratch = vec![(Transform::identity(), Motion::zero()); model.bodies().len()];
        let e = self.call(s, |x| energy(&model, x.state(), &mut scratch));
        Energy { kinetic: e.kinetic.to_f64(), gravity: e.gravity.to_f64(), elastic: e.elastic.to_f64() }
    }

    /// `power`.
    pub fn power(&self, s: &Point) -> Power<f64> {
        let model = self.model();
        let mut scratch = vec![(Transform::identity(), Motion::zero()); model.bodies().len()];
        let p = self.call(s, |x| power(&model, x.state(), &x.tau, x.external(), &mut scratch));
        Power { supplied: p.supplied.to_f64(), dissipated: p.dissipated.to_f64() }
    }

    /// The same for what does not fail.
    pub(crate) fn call_any<R>(&self, s: &Point, mut run: impl FnMut(&Inputs<T>) -> R) -> R {
        self.call(s, |x| Ok(run(x)))
    }

    pub(crate) fn call<R>(&self, s: &Point, mut run: impl FnMut(&Inputs<T>) -> Result<R, SizeError>) -> R {
        let x = Inputs::new(s);
        if self.dirty {
            run(&x.spoilt()).expect("slices fit the model");
        }
        run(&x).expect("slices fit the model")
    }
}

/// A state in the scalar.
pub(crate) struct Inputs<T> {
    pub(crate) q: Vec<T>,
    qd: Vec<T>,
    theta: Vec<T>,
    thetad: Vec<T>,
    pub(crate) qdd: Vec<T>,
    pub(crate) thetadd: Vec<T>,
    pub(crate) tau: Vec<T>,
    tau_ext: Vec<T>,
    wrenches: Vec<Force<T>>,
}

impl<T: Real> Inputs<T> {
    pub(crate) fn new(s: &Point) -> Self {
        Self {
            q: cast(&s.q),
            qd: cast(&s.qd),
            theta: cast(&s.theta),
            thetad: cast(&s.thetad),
            qdd: cast(&s.qdd),
            thetadd: cast(&s.thetadd),
            tau: cast(&s.tau),
            tau_ext: cast(&s.tau_ext),
            wrenches: s.wrenches.iter().map(|w| Force::from(w.map(T::from_f64))).collect(),
        }
    }

    /// NaN wherever there was a number.
    pub(crate) fn spoilt(&self) -> Self {
        let nans = |x: &[T]| vec![nan(); x.len()];
        Self {
            q: nans(&self.q),
            qd: nans(&self.qd),
            theta: nans(&self.theta),
            thetad: nans(&self.thetad),
            qdd: nans(&self.qdd),
            thetadd: nans(&self.thetadd),
            tau: nans(&self.tau),
            tau_ext: nans(&self.tau_ext),
            wrenches: vec![Force::from([nan(); 6]); self.wrenches.len()],
        }
    }

    pub(crate) fn state(&self) -> State<'_, T> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }

    pub(crate) fn external(&self) -> External<'_, T> {
        External { tau: &self.tau_ext, wrenches: &self.wrenches }
    }
}

pub(crate) fn nan<T: Real>() -> T {
    T::from_f64(f64::NAN)
}

pub(crate) fn cast<T: Real>(x: &[f64]) -> Vec<T> {
    x.iter().map(|x| T::from_f64(*x)).collect()
}

pub(crate) fn double<T: Real>(x: &[T]) -> Vec<f64> {
    x.iter().map(|x| x.to_f64()).collect()
}
