//! Controllers of the lightweight arm side by side: what knows more follows better, with the plant as it is known.

use gyroflex_sim::ScenarioFile;
use gyroflex_sim::compare::{Compared, Variation, compare};
use gyroflex_sim::load::{Disk, LoadOptions, load};
use std::path::{Path, PathBuf};

fn scenario(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../robots/lwr/compare/{name}.yaml"))
}

fn run(name: &str, plants: &[Variation]) -> Vec<Compared> {
    let file = ScenarioFile::load(&Disk, &scenario(name)).unwrap();
    let robot = load(&file.robot_path(), &LoadOptions::default()).unwrap();
    compare(&robot, &file, Some("tool"), plants).unwrap()
}

fn nominal(name: &str) -> Compared {
    run(name, &[Variation::NONE]).remove(0)
}

/// Thümmel, Otter & Bals, figure 7: the inverse in front of the same feedback takes most of error and vibration away.
#[test]
fn the_inverse_takes_errors_and_vibration_away() {
    let (pd, inverse) = (nominal("pd_gravity"), nominal("two_dof"));
    assert!(inverse.rms_error < 0.02 * pd.rms_error, "{inverse:?} {pd:?}");
    assert!(inverse.residual_vibration < 0.02 * pd.residual_vibration, "{inverse:?} {pd:?}");
    let rigid = nominal("computed_torque");
    assert!(inverse.rms_error < 0.1 * rigid.rms_error, "{inverse:?} {rigid:?}");
}

/// A regulator that sees the links does better than PD that sees the motors, also with a plant that it does not know.
#[test]
fn feedback_of_the_links_bears_errors_of_the_plant_better() {
    let soft = [Variation { stiffness: 0.8, payload: 1.2 }];
    let (motors, links) = (run("two_dof", &soft).remove(0), run("lqr", &soft).remove(0));
    assert!(links.rms_error < motors.rms_error, "{links:?} {motors:?}");
    assert!(links.residual_vibration < 0.5 * motors.residual_vibration, "{links:?} {motors:?}");
}

#[test]
fn a_shaper_takes_the_vibration_of_its_modes_away() {
    let (plain, shaped) = (nominal("pd_gravity"), nominal("shaped"));
    assert!(shaped.residual_vibration < 0.25 * plain.residual_vibration, "{shaped:?} {plain:?}");
}

/// The controller does not know the factors, so that errors grow with them; without factors nothing changes to the last bit.
#[test]
fn plants_that_are_not_known_make_errors() {
    let plants = Variation::all(&[0.8, 1.2], &[1.2]);
    assert_eq!(plants.len(), 6);
    let runs = run("two_dof", &plants);
    assert_eq!(runs[0].rms_error.to_bits(), nominal("two_dof").rms_error.to_bits());
    assert!(runs[1..].iter().all(|run| run.rms_error > 10.0 * runs[0].rms_error), "{runs:?}");
}
