//! Laws of links that hang at rest.

use crate::arms::{EI, LENGTH, MASS_PER_LENGTH, beam, run, tree};
use gyroflex::dynamics::External;
use gyroflex_sim::Dynamics;

/// A small force, for which the deflection is linear [N].
const FORCE: f64 = 1e-3;

#[test]
fn a_force_on_the_tip_bends_a_cantilever_by_the_textbook() {
    // u = F L³ / 3 EI, turning by F L² / 2 EI: clamped modes approach it from below, the first alone within 3 %.
    let (displacement, rotation) = (FORCE * LENGTH.powi(3) / (3.0 * EI), FORCE * LENGTH.powi(2) / (2.0 * EI));
    let mut before = 0.0;
    for (modes, tolerance) in [(1, 0.03), (2, 0.01), (4, 0.002), (8, 3e-4)] {
        let robot = beam(modes, "", [0.0; 3], "");
        let text = format!(
            "duration: 0.001\nlog: {{rate: 1000}}\nwrenches: [{{link: tool, force: [0, {FORCE}, 0], frame: world}}]\n\
             integrator: {{method: dopri5, rtol: 1e-8, atol: 1e-10}}\n"
        );
        let (_, table, _) = run(&robot, &text);
        let tip = |key: &str| table.get(&format!("tip.beam.{key}")).unwrap()[0];
        assert!((tip("y") / displacement - 1.0).abs() < tolerance, "{modes} modes: {}", tip("y") / displacement);
        assert!(tip("y") > before && tip("y") < displacement, "each mode softens the beam");
        assert!((tip("rz") / rotation - 1.0).abs() < 15.0 * tolerance, "{modes} modes: {}", tip("rz") / rotation);
        assert!(tip("x").abs() + tip("z").abs() + tip("rx").abs() + tip("ry").abs() < 1e-15);
        before = tip("y");
    }
}

#[test]
fn a_cantilever_hangs_under_its_weight_by_the_textbook() {
    // u = μ g L⁴ / 8 EI.
    let gravity = 0.02;
    let robot = beam(3, "", [0.0, -gravity, 0.0], "");
    let (_, table, _) = run(&robot, "duration: 0.001\nlog: {rate: 1000}\nintegrator: {method: dopri5}\n");
    let expected = -MASS_PER_LENGTH * gravity * LENGTH.powi(4) / (8.0 * EI);
    let found = table.get("tip.beam.y").unwrap()[0];
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn at_rest_nothing_accelerates_the_modes_while_the_joints_are_held() {
    for model in ["complete", "rigid"] {
        let robot = tree(model, 0.0, false);
        let mut dynamics = Dynamics::new(robot.model(robot.fidelity).unwrap());
        let mut q = vec![0.0; dynamics.nq()];
        q[..3].copy_from_slice(&[0.3, -0.8, 0.2]);
        dynamics.settle(&mut q, External::none()).unwrap();
        let nv = dynamics.nv();
        let rest = vec![0.0; nv];
        let [mut tau_j, mut tau, mut etadd] = [nv, nv, nv - 3].map(|n| vec![1.0; n]);
        let state = gyroflex::dynamics::State { q: &q, qd: &rest, theta: &rest, thetad: &rest };
        let accel = gyroflex::dynamics::Acceleration { qdd: &rest, thetadd: &rest };
        let out = gyroflex::dynamics::Inverse { tau_j: &mut tau_j, tau: &mut tau };
        dynamics.hybrid(state, accel, External::none(), out, &mut etadd).unwrap();
        assert!(etadd.iter().all(|x| x.abs() < 1e-9), "{etadd:?}");
        assert!(q[3..].iter().any(|eta| eta.abs() > 1e-4), "gravity bends the links");
    }
}

#[test]
fn a_scenario_starts_where_its_links_hang_and_stays_there() {
    let robot = tree("complete", 0.05, false);
    let kp = "controller: {type: pd, rate: 1000, kp: 200, kd: 5, gravity_compensation: true}";
    let text = format!(
        "duration: 0.3\nreference: {{shoulder: {{hold: 0.4}}}}\n{kp}\nlog: {{rate: 100}}\nintegrator: {{method: rk4, step: 2e-5}}\n"
    );
    let (_, table, _) = run(&robot, &text.replace("{hold: 0.4}", "{type: hold, at: 0.4}"));
    for name in ["q.shoulder", "q.elbow", "q.slide", "eta.upper.bending_y1", "eta.lower.bending_z1"] {
        let column = table.get(name).unwrap();
        let moved = column.iter().fold(0.0, |most: f64, x| most.max((x - column[0]).abs()));
        assert!(moved < 1e-8, "{name} moves by {moved}");
    }
}
