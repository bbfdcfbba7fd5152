//! Steps in time, and positions along velocities, over joints and modes.

use super::Dynamics;
use crate::error::Error;
use gyroflex::dynamics::{External, Forward, State};
use gyroflex::integrate::{self, StateMut};
use gyroflex::model::{JointKind, Model, SizeError};

/// A function of the core over positions and velocities of joints.
type OverJoints = fn(&Model<f64>, &[f64], &[f64], &mut [f64]) -> Result<(), SizeError>;

impl Dynamics {
    /// One step of the classical Runge-Kutta scheme; see [`integrate::rk4`].
    pub(super) fn flexible_rk4(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
    ) -> Result<(), Error> {
        let (nq, nv) = (self.nq(), self.nv());
        let Some(mut work) = self.bending.as_mut().map(|b| std::mem::take(&mut b.work)) else { return Ok(()) };
        let done = self.runge_kutta(state, tau, ext, step, (nq, nv), &mut work);
        if let Some(bending) = &mut self.bending {
            bending.work = work;
        }
        done
    }

    fn runge_kutta(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
        (nq, nv): (usize, usize),
        work: &mut [f64],
    ) -> Result<(), Error> {
        let StateMut { q, qd, theta, thetad } = state;
        let (start, rest) = work.split_at_mut(nq + 3 * nv);
        let (slope, rest) = rest.split_at_mut(nq + 3 * nv);
        let (sum, tau_j) = rest.split_at_mut(nq + 3 * nv);
        let now = q.iter().chain(qd.iter()).chain(theta.iter()).chain(thetad.iter());
        start.iter_mut().zip(now).for_each(|(slot, x)| *slot = *x);
        sum.fill(0.0);
        // x ← x₀ + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄), each slope taken at x₀ + (0, ½, ½, 1) h k.
        for (reach, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
            let (q_rate, rates) = slope.split_at_mut(nq);
            let (qdd, rates) = rates.split_at_mut(nv);
            let (theta_rate, thetadd) = rates.split_at_mut(nv);
            let at = State { q: &*q, qd: &*qd, theta: &*theta, thetad: &*thetad };
            self.forward(at, tau, ext, Forward { qdd, thetadd, tau_j: &mut *tau_j })?;
            self.position_rate(q, qd, q_rate)?;
            theta_rate.copy_from_slice(thetad);
            sum.iter_mut().zip(slope.iter()).for_each(|(total, k)| *total += weight * k);
            let next = q.iter_mut().chain(qd.iter_mut()).chain(theta.iter_mut()).chain(thetad.iter_mut());
            next.zip(start.iter().zip(slope.iter())).for_each(|(next, (x0, k))| *next = x0 + reach * step * k);
        }
        let next = q.iter_mut().chain(qd.iter_mut()).chain(theta.iter_mut()).chain(thetad.iter_mut());
        next.zip(start.iter().zip(sum.iter())).for_each(|(next, (x0, total))| *next = x0 + step / 6.0 * total);
        self.normalize(q)?;
        self.follow_joints(StateMut { q, qd, theta, thetad });
        Ok(())
    }

    /// One step of semi-implicit Euler; see [`integrate::semi_implicit_euler`].
    pub(super) fn flexible_euler(
        &mut self,
        state: StateMut<f64>,
        tau: &[f64],
        ext: External<f64>,
        step: f64,
    ) -> Result<(), Error> {
        let (nq, nv) = (self.nq(), self.nv());
        let Some(mut work) = self.bending.as_mut().map(|b| std::mem::take(&mut b.work)) else { return Ok(()) };
        let (qdd, rest) = work.split_at_mut(nv);
        let (thetadd, rest) = rest.split_at_mut(nv);
        let (shift, rest) = rest.split_at_mut(nv);
        let q_next = &mut rest[..nq];
        let StateMut { q, qd, theta, thetad } = state;
        let at = State { q: &*q, qd: &*qd, theta: &*theta, thetad: &*thetad };
        let done = self.forward(at, tau, ext, Forward { qdd, thetadd, tau_j: &mut *shift }).and_then(|()| {
            for k in 0..nv {
                qd[k] += step * qdd[k];
                thetad[k] += step * thetadd[k];
                shift[k] = step * qd[k];
                theta[k] += step * thetad[k];
            }
            self.integrate(q, shift, q_next)
        });
        if done.is_ok() {
            q.copy_from_slice(q_next);
            self.follow_joints(StateMut { q, qd, theta, thetad });
        }
        if let Some(bending) = &mut self.bending {
            bending.work = work;
        }
        done
    }

    /// `q ⊕ v`; see [`integrate::integrate`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn integrate(&self, q: &[f64], v: &[f64], out: &mut [f64]) -> Result<(), Error> {
        self.by_joints_and_modes(q, v, out, integrate::integrate, |q, v| q + v)
    }

    /// `dq/dt`; see [`integrate::position_rate`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn position_rate(&self, q: &[f64], qd: &[f64], out: &mut [f64]) -> Result<(), Error> {
        self.by_joints_and_modes(q, qd, out, integrate::position_rate, |_, v| v)
    }

    /// Brings the quaternion of a floating root back to unit length; see [`integrate::normalize`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn normalize(&self, q: &mut [f64]) -> Result<(), Error> {
        let joints = q.len() - self.modes().min(q.len());
        Ok(integrate::normalize(&self.model(), &mut q[..joints])?)
    }

    /// A function of the core over the joints, another over each mode.
    fn by_joints_and_modes(
        &self,
        q: &[f64],
        v: &[f64],
        out: &mut [f64],
        joints: OverJoints,
        mode: fn(f64, f64) -> f64,
    ) -> Result<(), Error> {
        let n = self.modes();
        let split = |len: usize| len.saturating_sub(n);
        let (q, eta) = q.split_at(split(q.len()));
        let (v, etad) = v.split_at(split(v.len()));
        let (out, modes) = out.split_at_mut(split(out.len()));
        joints(&self.model(), q, v, out)?;
        modes.iter_mut().zip(eta.iter().zip(etad)).for_each(|(out, (q, v))| *out = mode(*q, *v));
        Ok(())
    }

    /// Without an elastic transmission the motor turns with the joint; a mode has none.
    fn follow_joints(&self, state: StateMut<f64>) {
        let model = self.model();
        for body in model.bodies() {
            let (i, k) = (body.q_index(), body.v_index());
            match body.joint {
                JointKind::Floating => {
                    state.theta[k..k + 6].fill(0.0);
                    state.thetad[k..k + 6].fill(0.0);
                }
                _ if !body.is_elastic() => (state.theta[k], state.thetad[k]) = (state.q[i], state.qd[k]),
                _ => {}
            }
        }
        state.theta[model.nv()..].copy_from_slice(&state.q[model.nq()..]);
        state.thetad[model.nv()..].copy_from_slice(&state.qd[model.nv()..]);
    }
}
