//! Controllers of robots whose links bend.

use crate::arms::{run, tree};
use crate::assert_close;

#[test]
fn computed_torque_knows_the_robot_whose_links_do_not_bend() {
    let robot = tree("rigid", 0.02, false);
    let text = "duration: 0.01\ncontroller: {type: computed_torque, rate: 500, kp: 100, kd: 20}\nlog: {rate: 500}\n\
        reference: {default: {type: sine, amplitude: 0.3, frequency: 1.0}}\ninitial: {q: [0.1, 0.2, 0.05]}\nintegrator: {method: rk4, step: 2e-5}\n";
    let torques = |robot: &gyroflex_sim::Robot| {
        let (_, table, _) = run(robot, text);
        ["tau.shoulder", "tau.elbow", "tau.slide"].map(|name| table.get(name).unwrap()[0])
    };
    assert_close("at the start", &torques(&robot), &torques(&robot.with_rigid_links()), 1e-12);
}

#[test]
fn a_stiff_link_moves_as_a_rigid_one() {
    // The paper's check, here of the whole way from file to record: the error falls with 1/EI.
    let text = "duration: 0.1\ninitial: {q: {shoulder: 0.4}, qd: {shoulder: 1.0, elbow: -2.0}, eta: [0, 0, 0, 0, 0, 0]}\nlog: {rate: 100}\n\
        integrator: {method: kvaerno5, rtol: 1e-8, atol: 1e-10}\n";
    let robot = tree("rigid", 0.7, false);
    let stiffer = |factor: f64| {
        let mut robot = robot.clone();
        for flexure in &mut robot.flexible.links {
            flexure.integrals.pairs.iter_mut().for_each(|pair| {
                pair.stiffness *= factor;
                pair.damping *= factor.sqrt();
            });
        }
        robot
    };
    let end = |robot: &gyroflex_sim::Robot, text: &str| run(robot, text).2.state().q[..3].to_vec();
    let rigid = end(&robot.with_rigid_links(), &text.replace(", eta: [0, 0, 0, 0, 0, 0]", ""));
    let error =
        |factor: f64| end(&stiffer(factor), text).iter().zip(&rigid).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let (soft, stiff) = (error(100.0), error(1000.0));
    assert!(stiff < 0.2 * soft && stiff < 1e-3, "{soft} {stiff}");
}
