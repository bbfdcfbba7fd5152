//! The station frame: how what is fixed to a cross-section moves with it.
//!
//! The cross-section at `s` is displaced by `u = Σ φ_j η_j` (and by its shortening) and turned by `θ = Σ ψ_j η_j`. The rotation
//! is Cayley's, `R = 1 + κ (θ× + ½ θ× θ×)` with `κ = 4/(4 + θ²)`: a true rotation for any `θ`, without a branch, which
//! agrees with Cetinkunt & Book's `1 + θ×` (eq. 8) to first order and with a turn by the angle `θ` to second.

use super::scratch::FlexibleStation;
use crate::Scalar;
use crate::dynamics::aba_base::{centripetal, velocity_force};
use crate::model::{FlexibleLink, FlexibleModel};
use crate::spatial::{Mat3, Motion, SpatialInertia, Transform, Vec3};

/// Places station `k` of a link, counted from its first, and says how it moves beside the link, `omega` being the link's angular
/// velocity: transform, `ω`, `c`, the force that its lumps need, and the motion per unit of every mode in `columns`.
pub(super) fn move_station<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    link: &FlexibleLink<T::Param>,
    k: usize,
    omega: Vec3<T>,
    (eta, etad): (&[T], &[T]),
    s: &mut FlexibleStation<T>,
    columns: &mut [Motion<T>],
) {
    let (eta, etad) = (&eta[link.mode_range()], &etad[link.mode_range()]);
    let (shapes, shortenings) = (&model.shapes[link.shape_range(k)], &model.shortenings[link.shortening_range(k)]);
    let station = &model.stations[link.station_range()][k];
    let half = T::from_f64(0.5);

    // u = Σ (φ_j + ½ Σ_k s_jk η_k) η_j,   φ̂_j = φ_j + Σ_k s_jk η_k,   ü − Σ φ̂_j η̈_j = Σ s_jk η̇_j η̇_k
    let (mut u, mut rate, mut sagging) = (Vec3::zero(), Vec3::zero(), Vec3::zero());
    let (mut theta, mut theta_rate) = (Vec3::zero(), Vec3::zero());
    for (j, (shape, column)) in shapes.iter().zip(columns.iter_mut()).enumerate() {
        let (phi, psi) = (shape.displacement.map(T::from_param), shape.rotation.map(T::from_param));
        let mut shortening = Vec3::zero();
        for (k, s) in shortenings.iter().skip(j * shapes.len()).take(shapes.len()).enumerate() {
            let s = s.map(T::from_param);
            shortening = shortening.plus_scaled(eta[k], s);
            sagging = sagging.plus_scaled(etad[j] * etad[k], s);
        }
        let slope = phi + shortening;
        u = u.plus_scaled(eta[j], phi).plus_scaled(eta[j] * half, shortening);
        rate = rate.plus_scaled(etad[j], slope);
        theta = theta.plus_scaled(eta[j], psi);
        theta_rate = theta_rate.plus_scaled(etad[j], psi);
        *column = Motion { ang: psi, lin: slope };
    }

    // E = Rᵀ;   γ_j = κ (ψ_j − ½ θ × ψ_j) in the station's axes
    let four = T::from_f64(4.0);
    let kappa = four / (four + theta.dot(theta));
    let turn = Mat3::skew(theta);
    let e = Mat3::identity() + (turn.scale(half) * turn - turn).scale(kappa);
    let gamma = |psi: Vec3<T>| (psi - theta.cross(psi).scale(half)).scale(kappa);
    let position = station.position.map(T::from_param);
    for column in columns.iter_mut() {
        let ang = gamma(column.ang);
        *column = Motion { ang, lin: position.cross_plus(ang, e * column.lin) };
    }
    let spin = gamma(theta_rate);

    // The frame's origin, which at rest is the link's: s + u − R s
    let at = position + u;
    s.x = Transform { rot: e, pos: at - e.transpose_mul(position) };
    let carried = e * omega;
    s.omega = carried + spin;

    // γ̇ = −½ κ (θ·θ̇) γ + …,   α: E ω × γ + γ̇;   a: E (ω × (ω × (s + u)) + 2 ω × u̇ + ü), from there to the origin by −s
    let slowing = -(kappa * half * theta.dot(theta_rate));
    let ang = carried.cross(spin).plus_scaled(slowing, spin);
    let point = centripetal(omega, at) + omega.cross(rate).scale(T::from_f64(2.0)) + sagging;
    let lin = e * point + position.cross(ang) - centripetal(s.omega, position);
    s.c = Motion { ang, lin };

    let lumps: SpatialInertia<T> = station.inertia.map(T::from_param);
    s.p = velocity_force(lumps, s.omega);
    s.ia = lumps.into();
}
