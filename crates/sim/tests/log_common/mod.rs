//! A made-up run for the tests of logs: every number different, none of them round.
#![allow(dead_code, reason = "each test file uses its own part")]

use gyroflex::spatial::{Mat3, Transform, Vec3};
use gyroflex_sim::bending::Tip;
use gyroflex_sim::record::{Footing, Impact, RunInfo, Sample, Struck, Touch};
use std::path::PathBuf;

/// A floating robot of three joints: elastic drive, rigid drive with a negative ratio, sliding joint without a drive.
pub fn info() -> RunInfo {
    let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
    RunInfo {
        joints: ["shoulder", "Ellbogen_ä", "slide"].map(str::to_owned).to_vec(),
        prismatic: vec![false, false, true],
        elastic: vec![true, false, false],
        gear_ratios: vec![Some(107.815), Some(-53.7063), None],
        frames: vec![pair("trunk", "world"), pair("upper_arm", "trunk"), pair("tool", "upper_arm")],
        floating: true,
        held: true,
        contacts: vec!["foot".to_owned()],
        modes: ["upper_arm.bending_y1", "upper_arm.torsion1"].map(str::to_owned).to_vec(),
        turning: vec![false, true],
        tips: vec!["upper_arm".to_owned()],
        urdf: "<robot name=\"made up\"/>".to_owned(),
        attachments: vec![pair("robot.urdf", "<robot name=\"made up\"/>"), pair("scenario.yaml", "duration: 1.0\n")],
        metadata: vec![pair("model", "complete"), pair("step", "0.0001")],
    }
}

/// The `k`-th sample, a millisecond after the one before it.
pub fn sample(k: usize) -> Sample {
    let t = k as f64 * 1e-3;
    let wave = |phase: f64| (3.0 * t + phase).sin() / 3.0;
    let joints = |phase: f64| vec![wave(phase), 1e-300 * wave(phase + 0.1), -1e12 * wave(phase + 0.2)];
    let pose = |axis: [f64; 3], angle: f64| {
        let norm = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let axis = Vec3::new(axis[0] / norm, axis[1] / norm, axis[2] / norm);
        Transform::from_pose(Mat3::rotation(axis, angle.sin_cos()), Vec3::new(wave(0.3), wave(0.4), wave(0.5)))
    };
    let half_turn = std::f64::consts::PI;
    Sample {
        t,
        base_pose: Some([wave(1.0), wave(1.1), wave(1.2), 0.5, -0.5, 0.5, 0.5]),
        base_twist: Some([2.0, 2.1, 2.2, 2.3, 2.4, 2.5].map(wave)),
        q: joints(3.0),
        qd: joints(3.1),
        qdd: joints(3.2),
        theta: joints(3.3),
        thetad: joints(3.4),
        thetadd: joints(3.5),
        deflection: joints(3.6),
        tau_j: joints(3.7),
        tau: joints(3.8),
        gyroscopic: joints(3.9),
        friction: joints(4.0),
        reference: joints(4.1),
        tracking_error: joints(4.2),
        kinetic_energy: wave(5.0).abs(),
        gravity_energy: wave(5.1),
        elastic_energy: wave(5.2).abs(),
        power_in: wave(5.3),
        dissipation: wave(5.4).abs(),
        significance: 0.0,
        footing: Some(Footing {
            contacts: vec![Touch { force: [6.0, 6.1, 6.2].map(wave), gap: wave(6.3), mode: 1.0 }],
            center_of_mass: [6.4, 6.5, 6.6].map(wave),
            zero_moment_point: [6.7, 6.8].map(wave),
            drift: wave(6.9).abs(),
        }),
        eta: [9.0, 9.1].map(wave).to_vec(),
        etad: [9.2, 9.3].map(wave).to_vec(),
        etadd: [9.4, 9.5].map(wave).to_vec(),
        tips: vec![Tip { displacement: [9.6, 9.7, 9.8].map(wave), rotation: [9.9, 10.0, 10.1].map(wave) }],
        frames: vec![
            pose([0.0, 0.0, 1.0], 7.0 * t),
            pose([1.0, -2.0, 0.5], half_turn + t),
            pose([1.0, 1.0, 0.0], half_turn),
        ],
    }
}

/// An impact half a millisecond after the `k`-th sample.
pub fn impact(k: usize) -> Impact {
    let t = k as f64 * 1e-3 + 5e-4;
    let wave = |phase: f64| (3.0 * t + phase).sin() / 3.0;
    let struck = Struck {
        contact: 0,
        impulse: [8.0, 8.1, 8.2].map(wave),
        before: [8.3, 8.4, 8.5].map(wave),
        after: [8.6, 8.7, 8.8].map(wave),
    };
    Impact { t, struck: vec![struck], energy_lost: wave(8.9).abs() }
}

/// A fresh folder of that name for a test's files.
pub fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("the target folder is writable");
    folder
}
