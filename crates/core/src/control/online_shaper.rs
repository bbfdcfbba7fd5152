//! A shaper that runs at the rate of a controller.

use super::{Real, Shaper};

/// One impulse between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tap<T> {
    /// Whole samples of its delay.
    samples: usize,
    /// Amplitude at that sample.
    near: T,
    /// Amplitude at the sample before it.
    far: T,
}

/// A shaper for set points that arrive sample by sample, with its memory in storage of the caller's.
///
/// An impulse between two samples is split over them such that its delay is kept. The mean delay is then exact, its
/// spread is not: of a mode of `ω`, vibration of the order `(ω step)²` is left.
#[derive(Debug, PartialEq)]
pub struct OnlineShaper<'a, T, const N: usize> {
    taps: [Tap<T>; N],
    len: usize,
    memory: &'a mut [T],
    newest: usize,
}

/// Entries of `memory` that a shaper needs at a sampling time `step` [s].
pub fn memory_len<T: Real, const N: usize>(shaper: &Shaper<T, N>, step: T) -> usize {
    (shaper.duration() / step).whole().saturating_add(2)
}

impl<'a, T: Real, const N: usize> OnlineShaper<'a, T, N> {
    /// A shaper that rests at `position` [rad or m] and is asked every `step` > 0 [s]. `None` if `memory` is shorter than [`memory_len`] or a
    /// number makes no sense.
    pub fn new(shaper: &Shaper<T, N>, step: T, position: T, memory: &'a mut [T]) -> Option<Self> {
        if !step.positive() || !position.finite() || memory.len() < memory_len(shaper, step) {
            return None;
        }
        let mut taps = [Tap { samples: 0, near: T::zero(), far: T::zero() }; N];
        for (tap, impulse) in taps.iter_mut().zip(shaper.impulses()) {
            let delay = impulse.delay / step;
            let samples = delay.whole();
            let far = impulse.amplitude * (delay - T::of(samples));
            *tap = Tap { samples, near: impulse.amplitude - far, far };
        }
        memory.fill(position);
        Some(Self { taps, len: shaper.impulses().len(), memory, newest: 0 })
    }

    /// Takes the set point of this sample and gives the shaped one [rad or m].
    pub fn shape(&mut self, input: T) -> T {
        let count = self.memory.len();
        self.newest = if self.newest + 1 < count { self.newest + 1 } else { 0 };
        if let Some(slot) = self.memory.get_mut(self.newest) {
            *slot = input;
        }
        let before = |samples: usize| {
            let at = if samples <= self.newest { self.newest - samples } else { self.newest + count - samples };
            self.memory.get(at).map_or(T::zero(), |x| *x)
        };
        let taps = self.taps.iter().take(self.len);
        taps.fold(T::zero(), |sum, tap| sum + tap.near * before(tap.samples) + tap.far * before(tap.samples + 1))
    }
}
