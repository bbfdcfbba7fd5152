//! The matrices of robots whose links bend, by derivatives of the inertia matrix.

use super::Dynamics;
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{Acceleration, Bias, CoriolisMatrices, External, InertiaRates, Inverse, State};
use gyroflex::model::JointKind;
use nalgebra::DVector;

impl Dynamics {
    /// `C, C₁, C₂` in Christoffel form: `½ Σ_k (∂_k 𝓜_ij + ∂_j 𝓜_ik − ∂_i 𝓜_jk) ẋ_k`, `𝓜 = [M S; Sᵀ B]` a function of `q` alone.
    pub(super) fn flexible_coriolis(&mut self, state: State<f64>, out: CoriolisMatrices<f64>) -> Result<(), Error> {
        if self.model().bodies().first().is_some_and(|b| b.joint == JointKind::Floating) {
            return Err(Error {
                kind: ErrorKind::Model,
                file: String::new(),
                element: format!("flexible_links, link `{}`", self.model.first_bending_link().unwrap_or_default()),
                problem: "the link bends and the root floats, for which there is no Coriolis matrix here".to_owned(),
                remedy: "fix the root, or ask for the forces alone (inverse dynamics without acceleration)".to_owned(),
            });
        }
        let n = self.nv();
        let rates: Vec<[Vec<f64>; 2]> = self.inertia_slopes(state.q)?;
        let (qd, thetad) = (state.qd, state.thetad);
        let (m, s) = (
            |k: usize, i: usize, j: usize| rates[k][0][i * n + j],
            |k: usize, i: usize, j: usize| rates[k][1][i * n + j],
        );
        for i in 0..n {
            for j in 0..n {
                let (mut c, mut c1, mut c2) = (0.0, 0.0, 0.0);
                for k in 0..n {
                    c += (m(k, i, j) + m(j, i, k) - m(i, j, k)) * qd[k] + (s(j, i, k) - s(i, j, k)) * thetad[k];
                    c1 += (s(k, i, j) - s(i, k, j)) * qd[k];
                    c2 += (s(k, j, i) + s(j, k, i)) * qd[k];
                }
                (out.c[i * n + j], out.c1[i * n + j], out.c2[i * n + j]) = (0.5 * c, 0.5 * c1, 0.5 * c2);
            }
        }
        Ok(())
    }

    /// `Ṁ, Ṡ`.
    pub(super) fn flexible_inertia_rates(&mut self, state: State<f64>, out: InertiaRates<f64>) -> Result<(), Error> {
        out.m.fill(0.0);
        out.s.fill(0.0);
        for ([m, s], rate) in self.inertia_slopes(state.q)?.iter().zip(state.qd) {
            out.m.iter_mut().zip(m).for_each(|(sum, x)| *sum += rate * x);
            out.s.iter_mut().zip(s).for_each(|(sum, x)| *sum += rate * x);
        }
        Ok(())
    }

    fn inertia_slopes(&mut self, q: &[f64]) -> Result<Vec<[Vec<f64>; 2]>, Error> {
        let n = self.nv();
        let slope = |k| {
            let [mut m, mut s] = [(); 2].map(|()| vec![0.0; n * n]);
            self.inertia_slope(q, k, [&mut m, &mut s])?;
            Ok([m, s])
        };
        (0..n).map(slope).collect()
    }

    /// `C q̇ + C₁ θ̇ + g` and `C₂ q̇`: inverse dynamics without acceleration, friction, springs and dampers.
    pub(super) fn flexible_bias(&mut self, state: State<f64>, out: Bias<f64>) -> Result<(), Error> {
        let rest = vec![0.0; self.nv()];
        let accel = Acceleration { qdd: &rest, thetadd: &rest };
        self.inverse(state, accel, External::none(), Inverse { tau_j: out.link, tau: out.motor })?;
        let model = self.model();
        for body in model.bodies().iter().filter(|b| b.joint.nv() == 1) {
            let k = body.v_index();
            let (tau_j, tau) = (out.link[k], out.motor[k]);
            let friction = body.friction.torque(state.qd[k]);
            (out.link[k], out.motor[k]) = (tau_j - friction, 0.0);
            let Some(drive) = &body.drive else { continue };
            match &drive.elastic {
                // τ = (1 − e') τ_J + C₂ q̇ + friction of the motor
                Some(elastic) => {
                    let ratio = drive.rotor.gear_ratio;
                    let slope = elastic.error.map_or(0.0, |e| e.value_and_slope(state.theta[k], ratio).1);
                    out.motor[k] = tau - (1.0 - slope) * tau_j - drive.rotor.reflected_friction(state.thetad[k]);
                }
                None => out.link[k] = tau - friction - drive.rotor.reflected_friction(state.qd[k]),
            }
        }
        let (nq, nv) = (model.nq(), model.nv());
        if nv > 0 && model.bodies()[0].joint == JointKind::Floating {
            out.motor[..6].fill(0.0);
        }
        let [stiffness, damping] = self.modal_matrices();
        let held = stiffness * DVector::from_column_slice(&state.q[nq..])
            + damping * DVector::from_column_slice(&state.qd[nv..]);
        for (j, held) in held.iter().enumerate() {
            (out.link[nv + j], out.motor[nv + j]) = (out.link[nv + j] - held, 0.0);
        }
        Ok(())
    }

    /// `g(q)`.
    pub(super) fn flexible_gravity(&mut self, q: &[f64], g: &mut [f64]) -> Result<(), Error> {
        let rest = vec![0.0; self.nv()];
        let mut motor = rest.clone();
        let state = State { q, qd: &rest, theta: &rest, thetad: &rest };
        self.flexible_bias(state, Bias { link: g, motor: &mut motor })
    }
}
