//! Finite motions: unit quaternions and the screws of SE(3), without a branch on values.

use super::Vec3;
use crate::Scalar;

/// Hamilton product of quaternions `(x, y, z, w)`.
pub(crate) fn product<T: Scalar>([ax, ay, az, aw]: [T; 4], [bx, by, bz, bw]: [T; 4]) -> [T; 4] {
    let (a, b) = (Vec3::new(ax, ay, az), Vec3::new(bx, by, bz));
    let v = a.cross(b) + b.scale(aw) + a.scale(bw);
    [v.x, v.y, v.z, aw * bw - a.dot(b)]
}

/// The quaternion scaled to unit length.
pub(crate) fn unit<T: Scalar>(q: [T; 4]) -> [T; 4] {
    let [x, y, z, w] = q;
    let scale = T::one() / (x * x + y * y + z * z + w * w).sqrt();
    q.map(|c| c * scale)
}

/// Below this square of an angle, series of its functions are exact to rounding and divisions by it are not.
const SMALL: f64 = 1e-4;

/// The quaternion and the translation of unit time of the twist `(omega, lin)`: the exponential of SE(3).
pub(crate) fn screw<T: Scalar>(omega: Vec3<T>, lin: Vec3<T>) -> ([T; 4], Vec3<T>) {
    let f = T::from_f64;
    let x2 = omega.dot(omega);
    let small = |series: T, exact: T| x2.select_less(f(SMALL), series, exact);
    let x = x2.select_less(f(SMALL), f(1.0), x2).sqrt();
    let (s, (sh, ch)) = (x.sin_cos().0, (x * f(0.5)).sin_cos());
    // sin(x/2)/x and cos(x/2);  (1 − cos x)/x² = 2 (sin(x/2)/x)² and (x − sin x)/x³.
    let half_sinc = small(f(0.5) - x2 * (f(1.0 / 48.0) - x2 * f(1.0 / 3840.0)), sh / x);
    let half_cos = small(f(1.0) - x2 * (f(0.125) - x2 * f(1.0 / 384.0)), ch);
    let a = small(f(0.5) - x2 * (f(1.0 / 24.0) - x2 * f(1.0 / 720.0)), f(2.0) * (sh / x) * (sh / x));
    let b = small(f(1.0 / 6.0) - x2 * (f(1.0 / 120.0) - x2 * f(1.0 / 5040.0)), (x - s) / (x * x * x));
    let turn = omega.scale(half_sinc);
    // V = 1 + a ω× + b ω×ω×
    let wl = omega.cross(lin);
    let shift = lin + wl.scale(a) + omega.cross(wl).scale(b);
    ([turn.x, turn.y, turn.z, half_cos], shift)
}

/// The linear part of the twist whose screw of unit time shifts by `shift` while turning by `omega`: `V⁻¹ shift`.
pub(crate) fn screw_shift_inverse<T: Scalar>(omega: Vec3<T>, shift: Vec3<T>) -> Vec3<T> {
    let f = T::from_f64;
    let x2 = omega.dot(omega);
    let x = x2.select_less(f(SMALL), f(1.0), x2).sqrt();
    let (sh, ch) = (x * f(0.5)).sin_cos();
    // V⁻¹ = 1 − ½ ω× + (1 − (x/2) cot(x/2))/x² ω×ω×
    let exact = (f(1.0) - f(0.5) * x * ch / sh) / (x * x);
    let c = x2.select_less(f(SMALL), f(1.0 / 12.0) + x2 * (f(1.0 / 720.0) + x2 * f(1.0 / 30240.0)), exact);
    let ws = omega.cross(shift);
    shift - ws.scale(f(0.5)) + omega.cross(ws).scale(c)
}

/// The rotation vector of a unit quaternion, shorter than half a turn.
pub(crate) fn rotation_vector<T: Scalar>([x, y, z, w]: [T; 4]) -> Vec3<T> {
    let f = T::from_f64;
    // q and −q are the same rotation; take the one with w ≥ 0.
    let sign = w.select_less(T::zero(), f(-1.0), f(1.0));
    let (v, w) = (Vec3::new(x, y, z).scale(sign), w * sign);
    let s2 = v.dot(v);
    let s = s2.select_less(f(SMALL), f(1.0), s2).sqrt();
    let exact = f(2.0) * s.atan2(w) / s;
    // 2 atan(s/w)/s = (2/w) (1 − r²/3 + r⁴/5 − r⁶/7), r = s/w.
    let r2 = s2 / (w * w);
    let series = f(2.0) / w * (f(1.0) - r2 * (f(1.0 / 3.0) - r2 * (f(0.2) - r2 * f(1.0 / 7.0))));
    v.scale(s2.select_less(f(SMALL), series, exact))
}
