//! Linear models as rows, CSV and MAT files.

use super::mat::{self, Value};
use super::{Linearization, OperatingPoint};
use crate::error::{Error, ErrorKind};
use nalgebra::DMatrix;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A linear model as other programs take it, by JSON for one; matrices by rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Matrices {
    /// The instant, on a motion [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Sampling time [s]; absent in continuous time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Joint positions at the operating point.
    pub q: Vec<f64>,
    /// Joint velocities there.
    pub qd: Vec<f64>,
    /// Reflected motor positions there.
    pub theta: Vec<f64>,
    /// Reflected motor velocities there.
    pub thetad: Vec<f64>,
    /// Reflected motor torques there.
    pub tau: Vec<f64>,
    /// Names of the states.
    pub states: Vec<String>,
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Names of the outputs.
    pub outputs: Vec<String>,
    /// `A`.
    #[serde(rename = "A")]
    pub a: Vec<Vec<f64>>,
    /// `B`.
    #[serde(rename = "B")]
    pub b: Vec<Vec<f64>>,
    /// `C`.
    #[serde(rename = "C")]
    pub c: Vec<Vec<f64>>,
    /// `D`.
    #[serde(rename = "D")]
    pub d: Vec<Vec<f64>>,
}

impl From<&Linearization> for Matrices {
    fn from(linear: &Linearization) -> Self {
        let rows = |m: &DMatrix<f64>| m.row_iter().map(|r| r.iter().copied().collect()).collect();
        let OperatingPoint { state, tau, time } = linear.point.clone();
        Self {
            time,
            step: linear.step,
            q: state.q,
            qd: state.qd,
            theta: state.theta,
            thetad: state.thetad,
            tau,
            states: linear.states.clone(),
            inputs: linear.inputs.clone(),
            outputs: linear.outputs.clone(),
            a: rows(&linear.a),
            b: rows(&linear.b),
            c: rows(&linear.c),
            d: rows(&linear.d),
        }
    }
}

/// Writes `A.csv`, `B.csv`, `C.csv` and `D.csv` into a folder, which is made if it is not there: names of the columns in the first
/// line, of the rows in the first column. Of a series, one file each has all instants, their times in a column `time`.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write_csv(series: &[Linearization], folder: &Path) -> Result<Vec<PathBuf>, Error> {
    std::fs::create_dir_all(folder).map_err(|e| unwritable(folder, &e))?;
    let timed = series.iter().any(|l| l.point.time.is_some());
    let mut written = Vec::new();
    for name in ["A", "B", "C", "D"] {
        let mut text = String::new();
        for (i, l) in series.iter().enumerate() {
            let (matrix, rows, columns) = match name {
                "A" => (&l.a, &l.states, &l.states),
                "B" => (&l.b, &l.states, &l.inputs),
                "C" => (&l.c, &l.outputs, &l.states),
                _ => (&l.d, &l.outputs, &l.inputs),
            };
            if i == 0 {
                text += if timed { "time,row" } else { "row" };
                columns.iter().for_each(|c| text = std::mem::take(&mut text) + "," + &quoted(c));
                text.push('\n');
            }
            for (row, label) in matrix.row_iter().zip(rows) {
                if let Some(time) = l.point.time {
                    let _ = write!(text, "{time},");
                }
                text += &quoted(label);
                for x in row.iter() {
                    let _ = write!(text, ",{x:?}");
                }
                text.push('\n');
            }
        }
        let path = folder.join(format!("{name}.csv"));
        std::fs::write(&path, text).map_err(|e| unwritable(&path, &e))?;
        written.push(path);
    }
    Ok(written)
}

/// Writes a MAT file with `A`, `B`, `C`, `D`, the operating point, and the names as matrices of characters. Of a series, every
/// variable has the instant as its last index, and `time` has the times. `step` is the sampling time, 0 in continuous time.
///
/// # Errors
/// A file that cannot be written.
pub fn write_mat(series: &[Linearization], path: &Path) -> Result<(), Error> {
    let Some(first) = series.first() else { return Ok(()) };
    let stacked = |of: &dyn Fn(&Linearization) -> DMatrix<f64>| {
        let (rows, columns) = of(first).shape();
        let mut dimensions = vec![rows, columns];
        if series.len() > 1 {
            dimensions.push(series.len());
        }
        Value::Numbers(dimensions, series.iter().flat_map(|l| of(l).as_slice().to_vec()).collect())
    };
    let column = |v: &[f64]| DMatrix::from_column_slice(v.len(), 1, v);
    let mut variables = vec![
        ("A", stacked(&|l| l.a.clone())),
        ("B", stacked(&|l| l.b.clone())),
        ("C", stacked(&|l| l.c.clone())),
        ("D", stacked(&|l| l.d.clone())),
        ("q", stacked(&|l| column(&l.point.state.q))),
        ("qd", stacked(&|l| column(&l.point.state.qd))),
        ("theta", stacked(&|l| column(&l.point.state.theta))),
        ("thetad", stacked(&|l| column(&l.point.state.thetad))),
        ("tau", stacked(&|l| column(&l.point.tau))),
        ("step", Value::Numbers(vec![1, 1], vec![first.step.unwrap_or(0.0)])),
        ("states", Value::Lines(first.states.clone())),
        ("inputs", Value::Lines(first.inputs.clone())),
        ("outputs", Value::Lines(first.outputs.clone())),
    ];
    let times: Vec<f64> = series.iter().filter_map(|l| l.point.time).collect();
    if !times.is_empty() {
        variables.push(("time", Value::Numbers(vec![times.len(), 1], times)));
    }
    std::fs::write(path, mat::file(&variables)).map_err(|e| unwritable(path, &e))
}

/// A name as a cell of a CSV file.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.to_owned() }
}

fn unwritable(path: &Path, why: &std::io::Error) -> Error {
    Error {
        kind: ErrorKind::Io,
        file: path.display().to_string(),
        element: "output".to_owned(),
        problem: format!("cannot be written: {why}"),
        remedy: "choose a folder that exists and that you may write to".to_owned(),
    }
}
