//! Where a simulation's samples go: memory, MCAP, CSV.
//!
//! A [`Recorder`] takes one [`Sample`] after the other. All of them know a sample as the same named columns
//! ([`Column`]), which are also what [`read_states`] gives back from a log.

mod cdr;
mod columns;
mod csv;
mod file;
mod info;
mod mcap;
mod memory;
mod proto;
mod quaternion;
mod read;
mod ros;
mod sample;
mod tee;

pub use self::columns::{Column, Table, columns};
pub use self::csv::CsvRecorder;
pub use self::info::RunInfo;
pub use self::mcap::{ChunkLimits, McapRecorder};
pub use self::memory::MemoryRecorder;
pub use self::read::{StateLog, read_states};
pub use self::sample::{Footing, Impact, Sample, Struck, Touch};
pub use self::tee::TeeRecorder;

use crate::error::Error;

/// Takes the samples of one run.
pub trait Recorder {
    /// Takes one sample; times never decrease.
    ///
    /// # Errors
    /// When the sample cannot be written; what was written before is safe.
    fn record(&mut self, sample: &Sample) -> Result<(), Error>;

    /// Takes an impact that happened since the last sample; most recorders have no use for it.
    ///
    /// # Errors
    /// When it cannot be written.
    fn impact(&mut self, _impact: &Impact) -> Result<(), Error> {
        Ok(())
    }

    /// Completes the record. Called once, also after a run that was interrupted or diverged.
    ///
    /// # Errors
    /// When the end of the record cannot be written.
    fn finish(&mut self) -> Result<(), Error>;
}

impl<R: Recorder + ?Sized> Recorder for &mut R {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        (**self).record(sample)
    }

    fn impact(&mut self, impact: &Impact) -> Result<(), Error> {
        (**self).impact(impact)
    }

    fn finish(&mut self) -> Result<(), Error> {
        (**self).finish()
    }
}

impl<R: Recorder + ?Sized> Recorder for Box<R> {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        (**self).record(sample)
    }

    fn impact(&mut self, impact: &Impact) -> Result<(), Error> {
        (**self).impact(impact)
    }

    fn finish(&mut self) -> Result<(), Error> {
        (**self).finish()
    }
}
