//! The inverse of a robot with elastic joints.

use super::tracing::{traced, zeros};
use super::{Options, Quantity, Unavailable};
use crate::function::Function;
use crate::robot::Robot;
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::dynamics::{
    Deflections, DerivativeScratch, ElasticInverse, ElasticInverseScratch, External, JointMotion, JointOrders,
    MAX_COEFFICIENTS, Smoothness, SmoothnessScratch, VANISHING, elastic_inverse as solve, elastic_inverse_len,
    required_smoothness, smoothness_len,
};

/// Motions and torques of the motors from the motion of the links, up to as many derivatives as the torques depend on.
pub(super) fn elastic_inverse(robot: &Robot, options: &Options) -> Result<Function, Unavailable> {
    let (nv, bodies, rows) = (robot.nv(), robot.model.bodies().len(), 1 + options.torque_derivatives);
    let orders = orders(robot, options.torque_derivatives);
    let smoothness = Smoothness { joints: &orders, torque_derivatives: options.torque_derivatives };
    let Some(len) = elastic_inverse_len(&robot.model, &smoothness) else {
        return Err(Unavailable {
            quantity: Quantity::ElasticInverse,
            reason: format!(
                "it takes {} Taylor coefficients, and there is code for {MAX_COEFFICIENTS}",
                smoothness.coefficients()
            ),
            remedy: "generate the model `reduced`, or damp the transmissions: both take fewer derivatives".to_owned(),
        });
    };
    let (order, damped) = (smoothness.order(), orders.iter().any(|order| order.damped));
    let meaning =
        "Motions and torques of the motors that make the links move as asked, elastic transmissions included.";
    Ok(traced("elastic_inverse", meaning, |t| {
        let q = t.positions(robot);
        let rates =
            format!("{order} time derivatives of the joint positions, the velocities first, a row of {nv} each");
        let derivatives = t.argument("derivatives", order * nv, &rates);
        let (mut deflection, mut step) = (zeros(nv), Sym::zero());
        if damped {
            deflection = t.argument("deflection", nv, "deflections of damped transmissions, their state [rad or m]");
            step = t.argument("step", 1, "time after which deflections are wanted [s]")[0];
        }
        let records = t.records(robot, options).regrouped();
        let [mut tau_j, mut tau] = [(); 2].map(|()| zeros(rows * nv));
        let (mut theta, mut after, mut rate) = (zeros((2 + rows) * nv), zeros(nv), zeros(nv));
        solve::<Sym, MAX_COEFFICIENTS>(
            &records.view(),
            &smoothness,
            JointMotion { q: &q, derivatives: &derivatives },
            External::none(),
            Deflections { now: &deflection, step },
            &mut vec![ElasticInverseScratch::new(); len],
            ElasticInverse {
                theta: &mut theta,
                tau_j: &mut tau_j,
                tau: &mut tau,
                deflection: &mut after,
                deflection_rate: &mut rate,
            },
        )
        .unwrap_or_else(|error| unreachable!("{bodies} bodies, orders of their own: {error}"));
        t.matrix("theta", &theta, nv, "motor positions, reflected, and their time derivatives, a row each [rad or m]");
        t.matrix("tau_j", &tau_j, nv, "torque of each transmission, and its time derivatives, a row each [N m or N]");
        t.matrix("tau", &tau, nv, "torque of each motor, reflected, and its time derivatives, a row each [N m or N]");
        if damped {
            t.vector("deflection_after", &after, "deflections of damped transmissions after the step [rad or m]");
            t.vector("deflection_rate", &rate, "their present rates [rad/s or m/s]");
        }
    }))
}

/// What the inverse asks of every joint, from the numbers of the robot's description.
fn orders(robot: &Robot, torque_derivatives: usize) -> Vec<JointOrders> {
    let (model, nv, n) = (robot.model, robot.nv(), robot.model.bodies().len());
    let mut orders = vec![JointOrders::default(); n];
    let scratch = SmoothnessScratch {
        bodies: &mut vec![DerivativeScratch::new(); n],
        numbers: &mut vec![0.0; smoothness_len(&model)],
        contains: &mut vec![Default::default(); nv * nv],
    };
    required_smoothness(&model, torque_derivatives, VANISHING, scratch, &mut orders).expect("lengths are the model's");
    orders
}
