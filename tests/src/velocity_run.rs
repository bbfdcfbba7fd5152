//! The core's terms that depend on velocity, and gravity, on owned vectors.

use crate::Core;
use crate::core_run::{double, nan};
use gyroflex::dynamics::{
    Bias, CoriolisMatrices, DerivativeScratch, InertiaRates, bias, coriolis_matrices, gravity_torques, inertia_rates,
};
use gyroflex_testkit::State as Point;
use gyroflex_testkit::tolerance::Real;

/// The blocks of the Coriolis matrix, `nv × nv` by rows each.
#[derive(Clone, Debug)]
pub struct Coriolis {
    /// Links by links.
    pub c: Vec<f64>,
    /// Links by motors.
    pub c1: Vec<f64>,
    /// Motors by links.
    pub c2: Vec<f64>,
}

impl<T: Real> Core<T> {
    /// `coriolis_matrices`.
    pub fn coriolis(&self, s: &Point) -> Coriolis {
        let nv = self.model().nv();
        let [mut c, mut c1, mut c2] = [(); 3].map(|()| vec![nan::<T>(); nv * nv]);
        let mut scratch = self.derivative_scratch();
        self.call(s, |x| {
            let out = CoriolisMatrices { c: &mut c, c1: &mut c1, c2: &mut c2 };
            coriolis_matrices(&self.model(), x.state(), &mut scratch, out)
        });
        Coriolis { c: double(&c), c1: double(&c1), c2: double(&c2) }
    }

    /// `inertia_rates`: of `M`, then of `S`, by rows.
    pub fn inertia_rates(&self, s: &Point) -> [Vec<f64>; 2] {
        let nv = self.model().nv();
        let [mut m, mut coupling] = [(); 2].map(|()| vec![nan::<T>(); nv * nv]);
        let mut scratch = self.derivative_scratch();
        self.call(s, |x| {
            inertia_rates(&self.model(), x.state(), &mut scratch, InertiaRates { m: &mut m, s: &mut coupling })
        });
        [double(&m), double(&coupling)]
    }

    /// `gravity_torques`.
    pub fn gravity(&self, s: &Point) -> Vec<f64> {
        let mut g = vec![nan::<T>(); self.model().nv()];
        let mut scratch = self.derivative_scratch();
        self.call(s, |x| gravity_torques(&self.model(), &x.q, &mut scratch, &mut g));
        double(&g)
    }

    /// `bias`: of links, then of motors.
    pub fn bias(&self, s: &Point) -> [Vec<f64>; 2] {
        let [mut link, mut motor] = [(); 2].map(|()| vec![nan::<T>(); self.model().nv()]);
        let mut scratch = self.derivative_scratch();
        self.call(s, |x| bias(&self.model(), x.state(), &mut scratch, Bias { link: &mut link, motor: &mut motor }));
        [double(&link), double(&motor)]
    }

    fn derivative_scratch(&self) -> Vec<DerivativeScratch<T>> {
        vec![DerivativeScratch::new(); self.model().bodies().len()]
    }
}
