//! The core's elastic inverse, on owned vectors.

use crate::Core;
use crate::core_run::{cast, double, nan};
use gyroflex::dynamics::{
    Contains, Deflections, DerivativeScratch, ElasticInverse, ElasticInverseScratch, External, InverseError,
    JointMotion, JointOrders, MAX_COEFFICIENTS, Smoothness, SmoothnessScratch, elastic_inverse, elastic_inverse_len,
    required_smoothness, smoothness_len,
};
use gyroflex::model::{Fidelity, Model, RobotSpec};
use gyroflex::spatial::Force;
use gyroflex_testkit::Lowered;
use gyroflex_testkit::tolerance::Real;

/// What the inverse is given: rows of `nv` entries, a quantity and its time derivatives.
#[derive(Clone, Debug, Default)]
pub struct LinkMotion {
    /// Positions, `nq` entries.
    pub q: Vec<f64>,
    /// Derivatives of the positions, from the first on.
    pub derivatives: Vec<Vec<f64>>,
    /// Deflections of damped transmissions.
    pub deflection: Vec<f64>,
    /// The step after which they are wanted [s].
    pub step: f64,
    /// Generalised forces and their derivatives.
    pub tau_ext: Vec<Vec<f64>>,
    /// Wrenches on all bodies and their derivatives.
    pub wrenches: Vec<Vec<[f64; 6]>>,
}

/// What it gives, in the same rows.
#[derive(Clone, Debug)]
pub struct MotorMotion {
    /// Motor positions and derivatives.
    pub theta: Vec<Vec<f64>>,
    /// Torques through the transmissions, and their derivatives.
    pub tau_j: Vec<Vec<f64>>,
    /// Motor torques, and their derivatives.
    pub tau: Vec<Vec<f64>>,
    /// Deflections after the step.
    pub deflection: Vec<f64>,
    /// Their present rates.
    pub deflection_rate: Vec<f64>,
}

/// The orders that a robot asks for.
///
/// # Panics
/// If the robot is not valid.
pub fn smoothness(
    spec: &RobotSpec<'_>,
    fidelity: Fidelity,
    torque_derivatives: usize,
    vanishing: f64,
) -> Vec<JointOrders> {
    let lowered = Lowered::<f64>::new(spec, fidelity).expect("a random robot is valid");
    orders_of(&lowered.view(), torque_derivatives, vanishing)
}

/// The same of a lowered robot.
///
/// # Panics
/// If the core finds fault with the storage.
pub fn orders_of(model: &Model<'_, f64>, torque_derivatives: usize, vanishing: f64) -> Vec<JointOrders> {
    let (n, nv) = (model.bodies().len(), model.nv());
    let mut orders = vec![JointOrders::default(); n];
    let scratch = SmoothnessScratch {
        bodies: &mut vec![DerivativeScratch::new(); n],
        numbers: &mut vec![f64::NAN; smoothness_len(model)],
        contains: &mut vec![Contains::default(); nv * nv],
    };
    required_smoothness(model, torque_derivatives, vanishing, scratch, &mut orders).expect("slices fit the model");
    orders
}

impl<T: Real> Core<T> {
    /// `elastic_inverse` with these orders.
    ///
    /// # Errors
    /// As the core.
    pub fn elastic_inverse(
        &self,
        orders: &[JointOrders],
        torque_derivatives: usize,
        motion: &LinkMotion,
    ) -> Result<MotorMotion, InverseError> {
        let (model, smoothness) = (self.model(), Smoothness { joints: orders, torque_derivatives });
        let (nv, rows) = (model.nv(), 1 + torque_derivatives);
        let mut scratch = vec![ElasticInverseScratch::new(); elastic_inverse_len(&model, &smoothness).unwrap_or(0)];
        let flat = |rows: &[Vec<f64>]| -> Vec<T> { rows.iter().flat_map(|row| cast(row)).collect() };
        let wrenches = motion.wrenches.iter().flatten();
        let wrenches: Vec<Force<T>> = wrenches.map(|w| Force::from(w.map(T::from_f64))).collect();
        let (q, derivatives, tau_ext) = (cast(&motion.q), flat(&motion.derivatives), flat(&motion.tau_ext));
        let now = if motion.deflection.is_empty() { vec![T::zero(); nv] } else { cast(&motion.deflection) };
        let [mut theta, mut tau_j, mut tau] = [rows + 2, rows, rows].map(|r| vec![nan::<T>(); r * nv]);
        let [mut deflection, mut deflection_rate] = [(); 2].map(|()| vec![nan::<T>(); nv]);
        let mut run = |q: &[T], scratch: &mut [ElasticInverseScratch<T>]| {
            elastic_inverse::<T, MAX_COEFFICIENTS>(
                &model,
                &smoothness,
                JointMotion { q, derivatives: &derivatives },
                External { tau: &tau_ext, wrenches: &wrenches },
                Deflections { now: &now, step: T::from_f64(motion.step) },
                scratch,
                ElasticInverse {
                    theta: &mut theta,
                    tau_j: &mut tau_j,
                    tau: &mut tau,
                    deflection: &mut deflection,
                    deflection_rate: &mut deflection_rate,
                },
            )
        };
        if self.dirty {
            // Not a number cannot come out as one.
            let spoilt = vec![nan::<T>(); q.len()];
            assert!(run(&spoilt, &mut scratch).is_err() || q.is_empty());
        }
        run(&q, &mut scratch)?;
        let lines = |x: &[T]| x.chunks(nv.max(1)).map(double).collect();
        Ok(MotorMotion {
            theta: lines(&theta),
            tau_j: lines(&tau_j),
            tau: lines(&tau),
            deflection: double(&deflection),
            deflection_rate: double(&deflection_rate),
        })
    }
}
