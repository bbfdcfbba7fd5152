//! What flexible links become when they do not bend.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::{FlexibleOptions, RandomFlexible};
use gyroflex_testkit::tolerance::{norm, relative_error, tol};
use gyroflex_tests::{Core, FlexibleTrial, for_flexible};

/// Flexible links without a mode, whose stations do not move, and none at all.
#[test]
fn rigid_when_there_are_no_modes() {
    for flexible in [0.0, 0.5] {
        let options = FlexibleOptions { flexible, modes: 0..=0, ..FlexibleOptions::default() };
        for_flexible::<f64>(200, &options, &Fidelity::ALL, tol(1e-10, 0.0), |t| {
            let rigid = Core::<f64>::new(&t.robot.spec(), t.fidelity);
            let (got, want) = (t.core.forward(&t.state), rigid.aba(&t.state));
            t.assert_close("qdd", &got.qdd, &want.qdd, 0.0);
            t.assert_close("thetadd", &got.thetadd, &want.thetadd, 0.0);
            t.assert_close("tau_j", &got.tau_j, &want.tau_j, norm(&t.state.tau));
            let want = rigid.inverse(&t.state);
            for got in [t.core.inverse(&t.state), t.core.hybrid(&t.state).0] {
                t.assert_close("tau of the inverse", &got.tau, &want.tau, norm(&want.tau_j));
                t.assert_close("tau_j of the inverse", &got.tau_j, &want.tau_j, 0.0);
            }
            let [m, s] = t.core.matrices(&t.state);
            t.assert_close("M", &m, &rigid.mass_matrix(&t.state), 0.0);
            t.assert_close("S", &s, &rigid.coupling(&t.state), 1e-3);
            let (got, want) = (t.core.energy(&t.state), rigid.energy(&t.state));
            t.assert_close("kinetic energy", &[got.kinetic], &[want.kinetic], 0.0);
            t.assert_close("elastic energy", &[got.elastic], &[want.elastic], 0.0);
        });
    }
}

/// Ten times as stiff, a robot whose links bend as far as the rigid one's motion asks of them differs a tenth as much from the rigid one.
#[test]
fn rigid_as_stiffness_grows() {
    let mut tried = 0;
    for seed in 0..60 {
        for fidelity in Fidelity::ALL {
            let robot = RandomFlexible::new(seed, &FlexibleOptions::default().in_model(fidelity));
            let rigid = Core::<f64>::new(&robot.spec(), fidelity);
            let (nq, nv) = (robot.robot.nq(), robot.robot.nv());
            let mut s = robot.state(0);
            for x in [&mut s.qd, &mut s.tau, &mut s.tau_ext] {
                x[nv..].fill(0.0);
            }
            let joints: State = robot.oracle(fidelity).of_joints(&s);
            let moved = rigid.aba(&joints);
            let want = moved.qdd;
            let error = |stiffer: f64| {
                let mut stiff = robot.clone();
                stiff.links.iter_mut().for_each(|link| link.stiffness *= stiffer);
                let t = FlexibleTrial::<f64>::new(&stiff, fidelity, s.clone(), tol(0.0, 0.0));
                // Forces on the straight, still modes.
                let mut there = s.clone();
                there.q[nq..].fill(0.0);
                there.qdd[..nv].copy_from_slice(&want);
                there.qdd[nv..].fill(0.0);
                there.thetadd[..nv].copy_from_slice(&moved.thetadd);
                let mut first = 0;
                let forces = t.core.inverse(&there).tau;
                for link in &stiff.links {
                    let n = link.modes();
                    let force = nalgebra::DVector::from_column_slice(&forces[nv + first..nv + first + n]);
                    let bent = -link.stiffness.clone().cholesky().expect("positive").solve(&force);
                    there.q[nq + first..nq + first + n].copy_from_slice(bent.as_slice());
                    first += n;
                }
                relative_error(&t.core.forward(&there).qdd[..nv], &want, 1.0)
            };
            let (stiff, stiffer) = (error(1e4), error(1e5));
            if stiff < 1e-7 {
                // The rigid motion asks nothing of the modes.
                continue;
            }
            tried += 1;
            let ratio = stiff / stiffer;
            assert!((9.0..11.0).contains(&ratio), "{stiff:e}, then {stiffer:e}: seed {seed}, {}", fidelity.name());
        }
    }
    assert!(tried > 200, "only {tried} robots bent");
}
