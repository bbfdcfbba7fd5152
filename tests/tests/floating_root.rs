//! Positions of a floating root form a group: laws of `integrate`, `difference` and `position_rate`.

use gyroflex::integrate::{difference, integrate, position_rate};
use gyroflex::model::Fidelity;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, tol};
use gyroflex_tests::{Trial, for_trials};
use nalgebra::{Matrix3, Matrix4, Quaternion, UnitQuaternion, Vector3};

/// The group's operations in `f64` vectors.
struct Group<'t, 'r, T: Real>(&'t Trial<'r, T>);

impl<T: Real> Group<'_, '_, T> {
    fn integrate(&self, q: &[f64], v: &[f64]) -> Vec<f64> {
        self.write(q.len(), |out| integrate(&self.0.core.model(), &cast(q), &cast(v), out))
    }

    fn difference(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        self.write(self.0.robot.nv(), |out| difference(&self.0.core.model(), &cast(from), &cast(to), out))
    }

    fn rate(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        self.write(q.len(), |out| position_rate(&self.0.core.model(), &cast(q), &cast(qd), out))
    }

    fn write<E: core::fmt::Debug>(&self, len: usize, run: impl FnOnce(&mut [T]) -> Result<(), E>) -> Vec<f64> {
        let mut out = vec![T::from_f64(f64::NAN); len];
        run(&mut out).expect("slices fit the model");
        out.into_iter().map(Real::to_f64).collect()
    }
}

fn cast<T: Real>(x: &[f64]) -> Vec<T> {
    x.iter().map(|x| T::from_f64(*x)).collect()
}

fn scaled(s: f64, v: &[f64]) -> Vec<f64> {
    v.iter().map(|x| s * x).collect()
}

/// With the quaternion whose `w` is not negative: both signs are the same place.
fn canonical(q: &[f64]) -> Vec<f64> {
    let sign = if q[6] < 0.0 { -1.0 } else { 1.0 };
    q.iter().enumerate().map(|(i, x)| if (3..7).contains(&i) { sign * x } else { *x }).collect()
}

/// The pose of the root as a matrix.
fn pose(q: &[f64]) -> Matrix4<f64> {
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[6], q[3], q[4], q[5]));
    let mut m = turn.to_homogeneous();
    m.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::new(q[0], q[1], q[2]));
    m
}

/// The exponential of a body twist, angular first, by nalgebra's matrix exponential.
fn exponential(v: &[f64]) -> Matrix4<f64> {
    let mut m = Matrix4::zeros();
    let spin: Matrix3<f64> = Vector3::new(v[0], v[1], v[2]).cross_matrix();
    m.fixed_view_mut::<3, 3>(0, 0).copy_from(&spin);
    m.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::new(v[3], v[4], v[5]));
    m.exp()
}

fn group_laws<T: Real>(t: &Trial<'_, T>) {
    let g = Group(t);
    let (q, v) = (&t.state.q, &t.state.qd);
    let there = g.integrate(q, v);

    // The exponential of the twist, applied on the right.
    let want = pose(q) * exponential(v);
    t.assert_close("q exp(v)", pose(&there).as_slice(), want.as_slice(), 1.0);
    // And a unit quaternion.
    let length = there[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
    t.assert_close("|q exp(v)|", &[length], &[1.0], 0.0);

    // Nothing moves nothing; what moves there moves back; two halves are a whole.
    let still = g.integrate(q, &scaled(0.0, v));
    t.assert_close("q exp(0)", &canonical(&still), &canonical(q), 1.0);
    let back = g.integrate(&there, &scaled(-1.0, v));
    t.assert_close("q exp(v) exp(-v)", &canonical(&back), &canonical(q), 1.0);
    let half = scaled(0.5, v);
    let twice = g.integrate(&g.integrate(q, &half), &half);
    t.assert_close("q exp(v/2)²", &canonical(&twice), &canonical(&there), 1.0);

    // Difference inverts integration, up to full turns, and integration inverts difference.
    if v[..3].iter().map(|x| x * x).sum::<f64>().sqrt() < 3.0 {
        t.assert_close("q exp(v) - q", &g.difference(q, &there), v, 1.0);
    }
    let other = &t.robot.state(1).q;
    let other = &canonical(other);
    let met = g.integrate(q, &g.difference(q, other));
    t.assert_close("q + (p - q)", &canonical(&met), other, 1.0);
    let nowhere = g.difference(q, q);
    t.assert_close("q - q", &nowhere, &scaled(0.0, v), 1.0);
}

fn floating() -> Options {
    Options { floating: 1.0, bodies: 1..=6, ..Options::default() }
}

#[test]
fn integrate_and_difference_respect_the_group() {
    for_trials::<f64>(1000, &floating(), &[Fidelity::Complete], tol(1e-12, 0.0), group_laws);
    for_trials::<f32>(1000, &floating(), &[Fidelity::Complete], tol(0.0, 2e-5), group_laws);
}

/// From twists that barely turn to those that turn by almost half a turn: no loss of digits on the way.
#[test]
fn small_and_large_turns_are_as_exact_as_others() {
    for_trials::<f64>(100, &floating(), &[Fidelity::Complete], tol(1e-12, 0.0), |t| {
        let g = Group(t);
        for angle in [0.0, 1e-9, 1e-6, 1e-4, 0.99e-2, 1.01e-2, 0.1, 1.0, 3.0, 3.13] {
            let mut v = t.state.qd.clone();
            let length = v[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
            v[..3].iter_mut().for_each(|x| *x *= angle / length);
            let there = g.integrate(&t.state.q, &v);
            let want = pose(&t.state.q) * exponential(&v);
            t.assert_close(&format!("turn by {angle}"), pose(&there).as_slice(), want.as_slice(), 1.0);
            // Near half a turn the direction of the shift hangs on the last digits of the angle.
            t.assert_close(&format!("turn by {angle}, back"), &g.difference(&t.state.q, &there), &v, 10.0);
        }
    });
}

/// The rate of the coordinates is the derivative of integration at zero time.
#[test]
fn position_rate_is_the_derivative_of_integration() {
    for_trials::<f64>(300, &floating(), &[Fidelity::Complete], tol(1e-9, 0.0), |t| {
        let g = Group(t);
        let (q, v, h) = (&t.state.q, &t.state.qd, 1e-3);
        let at = |k: f64| g.integrate(q, &scaled(k * h, v));
        let (a, b, c, d) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
        let quotient: Vec<f64> = (0..q.len()).map(|i| (8.0 * (c[i] - b[i]) - (d[i] - a[i])) / (12.0 * h)).collect();
        t.assert_close("dq/dt", &g.rate(q, v), &quotient, 1.0);
    });
}
