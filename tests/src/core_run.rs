//! The core's algorithms on owned vectors.

use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, Energy, External, Forward, ForwardScratch, Inverse, Power, RneaScratch,
    State, coupling, crba, energy, forward_dynamics, forward_in_joint_space, matrix_len, power, reflected_inertia,
    rnea,
};
use gyroflex::model::{Fidelity, Model, RobotSpec, SizeError};
use gyroflex::spatial::{Force, Motion, Transform};
use gyroflex_testkit::Lowered;
use gyroflex_testkit::dense::{Accelerations, Torques};
use gyroflex_testkit::tolerance::Real;

/// A robot lowered to one model and scalar. Inputs and results are `f64` at the border.
#[derive(Clone, Debug)]
pub struct Core<T> {
    lowered: Lowered<T>,
}

/// A state in the scalar.
struct Inputs<T> {
    q: Vec<T>,
    qd: Vec<T>,
    theta: Vec<T>,
    thetad: Vec<T>,
    qdd: Vec<T>,
    thetadd: Vec<T>,
    tau: Vec<T>,
    tau_ext: Vec<T>,
    wrenches: Vec<Force<T>>,
}

impl<T: Real> Inputs<T> {
    fn new(s: &gyroflex_testkit::State) -> Self {
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

    fn state(&self) -> State<'_, T> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }

    fn external(&self) -> External<'_, T> {
        External { tau: &self.tau_ext, wrenches: &self.wrenches }
    }
}

impl<T: Real> Core<T> {
    /// Lowers a description that is known to be valid.
    ///
    /// # Panics
    /// If the core finds it is not.
    pub fn new(spec: &RobotSpec<'_>, fidelity: Fidelity) -> Self {
        Self { lowered: Lowered::new(spec, fidelity).expect("a random robot is valid") }
    }

    /// The view the algorithms take.
    pub fn model(&self) -> Model<'_, T> {
        self.lowered.view()
    }

    /// `forward_dynamics`, by whichever route the core picks.
    pub fn forward(&self, s: &gyroflex_testkit::State) -> Accelerations {
        let (model, x) = (self.model(), Inputs::<T>::new(s));
        let mut bodies = vec![AbaScratch::new(); model.bodies().len()];
        let mut matrix = vec![nan(); matrix_len(&model)];
        self.write_forward(|out| {
            let scratch = ForwardScratch { bodies: &mut bodies, matrix: &mut matrix };
            forward_dynamics(&model, x.state(), &x.tau, x.external(), scratch, out)
        })
    }

    /// Forward dynamics by the inertia matrix.
    pub fn forward_in_joint_space(&self, s: &gyroflex_testkit::State) -> Accelerations {
        let (model, x) = (self.model(), Inputs::<T>::new(s));
        let mut bodies = vec![AbaScratch::new(); model.bodies().len()];
        let mut matrix = vec![nan(); model.nv() * model.nv()];
        self.write_forward(|out| {
            forward_in_joint_space(&model, x.state(), &x.tau, x.external(), &mut bodies, &mut matrix, out)
        })
    }

    fn write_forward(&self, run: impl FnOnce(Forward<'_, T>) -> Result<(), SizeError>) -> Accelerations {
        let nv = self.model().nv();
        let (mut qdd, mut thetadd, mut tau_j) = (vec![nan(); nv], vec![nan(); nv], vec![nan(); nv]);
        run(Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j }).expect("slices fit the model");
        Accelerations { qdd: double(&qdd), thetadd: double(&thetadd), tau_j: double(&tau_j) }
    }

    /// `rnea`.
    ///
    /// # Panics
    /// If the state does not fit the robot, as everywhere here.
    pub fn inverse(&self, s: &gyroflex_testkit::State) -> Torques {
        let (model, x) = (self.model(), Inputs::<T>::new(s));
        let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
        let (mut tau_j, mut tau) = (vec![nan(); model.nv()], vec![nan(); model.nv()]);
        let accel = Acceleration { qdd: &x.qdd, thetadd: &x.thetadd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        rnea(&model, x.state(), accel, x.external(), &mut scratch, out).expect("slices fit the model");
        Torques { tau_j: double(&tau_j), tau: double(&tau) }
    }

    /// `crba`, by rows.
    ///
    /// # Panics
    /// If the state does not fit the robot.
    pub fn mass_matrix(&self, q: &[f64]) -> Vec<f64> {
        self.write_matrix(q, crba)
    }

    /// `coupling`, by rows.
    ///
    /// # Panics
    /// If the state does not fit the robot.
    pub fn coupling(&self, q: &[f64]) -> Vec<f64> {
        self.write_matrix(q, coupling)
    }

    fn write_matrix(
        &self,
        q: &[f64],
        run: impl FnOnce(&Model<'_, T>, &[T], &mut [CrbaScratch<T>], &mut [T]) -> Result<(), SizeError>,
    ) -> Vec<f64> {
        let model = self.model();
        let mut scratch = vec![CrbaScratch::new(); model.bodies().len()];
        let mut m = vec![nan(); model.nv() * model.nv()];
        run(&model, &cast(q), &mut scratch, &mut m).expect("slices fit the model");
        double(&m)
    }

    /// The diagonal of `B`.
    ///
    /// # Panics
    /// Never, for a valid robot.
    pub fn reflected_inertia(&self) -> Vec<f64> {
        let mut b = vec![nan(); self.model().nv()];
        reflected_inertia(&self.model(), &mut b).expect("slices fit the model");
        double(&b)
    }

    /// `energy`.
    ///
    /// # Panics
    /// If the state does not fit the robot.
    pub fn energy(&self, s: &gyroflex_testkit::State) -> Energy<T> {
        let (model, x) = (self.model(), Inputs::<T>::new(s));
        let mut scratch = vec![(Transform::identity(), Motion::zero()); model.bodies().len()];
        energy(&model, x.state(), &mut scratch).expect("slices fit the model")
    }

    /// `power`.
    ///
    /// # Panics
    /// If the state does not fit the robot.
    pub fn power(&self, s: &gyroflex_testkit::State) -> Power<T> {
        let (model, x) = (self.model(), Inputs::<T>::new(s));
        let mut scratch = vec![(Transform::identity(), Motion::zero()); model.bodies().len()];
        power(&model, x.state(), &x.tau, x.external(), &mut scratch).expect("slices fit the model")
    }
}

fn nan<T: Real>() -> T {
    T::from_f64(f64::NAN)
}

fn cast<T: Real>(x: &[f64]) -> Vec<T> {
    x.iter().map(|x| T::from_f64(*x)).collect()
}

fn double<T: Real>(x: &[T]) -> Vec<f64> {
    x.iter().map(|x| (*x).into()).collect()
}
