//! Natural frequencies and decay rates of a robot about a pose, and the largest step they allow an explicit scheme.
//!
//! The undamped linearised robot at rest is `M ẍ + K x = 0` in the coordinates `x` of links and elastic motors, with
//! `M = [[M_l, S], [Sᵀ, B]]` and `K` the tangent stiffness of the transmissions and of links that bend. The stiffness of gravity, which is that of
//! pendulums and orders of magnitude below that of gears, is left out, and so are velocity terms.

use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::{Error, ErrorKind};
use crate::scenario::Integrator;
use gyroflex::model::{Body, Friction};
use nalgebra::{Cholesky, DMatrix};
use std::f64::consts::TAU;

/// One natural mode.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Mode {
    /// Frequency [Hz].
    pub frequency: f64,
    /// The joint that moves most in it; or the assumed mode of a link that bends, by its name.
    pub joint: String,
    /// Whether that joint's motor moves more than its link.
    pub on_motor: bool,
    /// Whether it is an assumed mode that moves most.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub bends: bool,
}

impl Mode {
    /// What moves most in it, as `motor of joint1`.
    pub fn moves_most(&self) -> String {
        match (self.bends, self.on_motor) {
            (true, _) => format!("mode {}", self.joint),
            (false, true) => format!("motor of {}", self.joint),
            (false, false) => format!("link of {}", self.joint),
        }
    }
}

/// The fastest rate of decay.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Decay {
    /// Rate [1/s], of friction and damping alone; friction counts with its slope at standstill.
    pub rate: f64,
    /// The joint where it is fastest, or the assumed mode of a link that bends.
    pub joint: String,
}

/// What a robot does by itself near a pose.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Modes {
    /// All modes of the transmissions and of links that bend, from the slowest to the fastest; rigid motions are not listed.
    pub modes: Vec<Mode>,
    /// The fastest decay, if anything decays.
    pub decay: Option<Decay>,
}

/// Natural modes at the positions `q` (`nq` entries) and reflected motor positions `theta` (`nv` entries).
///
/// # Errors
/// A slice that does not fit the model, or an inertia matrix that is not positive definite.
pub fn modes(dynamics: &mut Dynamics, joints: &Coordinates, q: &[f64], theta: &[f64]) -> Result<Modes, Error> {
    let nv = dynamics.nv();
    let (mut m_l, mut s) = (vec![0.0; nv * nv], vec![0.0; nv * nv]);
    dynamics.mass_matrix(q, &mut m_l)?;
    dynamics.coupling(q, &mut s)?;
    let model = dynamics.model();

    let bending = [nv - dynamics.modes(), nv];
    // Coordinates: all nv of the links and their modes, then the motors behind elastic transmissions.
    let elastic: Vec<&Body<f64>> = model.bodies().iter().filter(|b| b.is_elastic()).collect();
    let size = nv + elastic.len();
    let mut m = DMatrix::zeros(size, size);
    m.view_mut((0, 0), (nv, nv)).copy_from(&DMatrix::from_row_slice(nv, nv, &m_l));
    let (mut stiffness, mut damping) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
    let [own_stiffness, own_damping] = dynamics.modal_matrices();
    let place = (bending[0], bending[0]);
    stiffness.view_mut(place, own_stiffness.shape()).copy_from(&own_stiffness);
    damping.view_mut(place, own_damping.shape()).copy_from(&own_damping);
    for body in model.bodies().iter().filter(|b| b.joint.nv() == 1) {
        let k = body.v_index();
        damping[(k, k)] += slope_at_rest(&body.friction);
        if let Some(rotor) = body.drive.as_ref().filter(|d| d.elastic.is_none()).map(|d| &d.rotor) {
            damping[(k, k)] += rotor.gear_ratio * rotor.gear_ratio * slope_at_rest(&rotor.friction);
        }
    }
    for (i, body) in elastic.iter().enumerate() {
        let (k, motor) = (body.v_index(), nv + i);
        let Some(drive) = body.drive.as_ref() else { continue };
        let (Some(transmission), rotor) = (&drive.elastic, &drive.rotor) else { continue };
        for row in 0..nv {
            m[(row, motor)] = s[row * nv + k];
            m[(motor, row)] = s[row * nv + k];
        }
        m[(motor, motor)] = rotor.reflected_inertia;
        // δ = θ − q − e(θ), so that K += k' d dᵀ with d = (−1, 1 − e'); the term of e'' is left out.
        let (e, slope) = transmission.error.map_or((0.0, 0.0), |e| e.value_and_slope(theta[k], rotor.gear_ratio));
        let deflection = theta[k] - q[body.q_index()] - e;
        let tangent = transmission.spring.slope(deflection, model.knots());
        let d = [(k, -1.0), (motor, 1.0 - slope)];
        for (row, a) in d {
            for (column, b) in d {
                stiffness[(row, column)] += tangent * a * b;
                damping[(row, column)] += transmission.damping * a * b;
            }
        }
        damping[(motor, motor)] += rotor.gear_ratio * rotor.gear_ratio * slope_at_rest(&rotor.friction);
    }

    let spectrum = Spectrum::new(m)?;
    let owner = |coordinate: usize| -> (String, bool, bool) {
        if (bending[0]..bending[1]).contains(&coordinate) {
            return (joints.modes.get(coordinate - bending[0]).cloned().unwrap_or_default(), false, true);
        }
        let (k, on_motor) =
            if coordinate < nv { (coordinate, false) } else { (elastic[coordinate - nv].v_index(), true) };
        let joint = joints.joints.iter().find(|j| j.v == k).map_or("root", |j| j.name.as_str());
        (joint.to_owned(), on_motor, false)
    };
    let mut list: Vec<Mode> = spectrum
        .of(stiffness)
        .into_iter()
        // One zero per rigid motion, up to rounding.
        .filter(|(value, _)| *value > 0.0)
        .map(|(value, coordinate)| {
            let (joint, on_motor, bends) = owner(coordinate);
            Mode { frequency: value.sqrt() / TAU, joint, on_motor, bends }
        })
        .collect();
    list.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // Each transmission adds one to the rank of K, and so does each mode; what is below as many largest values is rounding.
    list.drain(..list.len().saturating_sub(elastic.len() + bending[1] - bending[0]));
    let fastest = spectrum.of(damping).into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    let decay = fastest.filter(|(rate, _)| *rate > 0.0).map(|(rate, c)| Decay { rate, joint: owner(c).0 });
    Ok(Modes { modes: list, decay })
}

impl Modes {
    /// The fastest mode.
    pub fn fastest(&self) -> Option<&Mode> {
        self.modes.last()
    }

    /// The largest step [s] at which an explicit fixed-step scheme is stable; `None` if any step is, or the scheme adapts.
    ///
    /// With symmetric `M, K, D`, every eigenvalue `s` of the damped robot solves `s² + d s + k = 0` for some `d ≤ λ`, `k ≤ ω²`, with `λ`
    /// the fastest decay and `ω` the fastest mode; hence `|s| ≤ max(λ, ω)`. RK4 is stable up to 2.8 on the imaginary axis, and in
    /// the whole left half disc of radius 2.6. Semi-implicit Euler is stable for `ω² h² + 2 λ h < 4`.
    pub fn largest_step(&self, integrator: &Integrator) -> Option<f64> {
        let omega = self.fastest().map_or(0.0, |m| m.frequency * TAU);
        let lambda = self.decay.as_ref().map_or(0.0, |d| d.rate);
        if omega == 0.0 && lambda == 0.0 {
            return None;
        }
        match integrator {
            Integrator::SemiImplicitEuler { .. } => {
                Some(4.0 / (lambda + (lambda * lambda + 4.0 * omega * omega).sqrt()))
            }
            Integrator::Rk4 { .. } => {
                let radius = if lambda < 1e-3 * omega { 2.8 } else { 2.6 };
                Some(radius / omega.max(lambda))
            }
            _ => None,
        }
    }
}

/// How fast friction grows from standstill [N m s/rad].
fn slope_at_rest(friction: &Friction<f64>) -> f64 {
    friction.viscous + (friction.coulomb + friction.stribeck) / friction.smoothing_velocity
}

/// Eigenvalues relative to an inertia matrix `M = L Lᵀ`.
struct Spectrum {
    lower: DMatrix<f64>,
}

impl Spectrum {
    fn new(m: DMatrix<f64>) -> Result<Self, Error> {
        let failed = || Error {
            kind: ErrorKind::Model,
            file: String::new(),
            element: "inertia matrix".to_owned(),
            problem: "it is not positive definite at the initial pose".to_owned(),
            remedy: "check masses and inertias of links and rotors".to_owned(),
        };
        Ok(Self { lower: Cholesky::new(m).ok_or_else(failed)?.unpack() })
    }

    /// Eigenvalues of `A x = μ M x`, each with the coordinate that has the largest part of `x`, in units of `√M_ii`.
    fn of(&self, a: DMatrix<f64>) -> Vec<(f64, usize)> {
        let n = a.nrows();
        // L⁻¹ A L⁻ᵀ; L has a positive diagonal, so that the solves cannot fail.
        let half = self.lower.solve_lower_triangular(&a).unwrap_or_else(|| DMatrix::zeros(n, n));
        let whole = self.lower.solve_lower_triangular(&half.transpose()).unwrap_or_else(|| DMatrix::zeros(n, n));
        let symmetric = (&whole + whole.transpose()) * 0.5;
        let eigen = symmetric.symmetric_eigen();
        let weights: Vec<f64> = (0..n).map(|i| self.lower.row(i).norm()).collect();
        let shapes = self.lower.tr_solve_lower_triangular(&eigen.eigenvectors).unwrap_or_else(|| DMatrix::zeros(n, n));
        (0..n)
            .map(|i| {
                let size = |row: &usize| (shapes[(*row, i)] * weights[*row]).abs();
                let most = (0..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
                (eigen.eigenvalues[i], most)
            })
            .collect()
    }
}
