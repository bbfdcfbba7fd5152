//! The discrete algebraic Riccati equation, by doubling.

use crate::error::{Error, ErrorKind};
use crate::linearize::eigenvalues;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Each doubling squares the error; a loop that needs more of them takes `2⁶⁰` samples to settle.
const DOUBLINGS: usize = 60;
/// A residual above this, as part of the solution, is not rounding.
const RESIDUAL: f64 = 1e-8;
/// A spectral radius closer to 1 than this cannot be told from 1.
const MARGIN: f64 = 1e-10;

/// The stabilising solution of a Riccati equation, and the gain that belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Riccati {
    /// `X`, by the states on both sides: `xᵀ X x` is what the way from `x` to rest costs.
    pub x: DMatrix<f64>,
    /// `K`, a row an input: `u = −K x`.
    pub gain: DMatrix<f64>,
    /// Largest size of an eigenvalue of `A − B K` [–], below 1.
    pub radius: f64,
    /// Size of the equation's residual as part of the size of `X`, states scaled to cost the same [–].
    pub residual: f64,
}

/// The solution of `X = Aᵀ X A − Aᵀ X B (R + Bᵀ X B)⁻¹ Bᵀ X A + Q` for which `A − B K`, `K = (R + Bᵀ X B)⁻¹ Bᵀ X A`, is stable, by the
/// structure-preserving doubling algorithm (Chu, Fan, Lin, Wang, Int. J. Control 77, 2004). `Q` is symmetric
/// and not negative, `R` symmetric and positive.
///
/// # Errors
/// Matrices that do not fit or are not finite, weights that are none, and a system that no input stabilises or whose unstable
/// motions cost nothing; `names` are those of the states.
pub fn riccati(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
    names: &dyn Fn(usize) -> String,
) -> Result<Riccati, Error> {
    let factor = check(a, b, q, r)?;
    // In states and inputs that cost the same, and so are of one size, R is 1 and Q has ones on its diagonal.
    let n = a.nrows();
    let size = DVector::from_fn(n, |i, _| if q[(i, i)] > 0.0 { q[(i, i)].sqrt().recip() } else { 1.0 });
    let scaled = |m: &DMatrix<f64>, rows: f64, columns: f64| {
        DMatrix::from_fn(n, n, |i, j| m[(i, j)] * size[i].powf(rows) * size[j].powf(columns))
    };
    let a = scaled(a, -1.0, 1.0);
    let q = scaled(q, 1.0, 1.0);
    let mut b = b.clone();
    b.row_iter_mut().zip(size.iter()).for_each(|(mut row, size)| row /= *size);
    let inputs = factor.l().transpose();
    let Some(b) = inputs.transpose().solve_lower_triangular(&b.transpose()).map(|x| x.transpose()) else {
        return Err(weights("R"));
    };

    let x = doubled(&a, &b, &q, names)?;
    let unit = DMatrix::identity(b.ncols(), b.ncols());
    let (bx, inner) = (b.transpose() * &x, &unit + b.transpose() * &x * &b);
    let Some(inner) = Cholesky::new(inner) else { return Err(hopeless(&x, names)) };
    let gain = inner.solve(&(&bx * &a));
    let closed = &a - &b * &gain;
    let residual = (a.transpose() * &x * &closed + &q - &x).norm() / x.norm().max(f64::MIN_POSITIVE);
    let radius = eigenvalues(&closed)?.iter().fold(0.0, |most: f64, l| most.max(l.norm()));
    if radius >= 1.0 - MARGIN {
        return Err(free(closed, names));
    }
    if residual.is_nan() || residual > RESIDUAL {
        return Err(hopeless(&x, names));
    }
    let Some(mut gain) = inputs.solve_upper_triangular(&gain) else { return Err(weights("R")) };
    gain.column_iter_mut().zip(size.iter()).for_each(|(mut column, size)| column /= *size);
    Ok(Riccati { x: scaled(&x, -1.0, -1.0), gain, radius, residual })
}

/// The limit of the doubling, for `R = 1`.
fn doubled(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    names: &dyn Fn(usize) -> String,
) -> Result<DMatrix<f64>, Error> {
    let n = a.nrows();
    let (mut a, mut g, mut h) = (a.clone(), b * b.transpose(), q.clone());
    for _ in 0..DOUBLINGS {
        let w = (DMatrix::identity(n, n) + &g * &h).lu();
        let (Some(wa), Some(wg)) = (w.solve(&a), w.solve(&g)) else { return Err(hopeless(&h, names)) };
        let grown = a.transpose() * &h * &wa;
        g += &a * wg * a.transpose();
        a *= wa;
        h += &grown;
        // What is symmetric stays so to the last bit.
        (g, h) = ((&g + g.transpose()) * 0.5, (&h + h.transpose()) * 0.5);
        if !h.iter().chain(a.iter()).all(|x| x.is_finite()) {
            break;
        }
        if grown.norm() <= f64::EPSILON * h.norm() {
            return Ok(h);
        }
    }
    Err(hopeless(&h, names))
}

/// Shapes, finite numbers and signs; the factor of `R`.
fn check(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<Cholesky<f64, nalgebra::Dyn>, Error> {
    let (n, m) = (b.nrows(), b.ncols());
    if n == 0 || m == 0 || a.shape() != (n, n) || q.shape() != (n, n) || r.shape() != (m, m) {
        let problem =
            format!("A, B, Q and R are {:?}, {:?}, {:?} and {:?}", a.shape(), b.shape(), q.shape(), r.shape());
        return Err(fault(problem, "give n × n, n × m, n × n and m × m matrices, none of them empty"));
    }
    if [a, b, q, r].into_iter().flat_map(|x| x.iter()).any(|x| !x.is_finite()) {
        return Err(fault("a matrix has entries that are not finite".to_owned(), "give finite numbers"));
    }
    let symmetric = |x: &DMatrix<f64>| (x - x.transpose()).norm() <= 1e-12 * x.norm();
    if !symmetric(q) || q.clone().symmetric_eigenvalues().min() < -1e-12 * q.norm() {
        return Err(weights("Q"));
    }
    Cholesky::new(r.clone()).filter(|_| symmetric(r)).ok_or_else(|| weights("R"))
}

fn weights(which: &str) -> Error {
    let problem = format!("{which} is not symmetric and positive");
    fault(problem, "give a symmetric Q without negative eigenvalues and a symmetric R with positive ones")
}

/// Where the cost grows without end, the state that it is due to most.
fn hopeless(x: &DMatrix<f64>, names: &dyn Fn(usize) -> String) -> Error {
    let most = largest(x.nrows(), |i| if x[(i, i)].is_finite() { x[(i, i)] } else { f64::INFINITY });
    let problem = format!("no input stabilises the system, least of all `{}`", names(most));
    fault(problem, "drive every joint that can move, or take a model without what no motor reaches")
}

/// Where a motion does not fade although the cost is at its least, the state that takes the largest part in it.
fn free(mut closed: DMatrix<f64>, names: &dyn Fn(usize) -> String) -> Error {
    for _ in 0..DOUBLINGS {
        closed = &closed * &closed;
        closed.unscale_mut(closed.norm());
    }
    let most = largest(closed.nrows(), |i| closed.row(i).norm());
    let problem = format!("a motion of the system costs nothing, and is left as it is, most of all `{}`", names(most));
    fault(problem, "let every position have its cost: an allowed deviation that is finite")
}

fn largest(n: usize, size: impl Fn(usize) -> f64) -> usize {
    (0..n).max_by(|i, j| size(*i).total_cmp(&size(*j))).unwrap_or(0)
}

fn fault(problem: String, remedy: &str) -> Error {
    let element = "Riccati equation".to_owned();
    Error { kind: ErrorKind::Shape, file: String::new(), element, problem, remedy: remedy.to_owned() }
}
