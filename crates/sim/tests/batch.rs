//! Batches in lanes and on all cores against one state at a time.

use gyroflex::dynamics::{Acceleration, External, Forward, Inverse, State};
use gyroflex::model::Fidelity;
use gyroflex_sim::batch::{ForwardBatch, InverseBatch, forward, inverse};
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
    for robot in ["iiwa14", "planar_3r"] {
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
            let given = ForwardBatch { q: &q, qd: &qd, theta: &theta, thetad: &thetad, tau: &tau };
            let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            forward(&model, given, out).unwrap();
            let given = InverseBatch { q: &q, qd: &qd, theta: &theta, thetad: &thetad, qdd: &a, thetadd: &a };
            inverse(&model, given, Inverse { tau_j: &mut need_j, tau: &mut need }).unwrap();
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
        let given = ForwardBatch { q, qd: &six, theta: &six, thetad: &six, tau };
        forward(&model, given, Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c }).map_err(|e| e.to_string())
    };
    run(&six, &six).unwrap();
    assert!(run(&[0.0; 7], &six).unwrap_err().contains("`q` has 7 entries"));
    assert!(run(&six, &[0.0; 4]).unwrap_err().contains("`tau` has 4 entries"));
    // One row stands for all.
    run(&six, &[0.0; 3]).unwrap();
}
