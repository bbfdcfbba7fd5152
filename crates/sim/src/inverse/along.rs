//! The inverse of a robot along references.

use super::InverseModel;
use crate::coordinates::Coordinates;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::reference::References;
use crate::scenario::fault;
use gyroflex::dynamics::External;

/// An inverse, and the motion of the links at one instant.
#[derive(Clone, Debug)]
pub struct ReferenceInverse {
    inverse: InverseModel,
    joints: Coordinates,
    order: usize,
    q: Vec<f64>,
    derivatives: Vec<f64>,
    of_joint: Vec<f64>,
}

/// Times the slowest transmission settles in before the start.
const SETTLING_TIMES: f64 = 8.0;
/// Steps of that.
const SETTLING_STEPS: u32 = 400;
/// The longest way back before the start [s].
const LONGEST_SETTLING: f64 = 2.0;

impl ReferenceInverse {
    /// Takes an inverse of a robot on a fixed base, for references that are smooth enough for it.
    ///
    /// # Errors
    /// A floating root, and references with too few derivatives, joint by joint.
    pub fn new(
        inverse: InverseModel,
        joints: &Coordinates,
        references: &References,
        keys: &Keys,
    ) -> Result<Self, Error> {
        refuse_floating_root(joints, keys)?;
        let (orders, most) = (inverse.smoothness().joints, inverse.smoothness().order());
        let remedy = format!(
            "use `filtered_step` with `order: {most}`, `polynomial` with `order: {}` or `sines`; or invert a model that needs fewer: \
             `reduced`, or one with added `damping`; or prescribe the motors' motion, for which 2 are enough",
            most.saturating_sub(1)
        );
        check_smoothness(joints, references, keys, |body| orders[body].position, &remedy)?;
        let nv = inverse.deflection().len();
        let order = inverse.smoothness().order();
        Ok(Self {
            q: vec![0.0; joints.len()],
            derivatives: vec![0.0; order * nv],
            of_joint: vec![0.0; order + 1],
            joints: joints.clone(),
            inverse,
            order,
        })
    }

    /// The inverse, with what it found last.
    pub fn inverse(&self) -> &InverseModel {
        &self.inverse
    }

    /// Sets the deflections of damped transmissions, `nv` entries [rad or m]: for integrators of one's own.
    pub fn set_deflection(&mut self, deflection: &[f64]) {
        self.inverse.set_deflection(deflection);
    }

    /// Positions of the links at the last instant: `nq` entries.
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// A derivative of the positions there, from the first on: `nv` entries.
    pub fn derivative(&self, k: usize) -> &[f64] {
        let nv = self.inverse.deflection().len();
        &self.derivatives[(k - 1) * nv..k * nv]
    }

    /// Deflects the transmissions as they are at time 0 after a long time on the references: those of equilibrium, and for damped ones what
    /// has settled since.
    ///
    /// # Errors
    /// As [`InverseModel::at`].
    pub fn start(&mut self, references: &References) -> Result<(), Error> {
        let model = self.inverse.model().view();
        let slowest = model.bodies().iter().filter_map(|b| b.drive.and_then(|d| d.elastic)).filter(|e| e.damping > 0.0);
        let rate = slowest.map(|e| e.spring.stiffness / e.damping).fold(f64::INFINITY, f64::min);
        let time = if rate.is_finite() { (SETTLING_TIMES / rate).min(LONGEST_SETTLING) } else { 0.0 };
        let step = time / f64::from(SETTLING_STEPS);
        self.rest(references, -time)?;
        if time > 0.0 {
            for i in 0..SETTLING_STEPS {
                self.at(references, f64::from(i) * step - time, step)?;
                self.inverse.advance();
            }
        }
        self.at(references, 0.0, 0.0)
    }

    /// Deflections of equilibrium at time `t`.
    fn rest(&mut self, references: &References, t: f64) -> Result<(), Error> {
        self.look(references, t);
        self.inverse.rest(&self.q, External::none())
    }

    /// Motors and torques at time `t` [s]; `step` is the time to the next instant, for which `advance` of the inverse moves its
    /// deflections.
    ///
    /// # Errors
    /// As [`InverseModel::at`].
    pub fn at(&mut self, references: &References, t: f64, step: f64) -> Result<(), Error> {
        self.look(references, t);
        self.invert(step)
    }

    /// The same for the motion of the last look.
    pub(super) fn invert(&mut self, step: f64) -> Result<(), Error> {
        self.inverse.at(&self.q, &self.derivatives, External::none(), step)
    }

    /// Moves the deflections on by the step of the last instant.
    pub fn advance(&mut self) {
        self.inverse.advance();
    }

    /// The motion of the links at time `t`.
    pub(super) fn look(&mut self, references: &References, t: f64) {
        let nv = self.inverse.deflection().len();
        for (i, joint) in self.joints.joints.iter().enumerate() {
            references.derivatives(i, t, &mut self.of_joint);
            self.q[joint.q] = self.of_joint[0];
            for k in 0..self.order {
                self.derivatives[k * nv + joint.v] = self.of_joint[k + 1];
            }
        }
    }
}

/// # Errors
/// A floating root.
pub(super) fn refuse_floating_root(joints: &Coordinates, keys: &Keys) -> Result<(), Error> {
    if joints.floating {
        let problem = "a reference moves joints only, but the robot's root floats";
        return Err(fault(keys, "reference", problem, "fix the root"));
    }
    Ok(())
}

/// # Errors
/// References with fewer derivatives than are `needed` of the joint of a body, joint by joint.
pub(super) fn check_smoothness(
    joints: &Coordinates,
    references: &References,
    keys: &Keys,
    needed: impl Fn(usize) -> u8,
    remedy: &str,
) -> Result<(), Error> {
    let mut rough = Vec::new();
    for (i, joint) in joints.joints.iter().enumerate() {
        let needed = needed(joint.body);
        if let Some(given) = references.smoothness(i).filter(|given| *given < usize::from(needed)) {
            rough.push(format!("`{}` needs {needed} and has {given}", joint.name));
        }
    }
    if rough.is_empty() {
        return Ok(());
    }
    let problem = format!("the torques depend on more derivatives than the references have: {}", rough.join(", "));
    Err(fault(keys, "reference", problem, remedy))
}
