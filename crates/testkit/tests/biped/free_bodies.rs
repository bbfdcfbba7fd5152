//! Five free bodies in the plane and the forces between them: Newton and Euler for each link (eq. 20 for impulses), and that
//! the links hold together. Nothing is eliminated, so no formula of the paper but these is used.

use super::Trial;
use gyroflex_testkit::biped::{Biped, Links, Planar};
use nalgebra::{DMatrix, DVector};

/// What the tip `e` does.
#[derive(Clone, Copy, PartialEq)]
pub enum Tip {
    Free,
    Standing,
}

/// Rates of change of the links' velocities, or jumps of them, and the forces or impulses of the ground.
pub struct Answer {
    pub angular: Links,
    pub at_b: Planar,
    pub at_e: Planar,
}

/// From the centre of mass of link `i` to its joint and to what it carries.
fn ends(biped: &Biped, i: usize, theta: &Links) -> [Planar; 2] {
    let along = Planar::new(theta[i].sin(), theta[i].cos());
    [along * -biped.centre[i], along * (biped.carries[i] * biped.length[i] - biped.centre[i])]
}

/// Velocity of a point per clockwise turn, which is as well the clockwise moment per force on it.
fn arm(r: &Planar) -> Planar {
    Planar::new(r[1], -r[0])
}

/// The twelve relative velocities that vanish, over the fifteen velocities: joint `k` on link `k` less the same point on the link
/// before, the ground being the one before the first; at last the tip `e`.
fn joints(biped: &Biped, theta: &Links) -> DMatrix<f64> {
    let mut c = DMatrix::zeros(12, 15);
    let mut add = |row: usize, link: usize, r: &Planar, sign: f64| {
        for axis in 0..2 {
            c[(2 * row + axis, 3 * link + axis)] += sign;
            c[(2 * row + axis, 3 * link + 2)] += sign * arm(r)[axis];
        }
    };
    for link in 0..5 {
        let [near, far] = ends(biped, link, theta);
        add(link, link, &near, 1.0);
        add(link + 1, link, &far, if link == 4 { 1.0 } else { -1.0 });
    }
    c
}

/// Solves `mass · a = load + Cᵀ f`, `C a = drift` for fifteen accelerations and twelve forces, `f_k` acting on link `k` and
/// backwards on the one before.
fn solve(biped: &Biped, theta: &Links, tip: Tip, load: &DVector<f64>, drift: &DVector<f64>) -> Answer {
    let c = joints(biped, theta);
    let mut matrix = DMatrix::zeros(27, 27);
    for link in 0..5 {
        for (row, m) in [biped.mass[link], biped.mass[link], biped.inertia[link]].into_iter().enumerate() {
            matrix[(3 * link + row, 3 * link + row)] = m;
        }
    }
    matrix.view_mut((0, 15), (15, 12)).copy_from(&-c.transpose());
    matrix.view_mut((15, 0), (12, 15)).copy_from(&c);
    let mut right = DVector::zeros(27);
    right.rows_mut(0, 15).copy_from(load);
    right.rows_mut(15, 12).copy_from(drift);
    if tip == Tip::Free {
        // No force there instead of no motion.
        for row in 25..27 {
            matrix.row_mut(row).fill(0.0);
            matrix[(row, row)] = 1.0;
            right[row] = 0.0;
        }
    }
    let x = matrix.full_piv_lu().solve(&right).expect("a pose that is not singular");
    Answer {
        angular: Links::from_fn(|link, _| x[3 * link + 2]),
        at_b: Planar::new(x[15], x[16]),
        at_e: Planar::new(x[25], x[26]),
    }
}

/// Accelerations of the links and the forces of the ground under gravity and torques on the segments.
pub fn motion(t: &Trial, tip: Tip) -> Answer {
    let b = &t.biped;
    let load = DVector::from_fn(15, |i, _| match i % 3 {
        0 => 0.0,
        1 => -b.mass[i / 3] * b.gravity,
        _ => t.torque[i / 3],
    });
    // A point of a turning link is drawn to its centre, `−θ̇² r`; what this leaves between two links the accelerations make up for.
    let mut drift = DVector::zeros(12);
    for link in 0..5 {
        let [near, far] = ends(b, link, &t.theta).map(|r| r * t.rate[link].powi(2));
        for axis in 0..2 {
            drift[2 * link + axis] += near[axis];
            drift[2 * link + 2 + axis] += if link == 4 { far[axis] } else { -far[axis] };
        }
    }
    solve(b, &t.theta, tip, &load, &drift)
}

/// Jumps of the angular velocities and the impulses of the ground when the tip `e` comes to rest, `b` having been at rest.
pub fn impact(t: &Trial) -> Answer {
    let mut before = DVector::zeros(15);
    for link in 0..5 {
        let joint: Planar = (0..link)
            .map(|j| {
                let [near, far] = ends(&t.biped, j, &t.theta);
                arm(&(far - near)) * t.rate[j]
            })
            .sum();
        let [near, _] = ends(&t.biped, link, &t.theta);
        let centre = joint - arm(&near) * t.rate[link];
        before.rows_mut(3 * link, 3).copy_from_slice(&[centre[0], centre[1], t.rate[link]]);
    }
    let closing = -(joints(&t.biped, &t.theta) * before);
    solve(&t.biped, &t.theta, Tip::Standing, &DVector::zeros(15), &closing)
}
