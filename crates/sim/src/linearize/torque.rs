//! Equilibrium for given motor torques: the pose at which they hold the robot.

use super::outputs::curvature;
use super::point::check;
use super::{Linearizer, OperatingPoint};
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{Acceleration, DerivativeScratch, External, InverseDerivatives, inverse_derivatives};
use gyroflex::integrate::integrate;
use nalgebra::{DMatrix, DVector};

/// Newton takes a handful of steps where it converges at all.
const MAX_STEPS: usize = 100;
/// Relative to the largest torque in play.
const TOLERANCE: f64 = 1e-10;
/// Poses differ by less than this in one step [rad or m].
const REACH: f64 = 0.5;

impl Linearizer {
    /// The equilibrium, from the start `q` (`nq` entries), at which the motors exert `tau` (`nv` entries, or one a joint).
    ///
    /// Newton's method on the statics `τ(q) = τ`, with motor positions following the transmissions' torques. Directions in which
    /// no torque depends on the pose, as about a vertical axis, are left as they start.
    ///
    /// # Errors
    /// Vectors that do not fit, a floating root, or torques at which no equilibrium was found.
    pub fn equilibrium_for(&mut self, tau: &[f64], start: &[f64]) -> Result<OperatingPoint, Error> {
        self.robot.refuse_bending(
            "the search for the pose at which given torques hold the robot",
            "give the pose itself with q: the deflections there are found",
        )?;
        check("tau", tau, self.layout.nv())?;
        if self.layout.floating() {
            return Err(refused(
                "a floating root has no motors that could hold it".to_owned(),
                "fix the root, or give the pose with q",
            ));
        }
        let target = DVector::from_column_slice(tau);
        let mut point = self.equilibrium_at(start)?;
        let mut residual = &target - DVector::from_column_slice(&point.tau);
        for _ in 0..MAX_STEPS {
            let stiffness = self.stiffness(&point)?;
            let scale = target.amax().max(stiffness.amax());
            if residual.amax() <= TOLERANCE * scale {
                return Ok(point);
            }
            // The shortest step that serves best: directions without stiffness stay.
            let svd = stiffness.svd(true, true);
            let small = 1e-8 * svd.singular_values.max();
            let Ok(mut step) = svd.solve(&residual, small) else { break };
            step *= (REACH / step.amax()).min(1.0);
            // Half as far, until it helps.
            let mut better = None;
            for _ in 0..40 {
                let moved = self.equilibrium_at(&self.moved(&point, step.as_slice())?)?;
                let left = &target - DVector::from_column_slice(&moved.tau);
                if left.norm() < residual.norm() {
                    better = Some((moved, left));
                    break;
                }
                step *= 0.5;
            }
            match better {
                Some((moved, left)) => (point, residual) = (moved, left),
                None => break,
            }
        }
        let worst = (0..residual.len()).max_by(|a, b| residual[*a].abs().total_cmp(&residual[*b].abs())).unwrap_or(0);
        Err(refused(
            format!(
                "no pose was found at which these torques hold the robot: at the nearest, joint `{}` asks for {:.4e} where {:.4e} \
                 is given",
                self.layout.joint(worst),
                point.tau[worst],
                tau[worst]
            ),
            "give torques that gravity can ask for, another pose to start from, or the pose itself with q",
        ))
    }

    /// `∂τ/∂q` of the statics [N m/rad]: that of inverse dynamics at rest, and where the transmission is elastic,
    /// `∂τ = (1 − e') ∂τ_J − e'' τ_J ∂θ` with `(1 − e') ∂θ = ∂q + ∂τ_J / k'(δ)`.
    fn stiffness(&self, point: &OperatingPoint) -> Result<DMatrix<f64>, Error> {
        let (model, nv) = (self.dynamics.model(), self.layout.nv());
        let rest = vec![0.0; nv];
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; 6 * nv * nv]);
        let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
        let accel = Acceleration { qdd: &rest, thetadd: &rest };
        let out = InverseDerivatives { tau_j: &mut tau_j, tau: &mut tau };
        inverse_derivatives(&model, point.state.view(), accel, External::none(), &mut scratch, out)?;
        let by_pose = |all: &[f64]| DMatrix::from_row_slice(nv, 6 * nv, all).columns(0, nv).into_owned();
        let (on_joint, mut on_motor) = (by_pose(&tau_j), by_pose(&tau));
        for body in model.bodies() {
            let Some(drive) = &body.drive else { continue };
            let Some(elastic) = &drive.elastic else { continue };
            let (k, ratio, theta) = (body.v_index(), drive.rotor.gear_ratio, point.state.theta[body.v_index()]);
            let (e, slope) = elastic.error.map_or((0.0, 0.0), |e| e.value_and_slope(theta, ratio));
            let bend = elastic.error.map_or(0.0, |x| curvature(&x, e, ratio));
            let deflection = theta - point.state.q[body.q_index()] - e;
            let (through, stiffness) =
                (elastic.spring.torque(deflection, model.knots()), elastic.spring.slope(deflection, model.knots()));
            let share = 1.0 - slope;
            let mut row = on_joint.row(k).into_owned();
            row *= share - bend * through / (share * stiffness);
            row[k] -= bend * through / share;
            on_motor.set_row(k, &row);
        }
        Ok(on_motor)
    }

    fn moved(&self, point: &OperatingPoint, step: &[f64]) -> Result<Vec<f64>, Error> {
        let mut q = point.state.q.clone();
        integrate(&self.dynamics.model(), &point.state.q, step, &mut q)?;
        Ok(q)
    }
}

fn refused(problem: String, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: "tau".to_owned(),
        problem,
        remedy: remedy.to_owned(),
    }
}
