//! Laws of robots that stand.

use crate::robots::{G, close, run, table};
use gyroflex_sim::contact::EventKind;

const THREE: [[f64; 3]; 3] = [[-0.3, -0.2, -0.4], [-0.3, 0.2, -0.4], [0.3, 0.05, -0.4]];
const FOUR: [[f64; 3]; 4] = [[-0.3, -0.2, -0.4], [-0.3, 0.2, -0.4], [0.3, -0.2, -0.4], [0.35, 0.2, -0.4]];

#[test]
fn forces_on_the_feet_carry_the_weight() {
    for (feet, name) in [(&THREE[..], "three"), (&FOUR[..], "four")] {
        let made = run(&table(feet, ""), "duration: 0.5\nground: {friction: 0.6}\ninitial: {base: {xyz: [0, 0, 0.4]}}");
        for sample in &made.samples {
            let footing = sample.footing.as_ref().unwrap();
            let sum = |k: usize| footing.contacts.iter().map(|c| c.force[k]).sum::<f64>();
            for (k, expected) in [0.0, 0.0, 12.0 * G].into_iter().enumerate() {
                close(&format!("{name} feet, axis {k}"), sum(k), expected, 1e-6);
            }
            assert!(footing.contacts.iter().all(|c| c.force[2] >= -1e-9), "{footing:?}");
            // Level and at rest: the zero-moment point is below the centre of mass.
            for k in 0..2 {
                close("zero-moment point", footing.zero_moment_point[k], footing.center_of_mass[k], 1e-9);
            }
        }
        let speed = made.last().base_twist.unwrap().into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        assert!(speed < 1e-8, "{name} feet: {speed}");
    }
}

/// A push at half the height lets it slide before it tips, whichever feet bear.
#[test]
fn table_slides_only_when_all_its_friction_is_used_up() {
    let yaml = |force: f64| format!("duration: 0.4\nground: {{friction: 0.3}}\ninitial: {{base: {{xyz: [0, 0, 0.4]}}}}\nwrenches: [{{link: table, force: [0, {force}, 0], point: [0, 0, -0.4], start: 0.1}}]");
    let most = 0.3 * 12.0 * G;
    let still = run(&table(&FOUR, ""), &yaml(0.95 * most));
    close("less than friction", still.last().base_pose.unwrap()[1], 0.0, 1e-7);
    let moves = run(&table(&FOUR, ""), &yaml(1.5 * most));
    assert!(moves.last().base_pose.unwrap()[1] > 0.01, "more than friction");
}

/// Pushed at the top until it tips: the feet behind leave, and come down again when the push ends.
#[test]
fn tipped_table_comes_back_to_its_feet() {
    let made = run(&table(&FOUR, ""), "duration: 1.5\nground: {friction: 1.5}\ninitial: {base: {xyz: [0, 0, 0.4]}}\nwrenches: [{link: table, force: [130, 0, 0], point: [0, 0, 0], start: 0.1, end: 0.2}]\nintegrator: {method: rk4, step: 5e-4}");
    assert!(made.events(EventKind::LiftOff).count() >= 2, "{:?}", made.simulation.events());
    let footing = made.last().footing.as_ref().unwrap();
    close("weight", footing.contacts.iter().map(|c| c.force[2]).sum(), 12.0 * G, 1e-6);
    assert!(footing.contacts.iter().all(|c| c.gap.abs() < 1e-7), "{footing:?}");
    assert!(made.simulation.events().len() < 100, "{} events", made.simulation.events().len());
}
