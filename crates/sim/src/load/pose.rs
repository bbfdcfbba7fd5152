//! Poses as files write them.

use gyroflex::Scalar;
use gyroflex::spatial::{Mat3, Transform, Vec3};
use std::f64::consts::FRAC_PI_2;

/// An angle this close to a multiple of 90° is one, but for its rounding to 64 bits [rad]. `1.57079632679` is 5e-12 away and
/// stays what it is: in an arm whose last links weigh grams, accelerations would show the difference.
const RIGHT_ANGLE: f64 = 1e-14;

/// The pose of a frame given by its origin and roll, pitch, yaw about fixed axes: `Rz(yaw) Ry(pitch) Rx(roll)`.
pub(crate) fn pose(xyz: [f64; 3], rpy: [f64; 3]) -> Transform<f64> {
    Transform::from_pose(rotation(rpy), xyz.into())
}

/// `Rz(yaw) Ry(pitch) Rx(roll)`, with exact zeros and ones at right angles: the residue 6e-17 of `cos(π/2)` would cost
/// every algorithm multiplications, and symmetric robots their symmetry.
pub(crate) fn rotation([roll, pitch, yaw]: [f64; 3]) -> Mat3<f64> {
    let (o, i) = (0.0, 1.0);
    let turn = |axis: usize, angle: f64| {
        let (s, c) = sin_cos(angle);
        match axis {
            0 => Mat3::from_rows(Vec3::new(i, o, o), Vec3::new(o, c, -s), Vec3::new(o, s, c)),
            1 => Mat3::from_rows(Vec3::new(c, o, s), Vec3::new(o, i, o), Vec3::new(-s, o, c)),
            _ => Mat3::from_rows(Vec3::new(c, -s, o), Vec3::new(s, c, o), Vec3::new(o, o, i)),
        }
    };
    let product = turn(2, yaw) * turn(1, pitch) * turn(0, roll);
    // Negative zeros of the products become zeros, which read better.
    product.map(|x| x + 0.0)
}

fn sin_cos(angle: f64) -> (f64, f64) {
    let quarters = (angle / FRAC_PI_2).round();
    if (angle - quarters * FRAC_PI_2).abs() > RIGHT_ANGLE {
        return Scalar::sin_cos(angle);
    }
    match quarters.rem_euclid(4.0) as u8 {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// The direction of a vector; `None` if it has none.
pub(crate) fn direction(v: [f64; 3]) -> Option<Vec3<f64>> {
    // Scaled first, so that tiny and huge vectors neither vanish nor overflow.
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return None;
    }
    let [x, y, z] = v.map(|c| c / largest);
    let norm = (x * x + y * y + z * z).sqrt();
    Some(Vec3::new(x / norm, y / norm, z / norm))
}
