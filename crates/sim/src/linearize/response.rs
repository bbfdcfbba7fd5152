//! Frequency response of a joint: from its motor's torque to the positions of its motor and of its link.

use super::extremes::{Extreme, extremes};
use super::natural::eigenvalues;
use super::{Linearization, Linearizer, ModeKind, NaturalMode, OperatingPoint, Output, natural_modes};
use crate::error::{Error, ErrorKind};
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};
use std::f64::consts::TAU;

/// Which frequencies to look at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sweep {
    /// The first one [Hz]; default: well below the slowest mode.
    pub from: Option<f64>,
    /// The last one [Hz]; default: well above the fastest mode.
    pub to: Option<f64>,
    /// How many; default: 500.
    pub points: Option<usize>,
}

/// The response of a joint to its own motor.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Name of the joint.
    pub joint: String,
    /// Frequencies [Hz].
    pub frequency: Vec<f64>,
    /// Motor position per motor torque, both reflected [rad/(N m), or m/N].
    pub motor: Vec<Complex<f64>>,
    /// Link position per motor torque [rad/(N m), or m/N].
    pub link: Vec<Complex<f64>>,
    /// Peaks of the motor's response.
    pub resonances: Vec<Extreme>,
    /// Dips of the motor's response.
    pub antiresonances: Vec<Extreme>,
    /// The modes of the robot.
    pub modes: Vec<NaturalMode>,
}

const POINTS: usize = 500;
const MOST_POINTS: usize = 1_000_000;
/// Damping ratios below this are rounding.
const UNDAMPED: f64 = 1e-9;
/// Frequencies beyond this have no meaning for a robot [Hz].
const HIGHEST: f64 = 1e9;

/// The response of the joint of that name about an operating point.
///
/// # Errors
/// An unknown joint, or a range of frequencies that is none.
pub fn frequency_response(
    of: &Linearizer,
    point: &OperatingPoint,
    joint: &str,
    sweep: Sweep,
) -> Result<Response, Error> {
    let k = of.layout.find(joint)?;
    let linear = of.linearize(point, &Output::defaults())?;
    let modes = natural_modes(&linear)?;
    let input = of.layout.inputs().iter().position(|i| *i == k).unwrap_or(0);
    let system = System::new(&linear, input, [of.layout.motor(k), k]);
    let frequency = frequencies(sweep, &modes)?;
    let (Some(&from), Some(&to)) = (frequency.first(), frequency.last()) else {
        return Err(fault("there are no frequencies", "give two points or more"));
    };
    let mut motor = Vec::with_capacity(frequency.len());
    let mut link = Vec::with_capacity(frequency.len());
    for &f in &frequency {
        let [m, l] = system.at(f).ok_or_else(|| {
            fault(&format!("the robot is undamped and resonates at exactly {f} Hz"), "shift the range a little")
        })?;
        motor.push(m);
        link.push(l);
    }
    // Sharp peaks and dips lie at poles and zeros: where to look besides the sweep.
    let mut grid = frequency.clone();
    grid.extend(logarithmic(from, to, POINTS));
    grid.extend(modes.iter().filter(|m| m.kind == ModeKind::Oscillation).map(|m| m.eigenvalue[1] / TAU));
    grid.extend(system.zeros()?);
    grid.retain(|f| (from..=to).contains(f));
    grid.sort_by(f64::total_cmp);
    grid.dedup();
    let (mut resonances, antiresonances) = extremes(&grid, |f| system.at(f).map_or(f64::INFINITY, |[m, _]| m.norm()));
    let undamped = |f: f64| {
        let near =
            |m: &NaturalMode| (m.frequency - f).abs() < 1e-6 * f && m.damping_ratio.is_some_and(|z| z.abs() < UNDAMPED);
        modes.iter().any(near)
    };
    resonances.iter_mut().filter(|e| undamped(e.frequency)).for_each(|e| e.magnitude = None);
    Ok(Response { joint: joint.to_owned(), frequency, motor, link, resonances, antiresonances, modes })
}

/// One input and two positions of a linear model.
struct System {
    a: DMatrix<f64>,
    b: DVector<f64>,
    outputs: [usize; 2],
    scale: DVector<f64>,
}

impl System {
    fn new(linear: &Linearization, input: usize, outputs: [usize; 2]) -> Self {
        let mut a = linear.a.clone();
        let scale = balance_parlett_reinsch(&mut a);
        let b = linear.b.column(input).component_div(&scale);
        Self { a, b, outputs, scale }
    }

    /// `C (jω − A)⁻¹ B` at a frequency [Hz]; `None` at an undamped pole. Positions answer with no direct term.
    fn at(&self, frequency: f64) -> Option<[Complex<f64>; 2]> {
        let n = self.a.nrows();
        let jw = Complex::new(0.0, TAU * frequency);
        let matrix = DMatrix::from_diagonal_element(n, n, jw) - self.a.map(|x| Complex::new(x, 0.0));
        let x = matrix.lu().solve(&self.b.map(|x| Complex::new(x, 0.0)))?;
        let [m, l] = self.outputs.map(|i| x[i] * self.scale[i]);
        (m.norm().is_finite() && l.norm().is_finite()).then_some([m, l])
    }

    /// Frequencies of the zeros of the motor's response [Hz]: those at which the rest of the robot swings while this motor is held,
    /// eigenvalues of `A − b c A² / (c A b)`.
    fn zeros(&self) -> Result<Vec<f64>, Error> {
        let c_a = self.a.row(self.outputs[0]).into_owned();
        let gain = (&c_a * &self.b)[0];
        if gain == 0.0 {
            return Ok(Vec::new());
        }
        let held = &self.a - &self.b * ((&c_a * &self.a) / gain);
        Ok(eigenvalues(&held)?.into_iter().filter(|l| l.im > 0.0).map(|l| l.im / TAU).collect())
    }
}

/// `points` frequencies in equal ratios, both ends included.
pub fn logarithmic(from: f64, to: f64, points: usize) -> impl Iterator<Item = f64> {
    let last = points.saturating_sub(1).max(1) as f64;
    (0..points).map(move |i| match i {
        0 => from,
        _ if i + 1 == points => to,
        _ => from * (to / from).powf(i as f64 / last),
    })
}

/// Magnitudes and phases [rad] of a response over rising frequencies, the phases without jumps of a turn, the first one between
/// −270° and 90°. Where an undamped robot jumps by half a turn, which way is anybody's choice: towards −90°.
pub fn bode(response: &[Complex<f64>]) -> [Vec<f64>; 2] {
    const MIDDLE: f64 = -0.25 * TAU;
    let nearest = |phase: f64, to: f64| phase - TAU * ((phase - to) / TAU).round();
    let mut before = MIDDLE;
    let phases = response.iter().map(|z| {
        let next = nearest(z.arg(), before);
        let half_a_turn = ((next - before).abs() - 0.5 * TAU).abs() < 1e-6;
        before = if half_a_turn { before + 0.5 * TAU * (MIDDLE - before).signum() } else { next };
        before
    });
    [response.iter().map(|z| z.norm()).collect(), phases.collect()]
}

fn frequencies(sweep: Sweep, modes: &[NaturalMode]) -> Result<Vec<f64>, Error> {
    let swings = || modes.iter().filter(|m| m.kind == ModeKind::Oscillation).map(|m| m.frequency);
    let slowest = swings().fold(f64::INFINITY, f64::min);
    let fastest = swings().fold(0.0, f64::max);
    let (low, high) = if fastest > 0.0 { (slowest / 5.0, fastest * 5.0) } else { (0.01, 100.0) };
    let from = sweep.from.unwrap_or_else(|| sweep.to.map_or(low, |to| low.min(to / 10.0)));
    let to = sweep.to.unwrap_or_else(|| high.max(from * 10.0));
    let points = sweep.points.unwrap_or(POINTS);
    if !(from > 0.0 && to > from && to <= HIGHEST) {
        let problem = format!("from {from} Hz to {to} Hz is no range of frequencies");
        return Err(fault(&problem, "give two frequencies above zero, the smaller one first"));
    }
    if !(2..=MOST_POINTS).contains(&points) {
        let remedy = format!("give from two to {MOST_POINTS}");
        let fault = fault(&format!("{points} frequencies are asked for"), &remedy);
        return Err(Error { element: "points".to_owned(), ..fault });
    }
    Ok(logarithmic(from, to, points).collect())
}

fn fault(problem: &str, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: "frequency response".to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
