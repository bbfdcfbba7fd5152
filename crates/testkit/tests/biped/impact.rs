//! The double impact.

use super::principle::slope;
use super::{assert_close, for_trials, free_bodies};
use core::f64::consts::TAU;
use gyroflex_testkit::biped::{Biped, relabelled, relabelled_rate};
use nalgebra::SMatrix;

#[test]
fn double_impact_is_that_of_five_free_bodies() {
    for_trials(|t| {
        let (got, want) = (t.biped.double_impact(&t.theta, &t.rate), free_bodies::impact(t));
        let size = t.biped.mass.iter().sum::<f64>();
        assert_close(t, "velocities", got.rate.as_slice(), (t.rate + want.angular).as_slice(), 1.0, 1e-10);
        assert_close(t, "impulse on the tip b", got.standing.as_slice(), want.at_b.as_slice(), size, 1e-10);
        assert_close(t, "impulse on the tip e", got.landing.as_slice(), want.at_e.as_slice(), size, 1e-10);
    });
}

/// What the far end's impulse does to the segments, `D Δθ̇ = Jᵀ P_e`, less `P_e + P_b = Σ m Δẋ`.
#[test]
fn impact_matrix_is_the_inertia_less_the_moment_of_the_whole_momentum_about_the_tips() {
    for_trials(|t| {
        let b = &t.biped;
        let momentum: SMatrix<f64, 2, 5> =
            (0..5).map(|i| slope(|x| b.centre_of_mass(i, x), &t.theta) * b.mass[i]).sum();
        let d = b.inertia_matrix(&t.theta);
        let want = d - b.constraint_jacobian(&t.theta).transpose() * momentum;
        assert_close(t, "W", b.impact_matrix(&t.theta).as_slice(), want.as_slice(), d.amax(), 1e-14);
    });
}

/// By Carnot's theorem the loss is the energy of the jump.
#[test]
fn double_impact_stops_the_tip_and_loses_the_energy_of_the_jump() {
    for_trials(|t| {
        let b = &t.biped;
        let after = b.double_impact(&t.theta, &t.rate).rate;
        let [energy, left, jump] = [t.rate, after, t.rate - after].map(|rate| b.kinetic(&t.theta, &rate));
        let moving = b.constraint_jacobian(&t.theta) * after;
        assert_close(t, "velocity of the tip", moving.as_slice(), &[0.0; 2], 1.0, 1e-10);
        assert!(left <= energy, "seed {}: {energy} J before and {left} J after", t.seed);
        assert_close(t, "loss", &[energy - left], &[jump], energy, 1e-10);
        let again = b.double_impact(&t.theta, &after);
        assert_close(t, "velocities", again.rate.as_slice(), after.as_slice(), 1.0, 1e-10);
    });
}

/// Both tips rest, so that either may be the one everything is seen from.
#[test]
fn relabelling_changes_the_names_and_not_the_motion() {
    for_trials(|t| {
        let b = Biped::MU_WU;
        let rate = b.standing_rate(&t.theta, &t.rate);
        let (theta, other_rate) = (relabelled(&t.theta), relabelled_rate(&rate));
        let (from_b, from_e) = (b.joint(5, &t.theta.into()), b.joint(5, &theta.into()));
        assert_close(t, "tip", &[-from_e[0], -from_e[1]], &from_b, 1.0, 1e-14);
        let (hip, seen) = (b.joint(2, &t.theta.into()), b.joint(2, &theta.into()));
        assert_close(t, "hip", &[from_b[0] + seen[0], from_b[1] + seen[1]], &hip, 1.0, 1e-14);
        let (all, seen) = (b.centre_of_all(&t.theta.into()), b.centre_of_all(&theta.into()));
        assert_close(t, "centre of mass", &[from_b[0] + seen[0], from_b[1] + seen[1]], &all, 1.0, 1e-13);
        let (energy, want) = (b.kinetic(&theta, &other_rate), b.kinetic(&t.theta, &rate));
        assert_close(t, "kinetic energy", &[energy], &[want], 1e-3, 1e-12);
        let turns = (relabelled(&theta) - t.theta) / TAU;
        assert!((turns - turns.map(f64::round)).amax() < 1e-14, "seed {}", t.seed);
        assert_eq!(relabelled_rate(&other_rate), rate);
    });
}
