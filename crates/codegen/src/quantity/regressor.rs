//! The regressor.

use super::Options;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;
use gyroflex::dynamics::{Acceleration, DerivativeScratch, PARAMETERS, Regressor};

/// Inverse dynamics as a linear function of [`PARAMETERS`] a body, of the links as they are.
pub(super) fn regressor(robot: &Robot, options: &Options) -> Function {
    let meaning = "Inverse dynamics as a linear function of twenty parameters a body: mass, first moment x y z, inertia xx yy zz xy xz yz \
                   of the link; inertia of the rotor; viscous, Coulomb and Stribeck friction of link and motor; K, K3 and D.";
    traced("regressor", meaning, |t| {
        let state = t.state(robot);
        let qdd = t.argument("qdd", robot.nv(), "joint accelerations [rad/s² or m/s²]");
        let thetadd = t.of_motors(robot, "thetadd", "motor accelerations, reflected [rad/s² or m/s²]");
        let records = t.records(robot, options);
        let model = records.view();
        let width = PARAMETERS * model.bodies().len();
        let [mut link, mut transmission, mut motor] = [(); 3].map(|()| zeros(robot.nv() * width));
        let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let out = Regressor { link: &mut link, transmission: &mut transmission, motor: &mut motor };
        gyroflex::dynamics::regressor(&model, state.view(), accel, &mut scratch, out).expect("lengths are the model's");
        t.matrix("link", &link, width, "of the torque that the links need");
        if robot.is_elastic() {
            t.matrix("transmission", &transmission, width, "of the torque that the transmission exerts");
        }
        t.matrix("motor", &motor, width, "of what the motor must exert beside the transmission's, reflected");
    })
}
