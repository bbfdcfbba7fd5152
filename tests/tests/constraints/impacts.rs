//! Impacts.

use super::{for_held, for_sticking};
use gyroflex::dynamics::Hold;
use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{Held, Trial, small};
use nalgebra::DVector;

fn plastic(held: &Held) -> Held {
    let mut held = held.clone();
    for contact in held.constraints.iter_mut().filter_map(|c| c.contact.as_mut()) {
        contact.restitution = 0.0;
    }
    held
}

/// `1 + e` of every row.
fn rebounds(held: &Held) -> Vec<f64> {
    let mut out = Vec::new();
    for c in &held.constraints {
        let Hold::Frame { directions, .. } = c.hold else {
            out.push(1.0);
            continue;
        };
        for direction in (0..6).filter(|d| directions.contains(*d)) {
            out.push(c.contact.filter(|c| c.normal == direction).map_or(1.0, |c| 1.0 + c.restitution));
        }
    }
    out
}

fn momentum_changes_by_the_impulses<T: Real>(t: &Trial<'_, T>, held: &Held) {
    let after = t.core.impact(&t.state, held);
    let nv = t.robot.nv();
    let change =
        |after: &[f64], before: &[f64]| DVector::from_iterator(nv, after.iter().zip(before).map(|(a, b)| a - b));
    let matrices = t.oracle().matrices(&t.state);
    let elastic: Vec<bool> = t.core.model().bodies().iter().flat_map(|b| vec![b.is_elastic(); b.joint.nv()]).collect();
    let (dq, mut dtheta) = (change(&after.links, &t.state.qd), change(&after.motors, &t.state.thetad));
    for (k, _) in elastic.iter().enumerate().filter(|(_, elastic)| !**elastic) {
        dtheta[k] = 0.0;
        t.assert_close("motor behind a rigid gear", &[after.motors[k]], &[after.links[k]], 1.0);
    }
    let [_, _, jacobian] = t.core.constraint_motion(&t.state.q, &t.state.qd, held);
    let impulse: Vec<f64> =
        (0..nv).map(|k| after.multipliers.iter().enumerate().map(|(r, p)| p * jacobian[r * nv + k]).sum()).collect();
    // M Δq̇ + S Δθ̇ = Jᵀ p,   Sᵀ Δq̇ + B Δθ̇ = 0
    let links = &matrices.m * &dq + &matrices.coupling * &dtheta;
    let motors = matrices.coupling.tr_mul(&dq) + &matrices.motor * &dtheta;
    t.assert_close("momentum of the links", links.as_slice(), &impulse, 0.0);
    t.assert_close("momentum of the rotors", motors.as_slice(), &vec![0.0; nv], norm(&impulse));
}

#[test]
fn momentum_of_the_2n_body_tree_changes_by_the_impulses() {
    for_held::<f64>(400, &Options::default(), &Fidelity::ALL, tol(1e-8, 0.0), momentum_changes_by_the_impulses);
}

#[test]
fn single_precision_has_the_same_momentum() {
    for_held::<f32>(200, &small(), &Fidelity::ALL, tol(0.0, 2e-2), momentum_changes_by_the_impulses);
}

#[test]
fn what_is_caught_moves_no_more_or_rebounds_as_it_should() {
    for_sticking::<f64>(400, &Options::default(), &Fidelity::ALL, tol(1e-8, 0.0), |t, held| {
        let after = t.core.impact(&t.state, held);
        let [_, before, _] = t.core.constraint_motion(&t.state.q, &t.state.qd, held);
        let [_, velocity, _] = t.core.constraint_motion(&t.state.q, &after.links, held);
        let want: Vec<f64> = before.iter().zip(rebounds(held)).map(|(v, r)| v * (1.0 - r)).collect();
        t.assert_close("velocity of the constraints", &velocity, &want, norm(&before).max(norm(&after.links)));
    });
}

fn kinetic<T: Real>(t: &Trial<'_, T>, qd: &[f64], thetad: &[f64]) -> f64 {
    let state = State { qd: qd.to_vec(), thetad: thetad.to_vec(), ..t.state.clone() };
    t.core.energy(&state).kinetic
}

#[test]
fn kinetic_energy_never_grows_in_a_plastic_impact() {
    for_sticking::<f64>(400, &Options::default(), &Fidelity::ALL, tol(0.0, 0.0), |t, held| {
        let after = t.core.impact(&t.state, &plastic(held));
        let (before, left) = (kinetic(t, &t.state.qd, &t.state.thetad), kinetic(t, &after.links, &after.motors));
        assert!(left <= before * (1.0 + 1e-9), "{before} J grow to {left} J; {t}");
    });
}

/// Without gyroscopics a rotor does not even feel its carrier turn.
#[test]
fn elastic_rotors_keep_their_speed_in_the_reduced_model() {
    let options = Options { driven: 1.0, elastic: 1.0, remote_mount: 0.0, ..Options::default() };
    for_held::<f64>(200, &options, &[Fidelity::Reduced], tol(0.0, 0.0), |t, held| {
        let after = t.core.impact(&t.state, held);
        for k in t.core.model().bodies().iter().filter(|b| b.is_elastic()).map(|b| b.v_index()) {
            assert_eq!(after.motors[k], t.state.thetad[k], "a rotor without gyroscopics keeps its speed; {t}");
        }
    });
}

#[test]
fn contacts_that_would_pull_are_released() {
    let sum = core::cell::Cell::new(0.0);
    for_sticking::<f64>(400, &Options::default(), &[Fidelity::Complete], tol(0.0, 0.0), |t, held| {
        let mut held = plastic(held);
        held.release = true;
        let after = t.core.impact(&t.state, &held);
        sum.set(sum.get() + after.solved.released);
        let mut first = 0;
        for c in &held.constraints {
            if let (Hold::Frame { directions, .. }, Some(contact)) = (c.hold, c.contact) {
                let row = first + (0..contact.normal).filter(|k| directions.contains(*k)).count();
                let p = after.multipliers[row];
                assert!(p >= -1e-9 * norm(&after.multipliers), "contact pulls with {p} N s; {t}");
            }
            first += c.rows();
        }
    });
    assert!(sum.get() > 20.0, "only {} contacts were released", sum.get());
}
