//! The angle less a multiple of a right angle: x = n π/2 + y - e.
//!
//! After W. J. Cody and W. Waite, "Software Manual for the Elementary Functions" (1980): π/2 is a sum of parts so short
//! that their products with n have no rounding error, and the parts are subtracted from x one after the other, the
//! largest first. The rounding error of the subtraction of a later part is computed exactly as `(s - a) + b` for `s =
//! a - b` (Dekker's fast sum) and collected in e.

use core::f32::consts::FRAC_2_PI as FRAC_2_PI_F32;
use core::f64::consts::FRAC_2_PI as FRAC_2_PI_F64;

use super::Lanes;

/// A reduced angle: `head - excess` is x - n π/2.
#[derive(Debug)]
pub struct Reduced<V> {
    /// n modulo 4 in the two lowest bits of its representation.
    pub(super) rounded: V,
    pub(super) head: V,
    pub(super) excess: V,
}

/// For abs(x) ≤ 10⁵, where abs(n) < 2¹⁶.
///
/// The parts of π/2 are those of fdlibm's `__ieee754_rem_pio2` (`e_rem_pio2.c`): 33 + 33 + 53 bits.
#[inline(always)]
pub(super) fn double<V: Lanes<Element = f64>>(x: V) -> Reduced<V> {
    // 1.5 · 2⁵²: adding it rounds to an integer, which is then in the lowest bits of the sum.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    const PART_1: f64 = 1.570_796_326_734_125_6;
    const PART_2: f64 = 6.077_100_506_303_966e-11;
    const PART_3: f64 = 2.022_266_248_795_950_6e-21;

    let rounded = V::splat(ROUNDER).plus_product(x, V::splat(FRAC_2_PI_F64));
    let n = rounded - V::splat(ROUNDER);
    // Exact: both are multiples of 2⁻⁵³, or of more, and their difference is below 1.
    let x1 = x.minus_product(n, V::splat(PART_1));
    let (head, excess_2) = difference(x1, n, PART_2);
    Reduced { rounded, head, excess: excess_2.plus_product(n, V::splat(PART_3)) }
}

/// For abs(x) ≤ 10⁵, where abs(n) < 2¹⁶ and no `f32` is nearer to a multiple of π/2 than 4 · 10⁻⁹.
///
/// Five parts of at most 8 bits and one of 24: π/2 to 2⁻⁷³. None is negative, else a negative zero would not stay one.
#[inline(always)]
pub(super) fn single<V: Lanes<Element = f32>>(x: V) -> Reduced<V> {
    // 1.5 · 2²³, as above.
    const ROUNDER: f32 = 12_582_912.0;
    const PART_1: f32 = 1.570_312_5;
    const PART_2: f32 = 4.825_592e-4;
    const PART_3: f32 = 1.266_598_7e-6;
    const PART_4: f32 = 9.895_302e-10;
    const PART_5: f32 = 2.557_953_8e-12;
    const PART_6: f32 = 5.390_303e-15;

    let rounded = V::splat(ROUNDER).plus_product(x, V::splat(FRAC_2_PI_F32));
    let n = rounded - V::splat(ROUNDER);
    // Exact both: multiples of 2⁻²⁴, or of more, and below 1.
    let x1 = x.minus_product(n, V::splat(PART_1));
    let x2 = x1.minus_product(n, V::splat(PART_2));
    let (x3, excess_3) = difference(x2, n, PART_3);
    let (x4, excess_4) = difference(x3, n, PART_4);
    let (head, excess_5) = difference(x4, n, PART_5);
    let excess = (excess_3 + excess_4 + excess_5).plus_product(n, V::splat(PART_6));
    Reduced { rounded, head, excess }
}

/// Returns `a - n part` rounded, and its rounding error, by which it is too large. The product has no rounding error.
/// The error is exact if the product is not larger than a, or if the difference needs no rounding.
#[inline(always)]
fn difference<V: Lanes>(a: V, n: V, part: V::Element) -> (V, V) {
    let rounded = a.minus_product(n, V::splat(part));
    (rounded, (rounded - a).plus_product(n, V::splat(part)))
}
