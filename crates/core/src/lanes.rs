//! Several states side by side.

use crate::Scalar;
use crate::dispatch::{Fused, Kernel, on_best_instructions};
use crate::scalar::{ANGLES, Fusible};
use crate::trig;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The same number of `N` states, computed with at once: every operation is done lane by lane, and the compiler puts the
/// lanes into the wide registers of the processor. The states share the robot, whose numbers are of type `T`.
///
/// Eight lanes of `f64` fill the registers of AVX-512 once and those of AVX2 twice, and a line of the cache, to which they are
/// aligned: one that straddles two lines costs double. Of more than eight, of `f32` too, the compiler does not keep all in registers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes<T, const N: usize>(pub [T; N]);

impl<T: Copy, const N: usize> Lanes<T, N> {
    /// All lanes the same.
    #[inline(always)]
    pub fn splat(x: T) -> Self {
        Self([x; N])
    }

    // Loops, not adapters of the standard library: those are not always inlined into code compiled for the processor.
    #[inline(always)]
    fn each(mut self, f: impl Fn(T) -> T) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i]);
        }
        self
    }

    #[inline(always)]
    fn zip(mut self, b: Self, f: impl Fn(T, T) -> T) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i], b.0[i]);
        }
        self
    }

    #[inline(always)]
    fn zip3(mut self, b: Self, c: Self, f: impl Fn(T, T, T) -> T) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i], b.0[i], c.0[i]);
        }
        self
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl<T: Scalar, const N: usize> $trait for Lanes<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                self.zip(b, $trait::$method)
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl<T: Scalar, const N: usize> Neg for Lanes<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.each(T::neg)
    }
}
impl<T: Scalar, const N: usize> AddAssign for Lanes<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl<T: Scalar, const N: usize> SubAssign for Lanes<T, N> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

macro_rules! lanes_of {
    ($float:ident, $trig:ident) => {
        impl<const N: usize> Scalar for Lanes<$float, N> {
            type Param = $float;

            #[inline(always)]
            fn from_param(x: $float) -> Self {
                Self::splat(x)
            }
            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                Self::splat(x as $float)
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                self.zip3(factor, addend, Scalar::mul_add)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                self.0.iter().all(|x| Scalar::is_finite(*x))
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.each(Scalar::sqrt)
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = trig::$trig::sin_cos(|i| self.0[i]);
                (Self(sin), Self(cos))
            }
            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                self.zip(x, Scalar::atan2)
            }
            #[inline(always)]
            fn tanh(self) -> Self {
                self.each(Scalar::tanh)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                self.each(Scalar::exp)
            }
            #[inline(always)]
            fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
                let mut out = otherwise;
                for i in 0..N {
                    out.0[i] = self.0[i].select_less(threshold.0[i], less.0[i], otherwise.0[i]);
                }
                out
            }
            #[inline(always)]
            fn dispatch<K: Kernel<Self>>(kernel: K) -> K::Output {
                on_best_instructions(kernel)
            }
        }

        impl<const N: usize> Fusible for Lanes<$float, N> {
            #[inline(always)]
            fn fused_mul_add(self, factor: Self, addend: Self) -> Self {
                self.zip3(factor, addend, Fusible::fused_mul_add)
            }
            #[inline(always)]
            fn fused_sin_cos(self) -> (Self, Self) {
                let (sin, cos) = trig::$trig::sin_cos_in::<Fused<$float>, N>(|i| self.0[i]);
                (Self(sin), Self(cos))
            }
            #[inline(always)]
            fn fused_sin_cos_each(angle: impl Fn(usize) -> Self, mut keep: impl FnMut(usize, Self, Self)) {
                for i in 0..ANGLES {
                    let (sin, cos) = angle(i).fused_sin_cos();
                    keep(i, sin, cos);
                }
            }
        }
    };
}
lanes_of!(f64, double);
lanes_of!(f32, single);
