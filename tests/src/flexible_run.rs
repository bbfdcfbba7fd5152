//! The core's algorithms of flexible links on owned vectors, with scratch as dirty as asked for.

use crate::core_run::{Inputs, double, nan};
use gyroflex::Scalar;
use gyroflex::dynamics::{
    Acceleration, Energy, FlexibleBody, FlexibleMatrices, FlexibleMode, FlexiblePlacements, FlexibleScratch,
    FlexibleStation, Forward, Inverse, Power, flexible_aba, flexible_energy, flexible_hybrid, flexible_mass_matrix,
    flexible_matrix_len, flexible_placements, flexible_power, flexible_rnea, flexible_shapes_len,
};
use gyroflex::model::{Fidelity, FlexibleModel, SizeError};
use gyroflex::spatial::{Motion, Transform};
use gyroflex_testkit::State as Point;
use gyroflex_testkit::dense::{Accelerations, Torques};
use gyroflex_testkit::flexible::LoweredFlexible;
use gyroflex_testkit::random::RandomFlexible;
use gyroflex_testkit::tolerance::Real;

/// A robot with flexible links lowered to one model and scalar; states and results are `f64` at the border.
#[derive(Clone, Debug)]
pub struct FlexibleCore<T: Real> {
    lowered: LoweredFlexible<T::Param>,
    dirty: bool,
}

impl<T: Real> FlexibleCore<T> {
    /// Lowers a description that is known to be valid.
    ///
    /// # Panics
    /// If the core finds it is not; and in all that follows, if a state does not fit the robot.
    pub fn new(robot: &RandomFlexible, fidelity: Fidelity) -> Self {
        let lowered = robot.lower(fidelity).unwrap_or_else(|e| panic!("seed {}: {e}", robot.robot.seed));
        Self { lowered, dirty: false }
    }

    /// Runs every algorithm on NaN first, and then again in the scratch that is left.
    pub fn with_dirty_scratch(self) -> Self {
        Self { dirty: true, ..self }
    }

    /// The view the algorithms take.
    pub fn model(&self) -> FlexibleModel<'_, T::Param> {
        self.lowered.view()
    }

    /// `flexible_aba`.
    pub fn forward(&self, s: &Point) -> Accelerations {
        let model = self.model();
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![nan::<T>(); model.nv()]);
        self.call(s, |x, scratch| {
            let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            flexible_aba(&model, x.state(), &x.tau, x.external(), scratch, out)
        });
        Accelerations { qdd: double(&qdd), thetadd: double(&thetadd), tau_j: double(&tau_j) }
    }

    /// `flexible_rnea`.
    pub fn inverse(&self, s: &Point) -> Torques {
        let model = self.model();
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![nan::<T>(); model.nv()]);
        self.call(s, |x, scratch| {
            let accel = Acceleration { qdd: &x.qdd, thetadd: &x.thetadd };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            flexible_rnea(&model, x.state(), accel, x.external(), scratch, out)
        });
        Torques { tau_j: double(&tau_j), tau: double(&tau) }
    }

    /// `flexible_hybrid`: torques, and accelerations of the modes.
    pub fn hybrid(&self, s: &Point) -> (Torques, Vec<f64>) {
        let model = self.model();
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![nan::<T>(); model.nv()]);
        let mut etadd = vec![nan::<T>(); model.modes()];
        self.call(s, |x, scratch| {
            let accel = Acceleration { qdd: &x.qdd, thetadd: &x.thetadd };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            flexible_hybrid(&model, x.state(), accel, x.external(), scratch, out, &mut etadd)
        });
        (Torques { tau_j: double(&tau_j), tau: double(&tau) }, double(&etadd))
    }

    /// `flexible_mass_matrix`: inertia, then coupling to elastic rotors, by rows.
    pub fn matrices(&self, s: &Point) -> [Vec<f64>; 2] {
        let model = self.model();
        let [mut mass, mut coupling] = [(); 2].map(|()| vec![nan::<T>(); model.nv() * model.nv()]);
        self.call(s, |x, scratch| {
            let out = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
            flexible_mass_matrix(&model, &x.q, scratch, out)
        });
        [double(&mass), double(&coupling)]
    }

    /// `flexible_energy`.
    pub fn energy(&self, s: &Point) -> Energy<f64> {
        let model = self.model();
        let e = self.call(s, |x, scratch| flexible_energy(&model, x.state(), scratch));
        Energy { kinetic: e.kinetic.to_f64(), gravity: e.gravity.to_f64(), elastic: e.elastic.to_f64() }
    }

    /// `flexible_power`.
    pub fn power(&self, s: &Point) -> Power<f64> {
        let model = self.model();
        let p = self.call(s, |x, scratch| flexible_power(&model, x.state(), &x.tau, x.external(), scratch));
        Power { supplied: p.supplied.to_f64(), dissipated: p.dissipated.to_f64() }
    }

    /// `flexible_placements`: positions and rotations of links, then of stations, twelve numbers each.
    pub fn placements(&self, s: &Point) -> [Vec<f64>; 2] {
        let model = self.model();
        let mut links = vec![Transform::<T>::identity(); model.rigid().bodies().len()];
        let mut stations = vec![Transform::<T>::identity(); model.stations().len()];
        self.call(s, |x, scratch| {
            let out = FlexiblePlacements { links: &mut links, stations: &mut stations };
            flexible_placements(&model, &x.q, scratch, out)
        });
        [links, stations].map(|poses| {
            let numbers = poses.iter().flat_map(|x| [x.pos, x.rot.rows[0], x.rot.rows[1], x.rot.rows[2]]);
            numbers.flat_map(|v| v.to_array()).map(T::to_f64).collect()
        })
    }

    fn call<R>(&self, s: &Point, mut run: impl FnMut(&Inputs<T>, FlexibleScratch<'_, T>) -> Result<R, SizeError>) -> R {
        let mut storage = FlexibleStorage::<T>::new(&self.model());
        let mut once = |x: &Inputs<T>| run(x, storage.scratch()).expect("slices fit the model");
        let x = Inputs::new(s);
        if self.dirty {
            once(&x.spoilt());
        }
        once(&x)
    }
}

/// Owns what a [`FlexibleScratch`] borrows.
#[derive(Clone, Debug)]
pub struct FlexibleStorage<T> {
    bodies: Vec<FlexibleBody<T>>,
    stations: Vec<FlexibleStation<T>>,
    modes: Vec<FlexibleMode<T>>,
    shapes: Vec<Motion<T>>,
    matrix: Vec<T>,
}

impl<T: Scalar> FlexibleStorage<T> {
    /// As much as a model needs.
    pub fn new(model: &FlexibleModel<'_, T::Param>) -> Self {
        Self {
            bodies: vec![FlexibleBody::new(); model.rigid().bodies().len()],
            stations: vec![FlexibleStation::new(); model.stations().len()],
            modes: vec![FlexibleMode::new(); model.modes()],
            shapes: vec![Motion::zero(); flexible_shapes_len(model)],
            matrix: vec![T::from_f64(f64::NAN); flexible_matrix_len(model)],
        }
    }

    /// The view the algorithms take.
    pub fn scratch(&mut self) -> FlexibleScratch<'_, T> {
        FlexibleScratch {
            bodies: &mut self.bodies,
            stations: &mut self.stations,
            modes: &mut self.modes,
            shapes: &mut self.shapes,
            matrix: &mut self.matrix,
        }
    }
}
