//! Runs on several threads, handed on in their order.

use super::{Measures, is_of_the_run};
use crate::error::Error;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

/// What came of a run: its numbers, or why it has none.
pub type Outcome = Result<Measures, Error>;

/// Runs on `threads` threads, each taking the next run when it is free, so that few outcomes wait for earlier ones to be handed on.
/// Ends early when `run` says `None`, in which case the runs before are handed on as far as there is no gap.
///
/// # Errors
/// The first error that is not about one run alone ([`is_of_the_run`]), and what `take` refuses.
pub fn run_in_order(
    runs: Range<usize>,
    threads: usize,
    run: &(dyn Fn(usize) -> Option<Outcome> + Sync),
    take: &mut dyn FnMut(usize, Outcome) -> Result<(), Error>,
) -> Result<(), Error> {
    let (next, end) = (AtomicUsize::new(runs.start), AtomicUsize::new(runs.end));
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, runs.len().max(1)) {
            let (send, next, end) = (send.clone(), &next, &end);
            scope.spawn(move || {
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    if i >= end.load(Ordering::Relaxed) {
                        break;
                    }
                    let Some(outcome) = run(i) else { break };
                    if send.send((i, outcome)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        let (mut waiting, mut due) = (BTreeMap::new(), runs.start);
        for (i, outcome) in receive {
            waiting.insert(i, outcome);
            while let Some(outcome) = waiting.remove(&due) {
                let taken = match outcome {
                    Err(error) if !is_of_the_run(&error) => Err(error),
                    outcome => take(due, outcome),
                };
                // No thread begins another run after an error.
                taken.inspect_err(|_| end.store(0, Ordering::Relaxed))?;
                due += 1;
            }
        }
        Ok(())
    })
}
