//! Proportional and derivative feedback of the motors around a desired motion.

use crate::Scalar;
use crate::model::SizeError;

/// Reflected positions and velocities of the motors: `nv` entries each.
#[derive(Clone, Copy, Debug)]
pub struct Motors<'a, T> {
    /// Positions [rad or m].
    pub theta: &'a [T],
    /// Velocities [rad/s or m/s].
    pub thetad: &'a [T],
}

/// `τ = τ_d + k_p (θ_d − θ) + k_d (θ̇_d − θ̇)`, joint by joint: what is measured at the motors alone. With the torque and the motion of
/// the inverse it is the feedback of Thümmel, Otter & Bals, §6; with those of rest, PD with gravity compensation (Tomei 1991).
#[derive(Clone, Copy, Debug)]
pub struct Pd<'a, T> {
    /// Position gains: `nv` entries [N m/rad or N/m].
    pub kp: &'a [T],
    /// Velocity gains: `nv` entries [N m s/rad or N s/m].
    pub kd: &'a [T],
}

impl<T: Scalar> Pd<'_, T> {
    /// Adds the feedback to the feedforward torques `tau` (`nv` entries, reflected).
    ///
    /// # Errors
    /// [`SizeError`] if slices are of different lengths; nothing is written then.
    pub fn add(&self, desired: Motors<T>, measured: Motors<T>, tau: &mut [T]) -> Result<(), SizeError> {
        let nv = tau.len();
        let lengths = [
            ("kp", self.kp.len()),
            ("kd", self.kd.len()),
            ("theta desired", desired.theta.len()),
            ("thetad desired", desired.thetad.len()),
            ("theta", measured.theta.len()),
            ("thetad", measured.thetad.len()),
        ];
        lengths.into_iter().try_for_each(|(name, given)| SizeError::check(name, given, nv))?;
        let gains = self.kp.iter().zip(self.kd);
        let positions = desired.theta.iter().zip(measured.theta);
        let velocities = desired.thetad.iter().zip(measured.thetad);
        for (((tau, (kp, kd)), (theta_d, theta)), (thetad_d, thetad)) in
            tau.iter_mut().zip(gains).zip(positions).zip(velocities)
        {
            *tau = kp.mul_add(*theta_d - *theta, kd.mul_add(*thetad_d - *thetad, *tau));
        }
        Ok(())
    }
}
