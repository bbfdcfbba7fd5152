//! Laws of the analysis of when rotors matter.

use gyroflex::model::Fidelity;
use gyroflex_sim::analyze::{Options, bounds, coriolis_norm, motions, of_workspace, ranges, significance};
use gyroflex_sim::load::{Embedded, LoadOptions, load, load_from};
use gyroflex_sim::{Dynamics, Robot};
use nalgebra::{DMatrix, DVector};
use std::path::{Path, PathBuf};

/// Inertias of the links of the pair about their common axis [kg m²], and gear ratio and rotor inertia [kg m²] of both drives.
const INERTIA: [f64; 2] = [2.0, 0.5];
const RATIO: f64 = 100.0;
const ROTOR: f64 = 1e-3;

/// Two links that turn about the same vertical axis, one on the other.
const PAIR: &str = r#"<robot name="pair">
  <link name="base"/>
  <link name="one"><inertial><mass value="20"/><inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.0"/></inertial></link>
  <link name="two"><inertial><mass value="5"/><inertia ixx="0.5" ixy="0" ixz="0" iyy="0.5" iyz="0" izz="0.5"/></inertial></link>
  <joint name="lower" type="revolute"><parent link="base"/><child link="one"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="2"/></joint>
  <joint name="upper" type="revolute"><parent link="one"/><child link="two"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="2"/></joint>
</robot>"#;
const DRIVES: &str = "urdf: pair.urdf
drives:
  lower: {rotor: {inertia: 1.0e-3}, gear_ratio: 100, transmission: {stiffness: 1.0e4}}
  upper: {rotor: {inertia: 1.0e-3}, gear_ratio: 100, transmission: {stiffness: 1.0e4}}
";
const GROUNDED: &str = "urdf: pair.urdf
drives:
  lower: {rotor: {inertia: 1.0e-3}, gear_ratio: 100, transmission: {stiffness: 1.0e4}}
  upper: {rotor: {inertia: 1.0e-3, mount: {link: base, axis: [0, 0, 1]}}, gear_ratio: 100, transmission: {stiffness: 1.0e4}}
";
const FILES: Embedded = Embedded(&[("pair.urdf", PAIR), ("pair.yaml", DRIVES), ("grounded.yaml", GROUNDED)]);

fn pair(file: &str) -> Robot {
    load_from(&FILES, Path::new(file), &LoadOptions::default()).expect("the pair is physical")
}

fn robot(name: &str) -> Robot {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "../../robots", name, "robot.yaml"].iter().collect();
    load(&path, &LoadOptions::default()).expect("the robot is physical")
}

fn close(got: f64, want: f64) {
    assert!((got - want).abs() <= 1e-10 * want.abs(), "{got} instead of {want}");
}

#[test]
fn errors_of_a_pair_on_one_axis_are_its_closed_form() {
    let options = Options { samples: 200, ..Options::default() };
    let report = of_workspace(&pair("pair.yaml"), &options).expect("the pair is physical");
    let a = 2.0 / options.rise;
    let couple = RATIO * ROTOR * a;
    let [lower, upper] = [&report.joints[0], &report.joints[1]];
    // τ_J₁ = (I₁ + I₂) q̈₁ + I₂ q̈₂ + N J θ̈₂ and τ₂ = I₂ (q̈₁ + q̈₂) + B θ̈₂ + N J q̈₁; both are largest where all turn one way.
    let whole = (INERTIA[0] + 2.0 * INERTIA[1]) * a + couple;
    close(lower.tau_j.peak, whole);
    close(lower.tau_j.error_max, couple);
    close(lower.tau_j.error_max_percent, 100.0 * couple / whole);
    close(upper.tau.error_max, couple);
    close(upper.tau.peak, (2.0 * INERTIA[1] + RATIO * RATIO * ROTOR) * a + couple);
    assert!(upper.tau_j.error_max <= 1e-12 * upper.tau_j.peak);
    // r_s = 2 q̇ᵀ S q̇ / (q̇ᵀ M q̇) with the only entry N J of S: eigenvalues of a 2 × 2 pencil.
    let (nj, det) = (RATIO * ROTOR, INERTIA[0] * INERTIA[1]);
    let half = -nj * INERTIA[1] / det;
    let root = (half * half + nj * nj / det).sqrt();
    close(report.significance.r_s_max, half + root);
    close(report.significance.r_s_min, half - root);
}

#[test]
fn at_the_threshold_speed_the_error_is_the_threshold() {
    let robot = pair("pair.yaml");
    let options = Options { samples: 200, threshold: 1.0, ..Options::default() };
    let full = of_workspace(&robot, &options).expect("the pair is physical");
    assert!(!full.reduced_is_enough);
    let limit = full.joints[0].threshold_speed.expect("it passes the threshold");
    let percent = full.joints[0].tau_j.error_max_percent;
    close(limit, 2.0 * (options.threshold / percent).sqrt());
    // The same motions run through slower: accelerations shrink with the square.
    let slower = Options { speed: Some(limit), rise: options.rise * 2.0 / limit, ..options };
    let slow = of_workspace(&robot, &slower).expect("the pair is physical");
    close(slow.joints[0].tau_j.error_max, 0.01 * options.threshold * full.joints[0].tau_j.peak);
    // A threshold above the error is never passed.
    let enough = of_workspace(&robot, &Options { threshold: percent * 1.01, ..options }).expect("the pair is physical");
    assert_eq!((enough.joints[0].threshold_speed, enough.reduced_is_enough), (None, true));
}

#[test]
fn rotors_on_the_ground_leave_no_error() {
    let report = of_workspace(&pair("grounded.yaml"), &Options::default()).expect("the pair is physical");
    assert!(report.reduced_is_enough && report.enough_up_to >= 1.0);
    for joint in &report.joints {
        assert!(joint.worst_percent() <= 1e-10, "{}: {}", joint.name, joint.worst_percent());
    }
    assert!(report.significance.r_s_max.abs() <= 1e-12 && report.significance.r_s_min.abs() <= 1e-12);
}

#[test]
fn significance_extremes_bound_every_velocity() {
    for name in ["puma560", "manutec_r3", "iiwa14"] {
        let robot = robot(name);
        let mut complete = Dynamics::new(robot.model(Fidelity::Complete).expect("physical"));
        let options = Options { samples: 500, seed: 3, ..Options::default() };
        let report = of_workspace(&robot, &options).expect("physical").significance;
        for motion in motions(&robot, &ranges(&robot, &options), &options) {
            let s = significance(&mut complete, &motion.q, Some(&motion.qd)).expect("physical");
            let r_s = s.r_s.expect("it moves");
            assert!(s.r_s_min <= r_s && r_s <= s.r_s_max && r_s.abs() <= s.bound_singular_values, "{name}: {s:?}");
            assert!(report.r_s_min <= s.r_s_min && s.r_s_max <= report.r_s_max, "{name}");
            assert!(report.r_s_lowest <= r_s && r_s <= report.r_s_highest, "{name}");
        }
    }
}

#[test]
fn bounds_hold_for_ten_times_as_many_other_poses() {
    for name in ["puma560", "iiwa14"] {
        let robot = robot(name);
        let options = Options { samples: 300, ..Options::default() };
        let found = bounds(&robot, &options).expect("physical");
        let mut complete = Dynamics::new(robot.model(Fidelity::Complete).expect("physical"));
        let n = complete.nv();
        let (mut m, mut g) = (vec![0.0; n * n], vec![0.0; n]);
        let others = Options { samples: 3000, seed: 99, ..options };
        for motion in motions(&robot, &ranges(&robot, &others), &others) {
            complete.mass_matrix(&motion.q, &mut m).expect("sizes fit");
            let values = DMatrix::from_row_slice(n, n, &m).singular_values();
            assert!(values.max() <= found.inertia_max.value, "{name}: {} {}", values.max(), found.inertia_max.value);
            assert!(values.max() >= found.inertia_min.value, "{name}: {} {}", values.max(), found.inertia_min.value);
            assert!(
                values.min() >= found.eigenvalue_min.value,
                "{name}: {} {}",
                values.min(),
                found.eigenvalue_min.value
            );
            complete.gravity_torques(&motion.q, &mut g).expect("sizes fit");
            assert!(DVector::from_column_slice(&g).norm() <= found.gravity_max.value, "{name}: {g:?}");
            let speed = DVector::from_column_slice(&motion.qd).norm();
            let c = coriolis_norm(&mut complete, &motion.q, &motion.qd).expect("sizes fit");
            assert!(c <= found.coriolis_max.value * speed, "{name}: {c} {speed} {}", found.coriolis_max.value);
        }
        let at = &found.inertia_max;
        complete.mass_matrix(&at.q, &mut m).expect("sizes fit");
        close(DMatrix::from_row_slice(n, n, &m).singular_values().max(), at.value);
        let at = &found.coriolis_max;
        close(coriolis_norm(&mut complete, &at.q, &at.qd).expect("sizes fit"), at.value);
    }
}

#[test]
fn options_that_mean_nothing_are_refused() {
    let robot = pair("pair.yaml");
    let bad = [
        Options { samples: 0, ..Options::default() },
        Options { speed: Some(-1.0), ..Options::default() },
        Options { threshold: f64::NAN, ..Options::default() },
        Options { rise: 0.0, ..Options::default() },
    ];
    for options in bad {
        let error = of_workspace(&robot, &options).expect_err("it means nothing");
        assert!(!error.element.is_empty() && !error.remedy.is_empty(), "{error}");
    }
}
