//! The inertia matrix.

use super::Options;
use super::bending::Storage;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::{CrbaScratch, FlexibleMatrices, coupling, crba, flexible_mass_matrix};

/// `M_l(q)`.
pub(super) fn mass_matrix(robot: &Robot, options: &Options) -> Function {
    traced("mass_matrix", "Inertia matrix of links and modes, elastic rotors at rest beside their carriers.", |t| {
        let q = t.positions(robot);
        let records = t.records(robot, options).regrouped();
        let [m, _] = matrices(&records, &q, robot.nv());
        t.matrix("m", &m, robot.nv(), "inertia matrix, symmetric [kg m², kg m or kg]");
    })
}

/// `M_l` and `S`.
pub(super) fn matrices(records: &Records, q: &[Sym], nv: usize) -> [Vec<Sym>; 2] {
    let (mut m, mut s) = (zeros(nv * nv), zeros(nv * nv));
    match records.flexible() {
        Some(model) => {
            let out = FlexibleMatrices { mass: &mut m, coupling: &mut s };
            flexible_mass_matrix(&model, q, Storage::of(&model).lend(), out)
        }
        None => {
            let (model, mut scratch) = (records.view(), vec![CrbaScratch::new(); records.view().bodies().len()]);
            crba(&model, q, &mut scratch, &mut m).and_then(|()| coupling(&model, q, &mut scratch, &mut s))
        }
    }
    .expect("lengths are the model's");
    [m, s]
}
