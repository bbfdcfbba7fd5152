//! Checks of the numbers of one flexible link.

use super::file::ProfileFile;
use crate::beam::Profile;
use crate::error::Error;
use crate::load::yaml::Keys;

/// The keys of one flexible link.
pub(super) struct Numbers<'a> {
    pub(super) keys: &'a Keys,
    /// Path of the link's entry.
    pub(super) key: &'a str,
}

/// Ends of tables closer to those of the beam than this part of its length are meant to be there.
const SAME_END: f64 = 1e-9;

impl Numbers<'_> {
    /// An error about a key of the link.
    pub(super) fn error(&self, key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.keys.error(&format!("{}.{key}", self.key), problem, remedy)
    }

    pub(super) fn positive(&self, key: &str, value: f64) -> Result<(), Error> {
        if value > 0.0 {
            return Ok(());
        }
        Err(self.error(key, format!("it must be positive, and is {value}"), "give a positive number"))
    }

    pub(super) fn not_negative(&self, key: &str, value: f64) -> Result<(), Error> {
        if value >= 0.0 {
            return Ok(());
        }
        Err(self.error(key, format!("it is negative: {value}"), "give zero or a positive number"))
    }

    /// A quantity over the length, positive or at least not negative.
    pub(super) fn profile(&self, key: &str, file: &ProfileFile, length: f64, positive: bool) -> Result<Profile, Error> {
        let check = |value: f64| if positive { self.positive(key, value) } else { self.not_negative(key, value) };
        let mut profile = Profile::from(file);
        match &mut profile {
            Profile::Constant(value) => check(*value)?,
            Profile::Table(points) => {
                self.span(key, &points.iter().map(|p| p[0]).collect::<Vec<_>>(), length)?;
                points.iter().try_for_each(|p| check(p[1]))?;
                stretch(points, length);
            }
        }
        Ok(profile)
    }

    /// Positions of a table must ascend from the root to the tip.
    pub(super) fn span(&self, key: &str, x: &[f64], length: f64) -> Result<(), Error> {
        let remedy = format!("list points from x = 0 to x = {length} m, the beam's length, x ascending");
        let [first, .., last] = x else {
            return Err(self.error(key, "a table needs two points at least", remedy));
        };
        if first.abs() > SAME_END * length || (last - length).abs() > SAME_END * length {
            let problem = format!("the table goes from x = {first} m to x = {last} m, the beam from 0 to {length} m");
            return Err(self.error(key, problem, remedy));
        }
        match x.windows(2).find(|x| x[1] <= x[0]) {
            Some(x) => Err(self.error(key, format!("x = {} m comes after x = {} m", x[1], x[0]), remedy)),
            None => Ok(()),
        }
    }
}

/// Puts the ends of a table where those of the beam are, from which they differ by rounding.
pub(super) fn stretch<const N: usize>(points: &mut [[f64; N]], length: f64) {
    if let [first, .., last] = points {
        (first[0], last[0]) = (0.0, length);
    }
}
