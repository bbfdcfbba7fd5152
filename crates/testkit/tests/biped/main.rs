//! The closed forms of the five-link biped against mechanics written down in other ways: eq. 1 and d'Alembert's principle,
//! and five free bodies with the forces between them.

mod double_support;
mod free_bodies;
mod impact;
mod principle;

use gyroflex_testkit::Biped;
use gyroflex_testkit::biped::Links;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// One biped at one state; knees are bent by at least a tenth of a radian, because straight legs are singular in double support.
pub struct Trial {
    /// What it was drawn from.
    pub seed: u64,
    /// The parameters.
    pub biped: Biped,
    /// `θ` [rad].
    pub theta: Links,
    /// `θ̇` [rad/s].
    pub rate: Links,
    /// `θ̈`, where it is given [rad/s²].
    pub acceleration: Links,
    /// `T_θ`: on the segments [N m].
    pub torque: Links,
}

/// Shows a law the biped of the paper, and others whose ten lengths, masses and inertias have nothing in common.
pub fn for_trials(law: impl Fn(&Trial)) {
    for seed in 0..1000 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut within = |lo: f64, hi: f64| rng.random_range(lo..hi);
        let biped = if seed % 2 == 0 { Biped::MU_WU } else { any_biped(&mut within) };
        let theta = loop {
            let theta = Links::from_fn(|_, _| within(-3.0, 3.0));
            if (theta[0] - theta[1]).sin().abs() > 0.1 && (theta[3] - theta[4]).sin().abs() > 0.1 {
                break theta;
            }
        };
        let mut all = |size: f64| Links::from_fn(|_, _| within(-size, size));
        let (rate, acceleration, torque) = (all(3.0), all(10.0), all(50.0));
        law(&Trial { seed, biped, theta, rate, acceleration, torque });
    }
}

fn any_biped(within: &mut impl FnMut(f64, f64) -> f64) -> Biped {
    let mut five = |lo: f64, hi: f64| core::array::from_fn(|_| within(lo, hi));
    Biped {
        mass: five(1.0, 15.0),
        inertia: five(0.02, 0.5),
        length: five(0.2, 0.6),
        centre: five(0.05, 0.4),
        ..Biped::MU_WU
    }
}

/// Asserts equality relative to the larger of the wanted numbers and `floor`.
#[track_caller]
pub fn assert_close(t: &Trial, what: &str, got: &[f64], want: &[f64], floor: f64, tolerance: f64) {
    let context = format!("seed {}", t.seed);
    gyroflex_testkit::tolerance::assert_close_above(what, &context, got, want, tolerance, floor);
}
