//! Laws of what Thümmel, Otter & Bals found, for `robots/lwr`.

mod arm;
mod following;
mod positioning;
mod square;
mod torques;

use arm::N;
use following::{Conditions, LAWS, Run, follow};
use square::Square;
use torques::{CUTOFFS, Size, Torques, orders};

const NOMINAL: Conditions = Conditions { springs: 1.0, rate: 1e3 };

fn all(motion: &following::Motion, conditions: Conditions) -> Vec<Run> {
    let run = |law| follow(law, motion, conditions).expect("the motion is smooth enough");
    (0..LAWS.len()).map(run).collect()
}

#[test]
fn table_1_comes_out() {
    assert_eq!(orders("robot.yaml").expect("it is there"), [6, 3]);
    assert_eq!(orders("undamped.yaml").expect("it is there"), [10, 4]);
}

/// Figure 6: "roughly one percent of the overall torque and much smaller than the errors of a rigid model".
#[test]
fn the_reduced_model_errs_by_a_percent_and_the_rigid_one_by_more() {
    for load in ["robot.yaml", "loaded.yaml"] {
        for cutoff in CUTOFFS {
            let torques = Torques::along_step(load, cutoff).expect("it can be inverted");
            let peak = |model: usize, joints: std::ops::Range<usize>| torques.error(model, joints).peak;
            for joint in 0..N {
                let share = peak(1, joint..joint + 1) / torques.torque(joint..joint + 1).peak;
                assert!((2e-3..2e-2).contains(&share), "{load}, {cutoff} Hz, joint {}: {share}", joint + 1);
            }
            let [reduced, rigid] = [1, 2].map(|model| torques.error(model, 0..N));
            assert!(reduced.peak < 0.2 * rigid.peak && reduced.rms < 0.2 * rigid.rms, "{reduced:?} {rigid:?}");
            for joint in 0..4 {
                let (reduced, rigid) = (peak(1, joint..joint + 1), peak(2, joint..joint + 1));
                assert!(reduced < 0.7 * rigid, "{load}, {cutoff} Hz, joint {}: {reduced} {rigid}", joint + 1);
            }
        }
    }
}

/// What the paper does not say: a joint that moves little but its own rotor feels the other rotors more than its spring.
#[test]
fn the_last_joint_is_served_better_by_the_rigid_model_with_rotors() {
    let torques = Torques::along_step("loaded.yaml", CUTOFFS[0]).expect("it can be inverted");
    let [reduced, rigid, reflected] = [1, 2, 3].map(|model| torques.error(model, N - 1..N).peak);
    assert!(rigid < 0.2 * reduced && reflected > 0.5 * reduced, "{reduced} {rigid} {reflected}");
}

#[test]
fn the_inverse_leaves_less_vibration_behind() {
    let motion = positioning::motion().expect("it is there");
    for (springs, factor) in [(1.0, 40.0), (0.8, 8.0)] {
        let runs = all(&motion, Conditions { springs, ..NOMINAL });
        let peak = |run: &Run| Size::of(positioning::residual(run).into_iter().map(|r| r.1)).peak;
        let pd = peak(&runs[0]);
        assert!(pd > 5e-4, "PD alone leaves only {pd} m");
        assert!(positioning::settling(&positioning::residual(&runs[0]), 1e-4) > 0.2);
        for run in &runs[1..] {
            assert!(factor * peak(run) < pd, "springs × {springs}: {} of {pd} m", peak(run));
            assert!(run.effort < 1.0 && run.haste < 1.0, "beyond the drives: {} {}", run.effort, run.haste);
        }
    }
}

#[test]
fn the_inverse_keeps_the_tip_on_the_square() {
    let square = Square::new().expect("it can be reached");
    let off = |places: &[gyroflex::spatial::Vec3<f64>]| Size::of(places.iter().map(|p| square.distance(*p)));
    let runs = all(&square.motion, NOMINAL);
    let pd = off(&runs[0].tip);
    assert!(off(&runs[0].wanted).peak < 1e-8, "the reference leaves the path");
    let furthest = runs[0].wanted.iter().map(|p| (*p - square.centre).norm()).fold(0.0, f64::max);
    assert!((furthest - square::HALF * 2f64.sqrt()).abs() < 1e-6, "it does not pass the corners");
    for run in &runs[1..] {
        let inverse = off(&run.tip);
        assert!(100.0 * inverse.rms < pd.rms && 100.0 * inverse.peak < pd.peak, "{inverse:?} {pd:?}");
        assert!(run.effort < 1.0 && run.haste < 1.0, "beyond the drives: {} {}", run.effort, run.haste);
    }
    // What a controller of 10 kHz leaves is what the reduced model leaves out.
    let runs = all(&square.motion, Conditions { rate: 1e4, ..NOMINAL });
    let [reduced, complete] = [1, 2].map(|law| off(&runs[law].tip).rms);
    assert!(2.0 * complete < reduced, "{complete} {reduced}");
}
