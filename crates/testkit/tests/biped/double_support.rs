//! Double support: derivatives of the constraint and of hip and trunk, and the constrained motion.

use super::free_bodies::{Tip, motion};
use super::principle::{acceleration, slope};
use super::{Trial, assert_close, for_trials};
use nalgebra::Vector2;

/// A trial whose tip `e` rests.
fn standing(t: &Trial) -> Trial {
    Trial { rate: t.biped.standing_rate(&t.theta, &t.rate), ..*t }
}

#[test]
fn constraint_and_hip_have_the_printed_derivatives() {
    for_trials(|t| {
        let (b, theta) = (&t.biped, &t.theta);
        let (j, out) = (b.constraint_jacobian(theta), b.outputs(theta, &t.rate));
        assert_close(t, "J", j.as_slice(), slope(|x| b.joint(5, x), theta).as_slice(), 0.0, 1e-14);
        let want = slope(|x| b.joint(2, x), theta);
        assert_close(t, "R", out.jacobian.fixed_rows::<2>(0).clone_owned().as_slice(), want.as_slice(), 0.0, 1e-14);
        assert_eq!(out.jacobian.row(2).transpose().as_slice(), [0.0, 0.0, 1.0, 0.0, 0.0]);
        assert_eq!((out.value[2], out.jacobian_rate.row(2).amax()), (theta[2], 0.0));
        let tip = j * t.acceleration + b.constraint_jacobian_rate(theta, &t.rate) * t.rate;
        let hip = out.jacobian * t.acceleration + out.jacobian_rate * t.rate;
        let floor = t.rate.norm_squared();
        assert_close(t, "tip", tip.as_slice(), acceleration(|x| b.joint(5, x), t).as_slice(), floor, 1e-14);
        let want = acceleration(|x| b.joint(2, x), t);
        assert_close(t, "hip", &[hip[0], hip[1], hip[2]], &[want[0], want[1], t.acceleration[2]], floor, 1e-14);
        let [x, y]: [f64; 2] = b.joint(5, &(*theta).into());
        assert_eq!(b.constraint(theta, 0.7), Vector2::new(x - 0.7, y));
    });
}

#[test]
fn double_support_moves_as_five_free_bodies_joined_together() {
    for_trials(|t| {
        let t = standing(t);
        let (got, want) = (t.biped.double_support(&t.theta, &t.rate, &t.torque), motion(&t, Tip::Standing));
        assert_close(&t, "accelerations", got.acceleration.as_slice(), want.angular.as_slice(), 1.0, 1e-10);
        assert_close(&t, "force on the tip e", got.force.as_slice(), want.at_e.as_slice(), 1.0, 1e-10);
        let gained = (0..5).map(|i| {
            let moving = Trial { acceleration: got.acceleration, ..t };
            acceleration(|x| t.biped.centre_of_mass(i, x), &moving) * t.biped.mass[i]
        });
        let weight = Vector2::new(0.0, t.biped.gravity * t.biped.mass.iter().sum::<f64>());
        let held = gained.sum::<Vector2<f64>>() + weight - got.force;
        assert_close(&t, "force on the tip b", held.as_slice(), want.at_b.as_slice(), weight[1], 1e-10);
    });
}

#[test]
fn reduced_form_moves_hip_and_trunk_as_the_constrained_biped_does() {
    for_trials(|t| {
        let t = standing(t);
        let out = t.biped.outputs(&t.theta, &t.rate);
        let form = t.biped.reduced_form(&t.theta, &t.rate);
        let got = form.rate_matrix * (out.jacobian * t.rate)
            + form.torque_matrix * (t.torque - t.biped.bias(&t.theta, &t.rate));
        let want = out.jacobian * t.biped.double_support(&t.theta, &t.rate, &t.torque).acceleration
            + out.jacobian_rate * t.rate;
        assert_close(&t, "accelerations of the outputs", got.as_slice(), want.as_slice(), 1.0, 1e-9);
    });
}
