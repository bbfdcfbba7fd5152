//! Constrained inverse dynamics.

use super::for_sticking;
use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{norm, tol};
use gyroflex_tests::{Held, Trial};
use nalgebra::{DMatrix, DVector};

/// Of rigid robots: what an elastic transmission exerts, its state says.
const RIGID: [Fidelity; 2] = [Fidelity::Rigid, Fidelity::RigidReflected];

/// A motion that the constraints allow and that has some cause.
fn allowed(t: &Trial<'_, f64>, held: &Held) -> State {
    let found = t.core.constrained(&t.state, held);
    State { qdd: found.links, thetadd: found.motors, ..t.state.clone() }
}

fn weights(nv: usize) -> Vec<f64> {
    (0..nv).map(|k| 1.0 + 0.3 * k as f64).collect()
}

/// As many velocities as the multipliers can take care of, the first ones: those of a floating root.
fn passive(t: &Trial<'_, f64>, held: &Held) -> Vec<usize> {
    (0..t.robot.nv().min(held.rows()).min(6) / 2).collect()
}

#[test]
fn forward_dynamics_under_the_torques_is_the_motion() {
    for_sticking::<f64>(200, &Options::default(), &RIGID, tol(1e-7, 0.0), |t, held| {
        let s = allowed(t, held);
        let [_, tau, multipliers] = t.core.constrained_inverse(&s, held, &weights(t.robot.nv()), &[], 1e-6);
        let again = t.core.constrained(&State { tau, ..s.clone() }, held);
        t.assert_close("qdd", &again.links, &s.qdd, 0.0);
        t.assert_close("multipliers", &again.multipliers, &multipliers, norm(&s.tau));
    });
}

#[test]
fn elastic_motors_drive_the_same_motion_as_the_2n_body_tree() {
    for_sticking::<f64>(
        200,
        &Options::default(),
        &[Fidelity::Complete, Fidelity::Reduced],
        tol(1e-9, 0.0),
        |t, held| {
            let s = allowed(t, held);
            let [tau_j, tau, multipliers] = t.core.constrained_inverse(&s, held, &weights(t.robot.nv()), &[], 1e-6);
            let [_, _, jacobian] = t.core.constraint_motion(&s.q, &s.qd, held);
            let nv = t.robot.nv();
            let mut loaded = s.clone();
            for (r, l) in multipliers.iter().enumerate() {
                (0..nv).for_each(|k| loaded.tau_ext[k] += l * jacobian[r * nv + k]);
            }
            let want = t.oracle().inverse(&loaded);
            let size = norm(&want.tau_j).max(norm(&loaded.tau_ext));
            t.assert_close("tau_j", &tau_j, &want.tau_j, size);
            t.assert_close("tau", &tau, &want.tau, size);
        },
    );
}

/// The cost's derivative vanishes along every change of the multipliers that leaves the passive velocities alone.
#[test]
fn no_other_distribution_costs_less() {
    let some = core::cell::Cell::new(0);
    for_sticking::<f64>(200, &Options::default(), &RIGID, tol(1e-7, 0.0), |t, held| {
        let (s, nv, cost) = (allowed(t, held), t.robot.nv(), 1e-2);
        let (weights, passive) = (weights(nv), passive(t, held));
        let [tau_j, _, multipliers] = t.core.constrained_inverse(&s, held, &weights, &passive, cost);
        let [_, _, jacobian] = t.core.constraint_motion(&s.q, &s.qd, held);
        let j = DMatrix::from_row_slice(held.rows(), nv, &jacobian);
        let j_p = DMatrix::from_fn(held.rows(), passive.len(), |r, p| j[(r, passive[p])]);
        // Without a way to bear the passive joints' load there is nothing to distribute.
        let bears = |j: &DMatrix<f64>| j.clone().svd(false, false).singular_values.iter().all(|s| *s > 1e-2);
        if !passive.is_empty() && !bears(&j_p) {
            return;
        }
        some.set(some.get() + 1);
        let torques = DVector::from_fn(nv, |k, _| if passive.contains(&k) { 0.0 } else { weights[k] * tau_j[k] });
        let gradient = -&j * torques + DVector::from_column_slice(&multipliers) * cost;
        // Its part across the columns of J_p
        let rest = match passive.len() {
            0 => gradient.clone(),
            _ => {
                let normal = j_p.tr_mul(&j_p).cholesky().expect("independent columns");
                &gradient - &j_p * normal.solve(&j_p.tr_mul(&gradient))
            }
        };
        let size = norm(gradient.as_slice()).max(norm(&tau_j) * j.amax());
        t.assert_close("gradient", rest.as_slice(), &vec![0.0; held.rows()], size);
        let left: Vec<f64> = passive.iter().map(|k| tau_j[*k]).collect();
        t.assert_close("what nothing bears", &left, &vec![0.0; left.len()], norm(&tau_j).max(norm(&multipliers)));
    });
    assert!(some.get() > 50, "only {} robots were balanced", some.get());
}

/// Errors that the constraints allow are answered by the gains as if nothing were held; all others the constraints take up.
#[test]
fn computed_torque_lets_allowed_errors_decay_as_without_constraints() {
    let options = Options { floating: 0.0, friction: 0.0, ..Options::default() };
    for_sticking::<f64>(200, &options, &RIGID, tol(1e-6, 0.0), |t, held| {
        let s = State { tau_ext: Vec::new(), wrenches: Vec::new(), ..t.state.clone() };
        let found = t.core.constrained(&s, held);
        let [_, _, jacobian] = t.core.constraint_motion(&s.q, &s.qd, held);
        let (nv, kp, kd) = (t.robot.nv(), 30.0, 7.0);
        // A deviation across all constraints
        let j = DMatrix::from_row_slice(held.rows(), nv, &jacobian);
        let any = DVector::from_fn(nv, |k, _| ((3 * k + 1) as f64).sin());
        let normal = (&j * j.transpose()).cholesky().expect("independent constraints");
        let e = &any - j.transpose() * normal.solve(&(&j * &any));
        let desired: Vec<f64> = s.q.iter().zip(e.iter()).map(|(q, e)| q + e).collect();
        let rates: Vec<f64> = s.qd.iter().zip(e.iter()).map(|(qd, e)| qd - 0.5 * e).collect();
        let tau = t.core.computed_torque_while_held(&s, held, [kp, kd], [&desired, &rates], &found.links);
        let got = t.core.constrained(&State { tau, ..s.clone() }, held).links;
        let want: Vec<f64> = found.links.iter().zip(e.iter()).map(|(a, e)| a + (kp - 0.5 * kd) * e).collect();
        t.assert_close("accelerations", &got, &want, 0.0);
    });
}
