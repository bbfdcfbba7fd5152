//! What can be wrong with references and shapers.

use super::validate::Check;
use super::{InputShaper, JointReference, References, ShaperModes, ShaperType};
use crate::error::Error;
use crate::reference::{MAX_LIMITS, SmoothSpline};
use gyroflex::control::reference::PointToPoint;

/// The most lags of a filter.
const MAX_LAGS: usize = 32;

impl Check<'_> {
    pub(super) fn references(&self, references: &References) -> Result<(), Error> {
        if let Some(degree) = references.degree {
            self.degree("reference.degree", degree)?;
            if references.csv.is_none() {
                let problem = "it is the degree of the spline through a CSV file, but there is no `csv`";
                return self.fail("reference.degree", problem.to_owned(), "remove it, or give `csv`");
            }
        }
        references.joints.iter().try_for_each(|(name, r)| self.reference(&format!("reference.{name}"), r))
    }

    fn reference(&self, key: &str, reference: &JointReference) -> Result<(), Error> {
        let within = |name: &str| format!("{key}.{name}");
        match reference {
            JointReference::Hold { at } => self.finite(key, at.iter()),
            JointReference::Sine { amplitude, frequency, phase, offset } => {
                self.finite(key, [amplitude, frequency, phase, offset])
            }
            JointReference::Sines { offset, terms } => {
                self.finite(key, [offset])?;
                terms.iter().try_for_each(|t| self.finite(key, [&t.amplitude, &t.frequency, &t.phase]))
            }
            JointReference::Zhao { amplitude, omega, offset } => {
                self.positive(&within("amplitude"), *amplitude)?;
                self.positive(&within("omega"), *omega)?;
                self.finite(key, [offset])
            }
            JointReference::Quintic { from, to, start, duration } => {
                self.finite(key, [from, to, start])?;
                self.positive(&within("duration"), *duration)
            }
            JointReference::Polynomial { from, to, start, duration, order } => {
                self.finite(key, [from, to, start])?;
                self.positive(&within("duration"), *duration)?;
                self.count(&within("order"), *order, PointToPoint::<f64>::MAX_ORDER)
            }
            JointReference::FilteredStep { from, to, start, order, cutoff } => {
                self.finite(key, [from, to, start])?;
                self.count(&within("order"), *order, MAX_LAGS)?;
                self.positive(&within("cutoff"), *cutoff)
            }
            JointReference::MinimumTime { from, to, start, limits } => {
                self.finite(key, [from, to, start])?;
                self.count(&within("limits"), limits.len(), MAX_LIMITS)?;
                limits.iter().try_for_each(|limit| self.positive(&within("limits"), *limit))
            }
            JointReference::Waypoints { times, positions, degree } => {
                self.finite(key, times.iter().chain(positions))?;
                self.degree(&within("degree"), *degree)?;
                self.waypoints(key, times, positions)
            }
        }
    }

    fn waypoints(&self, key: &str, times: &[f64], positions: &[f64]) -> Result<(), Error> {
        let times_key = format!("{key}.times");
        if times.len() != positions.len() {
            let problem = format!("there are {} times, but {} positions", times.len(), positions.len());
            return self.fail(&times_key, problem, "give one position for each time");
        }
        if times.len() < 2 {
            let problem = "a spline needs at least two points".to_owned();
            return self.fail(&times_key, problem, "add points, or use `{type: hold}`");
        }
        match times.windows(2).find(|w| w[1] <= w[0]) {
            Some(w) => {
                let problem = format!("{} s does not come after {} s", w[1], w[0]);
                self.fail(&times_key, problem, "let the times increase")
            }
            None => Ok(()),
        }
    }

    fn degree(&self, key: &str, degree: usize) -> Result<(), Error> {
        let most = SmoothSpline::MAX_DEGREE;
        if !degree.is_multiple_of(2) && (3..=most).contains(&degree) {
            return Ok(());
        }
        self.fail(
            key,
            format!("a spline of degree {degree} is not made"),
            &format!("give an odd degree from 3 to {most}"),
        )
    }

    pub(super) fn shaper(&self, shaper: &InputShaper) -> Result<(), Error> {
        match (shaper.kind, shaper.tolerance) {
            (ShaperType::Zv | ShaperType::Zvd, Some(_)) => {
                let problem = "only the shaper `ei` has a tolerance".to_owned();
                return self.fail("shaper.tolerance", problem, "remove it, or use `type: ei`");
            }
            (ShaperType::Ei, Some(v)) if !(v > 0.0 && v < 1.0) => {
                let problem = format!("{v} is not between 0 and 1");
                return self.fail("shaper.tolerance", problem, "give a share, such as 0.05");
            }
            _ => {}
        }
        let modes = match &shaper.modes {
            ShaperModes::Of(_) => return self.count("shaper.count", shaper.count.unwrap_or(1), InputShaper::MAX_MODES),
            ShaperModes::Given(modes) => modes,
        };
        for (key, given) in [("shaper.count", shaper.count.is_some()), ("shaper.motors", shaper.motors.is_some())] {
            if given {
                let problem = "the modes are listed, so that nothing is left to choose".to_owned();
                return self.fail(key, problem, "remove it, or use `modes: linearized`");
            }
        }
        self.count("shaper.modes", modes.len(), InputShaper::MAX_MODES)?;
        for (i, mode) in modes.iter().enumerate() {
            self.positive(&format!("shaper.modes[{i}].frequency"), mode.frequency)?;
            if !(0.0..1.0).contains(&mode.damping_ratio) {
                let problem = format!("{} is no damping ratio of a mode that oscillates", mode.damping_ratio);
                let key = format!("shaper.modes[{i}].damping_ratio");
                return self.fail(&key, problem, "give a number from 0 to below 1");
            }
        }
        Ok(())
    }

    /// Whether there is at least one, and not more than fit.
    fn count(&self, key: &str, count: usize, most: usize) -> Result<(), Error> {
        if (1..=most).contains(&count) {
            return Ok(());
        }
        self.fail(key, format!("{count} is out of range"), &format!("give from 1 to {most}"))
    }
}
