//! Laws of the calculator: what it says of joints and modes fits together.

use crate::arms::{state, tree};
use crate::{assert_close, numbers};
use gyroflex_sim::Robot;
use gyroflex_sim::eval::{Answer, Evaluator, Options, Query};
use gyroflex_sim::simulate::StateVec;

const ALL: Options = Options { fidelity: None, matrices: true, energy: true, significance: false, motor_side: false };

/// A query at a state.
fn query(robot: &Robot, at: &StateVec) -> Query {
    let (n, modes) = (robot.joints.len(), robot.flexible.modes());
    let joints = |v: &[f64]| Some(v[..v.len() - modes].to_vec());
    let of_modes = |v: &[f64]| Some(v[v.len() - modes..].to_vec());
    assert_eq!(at.q.len(), n + modes);
    Query {
        q: joints(&at.q),
        qd: joints(&at.qd),
        theta: joints(&at.theta),
        thetad: joints(&at.thetad),
        eta: of_modes(&at.q),
        etad: of_modes(&at.qd),
        ..Query::default()
    }
}

fn times(matrix: &[Vec<f64>], v: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum()).collect()
}

#[test]
fn matrices_and_accelerations_obey_the_equations_of_motion() {
    for model in ["complete", "reduced", "rigid", "rigid_reflected"] {
        let robot = tree(model, 0.02, false);
        let at = state(&robot, 5);
        let mut evaluator = Evaluator::new(robot.clone(), ALL).unwrap();
        let tau = numbers(8, 3);
        let tau_eta = numbers(9, robot.flexible.modes());
        let asked = Query { tau: Some(tau.clone()), tau_eta: Some(tau_eta.clone()), ..query(&robot, &at) };
        let Answer { qdd, thetadd, tau_j, etadd, m, s, g, k, d, velocity_matrices, .. } =
            evaluator.evaluate(&asked).unwrap();
        let (qdd, etadd, moving) = (qdd.unwrap(), etadd.unwrap(), velocity_matrices.unwrap());
        let with_modes = |v: Vec<f64>| [v, vec![0.0; etadd.len()]].concat();
        let all = [qdd.clone(), etadd.clone()].concat();
        // M q̈ + S θ̈ + C q̇ + C₁ θ̇ + g + [0; K η + D η̇] = [τ_J; f]
        let terms = [
            times(&m.unwrap(), &all),
            times(&s.unwrap(), &with_modes(thetadd.unwrap())),
            times(&moving.c, &at.qd),
            times(&moving.c1, &at.thetad),
            g.unwrap(),
            [vec![0.0; 3], times(&k.unwrap(), asked.eta.as_ref().unwrap())].concat(),
            [vec![0.0; 3], times(&d.unwrap(), asked.etad.as_ref().unwrap())].concat(),
        ];
        let sum: Vec<f64> = (0..all.len()).map(|i| terms.iter().map(|t| t[i]).sum()).collect();
        // Behind a rigid gear the rotor is in M: there the whole motor torque is on the right.
        let elastic = matches!(model, "complete" | "reduced");
        let elbow = if elastic { tau_j.unwrap()[1] } else { tau[1] };
        let right = [vec![tau[0], elbow, tau[2]], tau_eta].concat();
        assert_close(model, &sum, &right, 1e-9);
    }
}

#[test]
fn inverse_dynamics_returns_what_forward_dynamics_was_given() {
    for model in ["complete", "rigid"] {
        let robot = tree(model, 0.02, false);
        let at = state(&robot, 11);
        let mut evaluator = Evaluator::new(robot.clone(), Options::default()).unwrap();
        let (tau, tau_eta) = (numbers(8, 3), numbers(9, robot.flexible.modes()));
        let forward = Query { tau: Some(tau.clone()), tau_eta: Some(tau_eta.clone()), ..query(&robot, &at) };
        let found = evaluator.evaluate(&forward).unwrap();
        let (qdd, thetadd, etadd) = (found.qdd, found.thetadd, found.etadd.unwrap());
        let inverse =
            Query { qdd: qdd.clone(), thetadd: thetadd.clone(), etadd: Some(etadd.clone()), ..query(&robot, &at) };
        let back = evaluator.evaluate(&inverse).unwrap();
        assert_close("tau_eta", &back.tau_eta.unwrap(), &tau_eta, 1e-9);
        if model == "rigid" {
            assert_close("tau", &back.tau.unwrap(), &tau, 1e-9);
        } else {
            assert_close("tau_j", &back.tau_j.unwrap(), &found.tau_j.unwrap(), 1e-9);
        }
        // Free modes accelerate as they did.
        let free = Query { qdd, thetadd, ..query(&robot, &at) };
        let forces_free = Query { tau: Some(tau), ..query(&robot, &at) };
        let alone = evaluator.evaluate(&forces_free).unwrap();
        let free = Query { qdd: alone.qdd.clone(), thetadd: alone.thetadd.clone(), ..free };
        let hybrid = evaluator.evaluate(&free).unwrap();
        assert_close("etadd", &hybrid.etadd.unwrap(), &alone.etadd.unwrap(), 1e-9);
        assert_eq!(hybrid.tau_eta, None);
    }
}

#[test]
fn a_wrench_on_a_tool_does_its_work_on_joints_and_modes() {
    // Power of the wrench = power of the generalised forces it amounts to, for every coordinate alone.
    let robot = tree("rigid", 0.0, false);
    let at = state(&robot, 2);
    let mut evaluator = Evaluator::new(robot.clone(), Options::default()).unwrap();
    let load = r#"{"q": Q, "eta": E, "qd": [0, 0, 0], "qdd": [0, 0, 0], "etadd": Z, "wrenches": [W]}"#;
    let modes = robot.flexible.modes();
    let eta = &at.q[3..];
    let line = |wrench: &str| {
        let text = load.replace('Q', &format!("{:?}", &at.q[..3])).replace('E', &format!("{eta:?}"));
        text.replace('Z', &format!("{:?}", vec![0.0; modes])).replace('W', wrench)
    };
    let mut ask = |line: &str| evaluator.evaluate(&Query::parse(line).unwrap()).unwrap();
    let without = ask(&line("").replace(", \"wrenches\": []", ""));
    let wrench = r#"{"link": "hand", "force": [3, -2, 5], "point": [0.02, 0.01, 0.03], "frame": "world"}"#;
    let with = ask(&line(wrench));
    let minus = |a: Option<Vec<f64>>, b: Option<Vec<f64>>| -> Vec<f64> {
        a.unwrap().iter().zip(&b.unwrap()).map(|(a, b)| a - b).collect()
    };
    let forces = [minus(without.tau, with.tau), minus(without.tau_eta, with.tau_eta)].concat();
    // Jacobian of the point of attack, by the linear model's pose of the hand.
    use gyroflex_sim::linearize::{KeptFriction, Linearizer, Output};
    let linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let still = StateVec { q: at.q.clone(), ..StateVec::zeros(0, at.qd.len()) };
    let point = linearizer.point(still, vec![0.0; at.qd.len()]).unwrap();
    let c = linearizer.linearize(&point, &[Output::Pose("hand".to_owned())]).unwrap().c;
    let dynamics = gyroflex_sim::Dynamics::new(robot.model(robot.fidelity).unwrap());
    let mut poses = vec![gyroflex::spatial::Transform::identity(); robot.bodies.len()];
    dynamics.placements(&at.q, &mut poses).unwrap();
    let hand = robot.links.iter().position(|l| l.name == "hand").unwrap();
    let section = gyroflex_sim::bending::CrossSection::of_link(&robot, hand).unwrap();
    let link = &robot.links[hand];
    let world = link.placement.after(section.pose(eta).after(poses[link.body.unwrap()])).rotation();
    let arm = world * gyroflex::spatial::Vec3::new(0.02, 0.01, 0.03);
    let force = gyroflex::spatial::Vec3::new(3.0, -2.0, 5.0);
    let moment = arm.cross(force);
    let expected: Vec<f64> = (0..at.qd.len())
        .map(|k| {
            let lin = gyroflex::spatial::Vec3::new(c[(0, k)], c[(1, k)], c[(2, k)]);
            let ang = gyroflex::spatial::Vec3::new(c[(3, k)], c[(4, k)], c[(5, k)]);
            lin.dot(force) + ang.dot(moment)
        })
        .collect();
    assert_close("forces", &forces, &expected, 1e-10);
}

#[test]
fn keys_of_modes_are_named_where_they_do_not_fit() {
    let robot = tree("rigid", 0.0, false);
    let mut evaluator = Evaluator::new(robot, Options::default()).unwrap();
    let mut error = |line: &str| evaluator.evaluate_line(line).unwrap_err().to_string();
    let text = error(r#"{"q": [0, 0, 0], "qd": [0, 0, 0], "tau": [0, 0, 0], "eta": [0.1]}"#);
    assert!(
        text.contains("eta: 1 entries are given, but 6 are expected")
            && text.contains("upper.bending_y1, upper.bending_y2"),
        "{text}"
    );
    let text = error(r#"{"q": [0, 0, 0], "qd": [0, 0, 0], "tau": [0, 0, 0], "etadd": [0, 0, 0, 0, 0, 0]}"#);
    assert!(text.contains("forward dynamics computes them"), "{text}");
    let text = error(r#"{"q": [0, 0, 0], "qd": [0, 0, 0], "qdd": [0, 0, 0], "tau_eta": [0, 0, 0, 0, 0, 0]}"#);
    assert!(text.contains("it has no effect without `tau`"), "{text}");
    let wrench = r#"{"q": [0, 0, 0], "qd": [0, 0, 0], "tau": [0, 0, 0],
        "wrenches": [{"link": "upper", "force": [0, 0, 1], "point": [0.5, 0, 0]}]}"#;
    let text = error(wrench);
    assert!(text.contains("wrenches[0].point") && text.contains("name a link that a fixed joint holds"), "{text}");
}
