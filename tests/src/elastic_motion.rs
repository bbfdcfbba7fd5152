//! Random motions for the inverse of elastic robots.

use crate::LinkMotion;
use gyroflex::dynamics::JointOrders;
use gyroflex::model::{Model, SpringSpec, TransmissionSpec};
use gyroflex_testkit::random::RandomRobot;

/// A motion of random derivatives, as many as the orders ask for, loads that change, and deflections of usual size.
pub fn random_motion(robot: &RandomRobot, model: &Model<'_, f64>, orders: &[JointOrders], index: u64) -> LinkMotion {
    let order = orders.iter().map(|o| usize::from(o.position)).max().unwrap_or(0).max(2);
    let of = |row: usize| robot.state(1 + index + 100 * row as u64);
    let start = of(0);
    let mut deflection = vec![0.0; robot.nv()];
    for body in model.bodies().iter().filter(|b| b.is_elastic()) {
        let (k, drive) = (body.v_index(), body.drive.expect("an elastic joint has a drive"));
        let error = drive.elastic.and_then(|e| e.error);
        let e = error.map_or(0.0, |e| e.value_and_slope(start.theta[k], drive.rotor.gear_ratio).0);
        deflection[k] = start.theta[k] - start.q[body.q_index()] - e;
    }
    LinkMotion {
        q: start.q,
        // Of about 2 π rad/s.
        derivatives: (1..=order)
            .map(|row| of(row).qd.iter().map(|x| 0.1 * x * 6f64.powi(row as i32)).collect())
            .collect(),
        deflection,
        step: 1e-3,
        tau_ext: (0..3).map(|row| of(row).tau_ext).collect(),
        wrenches: (0..3).map(|row| of(row).wrenches).collect(),
    }
}

/// The same robot with damping by which every transmission settles in a hundredth of a second or later: the derivatives of faster
/// transients are beyond all measure.
pub fn settling(mut robot: RandomRobot) -> RandomRobot {
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        let TransmissionSpec::Elastic { spring, damping, .. } = &mut drive.transmission else { continue };
        let stiffness = match *spring {
            SpringSpec::Polynomial { stiffness, .. } => stiffness,
            SpringSpec::Table { first, .. } => {
                let [a, b] = [robot.spring_tables[first], robot.spring_tables[first + 1]];
                (b[1] - a[1]) / (b[0] - a[0])
            }
        };
        if *damping > 0.0 {
            *damping = damping.max(stiffness / 100.0);
        }
    }
    robot
}
