//! Numbers that hold one state or several side by side.

use gyroflex::{Lanes, Scalar};

/// A scalar that takes its lanes from as many states.
pub trait Lane: Scalar + 'static {
    /// How many states it holds.
    const WIDTH: usize;

    /// One number of each state.
    fn gather(states: impl Fn(usize) -> f64) -> Self;

    /// The number of one of the states.
    fn lane(self, i: usize) -> f64;
}

macro_rules! one_state {
    ($($float:ident),*) => {$(
        impl Lane for $float {
            const WIDTH: usize = 1;

            fn gather(states: impl Fn(usize) -> f64) -> Self {
                states(0) as Self
            }

            fn lane(self, _: usize) -> f64 {
                f64::from(self)
            }
        }
    )*};
}
one_state!(f32, f64);

macro_rules! states_side_by_side {
    ($($float:ident),*) => {$(
        impl<const N: usize> Lane for Lanes<$float, N> {
            const WIDTH: usize = N;

            fn gather(states: impl Fn(usize) -> f64) -> Self {
                Self(std::array::from_fn(|i| states(i) as $float))
            }

            fn lane(self, i: usize) -> f64 {
                f64::from(self.0[i])
            }
        }
    )*};
}
states_side_by_side!(f32, f64);
