//! Stiffness of transmissions and links.

use super::Options;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::{Drive, FlexibleModel};

/// `k'(δ)` of the transmissions, and `K` of the modes.
pub(super) fn stiffness(robot: &Robot, options: &Options) -> Function {
    traced("stiffness", "Tangent stiffness of the transmissions, and stiffness of links that bend.", |t| {
        let q = t.positions(robot);
        let theta = t.of_motors(robot, "theta", "motor positions, reflected [rad or m]");
        let records = t.records(robot, options);
        if robot.is_elastic() {
            let (model, mut k) = (records.view(), zeros(robot.nv()));
            for body in model.bodies() {
                let Some(Drive { rotor, elastic: Some(elastic) }) = &body.drive else { continue };
                // δ = θ − q − e(θ)
                let v = body.v_index();
                let e = elastic.error.map_or(Sym::zero(), |e| e.value_and_slope(theta[v], rotor.gear_ratio).0);
                k[v] = elastic.spring.slope(theta[v] - q[body.q_index()] - e, model.knots());
            }
            t.vector("k", &k, "of each transmission, zero where it is rigid [N m/rad or N/m]");
        }
        if let Some(model) = records.flexible() {
            t.matrix("modal", &modal(&model), model.modes(), "of the modes of links that bend [N/m]");
        }
    })
}

/// `K` of the modes of all links: a block a link.
fn modal(model: &FlexibleModel<Sym>) -> Vec<Sym> {
    let modes = model.modes();
    let mut all = zeros(modes * modes);
    for link in model.links() {
        let range = link.mode_range();
        for (p, pair) in model.pairs()[link.pair_range()].iter().enumerate() {
            let (j, k) = (p / range.len(), p % range.len());
            all[(range.start + j) * modes + range.start + k] = pair.stiffness;
        }
    }
    all
}
