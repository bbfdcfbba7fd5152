//! How much the gyroscopic coupling of rotors and links matters (Zhao et al. 2015, eq. 12 and the bounds below it).

use crate::Dynamics;
use crate::error::{Error, ErrorKind};
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Significance of the gyroscopic coupling at one state. Where `r_s_max` and `-r_s_min` are far below 1, the reduced model will do.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Significance {
    /// `r_s = 2 q̇ᵀ S q̇ / (q̇ᵀ M_l q̇)`; `None` at rest, where it is 0/0.
    pub r_s: Option<f64>,
    /// Singular values of `S`, descending [kg m²].
    #[serde(rename = "sigma_S")]
    pub sigma_s: Vec<f64>,
    /// Singular values of `M_l`, descending [kg m²].
    #[serde(rename = "sigma_M_l")]
    pub sigma_m_l: Vec<f64>,
    /// `2 σ_max(S) / σ_min(M_l)`, never below `|r_s|`.
    pub bound_singular_values: f64,
    /// Smallest `r_s` over all velocities: the least generalised eigenvalue of `(S + Sᵀ, M_l)`.
    pub r_s_min: f64,
    /// Largest `r_s` over all velocities.
    pub r_s_max: f64,
}

/// Significance at the positions `q` and, if given, the velocities `qd`, of a model with elastic transmissions.
///
/// # Errors
/// A slice of the wrong length, or an inertia matrix that is not positive definite.
pub fn significance(dynamics: &mut Dynamics, q: &[f64], qd: Option<&[f64]>) -> Result<Significance, Error> {
    let nv = dynamics.model().nv();
    if nv == 0 {
        return Ok(Significance::default());
    }
    let (mut s, mut m) = (vec![0.0; nv * nv], vec![0.0; nv * nv]);
    dynamics.coupling(q, &mut s)?;
    dynamics.mass_matrix(q, &mut m)?;
    if s.iter().chain(&m).any(|x| !x.is_finite()) {
        return Err(not_finite("", "significance"));
    }
    let (s, m) = (DMatrix::from_row_slice(nv, nv, &s), DMatrix::from_row_slice(nv, nv, &m));

    let symmetric = &s + s.transpose();
    let r_s = qd.and_then(|qd| {
        let v = DVector::from_column_slice(qd);
        let ratio = v.dot(&(&symmetric * &v)) / v.dot(&(&m * &v));
        ratio.is_finite().then_some(ratio)
    });

    // A x = r M x with M = L Lᵀ is the ordinary symmetric problem of L⁻¹ A L⁻ᵀ.
    let reduced = m.clone().cholesky().and_then(|cholesky| {
        let l = cholesky.l();
        let half = l.solve_lower_triangular(&symmetric)?;
        l.solve_lower_triangular(&half.transpose())
    });
    let Some(reduced) = reduced else {
        return Err(Error {
            problem: "the inertia matrix is not positive definite, so the significance ratio has no bounds".to_owned(),
            remedy: "give the last link of every branch mass, and inertia about its joint".to_owned(),
            ..not_finite("", "significance")
        });
    };
    let extremes = reduced.symmetric_eigenvalues();

    let (sigma_s, sigma_m_l) = (descending(s), descending(m));
    Ok(Significance {
        r_s,
        bound_singular_values: 2.0 * sigma_s[0] / sigma_m_l[nv - 1],
        r_s_min: extremes.iter().copied().fold(f64::INFINITY, f64::min),
        r_s_max: extremes.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        sigma_s,
        sigma_m_l,
    })
}

fn not_finite(element: &str, key: &str) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: element.to_owned(),
        problem: format!("the result `{key}` is not a finite number"),
        remedy: "check the size of the numbers given, and that the links beyond the joint have inertia".to_owned(),
    }
}

fn descending(m: DMatrix<f64>) -> Vec<f64> {
    let mut values: Vec<f64> = m.singular_values().iter().copied().collect();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}
