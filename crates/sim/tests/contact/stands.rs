//! A body that stands on more points than it needs.

use crate::machines::{G, MASS, assert_near, inertial, run, try_load};
use gyroflex_sim::Robot;

const CORNERS: [[f64; 2]; 4] = [[0.2, 0.1], [0.2, -0.1], [-0.2, 0.1], [-0.2, -0.1]];

pub fn table(legs: usize) -> Robot {
    let urdf = format!("<robot name=\"machine\"><link name=\"top\">{}</link></robot>", inertial(MASS, 0.05, 0.3, 0.02));
    let feet: Vec<String> = CORNERS[..legs]
        .iter()
        .enumerate()
        .map(|(i, [x, y])| format!("  foot{i}: {{link: top, point: [{x}, {y}, 0]}}\n"))
        .collect();
    try_load(&urdf, &format!("floating: true\ncontacts:\n{}", feet.concat())).unwrap_or_else(|e| panic!("{e}"))
}

fn standing(legs: usize) -> crate::machines::Run {
    run(&table(legs), "duration: 0.3\nground: {friction: 0.8}\nintegrator: {method: rk4, step: 1e-3}\nlog: {rate: 100}")
}

#[test]
fn standing_body_is_carried_by_its_feet_together() {
    for legs in [3, 4] {
        let run = standing(legs);
        assert!(run.summary.events.is_empty(), "{:?}", run.summary.events);
        for sample in &run.samples {
            let footing = sample.footing.as_ref().expect("it stands");
            let sum = |k: usize| footing.contacts.iter().map(|c| c.force[k]).sum::<f64>();
            assert_near("weight", sum(2), MASS * G, 1e-6);
            assert_near("along x", sum(0), 0.0, 1e-6);
            assert_near("along y", sum(1), 0.0, 1e-6);
            // At rest the point without moments is below the centre of mass.
            for k in 0..2 {
                assert_near("zero-moment point", footing.zero_moment_point[k], footing.center_of_mass[k], 1e-7);
            }
            assert_near("centre of mass", footing.center_of_mass[0], 0.05, 1e-9);
            assert!(footing.contacts.iter().all(|c| c.force[2] > -1e-9), "{:?}", footing.contacts);
        }
    }
}

#[test]
fn redundant_feet_are_reported() {
    let warnings = standing(4).summary.warnings;
    assert!(warnings.iter().any(|w| w.contains("directions depend on others")), "{warnings:?}");
}
