//! The record as comma-separated values: a header `name [unit]`, then a row a sample.
//!
//! The columns are those of [`columns`](super::columns()). Numbers are the shortest decimals that read back to the same
//! bits.

use super::columns::{columns, row};
use super::{Recorder, RunInfo, Sample, file};
use crate::error::Error;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// What a killed process can lose: rows are handed to the operating system at least this often.
const FLUSH_EVERY: Duration = Duration::from_secs(1);

/// Writes samples to a CSV file.
pub struct CsvRecorder<W: Write = File> {
    name: String,
    info: RunInfo,
    writer: Option<::csv::Writer<W>>,
    numbers: Vec<f64>,
    last: Option<f64>,
    flushed: Instant,
}

impl CsvRecorder {
    /// Creates the file, or empties it, and writes the header.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn create(path: &Path, info: RunInfo) -> Result<Self, Error> {
        Self::new(file::create(path)?, &path.display().to_string(), info)
    }
}

impl<W: Write> CsvRecorder<W> {
    /// Writes the header to `sink`, called `name` in errors.
    ///
    /// # Errors
    /// When the sink cannot be written.
    pub fn new(sink: W, name: &str, info: RunInfo) -> Result<Self, Error> {
        let mut writer = ::csv::Writer::from_writer(sink);
        let header = columns(&info).into_iter().map(|c| format!("{} [{}]", c.name, c.unit));
        writer.write_record(header).map_err(|e| error(name, e))?;
        writer.flush().map_err(|e| file::write_error(name, &e))?;
        let (name, writer, flushed) = (name.to_owned(), Some(writer), Instant::now());
        Ok(Self { name, info, writer, numbers: Vec::new(), last: None, flushed })
    }
}

impl<W: Write> Recorder for CsvRecorder<W> {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        let writer = self.writer.as_mut().ok_or_else(|| file::finished(&self.name))?;
        sample.check(&self.info, self.last)?;
        self.numbers.clear();
        row(sample, &mut self.numbers);
        writer.serialize(&self.numbers).map_err(|e| error(&self.name, e))?;
        self.last = Some(sample.t);
        if self.flushed.elapsed() >= FLUSH_EVERY {
            writer.flush().map_err(|e| file::write_error(&self.name, &e))?;
            self.flushed = Instant::now();
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        match self.writer.take() {
            Some(mut writer) => writer.flush().map_err(|e| file::write_error(&self.name, &e)),
            None => Ok(()),
        }
    }
}

fn error(name: &str, e: ::csv::Error) -> Error {
    match e.into_kind() {
        ::csv::ErrorKind::Io(source) => file::write_error(name, &source),
        other => file::write_error(name, &io::Error::other(format!("{other:?}"))),
    }
}
