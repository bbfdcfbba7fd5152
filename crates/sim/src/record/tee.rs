//! Several recorders at once.

use super::{Impact, Recorder, Sample};
use crate::error::Error;

/// Hands every sample to all of its recorders.
#[derive(Default)]
pub struct TeeRecorder<'a> {
    recorders: Vec<Box<dyn Recorder + 'a>>,
}

impl<'a> TeeRecorder<'a> {
    /// No recorder yet: samples go nowhere.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a recorder; `&mut R` is one too, for a caller who wants his recorder back.
    #[must_use]
    pub fn with(mut self, recorder: impl Recorder + 'a) -> Self {
        self.recorders.push(Box::new(recorder));
        self
    }

    /// Whether there is no recorder.
    pub fn is_empty(&self) -> bool {
        self.recorders.is_empty()
    }

    /// Calls all of them, also after one has failed: a full disk must not cost the record kept elsewhere.
    fn all(&mut self, mut call: impl FnMut(&mut dyn Recorder) -> Result<(), Error>) -> Result<(), Error> {
        let mut result = Ok(());
        for recorder in &mut self.recorders {
            result = result.and(call(recorder.as_mut()));
        }
        result
    }
}

impl Recorder for TeeRecorder<'_> {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        self.all(|r| r.record(sample))
    }

    fn impact(&mut self, impact: &Impact) -> Result<(), Error> {
        self.all(|r| r.impact(impact))
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.all(|r| r.finish())
    }
}
