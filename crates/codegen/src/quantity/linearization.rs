//! The linear model about a state.
//!
//! `x = (q, θ, q̇, θ̇)`: positions of the links, a floating root's as a small motion in its own frame, reflected positions of the
//! motors behind elastic transmissions, and the velocities of both. `u`: the motor torques of the joints.

use super::Options;
use super::forward_derivatives::partials;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::Body;
use gyroflex::spatial::Motion;

/// `A` and `B` of `ẋ = A x + B u`.
pub(super) fn linearization(robot: &Robot, options: &Options) -> Function {
    let meaning = "Linear model about a state: states are joint positions, positions of the motors of elastic joints, and the velocities of \
                   both; inputs are the motor torques of the joints.";
    traced("linearization", meaning, |t| {
        let (nv, bodies) = (robot.nv(), robot.model.bodies());
        let state = t.state(robot);
        let tau = t.argument("tau", nv, "motor torques, reflected [N m or N]");
        let records = t.records(robot, options).regrouped();
        let [dqdd, dthetadd] = partials(&records, &state, &tau);

        let elastic: Vec<usize> = bodies.iter().filter(|b| b.is_elastic()).map(Body::v_index).collect();
        let inputs: Vec<usize> = bodies.iter().filter(|b| b.joint.nv() == 1).map(Body::v_index).collect();
        let half = nv + elastic.len();
        let width = 2 * half;
        let (mut a, mut b) = (zeros(width * width), zeros(width * inputs.len()));
        for row in 0..half {
            a[row * width + half + row] = Sym::one();
            // Blocks by q, q̇, θ, θ̇, τ.
            let partial = |block: usize, k: usize| match row.checked_sub(nv) {
                None => dqdd[row * 5 * nv + block * nv + k],
                Some(i) => dthetadd[elastic[i] * 5 * nv + block * nv + k],
            };
            let to = &mut a[(half + row) * width..][..width];
            for k in 0..nv {
                (to[k], to[half + k]) = (partial(0, k), partial(1, k));
            }
            for (column, k) in elastic.iter().enumerate() {
                (to[nv + column], to[half + nv + column]) = (partial(2, *k), partial(3, *k));
            }
            for (column, k) in inputs.iter().enumerate() {
                b[(half + row) * inputs.len() + column] = partial(4, *k);
            }
        }
        if robot.model.is_floating() {
            transport(&state.qd, width, &mut a);
        }
        t.matrix("a", &a, width, "state matrix [units of the states, per second]");
        t.matrix("b", &b, inputs.len(), "input matrix [units of the states, per second and N m or N]");
    })
}

/// A small motion `ξ` of a floating root, given in its own frame, obeys `ξ̇ = δv − v × ξ`: the frame moves with the twist `v`.
fn transport(qd: &[Sym], width: usize, a: &mut [Sym]) {
    let twist = Motion::from(core::array::from_fn(|k| qd[k]));
    for column in 0..6 {
        let mut unit = zeros(6);
        unit[column] = Sym::one();
        let unit = Motion::from(core::array::from_fn(|k| unit[k]));
        for (row, rate) in twist.cross(unit).to_array().into_iter().enumerate() {
            a[row * width + column] = -rate;
        }
    }
}
