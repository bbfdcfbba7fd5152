//! Numbers as text that reads back as the same bits.

use super::Precision;

/// The shortest decimal form of a finite number in a precision, with a point or an exponent, as C, Rust and Python read it.
pub(super) fn literal(x: f64, precision: Precision) -> String {
    match precision {
        Precision::Single => format!("{:?}", x as f32),
        Precision::Double => format!("{x:?}"),
    }
}

/// Whether a number is one in a precision, and not infinite or nothing.
pub(super) fn is_finite(x: f64, precision: Precision) -> bool {
    match precision {
        Precision::Single => (x as f32).is_finite(),
        Precision::Double => x.is_finite(),
    }
}
