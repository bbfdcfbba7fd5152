//! Linear feedback of a whole state.

use crate::Scalar;
use crate::model::SizeError;

/// `u = u_d − K (x − x_d)`: what a linear-quadratic regulator gives (Anderson & Moore, *Optimal Control*, §2.3).
#[derive(Clone, Copy, Debug)]
pub struct StateFeedback<'a, T> {
    /// `K` by rows: a row an input, a column a state.
    pub gain: &'a [T],
}

impl<T: Scalar> StateFeedback<'_, T> {
    /// Adds the feedback to the feedforward `input`.
    ///
    /// # Errors
    /// [`SizeError`] if slices do not fit the gain; nothing is written then.
    pub fn add(&self, desired: &[T], state: &[T], input: &mut [T]) -> Result<(), SizeError> {
        SizeError::check("gain", self.gain.len(), state.len() * input.len())?;
        SizeError::check("desired state", desired.len(), state.len())?;
        if state.is_empty() {
            return Ok(());
        }
        for (u, row) in input.iter_mut().zip(self.gain.chunks_exact(state.len())) {
            for ((k, x), x_d) in row.iter().zip(state).zip(desired) {
                *u = k.mul_add(*x_d - *x, *u);
            }
        }
        Ok(())
    }
}
