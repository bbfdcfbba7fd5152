//! Invariant zeros of linear models: how an inverse of the robot moves by itself.
//!
//! What an inverse is asked for, `y`, stays at zero; what may still move obeys the *internal dynamics* (Thümmel, Otter, Bals 2005, §2), whose
//! eigenvalues are the `s` at which `[A − s 1, B; C, D]` loses rank. At rest, of the matrix form of `NOTATION.md`:
//!
//! * `y = q`, links on their way: `−S θ̈ + D θ̇ + k'(δ) θ = 0`, motors without the factor `1 − e'` that all terms share. A rotor acts on the
//!   links before its own, so that `S` is strictly upper triangular and the zeros are `−k'/D`, one a damped transmission. A transmission
//!   without damping has none: its inverse has no state, and asks for more derivatives of the motion in its place.
//! * `y = θ`, motors held: `M q̈ + (D + f') q̇ + (k' + ∂g/∂q) q = 0`. Without losses they lie on the imaginary axis, and
//!   where gravity is stronger than a spring one of them lies to the right of it.
//!
//! Joints without an elastic transmission are where they are asked to be, in both cases. Where links bend and all gears are rigid, the
//! links go on swinging about that: `M η̈ + D η̇ + (K + ∂g/∂η) η = 0`, stable as long as gravity is weaker than the links.

mod report;

pub use report::{AtPose, InverseStability, JointZeros, Verdict};

use crate::error::{Error, ErrorKind};
use crate::linearize::{Linearization, Linearizer, OperatingPoint, natural_modes};
use gyroflex::dynamics::{Acceleration, External, InverseDerivatives};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What an inverse is given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InverseOutput {
    /// The motion of the links, `q`.
    #[default]
    Link,
    /// The motion of the motors, `θ`.
    Motor,
}

/// One invariant zero; of a complex pair the one above the real axis.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Zero {
    /// Real and imaginary part [1/s].
    pub value: [f64; 2],
    /// The joint whose free side moves most, or the mode of a link that bends.
    pub joint: String,
}

impl Zero {
    /// `|s|` [1/s].
    pub fn size(&self) -> f64 {
        self.value[0].hypot(self.value[1])
    }
}

/// Stiffness `k'(δ)` and damping `D` of the transmission of velocity coordinate `k`, at an operating point.
struct Transmission {
    k: usize,
    stiffness: f64,
    damping: f64,
}

/// The zeros at rest at the positions `q` (`nq` entries), from the slowest to the fastest.
///
/// # Errors
/// Positions that do not fit the robot, a floating root, and an inertia matrix without an inverse.
pub fn zeros(linearizer: &mut Linearizer, q: &[f64], output: InverseOutput) -> Result<Vec<Zero>, Error> {
    if linearizer.layout().floating() {
        let problem = "its root floats, and no motor leads it along a motion that is given";
        return Err(fault("robot", problem, "fix the root"));
    }
    if linearizer.layout().modes() > 0 {
        return of_modes(linearizer, q);
    }
    let point = linearizer.equilibrium_at(q)?;
    let transmissions = transmissions(linearizer, &point);
    match output {
        InverseOutput::Link => Ok(of_links(linearizer, &transmissions)),
        InverseOutput::Motor => of_motors(linearizer, &point, &transmissions),
    }
}

/// The elastic transmissions in the order of [`Layout::elastic`](crate::linearize::Layout::elastic).
fn transmissions(linearizer: &Linearizer, point: &OperatingPoint) -> Vec<Transmission> {
    let model = linearizer.dynamics.model();
    let elastic = model.bodies().iter().filter_map(|body| Some((body, body.drive.as_ref()?)));
    let elastic = elastic.filter_map(|(body, drive)| Some((body, drive, drive.elastic.as_ref()?)));
    elastic
        .map(|(body, drive, elastic)| {
            let (k, q) = (body.v_index(), point.state.q[body.q_index()]);
            let theta = point.state.theta[k];
            let error = elastic.error.map_or(0.0, |e| e.value_and_slope(theta, drive.rotor.gear_ratio).0);
            let stiffness = elastic.spring.slope(theta - q - error, model.knots());
            Transmission { k, stiffness, damping: elastic.damping }
        })
        .collect()
}

/// Joints on their way behind rigid gears, links that bend: `M η̈ + D η̇ + (K + ∂g/∂η) η = 0`.
fn of_modes(linearizer: &mut Linearizer, q: &[f64]) -> Result<Vec<Zero>, Error> {
    if !linearizer.layout().elastic().is_empty() {
        linearizer.robot.refuse_bending("the inverse of elastic joints", ELASTIC_AND_BENDING)?;
    }
    let point = linearizer.equilibrium_at(q)?;
    let [inertia, damping, stiffness] = linearizer.dynamics.held_modes(&point.state.q)?;
    let n = inertia.nrows();
    let inertia = inertia.lu();
    let (Some(stiffness), Some(damping)) = (inertia.solve(&stiffness), inertia.solve(&damping)) else {
        return Err(fault("robot", "its modes have no inertia", "give the beams a mass per length"));
    };
    let names = linearizer.robot.mode_names();
    held(n, &stiffness, &damping, |i| names[i].clone(), &point)
}

/// What an inverse of elastic joints is told about links that bend.
pub(crate) const ELASTIC_AND_BENDING: &str =
    "invert the model `rigid`, whose gears are stiff and whose links bend, or take the links out of `flexible_links`";

/// Eigenvalues of `ẍ + D ẋ + K x = 0`.
fn held(
    n: usize,
    stiffness: &DMatrix<f64>,
    damping: &DMatrix<f64>,
    name: impl Fn(usize) -> String,
    point: &OperatingPoint,
) -> Result<Vec<Zero>, Error> {
    let mut a = DMatrix::zeros(2 * n, 2 * n);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    a.view_mut((n, 0), (n, n)).copy_from(&-stiffness);
    a.view_mut((n, n), (n, n)).copy_from(&-damping);
    let held = Linearization {
        a,
        b: DMatrix::zeros(2 * n, 0),
        c: DMatrix::zeros(0, 2 * n),
        d: DMatrix::zeros(0, 0),
        states: (0..2 * n).map(|i| name(i % n)).collect(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        point: point.clone(),
        step: None,
    };
    let modes = natural_modes(&held)?;
    Ok(modes.into_iter().map(|mode| Zero { value: mode.eigenvalue, joint: mode.moves_most }).collect())
}

fn of_links(linearizer: &Linearizer, transmissions: &[Transmission]) -> Vec<Zero> {
    let damped = transmissions.iter().filter(|t| t.damping > 0.0);
    let mut zeros: Vec<Zero> = damped
        .map(|t| Zero { value: [-t.stiffness / t.damping, 0.0], joint: linearizer.layout().joint(t.k).to_owned() })
        .collect();
    zeros.sort_by(|a, b| a.size().total_cmp(&b.size()));
    zeros
}

fn of_motors(
    linearizer: &mut Linearizer,
    point: &OperatingPoint,
    transmissions: &[Transmission],
) -> Result<Vec<Zero>, Error> {
    let (nv, n) = (linearizer.layout().nv(), transmissions.len());
    if n == 0 {
        return Ok(Vec::new());
    }
    let rest = vec![0.0; nv];
    let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; 6 * nv * nv]);
    let accel = Acceleration { qdd: &rest, thetadd: &rest };
    let out = InverseDerivatives { tau_j: &mut tau_j, tau: &mut tau };
    linearizer.dynamics.inverse_derivatives(point.state.view(), accel, External::none(), out)?;
    // Of the torque that the links need, by q, q̇ and q̈.
    let block = |which: usize| {
        DMatrix::from_fn(n, n, |i, j| tau_j[transmissions[i].k * 6 * nv + which * nv + transmissions[j].k])
    };
    let (mut stiffness, mut damping, inertia) = (block(0), block(1), block(2));
    for (i, t) in transmissions.iter().enumerate() {
        stiffness[(i, i)] += t.stiffness;
        damping[(i, i)] += t.damping;
    }
    let inertia = inertia.lu();
    let (Some(stiffness), Some(damping)) = (inertia.solve(&stiffness), inertia.solve(&damping)) else {
        let remedy = "give the links that it moves a mass, or take another pose";
        return Err(fault("robot", "its inertia matrix has no inverse at this pose", remedy));
    };
    held(n, &stiffness, &damping, |i| linearizer.layout().joint(transmissions[i].k).to_owned(), point)
}

fn fault(element: &str, problem: &str, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: element.to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
