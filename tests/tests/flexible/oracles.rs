//! Whether the oracles themselves are right: against each other, where they describe the same robot.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::random::{FlexibleOptions, RandomFlexible};
use gyroflex_testkit::tolerance::{assert_close_above, norm};

/// Without modes, Lagrange's equations of points are those of the tree of rigid bodies.
#[test]
fn robots_without_modes_are_those_of_the_dense_oracle() {
    let options = FlexibleOptions { flexible: 0.0, ..FlexibleOptions::default() };
    for seed in 0..100 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &options.in_model(fidelity));
            let (s, points, dense) = (robot.state(0), robot.oracle(fidelity), Oracle::new(robot.spec(), fidelity));
            let context = format!("seed {seed}, {}", fidelity.name());
            let close = |what: &str, got: &[f64], want: &[f64], floor: f64| {
                assert_close_above(what, &context, got, want, 1e-9, floor);
            };
            let (got, want) = (points.forward(&s), dense.forward(&s));
            close("qdd", &got.qdd, &want.qdd, 0.0);
            close("thetadd", &got.thetadd, &want.thetadd, 0.0);
            close("tau_j of forward dynamics", &got.tau_j, &want.tau_j, norm(&s.tau));
            let (got, want) = (points.inverse(&s), dense.inverse(&s));
            close("tau", &got.tau, &want.tau, 0.0);
            close("tau_j", &got.tau_j, &want.tau_j, 0.0);
            let (got, want) = (points.energy(&s), dense.energy(&s));
            close("kinetic", &[got.kinetic], &[want.kinetic], 0.0);
            close("gravity", &[got.gravity], &[want.gravity], 100.0);
            close("elastic", &[got.elastic], &[want.elastic], 0.0);
            let (got, want) = (points.power(&s), dense.power(&s));
            close("powers", &[got.input, got.dissipation], &[want.input, want.dissipation], 1.0);
        }
    }
}

/// A straight robot whose modes stand still is one of rigid bodies: `M` of its joints, and their forces.
#[test]
fn a_robot_that_does_not_bend_is_rigid() {
    for seed in 0..100 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &FlexibleOptions::default().in_model(fidelity));
            let (points, dense) = (robot.oracle(fidelity), Oracle::new(robot.spec(), fidelity));
            let (nq, nv) = (points.nq(), points.nv());
            let mut s = robot.state(0);
            s.q[nq..].fill(0.0);
            s.qd[nv..].fill(0.0);
            s.qdd[nv..].fill(0.0);
            let joints: State = points.of_joints(&s);
            let context = format!("seed {seed}, {}", fidelity.name());
            let (got, want) = (points.inverse(&s), dense.inverse(&joints));
            assert_close_above("tau", &context, &got.tau[..nv], &want.tau, 1e-9, 0.0);
            assert_close_above("tau_j", &context, &got.tau_j[..nv], &want.tau_j, 1e-9, 0.0);
            let ([m, coupling], want) = (points.matrices(&s), dense.matrices(&joints));
            let block = |m: &nalgebra::DMatrix<f64>| m.view((0, 0), (nv, nv)).into_owned();
            assert_close_above("M", &context, block(&m).as_slice(), want.m.as_slice(), 1e-10, 0.0);
            assert_close_above("S", &context, block(&coupling).as_slice(), want.coupling.as_slice(), 1e-10, 1e-12);
        }
    }
}
