//! The numbers that arrays hold, and the lanes they are computed in.

use gyroflex::{Lanes, Scalar};

/// `f32` or `f64`.
pub trait Real: Scalar<Param = Self> + Into<f64> + Send + Sync + 'static {
    /// Several states side by side.
    type Lanes: Scalar<Param = Self> + Send;
    /// How many states are side by side.
    const LANES: usize;

    /// The number of each state.
    fn each(lanes: &Self::Lanes) -> &[Self];

    /// The number of each state.
    fn each_mut(lanes: &mut Self::Lanes) -> &mut [Self];
}

macro_rules! real {
    ($float:ident, $lanes:literal) => {
        impl Real for $float {
            type Lanes = Lanes<$float, $lanes>;
            const LANES: usize = $lanes;

            fn each(lanes: &Self::Lanes) -> &[Self] {
                &lanes.0
            }
            fn each_mut(lanes: &mut Self::Lanes) -> &mut [Self] {
                &mut lanes.0
            }
        }
    };
}
real!(f64, 8);
// Of sixteen, the compiler no longer keeps all in registers: they take longer than twice eight.
real!(f32, 8);
