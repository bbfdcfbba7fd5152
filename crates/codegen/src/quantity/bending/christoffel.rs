//! Coriolis matrices by derivatives of the inertia matrix.

use super::super::tracing::{SymbolicState, zeros};
use super::slopes::inertia_slope;
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::FlexibleModel;

/// `C, C₁, C₂`: with `𝓜 = [M S; Sᵀ B]`, a function of `q` alone, `½ Σ_k (∂_k 𝓜_ij + ∂_j 𝓜_ik − ∂_i 𝓜_jk) ẋ_k`. Roots that float have
/// quasi-velocities, of which this is not true.
pub(in super::super) fn coriolis(model: &FlexibleModel<Sym>, state: &SymbolicState) -> [Vec<Sym>; 3] {
    let nv = model.nv();
    let slopes: Vec<[Vec<Sym>; 2]> = (0..nv).map(|k| inertia_slope(model, &state.q, k)).collect();
    let m = |k: usize, i: usize, j: usize| slopes[k][0][i.min(j) * nv + i.max(j)];
    let s = |k: usize, i: usize, j: usize| slopes[k][1][i * nv + j];
    let half = Sym::from_f64(0.5);
    let [mut c, mut c1, mut c2] = [(); 3].map(|()| zeros(nv * nv));
    for i in 0..nv {
        for j in 0..nv {
            let at = i * nv + j;
            for k in 0..nv {
                let (qd, thetad) = (state.qd[k], state.thetad[k]);
                c[at] += (m(k, i, j) + m(j, i, k) - m(i, j, k)) * qd + (s(j, i, k) - s(i, j, k)) * thetad;
                c1[at] += (s(k, i, j) - s(i, k, j)) * qd;
                c2[at] += (s(k, j, i) + s(j, k, i)) * qd;
            }
            (c[at], c1[at], c2[at]) = (half * c[at], half * c1[at], half * c2[at]);
        }
    }
    [c, c1, c2]
}
