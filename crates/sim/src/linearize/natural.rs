//! How a linear model moves by itself: its eigenvalues and the shapes that belong to them.

use super::Linearization;
use super::nullspace::Nullspace;
use crate::error::{Error, ErrorKind};
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector, Schur};
use std::f64::consts::TAU;

/// What kind of motion a mode is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ModeKind {
    /// A pair of complex eigenvalues: it swings.
    Oscillation,
    /// A real eigenvalue below zero: it creeps back.
    Decay,
    /// A real eigenvalue above zero: it falls away.
    Growth,
    /// An eigenvalue of zero: it stays wherever it is put.
    Rigid,
}

/// One mode of a linear model, damping and gravity included.
///
/// [`crate::modes::Mode`] is another thing: a fast undamped estimate of the transmissions alone, for choosing a step.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct NaturalMode {
    /// What kind of motion it is.
    pub kind: ModeKind,
    /// `|λ| / 2π` [Hz]: of an oscillation the natural frequency.
    pub frequency: f64,
    /// `−Re λ / |λ|` [–]; `None` for a rigid motion. Below zero it grows.
    pub damping_ratio: Option<f64>,
    /// `λ`, real and imaginary part [1/s]; of a pair the one above the real axis.
    pub eigenvalue: [f64; 2],
    /// The position that moves most, as `theta.joint1`.
    pub moves_most: String,
    /// The positions' part of the eigenvector, in the order of the states: real and imaginary part, the largest entry is 1.
    pub shape: Vec<[f64; 2]>,
}

/// The modes of a linearization in continuous time, from the slowest to the fastest; a pair of complex eigenvalues is one mode, and
/// the rigid motions are given by as simple shapes as there are.
///
/// # Errors
/// A sampled model, and a matrix whose eigenvalues are not found.
pub fn natural_modes(linear: &Linearization) -> Result<Vec<NaturalMode>, Error> {
    if linear.step.is_some() {
        return Err(fault("the model is sampled", "take the modes of the model in continuous time"));
    }
    let half = linear.a.nrows() / 2;
    if half == 0 {
        return Ok(Vec::new());
    }
    let names = &linear.states;
    let still = Nullspace::of(&linear.a);
    let mut modes: Vec<NaturalMode> = still
        .basis
        .iter()
        .map(|v| {
            let v: Vec<Complex<f64>> = v[..half].iter().map(|x| Complex::new(*x, 0.0)).collect();
            mode(ModeKind::Rigid, Complex::new(0.0, 0.0), v, names)
        })
        .collect();
    let mut eigenvalues = eigenvalues(&still.rest)?;
    eigenvalues.sort_by(|x, y| x.norm().total_cmp(&y.norm()));
    let mut a = linear.a.clone();
    let scale = balance_parlett_reinsch(&mut a);
    for (i, &lambda) in eigenvalues.iter().enumerate() {
        if lambda.im < 0.0 {
            continue;
        }
        let kind = match (lambda.im, lambda.re) {
            (im, _) if im > 0.0 => ModeKind::Oscillation,
            (_, re) if re < 0.0 => ModeKind::Decay,
            _ => ModeKind::Growth,
        };
        let v = eigenvector(&a, lambda, i);
        let v = (0..half).map(|i| v[i] * scale[i]).collect();
        modes.push(mode(kind, lambda, v, names));
    }
    Ok(modes)
}

impl Linearization {
    /// The eigenvalues of `A`, as many as states, by size; of a pair the one above the real axis comes last.
    ///
    /// # Errors
    /// If they are not found.
    pub fn eigenvalues(&self) -> Result<Vec<Complex<f64>>, Error> {
        let mut found = eigenvalues(&self.a)?;
        // Both of a pair stay neighbours, for they are of exactly the same size.
        found.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
        for pair in 1..found.len() {
            if found[pair] == found[pair - 1].conj() && found[pair].im < 0.0 {
                found.swap(pair - 1, pair);
            }
        }
        Ok(found)
    }
}

/// All eigenvalues of a matrix.
pub(crate) fn eigenvalues(a: &DMatrix<f64>) -> Result<Vec<Complex<f64>>, Error> {
    let n = a.nrows();
    if n == 0 {
        return Ok(Vec::new());
    }
    // With states in units that suit each other, small eigenvalues keep their digits.
    let mut balanced = a.clone();
    balance_parlett_reinsch(&mut balanced);
    // The iteration may go in circles where eigenvalues lie as far on one side of zero as on the other; in other axes it does not.
    for turns in 0..4 {
        let schur = Schur::try_new(balanced.clone(), f64::EPSILON, 100 * n.max(10));
        let found = schur.map(|s| s.complex_eigenvalues());
        if let Some(found) = found.filter(|l| l.iter().all(|x| x.re.is_finite() && x.im.is_finite())) {
            return Ok(found.iter().copied().collect());
        }
        let axes = DMatrix::from_fn(n, n, |i, j| no_pattern(i + n * j + turns)).qr().q();
        balanced = axes.transpose() * balanced * axes;
    }
    Err(fault("the eigenvalues of the linear model are not found", "check inertias and stiffnesses for extreme values"))
}

/// The eigenvector of an eigenvalue, by inverse iteration. Equal eigenvalues get different vectors by their number.
fn eigenvector(a: &DMatrix<f64>, lambda: Complex<f64>, number: usize) -> DVector<Complex<f64>> {
    let n = a.nrows();
    let mut aside = f64::EPSILON * a.norm();
    // Any start will do that is not orthogonal to it.
    let mut v = DVector::from_fn(n, |i, _| Complex::new(no_pattern(i + n * number), 0.0));
    for _ in 0..ITERATIONS {
        let shifted = a.map(|x| Complex::new(x, 0.0)) - DMatrix::from_diagonal_element(n, n, lambda + aside);
        match shifted.lu().solve(&v).filter(|x| x.iter().all(|x| x.re.is_finite() && x.im.is_finite())) {
            Some(next) => v = next.unscale(next.norm()),
            None => aside *= 8.0,
        }
    }
    v
}

/// Numbers between −1 and 1 that look random.
fn no_pattern(i: usize) -> f64 {
    2.0 * ((i as f64 + 1.0) * 0.618_033_988_749_895 + 0.31).fract() - 1.0
}

const ITERATIONS: usize = 4;

fn mode(kind: ModeKind, lambda: Complex<f64>, shape: Vec<Complex<f64>>, names: &[String]) -> NaturalMode {
    let largest = shape.iter().fold(0.0, |most: f64, x| most.max(x.norm()));
    // Of entries that are equal but for rounding the first, so that a link goes before its motor.
    let most = shape.iter().position(|x| x.norm() >= largest * (1.0 - 1e-6)).unwrap_or(0);
    let by = shape[most];
    let tidy = |x: f64| if x.abs() < TINY { 0.0 } else { x };
    let whole = |z: Complex<f64>| if by.norm() > 0.0 { [tidy((z / by).re), tidy((z / by).im)] } else { [0.0; 2] };
    NaturalMode {
        kind,
        frequency: lambda.norm() / TAU,
        damping_ratio: (kind != ModeKind::Rigid).then(|| -lambda.re / lambda.norm()),
        eigenvalue: [lambda.re, lambda.im],
        moves_most: names[most].clone(),
        shape: shape.into_iter().map(whole).collect(),
    }
}

/// Entries of a shape below this are rounding.
const TINY: f64 = 1e-12;

fn fault(problem: &str, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: "modes".to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
