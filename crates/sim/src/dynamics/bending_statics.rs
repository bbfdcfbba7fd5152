//! Links that bend at rest, or along a motion: which deflections they keep.

use super::Dynamics;
use super::bending::Dual;
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{self, Acceleration, External, Inverse, State};
use nalgebra::{DMatrix, DVector};

/// Newton takes a handful of steps where it converges at all.
const MAX_STEPS: usize = 60;

impl Dynamics {
    /// Deflections at which the links hang at rest in `q` under `ext`: writes the modal entries of `q`, starting from those that are there.
    /// Does nothing for a robot whose links do not bend.
    ///
    /// # Errors
    /// A slice that does not fit the model, and loads under which no equilibrium is found.
    pub fn settle(&mut self, q: &mut [f64], ext: External<f64>) -> Result<(), Error> {
        if self.modes() == 0 {
            return Ok(());
        }
        let rest = vec![0.0; self.nv()];
        self.settle_in_motion(q, &rest, &rest, ext)
    }

    /// The same for joints that move: deflections that the links keep while they accelerate as asked.
    ///
    /// # Errors
    /// As [`Dynamics::settle`].
    pub fn settle_in_motion(
        &mut self,
        q: &mut [f64],
        qd: &[f64],
        qdd: &[f64],
        ext: External<f64>,
    ) -> Result<(), Error> {
        let n = self.modes();
        if n == 0 {
            return Ok(());
        }
        let joints = q.len() - n.min(q.len());
        let mut before = f64::INFINITY;
        for _ in 0..MAX_STEPS {
            let (residual, stiffness) = self.modal_forces(q, qd, qdd, ext)?;
            let Some(step) = stiffness.lu().solve(&residual).filter(|s| s.iter().all(|x| x.is_finite())) else {
                break;
            };
            q[joints..].iter_mut().zip(step.iter()).for_each(|(eta, step)| *eta -= step);
            let size = step.amax();
            let eta = q[joints..].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            // Newton's steps shrink quadratically; once they no longer do, what is left is rounding.
            if size <= 1e-15 * eta || (size < 1e-9 * eta && size >= 0.5 * before) || size == 0.0 {
                return Ok(());
            }
            before = size;
        }
        Err(Error {
            kind: ErrorKind::Diverged,
            file: String::new(),
            element: format!("flexible_links.{}", self.model.first_bending_link().unwrap_or_default()),
            problem: "no deflection was found at which the links hang at rest".to_owned(),
            remedy: "check that the links are stiff enough for their loads, or give the modal coordinates (`eta`)"
                .to_owned(),
        })
    }

    /// Forces on the modes that a motion under `ext` asks for, and how they change with the modal coordinates.
    fn modal_forces(
        &mut self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        ext: External<f64>,
    ) -> Result<(DVector<f64>, DMatrix<f64>), Error> {
        let n = self.modes();
        let (mut force, mut slope) = (DVector::zeros(n), DMatrix::zeros(n, n));
        let (Some(model), Some(bending)) = (self.model.flexible(), &mut self.bending) else {
            return Ok((force, slope));
        };
        let nv = model.rigid().nv();
        let zeros = |n| vec![Dual::constant(0.0); n];
        let constant = |v: &[f64]| v.iter().map(|x| Dual::constant(*x)).collect::<Vec<_>>();
        let (qd, qdd) = (constant(qd), constant(qdd));
        let wrenches: Vec<_> = ext.wrenches.iter().map(|w| w.map(Dual::constant)).collect();
        let loads = constant(ext.tau);
        let ext = External { tau: &loads, wrenches: &wrenches };
        let [mut tau, mut tau_j] = [zeros(nv + n), zeros(nv + n)];
        let mut at = constant(q);
        for k in 0..n {
            let seed = at.len() - n.min(at.len()) + k;
            at[seed].0[1] = 1.0;
            let state = State { q: &at, qd: &qd, theta: &qd, thetad: &qd };
            let accel = Acceleration { qdd: &qdd, thetadd: &qdd };
            let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
            dynamics::flexible_rnea(&model, state, accel, ext, bending.dual_scratch.lend(), out)?;
            at[seed].0[1] = 0.0;
            for (j, tau) in tau[nv..].iter().enumerate() {
                (force[j], slope[(j, k)]) = (tau.value(), tau.derivative(1));
            }
        }
        Ok((force, slope))
    }

    /// Inertia, damping and stiffness of the modes while all joints are held, at rest in `q`.
    pub(crate) fn held_modes(&mut self, q: &[f64]) -> Result<[DMatrix<f64>; 3], Error> {
        let (n, nv) = (self.modes(), self.nv());
        let mut m = vec![0.0; nv * nv];
        self.mass_matrix(q, &mut m)?;
        let inertia = DMatrix::from_row_slice(nv, nv, &m).view((nv - n, nv - n), (n, n)).into_owned();
        let [_, damping] = self.modal_matrices();
        let rest = vec![0.0; nv];
        Ok([inertia, damping, self.modal_forces(q, &rest, &rest, External::none())?.1])
    }
}
