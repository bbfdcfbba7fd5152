//! Constrained forward dynamics.

use super::for_held;
use gyroflex::dynamics::Hold;
use gyroflex::integrate::integrate;
use gyroflex::model::Fidelity;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{Held, HeldMotion, Trial, small};
use nalgebra::Vector3;

/// `J q̈ + J̇ q̇`, from velocities a moment before and after.
fn acceleration_of(t: &Trial<'_, f64>, held: &Held, qdd: &[f64]) -> Vec<f64> {
    let velocity_at = |h: f64| {
        let step: Vec<f64> = t.state.qd.iter().zip(qdd).map(|(v, a)| h * v + 0.5 * h * h * a).collect();
        let qd: Vec<f64> = t.state.qd.iter().zip(qdd).map(|(v, a)| v + h * a).collect();
        let mut q = t.state.q.clone();
        integrate(&t.core.model(), &t.state.q, &step, &mut q).expect("slices fit the model");
        let [_, velocity, _] = t.core.constraint_motion(&q, &qd, held);
        velocity
    };
    let h = 1e-5;
    velocity_at(h).iter().zip(velocity_at(-h)).map(|(after, before)| (after - before) / (2.0 * h)).collect()
}

/// Rows whose multiplier follows a normal force because the contact slips.
fn slipping(held: &Held) -> Vec<bool> {
    let mut out = Vec::new();
    for c in &held.constraints {
        for direction in 0..6 {
            let Hold::Frame { directions, .. } = c.hold else {
                out.extend((direction == 0).then_some(false));
                continue;
            };
            if directions.contains(direction) {
                let slips = c.contact.is_some_and(|c| c.slip.is_some() && direction > 2 && direction != c.normal);
                out.push(slips);
            }
        }
    }
    out
}

#[test]
fn multipliers_keep_the_constraints() {
    for_held::<f64>(400, &Options::default(), &Fidelity::ALL, tol(1e-4, 0.0), |t, held| {
        let found = t.core.constrained(&t.state, held);
        let got = acceleration_of(t, held, &found.links);
        let [error, velocity, _] = t.core.constraint_motion(&t.state.q, &t.state.qd, held);
        let mut rows = 0;
        let mut want = got.clone();
        for c in &held.constraints {
            for _ in 0..c.rows() {
                let w = c.stabilisation;
                want[rows] = -2.0 * w * velocity[rows] - w * w * error[rows];
                rows += 1;
            }
        }
        // What slips may accelerate.
        for (row, _) in slipping(held).iter().enumerate().filter(|(_, slips)| **slips) {
            want[row] = got[row];
        }
        t.assert_close("acceleration of the constraints", &got, &want, norm(&found.links).max(100.0));
    });
}

fn plus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// `Jᵀ λ`.
fn generalised_force(t: &Trial<'_, impl Real>, held: &Held, multipliers: &[f64]) -> Vec<f64> {
    let [_, _, jacobian] = t.core.constraint_motion(&t.state.q, &t.state.qd, held);
    let nv = t.robot.nv();
    (0..nv).map(|k| multipliers.iter().enumerate().map(|(r, l)| l * jacobian[r * nv + k]).sum()).collect()
}

fn assert_motion<T: Real>(t: &Trial<'_, T>, got: &HeldMotion, qdd: &[f64], thetadd: &[f64], tau_j: &[f64]) {
    let forces = norm(&got.multipliers);
    t.assert_close("qdd", &got.links, qdd, 0.0);
    t.assert_close("thetadd", &got.motors, thetadd, 0.0);
    t.assert_close("tau_j", &got.tau_j, tau_j, norm(&t.state.tau).max(forces));
}

fn as_under_own_forces<T: Real>(t: &Trial<'_, T>, held: &Held) {
    let found = t.core.constrained(&t.state, held);
    let mut loaded = t.state.clone();
    loaded.tau_ext = plus(&loaded.tau_ext, &generalised_force(t, held, &found.multipliers));
    let want = t.oracle().forward(&loaded);
    assert_motion(t, &found, &want.qdd, &want.thetadd, &want.tau_j);
}

#[test]
fn constrained_robot_moves_as_the_2n_body_tree_under_the_constraints_forces() {
    for_held::<f64>(400, &Options::default(), &Fidelity::ALL, tol(1e-8, 0.0), as_under_own_forces);
}

#[test]
fn single_precision_moves_likewise() {
    for_held::<f32>(200, &small(), &Fidelity::ALL, tol(0.0, 2e-2), as_under_own_forces);
}

#[test]
fn wrenches_are_the_multipliers_in_world_axes() {
    for_held::<f64>(200, &Options::default(), &[Fidelity::Complete], tol(1e-8, 0.0), |t, held| {
        let found = t.core.constrained(&t.state, held);
        let links = t.oracle().links(&t.state);
        // As loads on links, in place of generalised forces; coupled joints have no wrench.
        let mut loaded = t.state.clone();
        let couplings: Vec<bool> = held.constraints.iter().map(|c| matches!(c.hold, Hold::Joints { .. })).collect();
        let mut row = 0;
        let mut multipliers = vec![0.0; held.rows()];
        for (c, coupled) in held.constraints.iter().zip(&couplings) {
            for _ in 0..c.rows() {
                multipliers[row] = if *coupled { found.multipliers[row] } else { 0.0 };
                row += 1;
            }
        }
        loaded.tau_ext = plus(&loaded.tau_ext, &generalised_force(t, held, &multipliers));
        for (c, wrench) in held.constraints.iter().zip(&found.wrenches) {
            let Hold::Frame { frame, anchor, .. } = c.hold else { continue };
            let r = frame.placement.pos;
            let link = &links[frame.body];
            let point = link.position + link.rotation * Vector3::new(r.x, r.y, r.z);
            let (couple, force) = (Vector3::from_row_slice(&wrench[..3]), Vector3::from_row_slice(&wrench[3..]));
            for (body, sign) in [(Some(frame.body), 1.0), (anchor.body, -1.0)] {
                let Some(body) = body else { continue };
                let link = &links[body];
                let about = couple + (point - link.position).cross(&force);
                let (couple, force) = (link.rotation.tr_mul(&about) * sign, link.rotation.tr_mul(&force) * sign);
                for k in 0..3 {
                    loaded.wrenches[body][k] += couple[k];
                    loaded.wrenches[body][k + 3] += force[k];
                }
            }
        }
        let want = t.oracle().forward(&loaded);
        assert_motion(t, &found, &want.qdd, &want.thetadd, &want.tau_j);
    });
}

#[test]
fn slipping_contacts_are_pushed_along_their_normal_force() {
    let slips = core::cell::Cell::new(0);
    for_held::<f64>(200, &Options::default(), &[Fidelity::Complete], tol(1e-12, 0.0), |t, held| {
        let found = t.core.constrained(&t.state, held);
        let mut first = 0;
        for c in &held.constraints {
            if let (Hold::Frame { directions, .. }, Some(contact)) = (c.hold, c.contact)
                && let Some(ratio) = contact.slip
            {
                let row = |d: usize| first + (0..d).filter(|k| directions.contains(*k)).count();
                let normal = found.multipliers[row(contact.normal)];
                for d in (3..6).filter(|d| *d != contact.normal && directions.contains(*d)) {
                    let want = ratio.to_array()[d - 3] * normal;
                    t.assert_close("friction", &[found.multipliers[row(d)]], &[want], 0.0);
                    slips.set(slips.get() + 1);
                }
            }
            first += c.rows();
        }
    });
    assert!(slips.get() > 10, "only {} slipping directions", slips.get());
}

#[test]
fn scratch_may_hold_anything() {
    for_held::<f64>(100, &Options::default(), &Fidelity::ALL, tol(0.0, 0.0), |t, held| {
        let clean = t.core.constrained(&t.state, held);
        let dirty = t.core.clone().with_dirty_scratch().constrained(&t.state, held);
        t.assert_close("qdd", &dirty.links, &clean.links, 0.0);
        t.assert_close("multipliers", &dirty.multipliers, &clean.multipliers, 0.0);
    });
}

#[test]
fn velocity_of_a_constraint_is_its_jacobian_times_the_velocities() {
    for_held::<f64>(200, &Options::default(), &[Fidelity::Complete], tol(1e-12, 0.0), |t, held| {
        let [_, velocity, jacobian] = t.core.constraint_motion(&t.state.q, &t.state.qd, held);
        let nv = t.robot.nv();
        let product: Vec<f64> =
            jacobian.chunks_exact(nv).map(|row| row.iter().zip(&t.state.qd).map(|(j, v)| j * v).sum()).collect();
        t.assert_close("velocity", &velocity, &product, 1.0);
    });
}

/// Of translations everywhere; of rotations the error is one to first order, and other tests have it near zero.
#[test]
fn jacobian_of_translations_is_the_derivative_of_the_error() {
    for_held::<f64>(200, &Options::default(), &[Fidelity::Complete], tol(1e-7, 0.0), |t, held| {
        let [_, _, jacobian] = t.core.constraint_motion(&t.state.q, &t.state.qd, held);
        let nv = t.robot.nv();
        let translations = translations(held);
        let h = 1e-6;
        for k in 0..nv {
            let error_at = |h: f64| {
                let mut step = vec![0.0; nv];
                step[k] = h;
                let mut q = t.state.q.clone();
                integrate(&t.core.model(), &t.state.q, &step, &mut q).expect("slices fit the model");
                t.core.constraint_motion(&q, &t.state.qd, held)[0].clone()
            };
            let (after, before) = (error_at(h), error_at(-h));
            let rows = || (0..held.rows()).filter(|r| translations[*r]);
            let got: Vec<f64> = rows().map(|r| (after[r] - before[r]) / (2.0 * h)).collect();
            let want: Vec<f64> = rows().map(|r| jacobian[r * nv + k]).collect();
            t.assert_close("column of the Jacobian", &got, &want, 1.0);
        }
    });
}

fn translations(held: &Held) -> Vec<bool> {
    let mut out = Vec::new();
    for c in &held.constraints {
        match c.hold {
            Hold::Frame { directions, .. } => out.extend((0..6).filter(|d| directions.contains(*d)).map(|d| d > 2)),
            Hold::Joints { .. } => out.push(true),
        }
    }
    out
}
