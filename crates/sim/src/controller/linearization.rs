//! Feedback linearization of the reduced model, with storage of its own.

use crate::coordinates::Coordinates;
use crate::error::Error;
use crate::inverse::InverseModel;
use crate::load::yaml::Keys;
use crate::reference::References;
use crate::robot::Robot;
use crate::scenario::fault;
use gyroflex::Jet;
use gyroflex::control::{FeedbackLinearization, LinearizationScratch};
use gyroflex::dynamics::{AbaScratch, ElasticInverseScratch, State, elastic_inverse_len};
use gyroflex::model::Fidelity;

/// The controller.
#[derive(Clone, Debug)]
pub(super) struct Linearization {
    reduced: InverseModel,
    bandwidth: Vec<f64>,
    degree: usize,
    desired: Vec<f64>,
    of_joint: Vec<f64>,
    bodies: Vec<AbaScratch<Jet<f64, 2>>>,
    series: Vec<ElasticInverseScratch<f64>>,
    jets: Vec<Jet<f64, 2>>,
    numbers: Vec<f64>,
}

impl Linearization {
    /// # Errors
    /// A robot that it cannot drive: with a floating root, driven joints that are rigid or have no drive, or transmissions some of
    /// which are damped.
    pub(super) fn new(robot: &Robot, joints: &Coordinates, bandwidth: Vec<f64>, keys: &Keys) -> Result<Self, Error> {
        let reduced = InverseModel::new(robot, Fidelity::Reduced, 0)?;
        let (model, smoothness) = (reduced.model().view(), reduced.smoothness());
        let fail = |problem: String| {
            Err(fault(keys, "controller.type", problem, "use `two_degree_of_freedom` or `computed_torque`"))
        };
        if joints.floating {
            return fail("feedback linearization cannot drive a floating root, which has no motor".to_owned());
        }
        if let Some(rigid) = joints.joints.iter().find(|j| !model.bodies()[j.body].is_elastic()) {
            return fail(format!("feedback linearization needs elastic joints, but `{}` is not", rigid.name));
        }
        let damped = smoothness.joints.iter().filter(|j| j.damped).count();
        if damped != 0 && damped != joints.len() {
            let problem = "feedback linearization needs transmissions that are all damped, or all undamped";
            return fail(problem.to_owned());
        }
        let law = FeedbackLinearization { model, smoothness, bandwidth: &bandwidth };
        let (nv, n, degree) = (model.nv(), model.bodies().len(), law.relative_degree());
        let length = elastic_inverse_len(&model, &smoothness).unwrap_or(0);
        Ok(Self {
            degree,
            desired: vec![0.0; (degree + 1) * nv],
            of_joint: vec![0.0; degree + 1],
            bodies: vec![AbaScratch::new(); n],
            series: vec![ElasticInverseScratch::new(); length],
            jets: vec![Jet([0.0; 2]); 8 * nv],
            numbers: vec![0.0; 11 * nv],
            bandwidth,
            reduced,
        })
    }

    /// Motor torques for the reference at time `t` [s] and the whole state.
    pub(super) fn tick(
        &mut self,
        references: &References,
        t: f64,
        state: State<f64>,
        tau: &mut [f64],
    ) -> Result<(), Error> {
        let nv = tau.len();
        for joint in 0..nv {
            references.derivatives(joint, t, &mut self.of_joint);
            for (row, x) in self.of_joint.iter().enumerate() {
                self.desired[row * nv + joint] = *x;
            }
        }
        let law = FeedbackLinearization {
            model: self.reduced.model().view(),
            smoothness: self.reduced.smoothness(),
            bandwidth: &self.bandwidth,
        };
        let scratch = LinearizationScratch {
            bodies: &mut self.bodies,
            series: &mut self.series,
            jets: &mut self.jets,
            numbers: &mut self.numbers,
        };
        law.torque(&self.desired, state, scratch, tau).map_err(|error| self.reduced.error(error))
    }

    /// Whether the references have the derivatives that the law feeds forward.
    ///
    /// # Errors
    /// Names the joints that have not.
    pub(super) fn check(&self, references: &References, joints: &Coordinates, keys: &Keys) -> Result<(), Error> {
        let rough = joints.names().enumerate().filter_map(|(i, name)| {
            let given = references.smoothness(i).filter(|given| *given < self.degree)?;
            Some(format!("`{name}` has {given}"))
        });
        let rough: Vec<_> = rough.collect();
        if rough.is_empty() {
            return Ok(());
        }
        let problem = format!("feedback linearization needs {} derivatives: {}", self.degree, rough.join(", "));
        Err(fault(keys, "reference", problem, "use smoother references: `filtered_step`, `polynomial`, `sines`"))
    }
}
