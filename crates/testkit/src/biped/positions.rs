//! Where the links are: eq. 1, in any scalar, so that derivatives of it can be taken without a second formula.

use super::Biped;
use gyroflex::Scalar;

impl Biped {
    /// Centre of mass of link `i`, seen from the tip `b` (eq. 1) [m].
    pub fn centre_of_mass<T: Scalar>(&self, i: usize, theta: &[T; 5]) -> [T; 2] {
        let (s, c) = theta[i].sin_cos();
        let (joint, d) = (self.joint(i, theta), T::from_f64(self.centre[i]));
        [joint[0] + d * s, joint[1] + d * c]
    }

    /// Joint `i`, where link `i` begins, seen from the tip `b` [m]; `i = 2` is the hip and `i = 5` the tip `e`.
    pub fn joint<T: Scalar>(&self, i: usize, theta: &[T; 5]) -> [T; 2] {
        let mut at = [T::zero(); 2];
        for (j, angle) in theta.iter().enumerate().take(i) {
            let (s, c) = angle.sin_cos();
            let reach = T::from_f64(self.reach(j));
            at = [at[0] + reach * s, at[1] + reach * c];
        }
        at
    }

    /// Centre of mass of the whole biped, seen from the tip `b` [m].
    pub fn centre_of_all<T: Scalar>(&self, theta: &[T; 5]) -> [T; 2] {
        let mut sum = [T::zero(); 2];
        for i in 0..5 {
            let (c, m) = (self.centre_of_mass(i, theta), T::from_f64(self.mass[i] / self.mass_from(0)));
            sum = [sum[0] + m * c[0], sum[1] + m * c[1]];
        }
        sum
    }

    /// Potential energy, zero at the height of the tip `b` (eq. 2) [J].
    pub fn potential(&self, theta: &[f64; 5]) -> f64 {
        self.gravity * self.mass_from(0) * self.centre_of_all(theta)[1]
    }
}
