//! Feedback linearization of the reduced model.
//!
//! With full feedback of links and motors, a robot whose rotors do not couple with the links (Spong's reduced model) and whose
//! driven joints are all elastic can be made a row of integrators: the torque that gives `q` the highest derivative `v` it can be given at
//! once is the inverse at the present state. Undamped that is the fourth derivative (Spong 1987, §4; De Luca & Book, eq. 11.97), damped the
//! third (the second of `θ` acts on the link at once):
//!
//! ```text
//! v = q_d⁽ʳ⁾ + Σ_{k<r} c_k (q_d⁽ᵏ⁾ − q⁽ᵏ⁾),   Σ c_k sᵏ + sʳ = (s + ω)ʳ
//! ```
//!
//! `q̈` follows from the state by forward dynamics, and `q⁽³⁾` by the same algorithm on a series of two coefficients.

use crate::dynamics::{
    AbaScratch, Deflections, ElasticInverse, ElasticInverseScratch, External, Forward, InverseError, JointMotion,
    Smoothness, State, aba, elastic_inverse,
};
use crate::model::Model;
use crate::{Jet, Scalar};

/// The controller.
#[derive(Clone, Copy, Debug)]
pub struct FeedbackLinearization<'a, T: Scalar> {
    /// The robot's reduced model, on a fixed base, every driven joint elastic, either all damped or none.
    pub model: Model<'a, T::Param>,
    /// What its inverse needs.
    pub smoothness: Smoothness<'a>,
    /// `ω`: closed-loop bandwidth of every joint, `nv` entries [rad/s].
    pub bandwidth: &'a [T],
}

/// What [`FeedbackLinearization::torque`] works in.
#[derive(Debug)]
pub struct LinearizationScratch<'a, T> {
    /// One record per body.
    pub bodies: &'a mut [AbaScratch<Jet<T, 2>>],
    /// As many as [`elastic_inverse_len`](crate::dynamics::elastic_inverse_len) says.
    pub series: &'a mut [ElasticInverseScratch<T>],
    /// `8 nv` entries.
    pub jets: &'a mut [Jet<T, 2>],
    /// `11 nv` entries.
    pub numbers: &'a mut [T],
}

impl<T: Scalar> FeedbackLinearization<'_, T> {
    /// How many derivatives of `q` the torque sets: 4, or 3 of damped robots.
    pub fn relative_degree(&self) -> usize {
        if self.smoothness.joints.iter().any(|j| j.damped) { 3 } else { 4 }
    }

    /// Motor torques `tau` (`nv` entries, reflected). `desired` has rows of `nv` entries: the position, and as many derivatives as the
    /// relative degree.
    ///
    /// # Errors
    /// [`InverseError`]: slices that do not fit, or torques that are not finite.
    pub fn torque(
        &self,
        desired: &[T],
        state: State<T>,
        scratch: LinearizationScratch<T>,
        tau: &mut [T],
    ) -> Result<(), InverseError> {
        use crate::model::SizeError;
        let (nv, degree) = (self.model.nv(), self.relative_degree());
        SizeError::check("desired", desired.len(), (degree + 1) * nv)?;
        SizeError::check("bandwidth", self.bandwidth.len(), nv)?;
        SizeError::check("q", state.q.len(), nv)?;
        SizeError::check("scratch.jets", scratch.jets.len(), 8 * nv)?;
        SizeError::check("scratch.numbers", scratch.numbers.len(), 11 * nv)?;
        let LinearizationScratch { bodies, series, jets, numbers } = scratch;

        // q̈ and its rate, once with the accelerations of the motors unknown, which an undamped transmission does not feel; those of the
        // links come from the first sweep.
        let (q, jets) = jets.split_at_mut(nv);
        let (qd, jets) = jets.split_at_mut(nv);
        let (theta, jets) = jets.split_at_mut(nv);
        let (thetad, jets) = jets.split_at_mut(nv);
        let (qdd, jets) = jets.split_at_mut(nv);
        let (thetadd, jets) = jets.split_at_mut(nv);
        let (tau_j, zeros) = jets.split_at_mut(nv);
        zeros.fill(Jet::zero());
        qdd.fill(Jet::zero());
        for _ in 0..2 {
            let of = |all: &[T], k: usize| all.get(k).map_or(T::zero(), |x| *x);
            for k in 0..nv {
                q[k] = Jet([of(state.q, k), of(state.qd, k)]);
                qd[k] = Jet([of(state.qd, k), qdd[k].value()]);
                theta[k] = Jet([of(state.theta, k), of(state.thetad, k)]);
                thetad[k] = Jet([of(state.thetad, k), T::zero()]);
            }
            let state = State { q, qd, theta, thetad };
            let out = Forward { qdd: &mut *qdd, thetadd: &mut *thetadd, tau_j: &mut *tau_j };
            aba(&self.model, state, zeros, External::none(), bodies, out)?;
        }

        // The motion that the inverse is asked for: measured, and its highest derivative commanded
        let (derivatives, rest) = numbers.split_at_mut(4 * nv);
        let (motors, rest) = rest.split_at_mut(3 * nv);
        let (torques, rest) = rest.split_at_mut(nv);
        let (deflection, rest) = rest.split_at_mut(nv);
        let (after, rate) = rest.split_at_mut(nv);
        for k in 0..nv {
            let of = |all: &[T], k: usize| all.get(k).map_or(T::zero(), |x| *x);
            let now = [of(state.q, k), of(state.qd, k), qdd[k].value(), qdd[k].0[1]];
            let mut highest = of(desired, degree * nv + k);
            // c_k = C(r, k) ω^(r−k)
            let (mut power, mut choose) = (T::one(), 1.0);
            for row in (0..degree).rev() {
                power = power * of(self.bandwidth, k);
                choose = choose * (row + 1) as f64 / (degree - row) as f64;
                highest = (power * T::from_f64(choose)).mul_add(of(desired, row * nv + k) - now[row], highest);
            }
            for row in 1..=degree {
                derivatives[(row - 1) * nv + k] = if row < degree { now[row] } else { highest };
            }
            deflection[k] = of(state.theta, k) - of(state.q, k);
        }
        for body in self.model.bodies() {
            let (k, Some(drive)) = (body.v_index(), &body.drive) else { continue };
            if let (Some(error), Some(slot)) = (drive.elastic.and_then(|e| e.error), deflection.get_mut(k)) {
                let theta = state.theta.get(k).map_or(T::zero(), |x| *x);
                *slot -= error.value_and_slope(theta, T::from_param(drive.rotor.gear_ratio)).0;
            }
        }
        elastic_inverse::<T, 4>(
            &self.model,
            &self.smoothness,
            JointMotion { q: state.q, derivatives: derivatives.get(..degree * nv).unwrap_or(&[]) },
            External::none(),
            Deflections { now: deflection, step: T::zero() },
            series,
            ElasticInverse { theta: motors, tau_j: torques, tau, deflection: after, deflection_rate: rate },
        )
    }
}
