//! Batches in lanes and on all cores against one state at a time.

use gyroflex::dynamics::{Acceleration, External, Forward, Inverse, State};
use gyroflex::integrate::StateMut;
use gyroflex::model::Fidelity;
use gyroflex_sim::batch::{Algorithm, Given, Rollout, Scheme, Trajectories, evaluate, rollout};
use gyroflex_sim::dynamics::Dynamics;
use gyroflex_sim::load::{LoadOptions, load};
use std::path::Path;

fn numbers(seed: u64, count: usize) -> Vec<f64> {
    // Weyl's sequence: equally spread, and different for every seed.
    let step = 0.618_033_988_749_894_9;
    (0..count).map(|i| 2.0 * (((seed * 7919 + i as u64) as f64 * step).fract() - 0.5)).collect()
}

fn assert_close(what: &str, got: &[f64], want: &[f64]) {
    let scale = want.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let error = got.iter().zip(want).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(error <= 1e-13 * scale, "{what} is off by {error:e} of {scale:e}");
}

#[test]
fn every_row_of_a_batch_equals_the_state_alone() {
    for robot in ["iiwa14", "planar_3r", "book_two_link"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(robot).join("robot.yaml");
        let robot = load(&path, &LoadOptions::default()).unwrap();
        for fidelity in Fidelity::ALL {
            let model = robot.model(fidelity).unwrap();
            let mut alone = Dynamics::new(model.clone());
            let nv = alone.nv();
            // Not a multiple of the lanes, and more than one task.
            let rows = 301;
            let [q, qd, tau, a] = [1, 2, 3, 4].map(|seed| numbers(seed, rows * nv));
            let (theta, thetad) = (q.clone(), qd.iter().map(|x| 0.9 * x).collect::<Vec<_>>());
            let [mut qdd, mut thetadd, mut tau_j, mut need_j, mut need] = [0; 5].map(|_| vec![f64::NAN; rows * nv]);
            let given = Given { q: &q, qd: &qd, theta: &theta, thetad: &thetad, ..Given::default() };
            let out = &mut [&mut qdd[..], &mut thetadd, &mut tau_j];
            evaluate(&model, &Algorithm::ForwardDynamics, rows, Given { tau: &tau, ..given }, out).unwrap();
            let out = &mut [&mut need_j[..], &mut need];
            evaluate(&model, &Algorithm::InverseDynamics, rows, Given { qdd: &a, thetadd: &a, ..given }, out).unwrap();
            for row in (0..rows).map(|r| r * nv..(r + 1) * nv) {
                let of = |all: &[f64]| all[row.clone()].to_vec();
                let [mut x, mut y, mut z] = [0; 3].map(|_| vec![f64::NAN; nv]);
                let (q, qd, theta, thetad, tau, a) = (of(&q), of(&qd), of(&theta), of(&thetad), of(&tau), of(&a));
                let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
                let out = Forward { qdd: &mut x, thetadd: &mut y, tau_j: &mut z };
                alone.forward(state, &tau, External::none(), out).unwrap();
                assert_close("qdd", &qdd[row.clone()], &x);
                assert_close("thetadd", &thetadd[row.clone()], &y);
                assert_close("tau_j", &tau_j[row.clone()], &z);
                let out = Inverse { tau_j: &mut x, tau: &mut y };
                alone.inverse(state, Acceleration { qdd: &a, thetadd: &a }, External::none(), out).unwrap();
                assert_close("tau_j of inverse dynamics", &need_j[row.clone()], &x);
                assert_close("tau", &need[row.clone()], &y);
            }
        }
    }
}

#[test]
fn arrays_of_different_lengths_are_refused() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/planar_3r/robot.yaml");
    let model = load(&path, &LoadOptions::default()).unwrap().model(Fidelity::Complete).unwrap();
    let six = [0.0; 6];
    let [mut a, mut b, mut c] = [[0.0; 6], [0.0; 6], [0.0; 6]];
    let mut run = |q: &[f64], tau: &[f64]| {
        let given = Given { q, qd: &six, theta: &six, thetad: &six, tau, ..Given::default() };
        let out = &mut [&mut a[..], &mut b, &mut c];
        evaluate(&model, &Algorithm::ForwardDynamics, 2, given, out).map_err(|e| e.to_string())
    };
    run(&six, &six).unwrap();
    assert!(run(&[0.0; 7], &six).unwrap_err().contains("`q` has 7 entries"));
    assert!(run(&six, &[0.0; 4]).unwrap_err().contains("`tau` has 4 entries"));
    // One row stands for all.
    run(&six, &[0.0; 3]).unwrap();
}

#[test]
fn a_rollout_is_so_many_motions_alone() {
    for name in ["planar_3r", "book_two_link"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name).join("robot.yaml");
        let model = load(&path, &LoadOptions::default()).unwrap().model(Fidelity::Complete).unwrap();
        let mut alone = Dynamics::new(model.clone());
        let (nv, rows, steps, step) = (alone.nv(), 11, 7, 1e-5);
        let [q, qd, tau] = [1, 2, 3].map(|seed| numbers(seed, rows * nv).iter().map(|x| 0.01 * x).collect::<Vec<_>>());
        let torques: Vec<f64> = numbers(4, rows * steps * nv);
        for (scheme, tau, tau_steps) in
            [(Scheme::Rk4, &torques, steps), (Scheme::SemiImplicitEuler, &torques, steps), (Scheme::Rk4, &tau, 1)]
        {
            let [mut all_q, mut all_qd, mut all_theta, mut all_thetad] =
                [0; 4].map(|_| vec![0.0; rows * (steps + 1) * nv]);
            let given = Rollout { q: &q, qd: &qd, theta: &q, thetad: &qd, tau, tau_steps, step, steps, scheme };
            let out = Trajectories { q: &mut all_q, qd: &mut all_qd, theta: &mut all_theta, thetad: &mut all_thetad };
            rollout(&model, rows, given, out).unwrap();
            for row in 0..rows {
                let of = |all: &[f64]| all[row * nv..][..nv].to_vec();
                let (mut q, mut qd, mut theta, mut thetad) = (of(&q), of(&qd), of(&q), of(&qd));
                for k in 0..=steps {
                    let at = (row * (steps + 1) + k) * nv..(row * (steps + 1) + k + 1) * nv;
                    assert_close("q", &all_q[at.clone()], &q);
                    assert_close("qd", &all_qd[at.clone()], &qd);
                    assert_close("theta", &all_theta[at.clone()], &theta);
                    assert_close("thetad", &all_thetad[at], &thetad);
                    let tau = &tau[(row * tau_steps + k.min(tau_steps - 1)) * nv..][..nv];
                    let state = StateMut { q: &mut q, qd: &mut qd, theta: &mut theta, thetad: &mut thetad };
                    match scheme {
                        Scheme::Rk4 => alone.rk4(state, tau, External::none(), step),
                        Scheme::SemiImplicitEuler => alone.semi_implicit_euler(state, tau, External::none(), step),
                    }
                    .unwrap();
                }
            }
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    for name in ["planar_3r", "book_two_link"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name).join("robot.yaml");
        let model = load(&path, &LoadOptions::default()).unwrap().model(Fidelity::Complete).unwrap();
        let (nv, rows) = (model.nv(), 301);
        let [q, mut qd, mut tau] = [1, 2, 3].map(|seed| numbers(seed, rows * nv));
        let [mut qdd, mut thetadd] = [0; 2].map(|_| vec![0.0; rows * nv]);
        let mut run = |qd: &[f64], tau: &[f64]| {
            let given = Given { q: &q, qd, theta: &q, thetad: qd, tau, ..Given::default() };
            let out = &mut [&mut qdd[..], &mut thetadd];
            evaluate(&model, &Algorithm::ForwardDynamics, rows, given, out).map_err(|e| e.to_string())
        };
        run(&qd, &tau).unwrap();
        tau[150 * nv + 1] = f64::NAN;
        assert!(run(&qd, &tau).unwrap_err().contains("tau: entry 1 of row 150 is NaN"));
        assert!(
            run(&qd, &[0.0, f64::INFINITY, 0.0, 0.0, 0.0, 0.0][..nv]).unwrap_err().contains("entry 1 of row 0 is inf")
        );
        // Finite numbers whose result is none.
        (tau[150 * nv + 1], qd[150 * nv + 1]) = (0.0, 1e200);
        assert!(run(&qd, &tau).unwrap_err().contains("dd[150]` is not finite"));
    }
}
