//! Numbers as text that reads back as the same bits.

use super::Precision;

/// The shortest decimal form of a number in a precision, with a point or an exponent, as C, Rust and Python read it.
pub(super) fn literal(x: f64, precision: Precision) -> String {
    match precision {
        Precision::Single => format!("{:?}", x as f32),
        Precision::Double => format!("{x:?}"),
    }
}
