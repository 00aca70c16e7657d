//! The registers of x86 processors.

#[cfg(target_arch = "x86")]
use core::arch::x86 as intrinsics;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64 as intrinsics;

/// The names that the table of a unit uses.
mod prelude {
    pub(super) use core::fmt;
    pub(super) use core::mem::transmute;
    pub(super) use core::ops::{Add, Div, Mul, Neg, Sub};

    pub(super) use super::super::register::register;
    pub(super) use super::intrinsics::*;
    pub(super) use crate::lanes::batch::vector::vector;
    pub(super) use crate::number::sin_cos::registers::Register;
    pub(super) use crate::number::sin_cos::{LIMIT, Lanes};
}

/// Registers of 256 bits, for AVX2 of the compiled target or detected at run time.
#[cfg(any(feature = "batch", all(target_feature = "avx2", target_feature = "fma")))]
macro_rules! avx2 {
    ($Unit:ty, many $MANY:literal) => {
        register! {
            Doubles: [f64; 4], __m256d, __m256i;
            unit $Unit, fused true, many $MANY;
            splat _mm256_set1_pd, _mm256_set1_epi64x;
            operators _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd;
            plus |c, a, b| _mm256_fmadd_pd(a, b, c);
            minus |c, a, b| _mm256_fnmadd_pd(a, b, c);
            bits _mm256_and_si256, _mm256_xor_si256, _mm256_add_epi64, _mm256_slli_epi64::<62>;
            odd |n, one, a, b| {
                let is_odd = _mm256_cmpeq_epi64(_mm256_and_si256(n, one), one);
                _mm256_blendv_pd(b, a, transmute::<__m256i, __m256d>(is_odd))
            };
            within |angle, sign, limit| _mm256_cmp_pd::<_CMP_LE_OQ>(_mm256_andnot_pd(sign, angle), limit);
            all _mm256_and_pd, |mask| _mm256_movemask_pd(mask) == 0b1111;
        }

        register! {
            Singles: [f32; 8], __m256, __m256i;
            unit $Unit, fused true, many $MANY;
            splat _mm256_set1_ps, _mm256_set1_epi32;
            operators _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps;
            plus |c, a, b| _mm256_fmadd_ps(a, b, c);
            minus |c, a, b| _mm256_fnmadd_ps(a, b, c);
            bits _mm256_and_si256, _mm256_xor_si256, _mm256_add_epi32, _mm256_slli_epi32::<30>;
            odd |n, one, a, b| {
                let is_odd = _mm256_cmpeq_epi32(_mm256_and_si256(n, one), one);
                _mm256_blendv_ps(b, a, transmute::<__m256i, __m256>(is_odd))
            };
            within |angle, sign, limit| _mm256_cmp_ps::<_CMP_LE_OQ>(_mm256_andnot_ps(sign, angle), limit);
            all _mm256_and_ps, |mask| _mm256_movemask_ps(mask) == 0b1111_1111;
        }
    };
}

/// AVX2 and fused multiply-add, detected at run time: for many states.
#[cfg(feature = "batch")]
pub(crate) mod avx2 {
    use super::prelude::*;
    use crate::lanes::registers::Avx2;

    avx2!(Avx2, many true);
}

/// AVX-512 F, BW, CD, DQ and VL, detected at run time.
#[cfg(feature = "batch")]
pub(crate) mod avx512 {
    use super::prelude::*;
    use crate::lanes::registers::Avx512;

    register! {
        Doubles: [f64; 8], __m512d, __m512i;
        unit Avx512, fused true, many true;
        splat _mm512_set1_pd, _mm512_set1_epi64;
        operators _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd;
        plus |c, a, b| _mm512_fmadd_pd(a, b, c);
        minus |c, a, b| _mm512_fnmadd_pd(a, b, c);
        bits _mm512_and_si512, _mm512_xor_si512, _mm512_add_epi64, _mm512_slli_epi64::<62>;
        odd |n, one, a, b| _mm512_mask_blend_pd(_mm512_test_epi64_mask(n, one), b, a);
    }

    register! {
        Singles: [f32; 16], __m512, __m512i;
        unit Avx512, fused true, many true;
        splat _mm512_set1_ps, _mm512_set1_epi32;
        operators _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps;
        plus |c, a, b| _mm512_fmadd_ps(a, b, c);
        minus |c, a, b| _mm512_fnmadd_ps(a, b, c);
        bits _mm512_and_si512, _mm512_xor_si512, _mm512_add_epi32, _mm512_slli_epi32::<30>;
        odd |n, one, a, b| _mm512_mask_blend_ps(_mm512_test_epi32_mask(n, one), b, a);
    }
}

/// AVX2 and fused multiply-add, for which the program is compiled.
#[cfg(all(target_feature = "avx2", target_feature = "fma"))]
pub(crate) mod compiled {
    use super::prelude::*;

    avx2!((), many false);
}

/// SSE2. The compiled target may have fused multiply-add in addition.
#[cfg(all(target_feature = "sse2", not(all(target_feature = "avx2", target_feature = "fma"))))]
pub(crate) mod compiled {
    use super::prelude::*;
    use crate::number::sin_cos::FUSED_F64 as FUSED;

    register! {
        Doubles: [f64; 2], __m128d, __m128i;
        unit (), fused FUSED, many false;
        splat _mm_set1_pd, _mm_set1_epi64x;
        operators _mm_add_pd, _mm_sub_pd, _mm_mul_pd, _mm_div_pd;
        plus |c, a, b| _mm_fmadd_pd(a, b, c);
        minus |c, a, b| _mm_fnmadd_pd(a, b, c);
        bits _mm_and_si128, _mm_xor_si128, _mm_add_epi64, _mm_slli_epi64::<62>;
        odd |n, one, a, b| {
            let is_odd = transmute::<__m128i, __m128d>(_mm_sub_epi64(_mm_setzero_si128(), _mm_and_si128(n, one)));
            _mm_xor_pd(b, _mm_and_pd(_mm_xor_pd(a, b), is_odd))
        };
        within |angle, sign, limit| _mm_cmple_pd(_mm_andnot_pd(sign, angle), limit);
        all _mm_and_pd, |mask| _mm_movemask_pd(mask) == 0b11;
    }

    register! {
        Singles: [f32; 4], __m128, __m128i;
        unit (), fused FUSED, many false;
        splat _mm_set1_ps, _mm_set1_epi32;
        operators _mm_add_ps, _mm_sub_ps, _mm_mul_ps, _mm_div_ps;
        plus |c, a, b| _mm_fmadd_ps(a, b, c);
        minus |c, a, b| _mm_fnmadd_ps(a, b, c);
        bits _mm_and_si128, _mm_xor_si128, _mm_add_epi32, _mm_slli_epi32::<30>;
        odd |n, one, a, b| {
            let is_odd = transmute::<__m128i, __m128>(_mm_sub_epi32(_mm_setzero_si128(), _mm_and_si128(n, one)));
            _mm_xor_ps(b, _mm_and_ps(_mm_xor_ps(a, b), is_odd))
        };
        within |angle, sign, limit| _mm_cmple_ps(_mm_andnot_ps(sign, angle), limit);
        all _mm_and_ps, |mask| _mm_movemask_ps(mask) == 0b1111;
    }
}
