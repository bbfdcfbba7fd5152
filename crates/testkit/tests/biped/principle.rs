//! Single support against eq. 1 alone: d'Alembert's principle with derivatives taken by dual numbers and Taylor series.

use super::free_bodies::{Tip, motion};
use super::{Trial, assert_close, for_trials};
use gyroflex::Jet;
use gyroflex_testkit::Dual;
use gyroflex_testkit::biped::{
    Biped, Links, OverLinks, joint_rates, relative_angles, segment_angles, segment_rates, segment_torques,
};
use nalgebra::{SMatrix, Vector2};

/// `∂/∂θ` of a point.
pub fn slope(at: impl Fn(&[Dual; 5]) -> [Dual; 2], theta: &Links) -> SMatrix<f64, 2, 5> {
    let column = |k: usize| {
        let along = core::array::from_fn(|j| Dual::new(theta[j], if j == k { 1.0 } else { 0.0 }));
        Vector2::from(at(&along).map(|x| x.slope))
    };
    SMatrix::from_columns(&core::array::from_fn::<_, 5, _>(column))
}

/// Acceleration of a point on the motion of a trial.
pub fn acceleration(at: impl Fn(&[Jet<f64, 3>; 5]) -> [Jet<f64, 3>; 2], t: &Trial) -> Vector2<f64> {
    let motion = core::array::from_fn(|i| Jet::from_derivatives(&[t.theta[i], t.rate[i], t.acceleration[i]]));
    Vector2::from(at(&motion).map(|x| x.derivative(2)))
}

/// `Σ m Jᵀ (a − g) + I θ̈`, by eq. 1 alone.
fn torques(t: &Trial) -> Links {
    let b = &t.biped;
    let of_link = |i: usize| {
        let a = acceleration(|theta| b.centre_of_mass(i, theta), t) + Vector2::new(0.0, b.gravity);
        slope(|theta| b.centre_of_mass(i, theta), &t.theta).transpose() * a * b.mass[i]
    };
    Links::from_fn(|i, _| b.inertia[i] * t.acceleration[i]) + (0..5).map(of_link).sum::<Links>()
}

#[test]
fn inertia_centrifugal_and_gravity_terms_follow_from_the_places_of_the_centres_of_mass() {
    for_trials(|t| {
        let got = t.biped.inertia_matrix(&t.theta) * t.acceleration + t.biped.bias(&t.theta, &t.rate);
        assert_close(t, "torques", got.as_slice(), torques(t).as_slice(), 0.0, 1e-13);
    });
}

#[test]
fn single_support_moves_as_five_free_bodies_joined_together() {
    for_trials(|t| {
        let got = t.biped.single_support(&t.theta, &t.rate, &t.torque);
        assert_close(t, "accelerations", got.as_slice(), motion(t, Tip::Free).angular.as_slice(), 0.0, 1e-10);
    });
}

#[test]
fn gravity_is_the_slope_of_the_potential_energy() {
    for_trials(|t| {
        let b = &t.biped;
        let of_link =
            |i: usize| slope(|x| b.centre_of_mass(i, x), &t.theta).row(1).transpose() * (b.mass[i] * b.gravity);
        let want: Links = (0..5).map(of_link).sum();
        assert_close(t, "gravity", b.gravity_torques(&t.theta).as_slice(), want.as_slice(), 0.0, 1e-14);
        let of_all =
            slope(|x| b.centre_of_all(x), &t.theta).row(1).transpose() * (b.mass.iter().sum::<f64>() * b.gravity);
        assert_close(t, "gravity of all", of_all.as_slice(), want.as_slice(), 0.0, 1e-14);
    });
}

/// Energy is kept because `Ḋ − 2 H` is antisymmetric; so the printed `H` is the matrix of Christoffel's symbols.
#[test]
fn the_rate_of_the_inertia_less_twice_the_velocity_matrix_is_antisymmetric() {
    for_trials(|t| {
        let h = 1e-6;
        let [ahead, behind] = [h, -h].map(|h| t.biped.inertia_matrix(&(t.theta + t.rate * h)));
        let x: OverLinks = (ahead - behind) / (2.0 * h) - t.biped.velocity_matrix(&t.theta, &t.rate) * 2.0;
        let scale = t.biped.inertia_matrix(&t.theta).amax() * t.rate.amax();
        assert_close(t, "symmetric part", (x + x.transpose()).as_slice(), &[0.0; 25], scale, 1e-8);
    });
}

#[test]
fn relative_angles_carry_the_same_dynamics() {
    for_trials(|t| {
        let (q, qd, qdd) = (relative_angles(&t.theta), joint_rates(&t.rate), joint_rates(&t.acceleration));
        assert_close(t, "angles", segment_angles(&q).as_slice(), t.theta.as_slice(), 0.0, 1e-14);
        assert_close(t, "rates", segment_rates(&qd).as_slice(), t.rate.as_slice(), 0.0, 1e-14);
        let (power, want) = (segment_torques(&t.torque).dot(&t.rate), t.torque.dot(&qd));
        assert_close(t, "power", &[power], &[want], t.torque.norm() * qd.norm(), 1e-14);
        let form = t.biped.relative_form(&q, &qd);
        let joint = form.inertia_matrix * qdd + form.bias;
        let segment = t.biped.inertia_matrix(&t.theta) * t.acceleration + t.biped.bias(&t.theta, &t.rate);
        assert_close(t, "torques", segment_torques(&joint).as_slice(), segment.as_slice(), joint.amax(), 1e-13);
        let (closing, want) = (form.constraint_jacobian * qd, t.biped.constraint_jacobian(&t.theta) * t.rate);
        assert_close(t, "closing velocity", closing.as_slice(), want.as_slice(), 1.0, 1e-13);
    });
}

/// `K` of eq. 3, link by link.
#[test]
fn kinetic_energy_is_that_of_the_links() {
    for_trials(|t| {
        let b: &Biped = &t.biped;
        let of_link = |i: usize| {
            let v = slope(|x| b.centre_of_mass(i, x), &t.theta) * t.rate;
            0.5 * (b.mass[i] * v.norm_squared() + b.inertia[i] * t.rate[i].powi(2))
        };
        let want: f64 = (0..5).map(of_link).sum();
        assert_close(t, "kinetic energy", &[b.kinetic(&t.theta, &t.rate)], &[want], 0.0, 1e-12);
    });
}
