//! Controllers of robots whose links bend.

use crate::arms::{beam, run, scenario, tree};
use crate::assert_close;
use gyroflex_sim::load::{Disk, LoadOptions, load};
use gyroflex_sim::record::MemoryRecorder;
use gyroflex_sim::{Dynamics, ScenarioFile};
use std::ops::ControlFlow;
use std::path::Path;

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

#[test]
fn a_velocity_loop_too_fast_for_the_root_of_a_bending_link_is_warned_of() {
    // Behind the hinge, what accelerates at once is M_qq − M_qη M_ηη⁻¹ M_ηq, far less than the whole beam.
    let robot = beam(2, "", [0.0; 3], "");
    let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
    let mut m = vec![0.0; 9];
    dynamics.mass_matrix(&[0.0; 3], &mut m).unwrap();
    // With masses as norms of the modes, M_ηη is a number.
    let (hinge, own) = (m[0], m[4]);
    let at_once = hinge - (m[1] * m[1] + m[2] * m[2]) / own;
    assert!(at_once < 0.1 * hinge, "{at_once} of {hinge}");
    let limit = 2.0 * 500.0 * at_once;
    let warned = |kd: f64| {
        let text = format!(
            "duration: 0.5\ninitial: {{q: {{hinge: 0.01}}}}\nreference: {{hinge: {{type: hold, at: 0}}}}\n\
             controller: {{type: pd, rate: 500, kp: 0.1, kd: {kd}}}\nlog: {{rate: 100}}\nintegrator: {{method: rk4, step: 1e-5}}\n"
        );
        let mut simulation = gyroflex_sim::Simulation::new(&robot, &scenario(&text)).expect("it fits");
        let warned = simulation.warnings().iter().any(|w| w.to_string().contains("the links bend away under it"));
        let mut recorder = MemoryRecorder::new(simulation.run_info());
        let ended = simulation.run(&mut recorder, &mut |_| ControlFlow::Continue(()));
        let speed = recorder.table().get("qd.hinge").unwrap().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        (warned, ended.is_err() || speed > 1.0)
    };
    assert_eq!(warned(0.9 * limit), (false, false));
    assert_eq!(warned(1.1 * limit), (true, true));
}

#[test]
fn loops_of_the_shipped_scenarios_are_slow_enough() {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    for name in ["book_two_link/move.yaml", "book_two_link/elastic_move.yaml", "deluca_siciliano/move.yaml"] {
        let file = ScenarioFile::load(&Disk, &robots.join(name)).expect("it loads");
        let robot = load(&file.robot_path(), &LoadOptions::default()).expect("it loads");
        let simulation = gyroflex_sim::Simulation::new(&robot, &file).expect("it fits");
        assert!(simulation.warnings().is_empty(), "{name}: {:?}", simulation.warnings());
    }
}
