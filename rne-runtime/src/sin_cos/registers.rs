//! SIMD registers of `wide`, as wide as the compiled target has them.
//!
//! Written out as registers rather than left to LLVM's vectorisers: those succeed or fail with the code around the
//! kernel.

use bytemuck::cast;

use super::Lanes;
// registers are of x86 and AArch64, which fuse both types or none
use super::FUSED_F64 as FUSED;

/// Lanes that are filled from an array and written to one.
pub trait Register: Lanes {
    const LANES: usize;

    /// The numbers from `start` on; zeros beyond the last.
    fn padded<const N: usize>(numbers: &[Self::Element; N], start: usize) -> Self;

    /// Writes the lanes to `numbers` from `start` on, as far as there are some.
    fn write<const N: usize>(self, numbers: &mut [Self::Element; N], start: usize);

    /// Whether the kernel is correct for all of these angles.
    fn are_within_limit(angles: &[Self]) -> bool;
}

macro_rules! register {
    ($Register:ident, $Bits:ident, [$element:ident; $N:literal], sign: $SIGN:literal) => {
        impl Lanes for wide::$Register {
            type Element = $element;

            const FUSED: bool = FUSED;

            #[inline(always)]
            fn splat(element: $element) -> Self {
                Self::splat(element)
            }

            #[inline(always)]
            fn plus_product(self, a: Self, b: Self) -> Self {
                if FUSED { a.mul_add(b, self) } else { self + a * b }
            }

            #[inline(always)]
            fn minus_product(self, a: Self, b: Self) -> Self {
                if FUSED { a.mul_neg_add(b, self) } else { self - a * b }
            }

            #[inline(always)]
            fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let [n, sine, cosine]: [wide::$Bits; 3] = [cast(rounded), cast(sine), cast(cosine)];
                let [zero, one, two] = [0, 1, 2].map(wide::$Bits::splat);
                let exchange = (sine ^ cosine) & (zero - (n & one));
                (
                    cast(sine ^ exchange ^ ((n & two) << ($SIGN - 1))),
                    cast(cosine ^ exchange ^ (((n + one) & two) << ($SIGN - 1))),
                )
            }
        }

        impl Register for wide::$Register {
            const LANES: usize = $N;

            #[inline(always)]
            fn padded<const N: usize>(numbers: &[$element; N], start: usize) -> Self {
                let mut lanes = [0.0; $N];
                for (lane, index) in lanes.iter_mut().zip(start..N) {
                    *lane = numbers[index];
                }
                Self::new(lanes)
            }

            #[inline(always)]
            fn write<const N: usize>(self, numbers: &mut [$element; N], start: usize) {
                for (lane, index) in self.to_array().into_iter().zip(start..N) {
                    numbers[index] = lane;
                }
            }

            #[inline(always)]
            fn are_within_limit(angles: &[Self]) -> bool {
                let limit = Self::splat(super::LIMIT.into());
                let within = |angle: &Self| angle.abs().simd_le(limit);
                let Some((first, others)) = angles.split_first() else { return true };
                others.iter().fold(within(first), |all, angle| all & within(angle)).all()
            }
        }
    };
}
register!(f64x4, u64x4, [f64; 4], sign: 63);
register!(f64x2, u64x2, [f64; 2], sign: 63);
register!(f32x8, u32x8, [f32; 8], sign: 31);
register!(f32x4, u32x4, [f32; 4], sign: 31);
