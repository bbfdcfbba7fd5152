//! Laws of the walks of Mu & Wu (2004).

mod study;

use study::{Study, walk};

/// Eight steps instead of twenty, which show the same.
fn short(text: String) -> String {
    text.replace("duration: 15.0", "duration: 6.0")
}

fn keeps_its_gait(study: &Study, friction: f64) {
    assert!(study.landings().count() >= 8, "only {} landings", study.landings().count());
    assert!((study.speed() - 1.0).abs() < 5e-3, "{} m/s", study.speed());
    assert!(study.foot_placing() < 2e-3, "footprints are off by {} m", study.foot_placing());
    assert!(study.drift < 1e-8, "feet drift by {} m", study.drift);
    for both in [false, true] {
        let figures = study.figures(both);
        assert!(figures.errors.iter().all(|e| *e < 2e-3), "{figures:?}");
        assert!(figures.vertical.iter().all(|f| *f > 0.0), "a foot pulls: {figures:?}");
        assert!(figures.friction.iter().all(|f| *f <= friction * 1.0001), "{figures:?}");
    }
}

#[test]
fn the_paper_s_biped_walks_with_a_model_that_is_wrong_and_needs_no_more_friction_than_it_says() {
    keeps_its_gait(&walk("biped5/walk.yaml", short).expect("it walks"), 0.25);
}

#[test]
fn the_elastic_biped_walks_too_on_a_rougher_floor() {
    keeps_its_gait(&walk("biped5_elastic/walk.yaml", short).expect("it walks"), 0.8);
}

#[test]
fn halving_the_step_changes_no_landing() {
    let coarse = walk("biped5/walk.yaml", short).expect("it walks");
    let fine = walk("biped5/walk.yaml", |text| short(text).replace("step: 5.0e-4", "step: 2.5e-4")).expect("it walks");
    assert_eq!(coarse.landings().count(), fine.landings().count());
    for (a, b) in coarse.touch_downs().zip(fine.touch_downs()) {
        assert!((a - b).abs() < 1e-7, "a landing moves from {a} s to {b} s");
    }
}
