//! Equilibrium for given motor torques: the pose at which they hold the robot.

use super::point::check;
use super::{Linearizer, OperatingPoint};
use crate::error::{Error, ErrorKind};
use gyroflex::integrate::integrate;
use nalgebra::{DMatrix, DVector};

/// Newton takes a handful of steps where it converges at all.
const MAX_STEPS: usize = 100;
/// Relative to the largest torque in play.
const TOLERANCE: f64 = 1e-10;
/// Half the width of the difference that gives the stiffness [rad or m].
const STEP: f64 = 1e-5;
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

    /// `∂τ/∂q` of the statics [N m/rad], by central differences.
    fn stiffness(&mut self, point: &OperatingPoint) -> Result<DMatrix<f64>, Error> {
        let nv = self.layout.nv();
        let mut stiffness = DMatrix::zeros(nv, nv);
        for k in 0..nv {
            let mut step = vec![0.0; nv];
            for sign in [1.0, -1.0] {
                step[k] = sign * STEP;
                let q = self.moved(point, &step)?;
                let tau = DVector::from_vec(self.equilibrium_at(&q)?.tau);
                let mut column = stiffness.column_mut(k);
                column += tau * (sign / (2.0 * STEP));
            }
        }
        Ok(stiffness)
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
