//! Sine and cosine without a branch, so that several angles are computed side by side, and in the precision of the scalar
//! alone, so that `f32` needs no `f64`.
//!
//! The angle is brought into [−π/4, π/4] by subtracting a multiple of π/2 given in three parts, whose first two are short
//! enough for exact products (Cody and Waite 1980, chapter 8). There both functions are polynomials fitted at Chebyshev
//! points, with errors below half a rounding. Angles too large for three parts go to the elementary functions of the
//! platform.

use crate::dispatch::Over;

macro_rules! sin_cos {
    ($module:ident, $float:ident, $bits:ident, $far:path,
     limit $limit:literal, round $round:literal, half_pi [$p1:literal, $p2:literal, $p3:literal],
     sin [$($s:literal),*], cos [$($c:literal),*]) => {
        pub(crate) mod $module {
            use super::{Over, far};

            /// Sines and cosines of `N` angles [rad], to one unit in the last place of 1.
            #[inline(always)]
            pub(crate) fn sin_cos<const N: usize>(angle: impl Fn(usize) -> $float) -> ([$float; N], [$float; N]) {
                sin_cos_in::<$float, N>(angle)
            }

            /// The same in the arithmetic `F`.
            #[inline(always)]
            pub(crate) fn sin_cos_in<F: Over<$float>, const N: usize>(
                angle: impl Fn(usize) -> $float,
            ) -> ([$float; N], [$float; N]) {
                let (mut sin, mut cos) = ([0.0; N], [0.0; N]);
                let mut far = false;
                for i in 0..N {
                    let x = angle(i);
                    (sin[i], cos[i]) = near_zero::<F>(x);
                    // Infinity and what is not a number are far, too.
                    far |= is_far(x);
                }
                if far {
                    for i in 0..N {
                        let x = angle(i);
                        if is_far(x) {
                            (sin[i], cos[i]) = any_size(x);
                        }
                    }
                }
                (sin, cos)
            }

            #[inline(always)]
            fn is_far(x: $float) -> bool {
                let near = x.abs() <= $limit;
                !near
            }

            #[cold]
            #[inline(never)]
            fn any_size(x: $float) -> ($float, $float) {
                $far(x)
            }

            #[inline(always)]
            fn near_zero<F: Over<$float>>(x: $float) -> ($float, $float) {
                let muladd = |a: $float, b: $float, c: $float| F::load(a).mul_add(F::load(b), F::load(c)).store();
                // k = the integer next to x / (π/2); adding a number so large that its last place is 1 rounds, and leaves k in
                // the last bits.
                let shifted = muladd(x, core::$float::consts::FRAC_2_PI, $round);
                let k = shifted - $round;
                let quarter = shifted.to_bits();
                // r = x − k π/2
                let r = muladd(k, -$p3, muladd(k, -$p2, muladd(k, -$p1, x)));
                // sin r = r + r³ p(r²),   cos r = 1 − r²/2 + r⁴ p(r²)
                let z = r * r;
                let p = horner::<F>(z, &[$($s),*]);
                let sin = muladd(r * z, p, r);
                let p = horner::<F>(z, &[$($c),*]);
                let cos = muladd(z * z, p, muladd(z, -0.5, 1.0));
                // Odd quarter turns exchange the two; two bits of k give the signs.
                let odd = (0 as $bits).wrapping_sub(quarter & 1);
                let (s, c) = (sin.to_bits(), cos.to_bits());
                let (s, c) = ((s & !odd) | (c & odd), (c & !odd) | (s & odd));
                let sign = |bit: $bits| (bit & 2) << ($bits::BITS - 2);
                ($float::from_bits(s ^ sign(quarter)), $float::from_bits(c ^ sign(quarter.wrapping_add(1))))
            }

            #[inline(always)]
            fn horner<F: Over<$float>>(z: $float, c: &[$float]) -> $float {
                let mut p = F::zero();
                for (i, c) in c.iter().rev().enumerate() {
                    p = if i == 0 { F::load(*c) } else { p.mul_add(F::load(z), F::load(*c)) };
                }
                p.store()
            }
        }
    };
}

/// For angles beyond the limits below.
#[cfg(feature = "std")]
mod far {
    pub(super) fn double(x: f64) -> (f64, f64) {
        x.sin_cos()
    }
    pub(super) fn single(x: f32) -> (f32, f32) {
        x.sin_cos()
    }
}
#[cfg(not(feature = "std"))]
mod far {
    pub(super) use libm::{sincos as double, sincosf as single};
}

sin_cos!(
    double, f64, u64, far::double,
    limit 1e6, round 6755399441055744.0, half_pi [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21],
    sin [-0.16666666666666666, 0.008333333333330946, -0.0001984126983675497, 2.755731610068303e-6,
         -2.5051131455427946e-8, 1.591810123027412e-10],
    cos [0.041666666666666664, -0.0013888888888887395, 2.4801587298763433e-5, -2.7557317270560326e-7,
         2.0876146024689747e-9, -1.1382614868556325e-11]
);

sin_cos!(
    single, f32, u32, far::single,
    limit 1e4, round 12582912.0, half_pi [1.5703125, 0.0004837513, 7.54979e-8],
    sin [-0.16666664, 0.008332748, -0.00019587841],
    cos [0.041666664, -0.0013888302, 2.4547891e-5]
);
