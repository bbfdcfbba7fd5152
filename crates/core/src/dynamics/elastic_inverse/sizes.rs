//! How many Taylor coefficients there is code for: loops of a known length are what makes series fast.

/// The most.
pub(super) const LARGEST: usize = 24;

/// The next number of coefficients there is code for.
pub(super) const fn rounded(coefficients: usize) -> Option<usize> {
    match coefficients {
        0..=9 => Some(if coefficients == 0 { 1 } else { coefficients }),
        10..=12 => Some(12),
        13..=16 => Some(16),
        17..=LARGEST => Some(LARGEST),
        _ => None,
    }
}

/// Runs code for as many coefficients as are needed, or for the next larger number. Numbers beyond `MAX` are not compiled.
macro_rules! with_size {
    ($needed:expr, $max:ident, $n:ident => $run:expr) => {
        $crate::dynamics::elastic_inverse::sizes::with_size!(@ $needed, $max, $n => $run, 1 2 3 4 5 6 7 8 9 12 16)
    };
    (@ $needed:expr, $max:ident, $n:ident => $run:expr, $($size:literal)*) => {
        match $needed {
            $(needed if needed <= $size || $max <= $size => {
                const $n: usize = $size;
                $run
            })*
            _ => {
                const $n: usize = $crate::dynamics::elastic_inverse::sizes::LARGEST;
                $run
            }
        }
    };
}
pub(super) use with_size;
