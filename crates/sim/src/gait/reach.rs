//! Whether the legs are long enough for a gait.

use super::{Gait, PlanarGait};
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::scenario::fault;

/// The most a leg may be stretched, as a share of its length: with a straight knee the foot has no way to go on.
const STRAIGHT: f64 = 0.999;
/// The same where the height of the hip is left open.
const BENT: f64 = 0.98;
/// Instants of a step that are looked at.
const INSTANTS: usize = 2000;

/// Least and largest distance from the hip to either foot over a step, with the times [m, s].
struct Distances {
    least: (f64, f64),
    largest: (f64, f64),
}

/// From both feet to the hip over a step: `(time, squared horizontal distance, height of the hip above its mean, less that of the foot)`.
fn feet(gait: &Gait) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
    (0..=INSTANTS).flat_map(|i| {
        let t = gait.step_time() * i as f64 / INSTANTS as f64;
        let (hip, swing) = (gait.hip(t, 0.0), gait.swing(t));
        let swing_height = if t < gait.single_support() { swing.z.q } else { 0.0 };
        [(0.0, 0.0), (swing.x.q, swing_height)].map(|(x, z)| (t, (x - hip.x.q).powi(2), hip.z.q - z))
    })
}

fn distances(gait: &Gait, height: f64) -> Distances {
    let mut out = Distances { least: (f64::INFINITY, 0.0), largest: (0.0, 0.0) };
    for (t, square, above) in feet(gait) {
        let distance = (square + (height + above).powi(2)).sqrt();
        if distance < out.least.0 {
            out.least = (distance, t);
        }
        if distance > out.largest.0 {
            out.largest = (distance, t);
        }
    }
    out
}

/// The greatest mean height of the hip at which no foot is farther from it than `reach` [m]; `None` if some foot is too far behind
/// or ahead.
fn highest(gait: &Gait, reach: f64) -> Option<f64> {
    feet(gait)
        .map(|(_, square, above)| {
            let left = reach * reach - square;
            if left > 0.0 { left.sqrt() - above } else { f64::NAN }
        })
        .try_fold(f64::INFINITY, |least, height| (!height.is_nan()).then(|| least.min(height)))
        .filter(|height| *height > 0.0)
}

impl PlanarGait {
    /// The mean height of the hip, which both legs can keep all the time [m].
    pub(super) fn height(gait: &Gait, keys: &Keys, at: &str) -> Result<f64, Error> {
        let [shortest, length] = gait.leg().reach();
        let fail = |key: &str, problem: String, remedy: String| fault(keys, &format!("{at}{key}"), problem, remedy);
        let Some(limit) = highest(gait, STRAIGHT * length) else {
            let widest = feet(gait).fold(0.0_f64, |widest, (_, square, _)| widest.max(square)).sqrt();
            return Err(fail(
                "step_length",
                format!("a foot is {widest:.3} m behind or ahead of the hip, and the legs are {length:.3} m long"),
                "shorten the step, lengthen the legs, or bring `hip.lead` and `hip.surge` nearer to zero".to_owned(),
            ));
        };
        let height = gait.hip.height.or_else(|| highest(gait, BENT * length)).unwrap_or(limit);
        let Distances { least, largest } = distances(gait, height);
        if height > limit {
            let (distance, t) = largest;
            return Err(fail(
                "hip.height",
                format!(
                    "at {height} m the hip is {distance:.4} m from a foot {t:.3} s after lift-off, and bent legs reach {:.4} m",
                    STRAIGHT * length
                ),
                format!("give {:.4} m or less, or shorten the step", (limit * 1e4).floor() / 1e4),
            ));
        }
        let (distance, t) = least;
        if distance <= shortest || height + feet(gait).fold(f64::INFINITY, |low, (.., above)| low.min(above)) <= 0.0 {
            return Err(fail(
                "hip.height",
                format!(
                    "the hip is {distance:.4} m from a foot {t:.3} s after lift-off, and the legs do not fold that far"
                ),
                "raise it, or lower `clearance` or `hip.rise`".to_owned(),
            ));
        }
        Ok(height)
    }
}
