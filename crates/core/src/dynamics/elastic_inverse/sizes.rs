//! How many Taylor coefficients there is code for: loops of a known length are what makes series fast.

/// The most.
pub(super) const LARGEST: usize = 24;

/// The next number of coefficients there is code for.
pub(super) const fn rounded(coefficients: usize) -> Option<usize> {
    match coefficients {
        0 | 1 => Some(1),
        2..=7 => Some(coefficients),
        8 | 9 => Some(9),
        10..=LARGEST => Some(LARGEST),
        _ => None,
    }
}

/// Runs a kernel for as many coefficients as are needed, or for the next larger number. Numbers beyond `MAX` are not compiled:
/// their condition is a constant. The largest, which hardly any robot needs, is not compiled for every instruction set.
macro_rules! with_size {
    ($needed:expr, $max:ident, $n:ident => $kernel:expr) => {
        $crate::dynamics::elastic_inverse::sizes::with_size!(@ $needed, $max, $n => $kernel, 1 2 3 4 5 6 7 9)
    };
    (@ $needed:expr, $max:ident, $n:ident => $kernel:expr, $($size:literal)*) => {
        match $needed {
            $(needed if const { $max <= $size } || needed <= $size => {
                const $n: usize = $size;
                T::dispatch($kernel)
            })*
            _ => {
                const $n: usize = $crate::dynamics::elastic_inverse::sizes::LARGEST;
                $kernel.run::<T>()
            }
        }
    };
}
pub(super) use with_size;
