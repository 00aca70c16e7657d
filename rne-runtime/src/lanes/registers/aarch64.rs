//! The registers of AArch64 processors: NEON.

use core::arch::aarch64::*;
use core::fmt;
use core::mem::transmute;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::register::register;
use crate::lanes::batch::vector::vector;
use crate::number::sin_cos::registers::Register;
use crate::number::sin_cos::{LIMIT, Lanes};

register! {
    Doubles: [f64; 2], float64x2_t, uint64x2_t;
    unit (), fused true, many false;
    splat vdupq_n_f64, vdupq_n_u64;
    operators vaddq_f64, vsubq_f64, vmulq_f64, vdivq_f64;
    plus |c, a, b| vfmaq_f64(c, a, b);
    minus |c, a, b| vfmsq_f64(c, a, b);
    bits vandq_u64, veorq_u64, vaddq_u64, vshlq_n_u64::<62>;
    odd |n, one, a, b| vbslq_f64(vtstq_u64(n, one), a, b);
    within |angle, _sign, limit| vcaleq_f64(angle, limit);
    all vandq_u64, |mask| vminvq_u32(vreinterpretq_u32_u64(mask)) == u32::MAX;
}

register! {
    Singles: [f32; 4], float32x4_t, uint32x4_t;
    unit (), fused true, many false;
    splat vdupq_n_f32, vdupq_n_u32;
    operators vaddq_f32, vsubq_f32, vmulq_f32, vdivq_f32;
    plus |c, a, b| vfmaq_f32(c, a, b);
    minus |c, a, b| vfmsq_f32(c, a, b);
    bits vandq_u32, veorq_u32, vaddq_u32, vshlq_n_u32::<30>;
    odd |n, one, a, b| vbslq_f32(vtstq_u32(n, one), a, b);
    within |angle, _sign, limit| vcaleq_f32(angle, limit);
    all vandq_u32, |mask| vminvq_u32(mask) == u32::MAX;
}
