//! Rows in a CSV file, which may go on after an interruption.

use super::{Grid, Measures, Outcome};
use crate::error::{Error, ErrorKind};
use serde_json::Value;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A CSV file with a row a run in the order of the grid: the values of the keys, the measures, and the error of a run that has none.
/// A row is one line, written when the run is done.
#[derive(Debug)]
pub struct Table {
    grid: Grid,
    path: PathBuf,
    file: File,
    /// Names of the measures, once a run had some.
    measures: Option<Vec<String>>,
    /// Runs that failed before any had measures: without those there is no head to write.
    early: Vec<(usize, Error)>,
    rows: usize,
    last: Option<String>,
}

impl Table {
    /// The file at `path`: a new one, or one that an interrupted sweep of the same values left.
    ///
    /// # Errors
    /// A file that is something else, or that cannot be read and written.
    pub fn open(path: &Path, grid: Grid) -> Result<Self, Error> {
        let file = OpenOptions::new().read(true).append(true).create(true).open(path);
        let mut file =
            file.map_err(|e| fault(path, format!("cannot be written: {e}"), "choose a folder that you may write to"))?;
        let unreadable = |e: io::Error| fault(path, format!("cannot be read: {e}"), OTHER);
        let mut text = io::read_to_string(&mut file).map_err(unreadable)?;
        // A line that was being written when the program or the machine stopped.
        text.truncate(text.rfind('\n').map_or(0, |end| end + 1));
        file.set_len(text.len() as u64).map_err(unreadable)?;

        let mut table =
            Self { grid, path: path.to_owned(), file, measures: None, early: Vec::new(), rows: 0, last: None };
        let mut lines = text.lines();
        let Some(head) = lines.next() else { return Ok(table) };
        let names = cells(head);
        let keys = table.grid.axes.len();
        let ours = names.len() > keys && names.last().is_some_and(|name| name == ERROR);
        if !ours || !names.iter().zip(&table.grid.axes).all(|(name, axis)| *name == axis.key) {
            return Err(table.fault("it is not the result of a sweep of these keys"));
        }
        table.measures = Some(names[keys..names.len() - 1].to_vec());
        for line in lines {
            let values = table.rows < table.grid.len()
                && cells(line).iter().zip(table.values(table.rows)).all(|(cell, value)| *cell == value);
            if !values {
                return Err(table.fault(format!("row {} has other values than this sweep", table.rows + 1)));
            }
            table.rows += 1;
            table.last = Some(line.to_owned());
        }
        Ok(table)
    }

    /// Number of runs that the file already has.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Refuses to go on if the last run that the file has comes out otherwise now.
    ///
    /// # Errors
    /// When the scenario, its robot or the program are not those that the file was made with.
    pub fn check_last(&mut self, outcome: Outcome) -> Result<(), Error> {
        let Some(last) = self.last.take() else { return Ok(()) };
        if self.line(self.rows - 1, outcome)? == last {
            return Ok(());
        }
        Err(self
            .fault("its last run comes out otherwise now: the scenario, the robot or the program have changed since"))
    }

    /// Writes the next row.
    ///
    /// # Errors
    /// A run with other measures than those before it, or a file that cannot be written.
    pub fn push(&mut self, run: usize, outcome: Outcome) -> Result<(), Error> {
        if self.measures.is_none() {
            match &outcome {
                Err(error) => {
                    self.early.push((run, error.clone()));
                    return Ok(());
                }
                Ok(measures) => self.begin(measures)?,
            }
        }
        let line = self.line(run, outcome)?;
        self.write(&line)
    }

    /// Completes the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(&mut self) -> Result<(), Error> {
        if self.measures.is_none() && !self.early.is_empty() {
            self.begin(&Measures::new())?;
        }
        Ok(())
    }

    /// Writes the head, and the rows that waited for it.
    fn begin(&mut self, measures: &Measures) -> Result<(), Error> {
        let names: Vec<String> = measures.iter().map(|(name, _)| name.clone()).collect();
        let keys = self.grid.axes.iter().map(|axis| axis.key.as_str());
        let head = line(keys.chain(names.iter().map(String::as_str)).chain([ERROR]));
        self.measures = Some(names);
        self.write(&head)?;
        for (run, error) in std::mem::take(&mut self.early) {
            let line = self.line(run, Err(error))?;
            self.write(&line)?;
        }
        Ok(())
    }

    fn line(&self, run: usize, outcome: Outcome) -> Result<String, Error> {
        let names = self.measures.as_deref().unwrap_or_default();
        let mut row = self.values(run);
        match outcome {
            Ok(measures) if measures.iter().map(|(name, _)| name).eq(names) => {
                row.extend(measures.iter().map(|(_, x)| cell(&Value::from(*x))));
                row.push(String::new());
            }
            Ok(_) => return Err(self.fault(format!("run {run} has other joints than those before it"))),
            Err(error) => {
                row.extend(names.iter().map(|_| String::new()));
                row.push(error.to_string().lines().next().unwrap_or_default().to_owned());
            }
        }
        Ok(line(row.iter().map(String::as_str)))
    }

    fn values(&self, run: usize) -> Vec<String> {
        self.grid.values(run).into_iter().map(cell).collect()
    }

    /// One write a line, so that a program that is stopped leaves whole lines.
    fn write(&mut self, line: &str) -> Result<(), Error> {
        self.file
            .write_all(format!("{line}\n").as_bytes())
            .map_err(|e| fault(&self.path, format!("cannot be written: {e}"), "make room on the disk"))
    }

    fn fault(&self, problem: impl Into<String>) -> Error {
        fault(&self.path, problem, OTHER)
    }
}

/// Name of the last column.
const ERROR: &str = "error";
const OTHER: &str = "name another file, or remove this one";

/// A value as text: nothing for none and NaN, lists and mappings as JSON.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

fn line<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::Any(b'\n')).from_writer(Vec::new());
    // Writing to memory does not fail.
    let _ = writer.write_record(cells.map(|cell| cell.replace(['\n', '\r'], " ")));
    let text = writer.into_inner().unwrap_or_default();
    String::from_utf8_lossy(&text).trim_end_matches('\n').to_owned()
}

fn cells(line: &str) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
    let record = reader.records().next().and_then(Result::ok).unwrap_or_default();
    record.iter().map(str::to_owned).collect()
}

fn fault(path: &Path, problem: impl Into<String>, remedy: &str) -> Error {
    let (file, problem, remedy) = (path.display().to_string(), problem.into(), remedy.to_owned());
    Error { kind: ErrorKind::Io, file, element: "output".to_owned(), problem, remedy }
}
