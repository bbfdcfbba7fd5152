//! Fewest and most instructions of a call, over many states.

use crate::board::Board;

/// A spread of counts.
#[derive(Clone, Copy, Debug)]
pub struct Count {
    pub least: u32,
    pub most: u32,
}

impl Count {
    pub const NONE: Self = Self { least: u32::MAX, most: 0 };

    /// Counts one call more; what reading the timer costs is taken off.
    #[inline(always)]
    pub fn add(&mut self, board: &Board, f: impl FnOnce()) {
        let empty = board.instructions(|| ());
        let n = board.instructions(f).saturating_sub(empty);
        self.least = self.least.min(n);
        self.most = self.most.max(n);
    }
}
