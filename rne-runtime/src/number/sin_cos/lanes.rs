//! One number or a register of numbers, with which the kernel of sine and cosine computes.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{FUSED_F32, FUSED_F64, Float};

/// `f64`, `f32` and, with `std`, SIMD registers of these.
pub trait Lanes:
    Copy + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    type Element: Float;

    /// Whether [`plus_product`](Self::plus_product) and [`minus_product`](Self::minus_product) round once.
    const FUSED: bool;

    /// Whether registers are computed one after another, so that the number of operations decides and not the length of
    /// their chain. Only used by code that is [fused](Self::FUSED).
    const MANY: bool = false;

    /// Returns lanes that all contain one number.
    fn splat(element: Self::Element) -> Self;

    /// `self + a * b`
    fn plus_product(self, a: Self, b: Self) -> Self;

    /// `self - a * b`
    fn minus_product(self, a: Self, b: Self) -> Self;

    /// Returns sine and cosine of x from those of x - n π/2. The two lowest bits of `rounded` contain n modulo 4.
    ///
    /// | n mod 4 | sine of x | cosine of x |
    /// |---|---|---|
    /// | 0 | sine | cosine |
    /// | 1 | cosine | -sine |
    /// | 2 | -sine | -cosine |
    /// | 3 | -cosine | sine |
    ///
    /// The lowest bit of n exchanges sine and cosine. The second lowest bit of n negates the sine of x, that of n + 1
    /// its cosine. These are bit operations and not branches, because neighbouring angles are in different quadrants.
    fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self);
}

macro_rules! number {
    ($type:ident, fused: $FUSED:ident, sign: $SIGN:literal) => {
        impl Lanes for $type {
            type Element = $type;

            const FUSED: bool = $FUSED;

            #[inline(always)]
            fn splat(element: $type) -> Self {
                element
            }

            #[inline(always)]
            fn plus_product(self, a: Self, b: Self) -> Self {
                #[cfg(feature = "std")]
                if $FUSED {
                    return a.mul_add(b, self);
                }
                #[cfg(all(feature = "core_float_math", not(feature = "std")))]
                if $FUSED {
                    return core::$type::math::mul_add(a, b, self);
                }
                self + a * b
            }

            #[inline(always)]
            fn minus_product(self, a: Self, b: Self) -> Self {
                if $FUSED { self.plus_product(-a, b) } else { self - a * b }
            }

            #[inline(always)]
            fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let (n, sine, cosine) = (rounded.to_bits(), sine.to_bits(), cosine.to_bits());
                let exchange = (sine ^ cosine) & (n & 1).wrapping_neg();
                (
                    Self::from_bits(sine ^ exchange ^ ((n & 2) << ($SIGN - 1))),
                    Self::from_bits(cosine ^ exchange ^ ((n.wrapping_add(1) & 2) << ($SIGN - 1))),
                )
            }
        }
    };
}
number!(f64, fused: FUSED_F64, sign: 63);
number!(f32, fused: FUSED_F32, sign: 31);
