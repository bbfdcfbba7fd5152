//! Which instructions an algorithm runs on.
//!
//! A program built for any x86-64 must not use the fused multiplication and the wide registers that nearly every x86-64
//! has. So an algorithm is a [`Kernel`], compiled once for the plain instruction set and once for each richer one in the
//! arithmetic [`Fused`], and [`Scalar::dispatch`] takes the best the machine has at the outermost call. A build that
//! names its processor (`-C target-cpu`), another architecture or a build without `std` runs the one kernel it has.

use crate::Scalar;
use crate::scalar::Fusible;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Arithmetic over numbers that are kept as `T`.
pub trait Over<T: Scalar>: Scalar<Param = T::Param> {
    /// Takes a kept number.
    fn load(x: T) -> Self;
    /// Gives a number to keep.
    fn store(self) -> T;
}

impl<T: Scalar> Over<T> for T {
    #[inline(always)]
    fn load(x: T) -> Self {
        x
    }
    #[inline(always)]
    fn store(self) -> T {
        self
    }
}

/// An algorithm with its arguments, whose numbers are kept as `T` and computed with in any arithmetic over `T`.
pub trait Kernel<T: Scalar> {
    /// What it returns.
    type Output;
    /// Whether it is compiled for AVX-512 as well as for AVX2: kernels of which there are many, and that gain nothing from it, are not.
    const WIDE: bool = true;
    /// Runs it. Implementations are inlined, down to the last operation, into code compiled for the processor.
    fn run<F: Over<T>>(self) -> Self::Output;
}

#[cfg(all(feature = "std", target_arch = "x86_64", not(target_feature = "fma")))]
mod x86_64 {
    use super::{Fused, Kernel};
    use crate::scalar::Fusible;
    use core::marker::PhantomData;
    use pulp::{NullaryFnOnce, Simd, x86};

    struct InFused<K, T>(K, PhantomData<T>);

    impl<T: Fusible, K: Kernel<T>> NullaryFnOnce for InFused<K, T> {
        type Output = K::Output;
        #[inline(always)]
        fn call(self) -> K::Output {
            self.0.run::<Fused<T>>()
        }
    }

    /// With AVX-512, or with AVX2 and FMA, where the processor has them.
    #[inline(always)]
    pub fn on_best_instructions<T: Fusible, K: Kernel<T>>(kernel: K) -> K::Output {
        if K::WIDE
            && let Some(v4) = x86::V4::try_new()
        {
            Simd::vectorize(v4, InFused(kernel, PhantomData))
        } else if let Some(v3) = x86::V3::try_new() {
            Simd::vectorize(v3, InFused(kernel, PhantomData))
        } else {
            kernel.run::<T>()
        }
    }

    /// What [`on_best_instructions`] takes on this machine.
    pub fn chosen_instructions() -> Option<&'static str> {
        if x86::V4::try_new().is_some() {
            Some("AVX-512")
        } else if x86::V3::try_new().is_some() {
            Some("AVX2 and FMA")
        } else {
            None
        }
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64", not(target_feature = "fma")))]
pub(crate) use x86_64::on_best_instructions;

/// The instructions that algorithms choose at run time on this machine; `None` where they run on those that the program is
/// compiled for.
pub fn chosen_instructions() -> Option<&'static str> {
    #[cfg(all(feature = "std", target_arch = "x86_64", not(target_feature = "fma")))]
    return x86_64::chosen_instructions();
    #[cfg(not(all(feature = "std", target_arch = "x86_64", not(target_feature = "fma"))))]
    None
}

/// With the instructions this program is compiled for.
#[cfg(not(all(feature = "std", target_arch = "x86_64", not(target_feature = "fma"))))]
#[inline(always)]
pub(crate) fn on_best_instructions<T: Scalar, K: Kernel<T>>(kernel: K) -> K::Output {
    kernel.run::<T>()
}

/// `T` with fused multiplication and addition. Only code compiled for processors that have it computes in this type.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Fused<T>(pub T);

impl<T: Fusible> Over<T> for Fused<T> {
    #[inline(always)]
    fn load(x: T) -> Self {
        Self(x)
    }
    #[inline(always)]
    fn store(self) -> T {
        self.0
    }
}

impl<T: Fusible> Scalar for Fused<T> {
    type Param = T::Param;

    #[inline(always)]
    fn from_param(x: T::Param) -> Self {
        Self(T::from_param(x))
    }
    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self(T::from_f64(x))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.fused_mul_add(factor.0, addend.0))
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0.fused_sin_cos();
        (Self(s), Self(c))
    }
    #[inline(always)]
    fn sin_cos_each(angle: impl Fn(usize) -> Self, mut keep: impl FnMut(usize, Self, Self)) {
        T::fused_sin_cos_each(
            #[inline(always)]
            |i| angle(i).0,
            #[inline(always)]
            |i, sin, cos| keep(i, Self(sin), Self(cos)),
        );
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        Self(self.0.tanh())
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Self(self.0.exp())
    }
    #[inline(always)]
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
        Self(self.0.select_less(threshold.0, less.0, otherwise.0))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl<T: Fusible> $trait for Fused<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                Self($trait::$method(self.0, b.0))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl<T: Fusible> Neg for Fused<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
impl<T: Fusible> AddAssign for Fused<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        self.0 += b.0;
    }
}
impl<T: Fusible> SubAssign for Fused<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        self.0 -= b.0;
    }
}
