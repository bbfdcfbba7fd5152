//! The record kept in memory: what a caller in Rust or Python works with, and what files are tested against.

use super::columns::Table;
use super::{Impact, Recorder, RunInfo, Sample};
use crate::error::Error;

/// Keeps every sample and every impact.
#[derive(Clone, Debug, Default)]
pub struct MemoryRecorder {
    info: RunInfo,
    samples: Vec<Sample>,
    impacts: Vec<Impact>,
}

impl MemoryRecorder {
    /// An empty record of a run.
    pub fn new(info: RunInfo) -> Self {
        Self { info, samples: Vec::new(), impacts: Vec::new() }
    }

    /// What is fixed for the run.
    pub fn info(&self) -> &RunInfo {
        &self.info
    }

    /// The samples so far, in order of time.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The impacts so far, in order of time.
    pub fn impacts(&self) -> &[Impact] {
        &self.impacts
    }

    /// The samples as named columns (see [`columns`](super::columns())).
    pub fn table(&self) -> Table {
        let mut table = Table::new(&self.info);
        self.samples.iter().for_each(|s| table.push(s));
        table
    }
}

impl Recorder for MemoryRecorder {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        sample.check(&self.info, self.samples.last().map(|s| s.t))?;
        self.samples.push(sample.clone());
        Ok(())
    }

    fn impact(&mut self, impact: &Impact) -> Result<(), Error> {
        impact.check(&self.info, self.samples.last().map(|s| s.t))?;
        self.impacts.push(impact.clone());
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        Ok(())
    }
}
