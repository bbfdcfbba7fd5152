//! The core's derivatives, on owned vectors.

use crate::Core;
use crate::core_run::{double, nan};
use gyroflex::dynamics::{
    Acceleration, DerivativeScratch, Forward, ForwardDerivatives, InverseDerivatives, derivative_matrix_len,
    forward_derivatives, inverse_derivatives,
};
use gyroflex_testkit::State as Point;
use gyroflex_testkit::dense::Accelerations;
use gyroflex_testkit::tolerance::Real;

impl<T: Real> Core<T> {
    /// `forward_derivatives`: the accelerations, and the matrices of `qdd` and of `thetadd`.
    pub fn forward_derivatives(&self, s: &Point) -> (Accelerations, [Vec<f64>; 2]) {
        let (model, nv) = (self.model(), self.model().nv());
        let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
        let mut matrix = vec![nan::<T>(); derivative_matrix_len(&model)];
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![nan::<T>(); nv]);
        let [mut by_qdd, mut by_thetadd] = [(); 2].map(|()| vec![nan::<T>(); 5 * nv * nv]);
        self.call(s, |x| {
            let value = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            let out = ForwardDerivatives { qdd: &mut by_qdd, thetadd: &mut by_thetadd };
            forward_derivatives(&model, x.state(), &x.tau, x.external(), &mut scratch, &mut matrix, value, out)
        });
        let value = Accelerations { qdd: double(&qdd), thetadd: double(&thetadd), tau_j: double(&tau_j) };
        (value, [double(&by_qdd), double(&by_thetadd)])
    }

    /// `inverse_derivatives`: the matrices of `tau_j` and of `tau`.
    pub fn inverse_derivatives(&self, s: &Point) -> [Vec<f64>; 2] {
        let (model, nv) = (self.model(), self.model().nv());
        let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![nan::<T>(); 6 * nv * nv]);
        self.call(s, |x| {
            let accel = Acceleration { qdd: &x.qdd, thetadd: &x.thetadd };
            let out = InverseDerivatives { tau_j: &mut tau_j, tau: &mut tau };
            inverse_derivatives(&model, x.state(), accel, x.external(), &mut scratch, out)
        });
        [double(&tau_j), double(&tau)]
    }
}
