//! The answer to one query.

use super::layout::{Arrays, Layout};
use crate::Dynamics;
use crate::analyze::Significance;
use crate::error::{Error, ErrorKind};
use gyroflex::dynamics::{CoriolisMatrices, Energy, InertiaRates, State};
use serde::Serialize;

/// What was asked for; the rest is `None` and not printed. Vectors have `nv` entries, matrices `nv` rows of `nv`; where links bend, the
/// matrices and `g` go on with the modes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Answer {
    /// Joint accelerations.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub qdd: Option<Vec<f64>>,
    /// Motor accelerations; those of the joint where there is no elastic transmission.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thetadd: Option<Vec<f64>>,
    /// Torque the transmission exerts, or must exert, on the joint; always on the link side [N m or N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau_j: Option<Vec<f64>>,
    /// Torque the motor must exert [N m or N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau: Option<Vec<f64>>,
    /// Forces of what is held, where anything is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held: Option<Vec<HeldAnswer>>,
    /// How many held directions depend on others, or cannot move at all: how those share the load is a choice.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dependent: Option<usize>,
    /// The largest acceleration that those ask for and do not get: not small where what is held contradicts itself. Forward dynamics only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contradiction: Option<f64>,
    /// The largest load at what nothing drives that nothing held bears either [N m or N]: not small where the motion is impossible. Inverse dynamics
    /// with passive velocities only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unborne: Option<f64>,
    /// Accelerations of the modes of links that bend.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub etadd: Option<Vec<f64>>,
    /// Generalised forces that must act on the modes, where their accelerations are given [N, in torsion N m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau_eta: Option<Vec<f64>>,
    /// `M(q)`: inertia matrix of the link side; in the rigid models that of the whole robot.
    #[serde(rename = "M", skip_serializing_if = "Option::is_none")]
    pub m: Option<Vec<Vec<f64>>>,
    /// `S(q)`: inertial coupling of links (rows) and motors (columns); zero where there is no elastic transmission.
    #[serde(rename = "S", skip_serializing_if = "Option::is_none")]
    pub s: Option<Vec<Vec<f64>>>,
    /// `B`: rotor inertias on the diagonal; zero where there is no elastic transmission.
    #[serde(rename = "B", skip_serializing_if = "Option::is_none")]
    pub b: Option<Vec<Vec<f64>>>,
    /// `g(q)`: generalised forces that hold the links against gravity [N m or N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub g: Option<Vec<f64>>,
    /// `K`: stiffness of the modes.
    #[serde(rename = "K", skip_serializing_if = "Option::is_none")]
    pub k: Option<Vec<Vec<f64>>>,
    /// `D`: damping of the modes.
    #[serde(rename = "D", skip_serializing_if = "Option::is_none")]
    pub d: Option<Vec<Vec<f64>>>,
    /// `C, C1, C2, M_dot, S_dot`, where the velocities are given.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub velocity_matrices: Option<VelocityMatrices>,
    /// Energies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyAnswer>,
    /// Significance of the gyroscopic coupling.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub significance: Option<Significance>,
}

/// Forces of a constraint, a coupling or a contact.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeldAnswer {
    /// Its name.
    pub name: String,
    /// Force on its link in world axes [N]; absent for couplings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<[f64; 3]>,
    /// Moment on its link about the origin of the held frame, in world axes [N m]; absent for couplings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<[f64; 3]>,
    /// Forces along its directions, out of rx, ry, rz, x, y, z in this order, in the axes of what it is held to; for a coupling that along
    /// the joint that follows [N or N m].
    pub multipliers: Vec<f64>,
}

/// What the matrices become in motion: blocks of the Coriolis matrix in Christoffel form, and rates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VelocityMatrices {
    /// `C`: links by links.
    #[serde(rename = "C")]
    pub c: Vec<Vec<f64>>,
    /// `C1`: links by motors.
    #[serde(rename = "C1")]
    pub c1: Vec<Vec<f64>>,
    /// `C2`: motors by links.
    #[serde(rename = "C2")]
    pub c2: Vec<Vec<f64>>,
    /// `dM/dt`.
    #[serde(rename = "M_dot")]
    pub m_dot: Vec<Vec<f64>>,
    /// `dS/dt`.
    #[serde(rename = "S_dot")]
    pub s_dot: Vec<Vec<f64>>,
}

impl VelocityMatrices {
    /// At a state, seen from the side the user wants: `C₁ N⁻¹`, `N⁻¹ C₂`, `Ṡ N⁻¹`.
    pub(super) fn at(dynamics: &mut Dynamics, state: State<f64>, arrays: &Arrays) -> Result<Self, Error> {
        let n = dynamics.nv();
        let [mut c, mut c1, mut c2, mut m, mut s] = [(); 5].map(|()| vec![0.0; n * n]);
        dynamics.coriolis_matrices(state, CoriolisMatrices { c: &mut c, c1: &mut c1, c2: &mut c2 })?;
        dynamics.inertia_rates(state, InertiaRates { m: &mut m, s: &mut s })?;
        Ok(Self {
            c: rows(n, |i, j| c[i * n + j]),
            c1: rows(n, |i, j| c1[i * n + j] / arrays.ratio(j)),
            c2: rows(n, |i, j| c2[i * n + j] / arrays.ratio(i)),
            m_dot: rows(n, |i, j| m[i * n + j]),
            s_dot: rows(n, |i, j| s[i * n + j] / arrays.ratio(j)),
        })
    }
}

/// Energies [J].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnergyAnswer {
    /// Of links and rotors.
    pub kinetic: f64,
    /// Of moving links and rotors in the field of gravity, zero for a mass at the world's origin.
    pub gravity: f64,
    /// In the springs of the transmissions, and in links that bend.
    pub elastic: f64,
    /// The sum of the three.
    pub total: f64,
}

impl From<Energy<f64>> for EnergyAnswer {
    fn from(e: Energy<f64>) -> Self {
        Self { kinetic: e.kinetic, gravity: e.gravity, elastic: e.elastic, total: e.kinetic + e.gravity + e.elastic }
    }
}

impl Answer {
    /// `M`, `S` and the diagonal of `B` as lists of rows, `S` and `B` seen from the side the user wants:
    /// `M_ml = S N⁻¹`, `M_m = N⁻¹ B N⁻¹`.
    pub(super) fn set_matrices(&mut self, arrays: &Arrays, m: &[f64], s: &[f64], b: &[f64]) {
        let n = b.len();
        let entry = |i: usize, j: usize, x: f64| if i == j { x / arrays.ratio(i) / arrays.ratio(i) } else { 0.0 };
        self.m = Some(rows(n, |i, j| m[i * n + j]));
        self.s = Some(rows(n, |i, j| s[i * n + j] / arrays.ratio(j)));
        self.b = Some(rows(n, |i, j| entry(i, j, b[i])));
    }

    /// Nothing that is not a number leaves this house.
    pub(super) fn check_finite(&self, layout: &Layout) -> Result<(), Error> {
        let mode = |k: usize| layout.owner(layout.nv() + k);
        for (key, vector) in [("etadd", &self.etadd), ("tau_eta", &self.tau_eta)] {
            if let Some(k) = vector.as_ref().and_then(|v| v.iter().position(|x| !x.is_finite())) {
                return Err(not_finite(&mode(k), key));
            }
        }
        let vectors = [
            ("qdd", &self.qdd),
            ("thetadd", &self.thetadd),
            ("tau_j", &self.tau_j),
            ("tau", &self.tau),
            ("g", &self.g),
        ];
        for (key, vector) in vectors {
            if let Some(k) = vector.as_ref().and_then(|v| v.iter().position(|x| !x.is_finite())) {
                return Err(not_finite(&layout.owner(k), key));
            }
        }
        let mut told = self.held.iter().flatten();
        if let Some(wrong) = told.find(|held| held.multipliers.iter().any(|x| !x.is_finite())) {
            return Err(not_finite(&format!("`{}`", wrong.name), "held"));
        }
        let moving = self.velocity_matrices.as_ref();
        let matrices = [
            ("M", self.m.as_ref()),
            ("S", self.s.as_ref()),
            ("B", self.b.as_ref()),
            ("C", moving.map(|m| &m.c)),
            ("C1", moving.map(|m| &m.c1)),
            ("C2", moving.map(|m| &m.c2)),
            ("M_dot", moving.map(|m| &m.m_dot)),
            ("S_dot", moving.map(|m| &m.s_dot)),
        ];
        for (key, matrix) in matrices {
            let wrong = |row: &Vec<f64>| row.iter().any(|x| !x.is_finite());
            if let Some(k) = matrix.and_then(|m| m.iter().position(wrong)) {
                return Err(not_finite(&layout.owner(k), key));
            }
        }
        match self.energy {
            Some(e) if !e.total.is_finite() => Err(not_finite("", "energy")),
            _ => Ok(()),
        }
    }
}

pub(super) fn rows(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
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
