//! Plain numbers.

use crate::Scalar;

/// A plain number, `f32` or `f64`: motions are piecewise in time, which needs an ordering.
pub trait Real: Scalar<Param = Self> + PartialOrd {
    /// The largest whole number not above it; 0 where it is negative or not a number.
    fn whole(self) -> usize;

    /// A whole number as one of these.
    #[inline(always)]
    fn of(n: usize) -> Self {
        Self::from_f64(n as f64)
    }

    /// Neither infinite nor undefined.
    #[inline(always)]
    fn finite(self) -> bool {
        self * Self::zero() == Self::zero()
    }

    /// Finite and above zero.
    #[inline(always)]
    fn positive(self) -> bool {
        self.finite() && self > Self::zero()
    }
}

impl Real for f32 {
    #[inline(always)]
    fn whole(self) -> usize {
        self as usize
    }
}

impl Real for f64 {
    #[inline(always)]
    fn whole(self) -> usize {
        self as usize
    }
}
