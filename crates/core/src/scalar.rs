//! The number type every algorithm is generic over.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number as the algorithms see it: arithmetic, a handful of elementary functions, no ordering.
///
/// Leaving the ordering out is what lets dual numbers, truncated Taylor series, lanes of several states and
/// symbolic expressions run the same source as `f32` and `f64`. Where a law is piecewise (a spring table), the
/// choice is made by [`Scalar::select_less`], which such types can evaluate without a branch.
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The constant `x`, rounded to this type.
    fn from_f64(x: f64) -> Self;
    /// Square root of a non-negative number.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle [rad].
    fn sin_cos(self) -> (Self, Self);
    /// Angle [rad] of the point with ordinate `self` and abscissa `x`, in `(−π, π]`.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// `less` where `self < threshold`, else `otherwise`, lane by lane, without a branch.
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self;

    /// Zero.
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    /// One.
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

macro_rules! float_scalar {
    ($float:ident, $sqrt:path, $sin:path, $cos:path, $atan2:path, $tanh:path, $exp:path) => {
        impl Scalar for $float {
            #[inline]
            fn from_f64(x: f64) -> Self {
                x as $float
            }
            #[inline]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                ($sin(self), $cos(self))
            }
            #[inline]
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            #[inline]
            fn tanh(self) -> Self {
                $tanh(self)
            }
            #[inline]
            fn exp(self) -> Self {
                $exp(self)
            }
            #[inline]
            fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
                if self < threshold { less } else { otherwise }
            }
        }
    };
}

#[cfg(feature = "std")]
mod elementary {
    use super::Scalar;
    float_scalar!(f32, f32::sqrt, f32::sin, f32::cos, f32::atan2, f32::tanh, f32::exp);
    float_scalar!(f64, f64::sqrt, f64::sin, f64::cos, f64::atan2, f64::tanh, f64::exp);
}

#[cfg(all(feature = "libm", not(feature = "std")))]
mod elementary {
    use super::Scalar;
    float_scalar!(f32, libm::sqrtf, libm::sinf, libm::cosf, libm::atan2f, libm::tanhf, libm::expf);
    float_scalar!(f64, libm::sqrt, libm::sin, libm::cos, libm::atan2, libm::tanh, libm::exp);
}

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("gyroflex needs elementary functions: enable the feature `std` (default) or `libm`");
