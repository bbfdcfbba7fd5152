//! The summary of a run, for people and for programs.

use gyroflex_sim::Summary;
use gyroflex_sim::contact::EventKind;
use gyroflex_sim::error::Error;
use std::fmt::Write;
use std::path::Path;

/// A summary, and the files that were written.
#[derive(Debug)]
pub struct Report<'a> {
    pub summary: &'a Summary,
    pub log: &'a Path,
    pub csv: Option<&'a Path>,
}

impl Report<'_> {
    /// The summary as indented JSON, with `log` and `csv`.
    pub fn json(&self) -> Result<String, Error> {
        let mut json = serde_json::to_value(self.summary)?;
        json["log"] = self.log.display().to_string().into();
        json["csv"] = self.csv.map(|p| p.display().to_string()).into();
        Ok(serde_json::to_string_pretty(&json)?)
    }

    /// A few lines and a table.
    pub fn text(&self) -> String {
        let s = self.summary;
        let mut out = format!(
            "{}, {} model: {} s simulated in {:.2} s, {:.1} times real time\n",
            s.robot, s.model, s.end_time, s.wall_time, s.real_time_factor
        );
        let widest = s.joints.iter().map(|j| j.name.chars().count()).max().unwrap_or(0).max("joint".len());
        let mut line = |cells: [&str; 5]| {
            let [name, rms, peak, torque, limited] = cells;
            let text = format!("  {name:<widest$}  {rms:>13}  {peak:>13}  {torque:>13}  {limited:>9}");
            out.push_str(text.trim_end());
            out.push('\n');
        };
        line(["joint", "rms error", "peak error", "peak torque", "at limit"]);
        for j in &s.joints {
            let numbers = [j.rms_tracking_error, j.peak_tracking_error, j.peak_torque].map(|x| format!("{x:.4e}"));
            line([&j.name, &numbers[0], &numbers[1], &numbers[2], &format!("{:.1} %", 100.0 * j.saturation)]);
        }
        out.push_str("  (errors in rad, torques in N m on the link side; m and N for sliding joints)\n");
        if let Some(mode) = &s.fastest_mode {
            let _ = writeln!(out, "fastest mode {:.1} Hz, {}", mode.frequency, mode.moves_most());
        }
        if let Some(drift) = s.energy_drift {
            let _ = writeln!(out, "energy drift {drift:.1e} of the largest kinetic energy");
        }
        if let Some(drift) = s.constraint_drift {
            let of = |kind| s.events.iter().filter(|e| e.kind == kind).count();
            let (down, off) = (of(EventKind::TouchDown) + of(EventKind::Bounce), of(EventKind::LiftOff));
            if !s.contacts.is_empty() {
                let (slip, stick) = (of(EventKind::Slip), of(EventKind::Stick));
                let _ = writeln!(
                    out,
                    "contacts: {down} touch-downs, {off} lift-offs, {slip} began to slip, {stick} stuck again"
                );
            }
            let _ = writeln!(out, "largest error of what was held {drift:.1e} m or rad");
        }
        let _ = write!(out, "log: {} ({} samples)", self.log.display(), s.samples);
        if let Some(csv) = self.csv {
            let _ = write!(out, "\ncsv: {}", csv.display());
        }
        out
    }
}
