//! Rotation matrix to unit quaternion.

use gyroflex::spatial::Mat3;

/// The unit quaternion `x y z w`, `w ≥ 0`, of a rotation matrix.
///
/// Four times the square of each component is a sum of diagonal entries; the largest is at least 1, so dividing by its
/// root is well conditioned at every angle (Shepperd 1978). A matrix that has drifted from orthogonality still gives a
/// unit quaternion.
pub(super) fn quaternion(r: Mat3<f64>) -> [f64; 4] {
    let [a, b, c] = r.rows;
    let squares = [1.0 + a.x - b.y - c.z, 1.0 - a.x + b.y - c.z, 1.0 - a.x - b.y + c.z, 1.0 + a.x + b.y + c.z];
    // Row i holds 4 qᵢ (x, y, z, w).
    let rows = [
        [squares[0], a.y + b.x, c.x + a.z, c.y - b.z],
        [a.y + b.x, squares[1], b.z + c.y, a.z - c.x],
        [c.x + a.z, b.z + c.y, squares[2], b.x - a.y],
        [c.y - b.z, a.z - c.x, b.x - a.y, squares[3]],
    ];
    let largest = (0..4).fold(3, |best, i| if squares[i] > squares[best] { i } else { best });
    let q = rows[largest];
    let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let signed = if q[3] < 0.0 { -norm } else { norm };
    q.map(|x| x / signed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half turns about every axis, tiny turns, and everything between: the places where one formula alone fails.
    fn quaternions() -> impl Iterator<Item = [f64; 4]> {
        let steps = [-1.0, -0.5, -1e-9, 0.0, 1e-9, 0.3, 1.0];
        steps.into_iter().flat_map(move |x| {
            steps
                .into_iter()
                .flat_map(move |y| steps.into_iter().flat_map(move |z| steps.into_iter().map(move |w| [x, y, z, w])))
        })
    }

    #[test]
    fn quaternion_of_the_matrix_of_a_quaternion_is_that_quaternion_up_to_sign() {
        for q in quaternions() {
            let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm < 1e-3 {
                continue;
            }
            let unit = q.map(|x| x / norm);
            let back = quaternion(Mat3::from_quaternion(unit));
            let dot: f64 = unit.iter().zip(&back).map(|(a, b)| a * b).sum();
            for (a, b) in unit.iter().zip(&back) {
                assert!((a * dot.signum() - b).abs() < 4e-16, "{unit:?} came back as {back:?}");
            }
            assert!(back[3] >= 0.0);
        }
    }
}
