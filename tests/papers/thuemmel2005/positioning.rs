//! Figure 7, left: how the tip vibrates after a fast motion.

use crate::arm::scenario;
use crate::following::{Motion, Run};
use gyroflex_sim::Error;
use gyroflex_sim::scenario::JointReference;

/// When the motion ends [s].
pub const END: f64 = 1.35;

/// The motion of `robots/lwr/compare`, slowed down to what the velocity limits allow.
///
/// # Errors
/// A file that cannot be read.
pub fn motion() -> Result<Motion, Error> {
    let mut reference = scenario("compare/pd_gravity.yaml")?.scenario.reference;
    for joint in reference.joints.values_mut() {
        if let JointReference::Polynomial { start, duration, .. } = joint {
            *duration = END - *start;
        }
    }
    Ok(Motion { reference, duration: 2.5 })
}

/// Times after the end of the motion [s], and how far the tip is from where it comes to rest [m].
pub fn residual(run: &Run) -> Vec<(f64, f64)> {
    let rest = run.tip[run.tip.len() - 1];
    let all = run.time.iter().zip(&run.tip).map(|(t, p)| (t - END, (*p - rest).norm()));
    all.filter(|(t, _)| *t >= 0.0).collect()
}

/// Time after which the tip stays within a distance [m] of where it comes to rest [s].
pub fn settling(residual: &[(f64, f64)], within: f64) -> f64 {
    residual.iter().rev().find(|(_, d)| *d > within).map_or(0.0, |(t, _)| *t)
}
