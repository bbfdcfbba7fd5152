//! References from a CSV file: a column `time` and a column per joint.

use super::{Ends, SmoothSpline, Spline, Trajectory};
use crate::coordinates::Coordinates;
use crate::error::{Error, ErrorKind};
use crate::load::yaml::Keys;
use crate::robot::SourceFile;

/// A spline through a column, and the times it covers [s].
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub(super) trajectory: Trajectory,
    pub(super) span: (f64, f64),
}

/// Reads one spline of this degree per joint that has a column.
pub(super) fn read(source: &SourceFile, joints: &Coordinates, degree: usize) -> Result<Vec<Option<Column>>, Error> {
    let file = source.name.as_str();
    let fail = |element: String, problem: String, remedy: &str| Error {
        kind: ErrorKind::Scenario,
        file: file.to_string(),
        element,
        problem,
        remedy: remedy.to_string(),
    };
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(source.text.as_bytes());
    let malformed = |e: csv::Error| fail(String::new(), e.to_string(), "give every row as many columns as the first");
    let header = reader.headers().map_err(malformed)?.clone();
    let mut time = None;
    let mut columns = vec![None; joints.len()];
    for (i, name) in header.iter().enumerate() {
        let slot = if name == "time" {
            &mut time
        } else {
            {
                let named = joints.find(name, &Keys::default(), "");
                let unknown = |e: Error| fail(format!("column `{name}`"), e.problem, &e.remedy);
                &mut columns[named.map_err(unknown)?]
            }
        };
        if slot.replace(i).is_some() {
            return Err(fail(format!("column `{name}`"), "it appears twice".to_string(), "remove one of them"));
        }
    }
    let Some(time) = time else {
        return Err(fail(
            "header".to_string(),
            "there is no column `time`".to_string(),
            "name the columns `time` and the joints",
        ));
    };

    let mut rows: Vec<Vec<f64>> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(malformed)?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut row = Vec::with_capacity(record.len());
        for (field, name) in record.iter().zip(&header) {
            let bad = || {
                let problem = format!("`{field}` is not a finite number");
                fail(format!("line {line}, column `{name}`"), problem, "give a finite number")
            };
            row.push(field.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(bad)?);
        }
        if rows.last().is_some_and(|last| row[time] <= last[time]) {
            let problem = format!("time {} does not come after the one before", row[time]);
            return Err(fail(format!("line {line}"), problem, "let the times increase from row to row"));
        }
        rows.push(row);
    }
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    let mut out = Vec::with_capacity(columns.len());
    for entry in columns {
        out.push(match entry {
            None => None,
            Some(i) => Some(through(column(time), column(i), degree).ok_or_else(|| {
                fail(String::new(), "it has fewer than two rows".to_string(), "give at least two rows")
            })?),
        });
    }
    Ok(out)
}

/// The spline of this degree through points; `None` if there are fewer than two.
fn through(times: Vec<f64>, values: Vec<f64>, degree: usize) -> Option<Column> {
    let span = (*times.first()?, *times.last()?);
    let trajectory = match degree {
        3 => Trajectory::Spline(Spline::new(times, values)?),
        _ => Trajectory::SmoothSpline(SmoothSpline::new(&times, &values, degree, Ends::Nearest)?),
    };
    Some(Column { trajectory, span })
}
