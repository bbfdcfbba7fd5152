//! The same for people.

use super::{PERIOD, Report, Times};
use std::fmt;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { robot, nv, calls, states, clock_ns, .. } = self;
        writeln!(
            f,
            "{robot}, {nv} velocity coordinates: {calls} calls each, over {states} random states inside the limits"
        )?;
        writeln!(f, "instructions: {}", self.instruction_set)?;
        writeln!(f, "Every call is timed on its own; reading the clock takes {clock_ns} ns, which is taken off.\n")?;
        let wide = |title: &str| format!("{title:^30}");
        let head = format!("{}  {}", wide("time of a call [µs]"), wide("share of a 1 kHz period [%]"));
        writeln!(f, "  {:36}{}", "", head.trim_end())?;
        let columns = ["median", "99.9 %", "maximum"].map(|c| format!("{c:>9}")).concat();
        writeln!(f, "  {:<16}{:<20}{columns}   {columns}", "model", "algorithm")?;
        for row in &self.rows {
            let Times { median_us, p999_us, max_us } = row.times;
            let all = [median_us, p999_us, max_us];
            let us = all.map(|t| format!("{:>9}", digits(t))).concat();
            let share = all.map(|t| format!("{:>9}", digits(100.0 * t / PERIOD))).concat();
            writeln!(f, "  {:<16}{:<20}{us}   {share}", row.model, row.algorithm)?;
        }
        if self.rows.is_empty() {
            writeln!(f, "  nothing was finished")?;
        }
        write!(f, "\nThe maximum has in it whatever else the machine did meanwhile.")
    }
}

/// Three digits, which is more than a clock of nanoseconds and a busy machine can say.
fn digits(x: f64) -> String {
    match x {
        _ if x < 9.995 => format!("{x:.3}"),
        _ if x < 99.95 => format!("{x:.1}"),
        _ => format!("{x:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn numbers_keep_three_digits_and_a_place() {
        assert_eq!([0.0345, 0.4786, 9.99, 12.34, 456.7].map(digits), ["0.035", "0.479", "9.990", "12.3", "457"]);
    }
}
