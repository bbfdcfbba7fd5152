//! The number type every algorithm is generic over.

use crate::dispatch::Kernel;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// How many angles [`Scalar::sin_cos_each`] takes at a time.
pub const ANGLES: usize = 4;

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
    /// What the numbers of a robot's model are while its state is of this type: `f64` for `f64`, and for several states
    /// side by side, which share the robot.
    type Param: Scalar<Param = Self::Param>;

    /// A number of the model.
    fn from_param(x: Self::Param) -> Self;
    /// The constant `x`, rounded to this type.
    fn from_f64(x: f64) -> Self;
    /// `self · factor + addend`: with one rounding where the processor has an instruction for it, with two elsewhere, never
    /// by a subroutine.
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    /// Whether it is a number, and not infinite, in all its parts. What has no value, as a symbol, is.
    fn is_finite(self) -> bool;
    /// Square root of a non-negative number.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle [rad].
    fn sin_cos(self) -> (Self, Self);
    /// Sines and cosines of several angles [rad], which many processors compute side by side: `keep` gets those of `angle(i)`.
    #[inline(always)]
    fn sin_cos_each(angle: impl Fn(usize) -> Self, mut keep: impl FnMut(usize, Self, Self)) {
        for i in 0..ANGLES {
            let (sin, cos) = angle(i).sin_cos();
            keep(i, sin, cos);
        }
    }
    /// Angle [rad] of the point with ordinate `self` and abscissa `x`, in `(−π, π]`.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// `less` where `self < threshold`, else `otherwise`, lane by lane, without a branch.
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self;

    /// Runs an algorithm over numbers of this type in the best arithmetic of the machine at hand.
    #[inline(always)]
    fn dispatch<K: Kernel<Self>>(kernel: K) -> K::Output {
        kernel.run::<Self>()
    }

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

/// A scalar whose processor may have an instruction for `a · b + c` that only part of a program is compiled for.
pub trait Fusible: Scalar {
    /// `self · factor + addend` with one rounding. Fast only inside code compiled for processors that have it.
    fn fused_mul_add(self, factor: Self, addend: Self) -> Self;
    /// [`Scalar::sin_cos`] with it.
    fn fused_sin_cos(self) -> (Self, Self);
    /// [`Scalar::sin_cos_each`] with it.
    fn fused_sin_cos_each(angle: impl Fn(usize) -> Self, keep: impl FnMut(usize, Self, Self));
}

macro_rules! float_scalar {
    ($float:ident, $trig:ident, $fma:path, $sqrt:path, $atan2:path, $tanh:path, $exp:path) => {
        impl Scalar for $float {
            type Param = Self;

            #[inline(always)]
            fn from_param(x: Self) -> Self {
                x
            }
            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $float
            }
            #[inline(always)]
            #[cfg(all(feature = "std", any(target_feature = "fma", target_arch = "aarch64")))]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                self.fused_mul_add(factor, addend)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let ([sin], [cos]) = crate::trig::$trig::sin_cos(|_| self);
                (sin, cos)
            }
            #[inline(always)]
            fn sin_cos_each(angle: impl Fn(usize) -> Self, mut keep: impl FnMut(usize, Self, Self)) {
                let (sin, cos) = crate::trig::$trig::sin_cos::<ANGLES>(angle);
                for i in 0..ANGLES {
                    keep(i, sin[i], cos[i]);
                }
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
            #[inline(always)]
            fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
                if self < threshold { less } else { otherwise }
            }
            #[inline(always)]
            fn dispatch<K: Kernel<Self>>(kernel: K) -> K::Output {
                crate::dispatch::on_best_instructions(kernel)
            }
        }

        impl Fusible for $float {
            #[inline(always)]
            fn fused_mul_add(self, factor: Self, addend: Self) -> Self {
                $fma(self, factor, addend)
            }
            #[inline(always)]
            fn fused_sin_cos(self) -> (Self, Self) {
                let ([sin], [cos]) = crate::trig::$trig::sin_cos_in::<crate::dispatch::Fused<Self>, 1>(|_| self);
                (sin, cos)
            }
            #[inline(always)]
            fn fused_sin_cos_each(angle: impl Fn(usize) -> Self, mut keep: impl FnMut(usize, Self, Self)) {
                let (sin, cos) = crate::trig::$trig::sin_cos_in::<crate::dispatch::Fused<Self>, ANGLES>(angle);
                for i in 0..ANGLES {
                    keep(i, sin[i], cos[i]);
                }
            }
        }
    };
}

#[cfg(feature = "std")]
mod elementary {
    use super::{ANGLES, Fusible, Kernel, Scalar};
    float_scalar!(f32, single, f32::mul_add, f32::sqrt, f32::atan2, f32::tanh, f32::exp);
    float_scalar!(f64, double, f64::mul_add, f64::sqrt, f64::atan2, f64::tanh, f64::exp);
}

#[cfg(all(feature = "libm", not(feature = "std")))]
mod elementary {
    use super::{ANGLES, Fusible, Kernel, Scalar};

    /// Without `std` the language offers no fused instruction.
    #[inline(always)]
    fn two_roundings<T: Scalar>(a: T, b: T, c: T) -> T {
        a * b + c
    }

    #[cfg(feature = "nightly")]
    use core::f32::math::sqrt as sqrtf;
    #[cfg(not(feature = "nightly"))]
    use libm::sqrtf;

    float_scalar!(f32, single, two_roundings, sqrtf, libm::atan2f, libm::tanhf, libm::expf);
    float_scalar!(f64, double, two_roundings, libm::sqrt, libm::atan2, libm::tanh, libm::exp);
}

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("gyroflex needs elementary functions: enable the feature `std` (default) or `libm`");
