//! Sampled systems: the exact answer to inputs that are held between samples.

use super::Linearization;
use crate::error::{Error, ErrorKind};
use nalgebra::DMatrix;
use nalgebra::linalg::balancing::balance_parlett_reinsch;

/// `A` and `B` of the system sampled every `step` seconds, inputs held in between:
/// `exp([[A, B], [0, 0]] h) = [[A_d, B_d], [0, I]]` (Van Loan, IEEE Trans. Autom. Control 23, 1978).
///
/// # Errors
/// A step that is not above zero, or a system that grows beyond all numbers within it.
pub fn zero_order_hold(a: &DMatrix<f64>, b: &DMatrix<f64>, step: f64) -> Result<(DMatrix<f64>, DMatrix<f64>), Error> {
    let fault = |problem: String, remedy: &str| Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: "zero-order hold".to_owned(),
        problem,
        remedy: remedy.to_owned(),
    };
    if !(step.is_finite() && step > 0.0) {
        return Err(fault(format!("the step is {step} s"), "give a number of seconds above zero"));
    }
    let (n, m) = (a.nrows(), b.ncols());
    // Positions and velocities in units that make their rates alike: the exponential halves the step as often as the largest entry
    // asks for, and loses digits each time. The units are powers of two, which cost nothing.
    let mut scaled = a * step;
    let units = balance_parlett_reinsch(&mut scaled);
    let mut block = DMatrix::zeros(n + m, n + m);
    block.view_mut((0, 0), (n, n)).copy_from(&scaled);
    block.view_mut((0, n), (n, m)).copy_from(&DMatrix::from_fn(n, m, |i, j| b[(i, j)] * step / units[i]));
    let sampled = block.exp();
    if !sampled.iter().all(|x| x.is_finite()) {
        let problem = format!("the robot moves beyond all numbers within {step} s");
        return Err(fault(problem, "give a smaller step"));
    }
    let a = DMatrix::from_fn(n, n, |i, j| sampled[(i, j)] * units[i] / units[j]);
    Ok((a, DMatrix::from_fn(n, m, |i, j| sampled[(i, n + j)] * units[i])))
}

/// A linearization sampled every `step` seconds; its outputs are those of the continuous system.
///
/// # Errors
/// As [`zero_order_hold`].
pub fn zero_order_hold_of(linear: &Linearization, step: f64) -> Result<Linearization, Error> {
    let (a, b) = zero_order_hold(&linear.a, &linear.b, step)?;
    Ok(Linearization { a, b, step: Some(step), ..linear.clone() })
}
