//! Base inertial parameters: fewer numbers, the same motion.

use super::subject::{DOUBLE, Subject, grown};
use gyroflex::Scalar;
use gyroflex::dynamics::{Acceleration, CrbaScratch, External, Inverse, RneaScratch, State, crba, rnea};
use gyroflex::model::Fidelity;
use gyroflex_codegen::graph::Graph;
use gyroflex_codegen::robot::Records;
use gyroflex_codegen::sym::{Sym, trace};
use gyroflex_testkit::random::{Options as Grown, RandomRobot};
use gyroflex_testkit::tolerance::assert_close_above;

/// `τ_J`, `τ` and `M` of a robot's records as they are, or regrouped: results by numbers, and how many operations they take.
fn traced(s: &Subject, regrouped: bool) -> (Vec<Vec<f64>>, usize) {
    let x = &s.state;
    let vectors = [&x.q, &x.qd, &x.theta, &x.thetad, &x.qdd, &x.thetadd];
    let ((results, used), graph) = trace(|| {
        let records = Records::of(&s.rigid.view());
        let records = if regrouped { records.regrouped() } else { records };
        let (model, mut first) = (records.view(), 0);
        let mut input = |x: &Vec<f64>| {
            first += x.len();
            (first - x.len()..first).map(Sym::input).collect::<Vec<Sym>>()
        };
        let [q, qd, theta, thetad, qdd, thetadd] = vectors.map(&mut input);
        let nv = model.nv();
        let [mut tau_j, mut tau] = [(); 2].map(|()| vec![Sym::zero(); nv]);
        let mut m = vec![Sym::zero(); nv * nv];
        let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        let n = model.bodies().len();
        rnea(&model, state, accel, External::none(), &mut vec![RneaScratch::new(); n], out).expect("it fits");
        crba(&model, &q, &mut vec![CrbaScratch::new(); n], &mut m).expect("it fits");
        let results = [tau_j, tau, m];
        let used: Vec<_> = results.iter().flatten().map(|x| x.id()).collect();
        (results.map(|all| all.into_iter().map(Sym::id).collect::<Vec<_>>()), used)
    });
    let inputs: Vec<f64> = vectors.into_iter().flatten().copied().collect();
    let values = graph.evaluate(&inputs, None);
    let results = results.iter().map(|all| all.iter().map(|id| values[id.index()]).collect()).collect();
    (results, operations(&graph, used))
}

fn operations(graph: &Graph, used: Vec<gyroflex_codegen::graph::Id>) -> usize {
    let reached = graph.reached_from(used);
    graph.nodes().iter().zip(reached).filter(|(node, reached)| *reached && node.is_operation()).count()
}

#[test]
fn regrouped_inertias_leave_torques_and_inertia_as_they_are() {
    for seed in 0..100 {
        let robot = RandomRobot::new(seed, &grown());
        for fidelity in Fidelity::ALL {
            let s = Subject::of(&robot, fidelity);
            let ((got, _), (want, _)) = (traced(&s, true), traced(&s, false));
            for (what, (got, want)) in ["tau_j", "tau", "m"].into_iter().zip(got.iter().zip(&want)) {
                assert_close_above(what, &s, got, want, DOUBLE, 0.0);
            }
        }
    }
}

#[test]
fn regrouped_chains_take_fewer_operations() {
    let chains = Grown { branching: 0.0, floating: 0.0, remote_mount: 0.0, bodies: 2..=9, ..grown() };
    for seed in 0..100 {
        let robot = RandomRobot::new(seed, &chains);
        for fidelity in Fidelity::ALL {
            let s = Subject::of(&robot, fidelity);
            let ((_, fewer), (_, more)) = (traced(&s, true), traced(&s, false));
            assert!(fewer < more, "{fewer} of {more} operations; {s}");
        }
    }
}
