//! A bar that shows how far a command is, and a flag that asks it to end.

use crate::failure::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Positions of a bar, from nothing to done.
pub const STEPS: u64 = 1000;

/// A bar where somebody can see it.
pub fn progress_bar(hidden: bool, doing: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden());
    let style = ProgressStyle::with_template(&format!("{doing} {{bar:40}} {{percent:>3}} %  {{eta}} left"));
    let bar = bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    if !hidden {
        show(&bar);
    }
    bar
}

/// Makes a hidden bar visible.
pub fn show(bar: &ProgressBar) {
    bar.set_draw_target(ProgressDrawTarget::stderr());
}

/// Becomes true on Ctrl-C, or when the system asks the program to end. `to` says what the command does then.
pub fn stop_flag(quiet: bool, to: &str) -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    let installed = ctrlc::set_handler(move || raised.store(true, Ordering::Relaxed));
    if let (Err(e), false) = (installed, quiet) {
        say(&format!("warning: Ctrl-C will not {to}: {e}"));
    }
    flag
}
