//! Coriolis matrices.

use super::Options;
use super::bending;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;
use gyroflex::dynamics::{CoriolisMatrices, DerivativeScratch, coriolis_matrices};

/// `C, C₁, C₂` in Christoffel form.
pub(super) fn coriolis(robot: &Robot, options: &Options) -> Function {
    traced("coriolis_matrices", "Coriolis and centrifugal matrices of links and motors in Christoffel form.", |t| {
        let nv = robot.nv();
        let state = t.moving(robot);
        let records = t.records(robot, options).regrouped();
        let [c, c1, c2] = match records.flexible() {
            Some(model) => bending::coriolis(&model, &state),
            None => {
                let [mut c, mut c1, mut c2] = [(); 3].map(|()| zeros(nv * nv));
                let mut scratch = vec![DerivativeScratch::new(); records.view().bodies().len()];
                let out = CoriolisMatrices { c: &mut c, c1: &mut c1, c2: &mut c2 };
                coriolis_matrices(&records.view(), state.view(), &mut scratch, out).expect("lengths are the model's");
                [c, c1, c2]
            }
        };
        t.matrix("c", &c, nv, "links by links [kg m²/s]");
        if robot.is_elastic() {
            t.matrix("c1", &c1, nv, "links by motors [kg m²/s]");
            t.matrix("c2", &c2, nv, "motors by links [kg m²/s]");
        }
    })
}
