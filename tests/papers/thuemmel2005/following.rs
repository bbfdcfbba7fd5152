//! The arm following a motion under PD, and under PD with an inverse fed forward.

use crate::arm::{Tip, robot, scenario};
use gyroflex::spatial::Vec3;
use gyroflex_sim::record::MemoryRecorder;
use gyroflex_sim::scenario::{Controller, Factors, Plant, References};
use gyroflex_sim::{Error, Simulation};
use std::ops::ControlFlow;

/// The robot that follows, with its load.
pub const ROBOT: &str = "loaded.yaml";
/// The compared controllers and the scenarios of `robots/lwr` they are from; their gains are the same.
pub const LAWS: [(&str, &str); 3] = [
    ("PD with gravity", "compare/pd_gravity.yaml"),
    ("PD + reduced inverse", "compare/two_dof_reduced.yaml"),
    ("PD + complete inverse", "compare/two_dof.yaml"),
];

/// A motion, and how long the arm is watched.
pub struct Motion {
    /// What the joints are to do.
    pub reference: References,
    /// Simulated time [s].
    pub duration: f64,
}

/// What the controller does not know, and how often it looks.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    /// Factor on the simulated robot's springs [–].
    pub springs: f64,
    /// Ticks of the controller a second [Hz].
    pub rate: f64,
}

/// What the tip did, instant by instant.
pub struct Run {
    /// Times [s].
    pub time: Vec<f64>,
    /// Where the tip was [m].
    pub tip: Vec<Vec3<f64>>,
    /// Where the reference had it [m].
    pub wanted: Vec<Vec3<f64>>,
    /// Largest share of a drive's torque that was asked for [–].
    pub effort: f64,
    /// Largest share of a joint's velocity limit that the reference asked for [–].
    pub haste: f64,
}

/// Simulates the complete model under one of the [`LAWS`].
///
/// # Errors
/// A motion that the controller cannot follow.
pub fn follow(law: usize, motion: &Motion, conditions: Conditions) -> Result<Run, Error> {
    let (robot, mut file) = (robot(ROBOT)?, scenario(LAWS[law].1)?);
    file.scenario.reference = motion.reference.clone();
    file.scenario.duration = motion.duration;
    file.scenario.plant = Some(Plant { stiffness: Some(Factors::All(conditions.springs)), ..Plant::default() });
    if let Controller::Pd { rate, .. } | Controller::TwoDegreeOfFreedom { rate, .. } = &mut file.scenario.controller {
        *rate = conditions.rate;
    }
    let mut simulation = Simulation::new(&robot, &file)?;
    let mut record = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut record, &mut |_| ControlFlow::Continue(()))?;
    let (samples, tip) = (record.samples(), Tip::new(&robot)?);
    let places = |q: fn(&gyroflex_sim::record::Sample) -> &[f64]| -> Result<Vec<Vec3<f64>>, Error> {
        samples.iter().map(|s| Ok(tip.pose(q(s))?.pos)).collect()
    };
    let effort = summary
        .joints
        .iter()
        .zip(&robot.joints)
        .map(|(j, limits)| j.peak_torque / limits.max_torque.unwrap_or(f64::INFINITY));
    let speeds = samples.windows(2).flat_map(|w| {
        let step = w[1].t - w[0].t;
        let limits = robot.joints.iter().map(|j| j.max_velocity.unwrap_or(f64::INFINITY));
        w[1].reference
            .iter()
            .zip(&w[0].reference)
            .zip(limits)
            .map(move |((b, a), limit)| ((b - a) / step / limit).abs())
    });
    Ok(Run {
        time: samples.iter().map(|s| s.t).collect(),
        tip: places(|s| &s.q)?,
        wanted: places(|s| &s.reference)?,
        effort: effort.fold(0.0, f64::max),
        haste: speeds.fold(0.0, f64::max),
    })
}
