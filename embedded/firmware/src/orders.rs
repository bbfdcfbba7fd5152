//! What the inverse of the elastic arm asks of every joint, a property of its structure: found on the host by
//! `required_smoothness`, as a test of the project checks.

use gyroflex::dynamics::JointOrders;

const fn orders(position: u8, torque: u8) -> JointOrders {
    JointOrders { position, torque, force: torque, motion: 4, damped: true }
}

/// One entry per joint.
pub const ORDERS: [JointOrders; 7] =
    [orders(6, 1), orders(6, 1), orders(6, 2), orders(6, 2), orders(6, 3), orders(5, 3), orders(6, 4)];
