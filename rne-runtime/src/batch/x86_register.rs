//! Registers of the vector units that pulp finds at run time.
//!
//! This is the one module with `unsafe` in it. Every operation of pulp wants its proof that the processor has the unit,
//! a value of no size. Generic code cannot hand it on: a constant is made from nothing. A register that carried a proof
//! or none would be a byte longer, and the processor would stall on every copy. So operations say that the unit is
//! there ([`proven`]), and nobody has a register without having shown that it is:
//!
//! - Registers are made by [`Lanes::splat`] and [`Vector::load`]. Both traits are private to this crate, so that no
//!   other can call them, although it can name the types (as what the public `BatchScalar` computes with).
//! - Within this crate the types are a parameter of [`Work::run`](super::vector::Work::run) alone, which takes the
//!   proof as an argument, and of what it calls: generated code, which makes constants of the scalar that it is given,
//!   and the loop of the machine.
//! - A processor that has a unit keeps it.
#![allow(unsafe_code)]

use core::fmt;
use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Neg, Sub};
use core::ptr::NonNull;
use core::slice;

use bytemuck::{Zeroable, cast, cast_slice, cast_slice_mut};
use pulp::Simd;
use pulp::x86::{V3, V4};

use super::vector::Vector;
use crate::sin_cos::registers::Register;
use crate::sin_cos::{Float, LIMIT, Lanes};

/// The proof that the processor has the unit.
///
/// # Safety
/// There has been such a proof before.
#[inline(always)]
unsafe fn proven<S: Simd>() -> S {
    const { assert!(size_of::<S>() == 0, "a proof is nothing to read") };
    // SAFETY: any aligned pointer is valid for reading no bytes, and the caller knows that the type has a value, which
    // it may copy.
    unsafe { NonNull::dangling().read() }
}

/// What pulp has for each unit but not for all.
pub trait Shift: Simd {
    /// The second lowest bit moves to the highest.
    fn shift_u64s(self, bits: Self::u64s) -> Self::u64s;
    fn shift_u32s(self, bits: Self::u32s) -> Self::u32s;
}

macro_rules! shift {
    ($($Unit:ident, $shift_u64s:ident, $shift_u32s:ident;)*) => {$(
        impl Shift for $Unit {
            #[inline(always)]
            fn shift_u64s(self, bits: Self::u64s) -> Self::u64s {
                self.$shift_u64s::<62>(bits)
            }

            #[inline(always)]
            fn shift_u32s(self, bits: Self::u32s) -> Self::u32s {
                self.$shift_u32s::<30>(bits)
            }
        }
    )*};
}
shift! {
    V3, shl_const_u64x4, shl_const_u32x8;
    V4, shl_const_u64x8, shl_const_u32x16;
}

macro_rules! register {
    (
        $Register:ident, $element:ident, $lanes:ident, $bits:ident,
        $splat_bits:ident, $equal_bits:ident, $and_bits:ident, $xor_bits:ident, $select_bits:ident,
        $add_bits:ident, $shift:ident,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $mul_add:ident, $negate_mul_add:ident,
        $split:ident, $split_mut:ident
    ) => {
        /// A register of numbers.
        #[derive(Clone, Copy)]
        pub struct $Register<S: Shift> {
            lanes: S::$lanes,
            unit: PhantomData<S>,
        }

        impl<S: Shift> $Register<S> {
            #[inline(always)]
            fn of(lanes: S::$lanes) -> Self {
                Self { lanes, unit: PhantomData }
            }

            #[inline(always)]
            fn unit() -> S {
                // SAFETY: code that has a register has been given a proof; see the head of this file.
                unsafe { proven() }
            }

            #[inline(always)]
            fn opposite(bits: S::$bits) -> S::$bits {
                let unit = Self::unit();
                unit.$xor_bits(bits, unit.$splat_bits($element::to_bits(-0.0)))
            }

        }

        register!(operators $Register, Add::add, $add, Sub::sub, $sub, Mul::mul, $mul, Div::div, $div);

        impl<S: Shift> Neg for $Register<S> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self::of(cast(Self::opposite(cast(self.lanes))))
            }
        }

        impl<S: Shift> PartialEq for $Register<S> {
            fn eq(&self, other: &Self) -> bool {
                Self::each(&self.lanes) == Self::each(&other.lanes)
            }
        }

        impl<S: Shift> fmt::Debug for $Register<S> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                Self::each(&self.lanes).fmt(f)
            }
        }

        impl<S: Shift> Lanes for $Register<S> {
            type Element = $element;

            /// The units that are looked for all have it.
            const FUSED: bool = true;

            const MANY: bool = true;

            #[inline(always)]
            fn splat(element: $element) -> Self {
                let mut lanes = S::$lanes::zeroed();
                Self::each_mut(&mut lanes).fill(element);
                Self::of(lanes)
            }

            #[inline(always)]
            fn plus_product(self, a: Self, b: Self) -> Self {
                Self::of(Self::unit().$mul_add(a.lanes, b.lanes, self.lanes))
            }

            #[inline(always)]
            fn minus_product(self, a: Self, b: Self) -> Self {
                Self::of(Self::unit().$negate_mul_add(a.lanes, b.lanes, self.lanes))
            }

            #[inline(always)]
            fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self) {
                let unit = Self::unit();
                let [n, sine, cosine]: [S::$bits; 3] = [cast(rounded.lanes), cast(sine.lanes), cast(cosine.lanes)];
                let (one, sign) = (unit.$splat_bits(1), unit.$splat_bits($element::to_bits(-0.0)));
                let is_odd = unit.$equal_bits(unit.$and_bits(n, one), one);
                let (sine, cosine) =
                    (unit.$select_bits(is_odd, cosine, sine), unit.$select_bits(is_odd, sine, cosine));
                // the second lowest bit as the sign
                let sign_of_sine = unit.$and_bits(unit.$shift(n), sign);
                let sign_of_cosine = unit.$and_bits(unit.$shift(unit.$add_bits(n, one)), sign);
                (
                    Self::of(cast(unit.$xor_bits(sine, sign_of_sine))),
                    Self::of(cast(unit.$xor_bits(cosine, sign_of_cosine))),
                )
            }
        }

        impl<S: Shift> Vector for $Register<S> {
            type Unit = S;
            type Numbers = S::$lanes;

            #[inline(always)]
            fn split(numbers: &[$element]) -> (&[Self::Numbers], &[$element]) {
                S::$split(numbers)
            }

            #[inline(always)]
            fn split_mut(numbers: &mut [$element]) -> (&mut [Self::Numbers], &mut [$element]) {
                S::$split_mut(numbers)
            }

            #[inline(always)]
            fn each(numbers: &Self::Numbers) -> &[$element] {
                cast_slice(slice::from_ref(numbers))
            }

            #[inline(always)]
            fn each_mut(numbers: &mut Self::Numbers) -> &mut [$element] {
                cast_slice_mut(slice::from_mut(numbers))
            }

            #[inline(always)]
            fn load(_: S, numbers: &Self::Numbers) -> Self {
                Self::of(*numbers)
            }

            #[inline(always)]
            fn store(self) -> Self::Numbers {
                self.lanes
            }
        }
    };
    (
        single calls $Register:ident, $element:ident, $LANES:literal,
        $less_or_equal:ident, $and:ident, $movemask:ident
    ) => {
        impl Register for $Register<V3> {
            const LANES: usize = $LANES;

            #[inline(always)]
            fn padded<const N: usize>(numbers: &[$element; N], start: usize) -> Self {
                let mut lanes = [$element::ZERO; $LANES];
                for (lane, index) in lanes.iter_mut().zip(start..N) {
                    *lane = numbers[index];
                }
                Self::of(cast(lanes))
            }

            #[inline(always)]
            fn write<const N: usize>(self, numbers: &mut [$element; N], start: usize) {
                let lanes: [$element; $LANES] = cast(self.lanes);
                for (lane, index) in lanes.into_iter().zip(start..N) {
                    numbers[index] = lane;
                }
            }

            #[inline(always)]
            fn are_within_limit(angles: &[Self]) -> bool {
                let (unit, limit) = (Self::unit(), Self::splat(LIMIT.into()));
                let mut are_within = !0;
                for angle in angles {
                    let above = unit.$less_or_equal(angle.lanes, limit.lanes);
                    let below = unit.$less_or_equal((-limit).lanes, angle.lanes);
                    are_within &= unit.avx.$movemask(cast(unit.$and(above, below)));
                }
                are_within & ((1 << $LANES) - 1) == (1 << $LANES) - 1
            }
        }
    };
    (operators $Register:ident, $($Operator:ident :: $operator:ident, $function:ident),*) => {$(
        impl<S: Shift> $Operator for $Register<S> {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self::of(Self::unit().$function(self.lanes, other.lanes))
            }
        }
    )*};
}
register!(
    Doubles,
    f64,
    f64s,
    u64s,
    splat_u64s,
    equal_u64s,
    and_u64s,
    xor_u64s,
    select_u64s,
    add_u64s,
    shift_u64s,
    add_f64s,
    sub_f64s,
    mul_f64s,
    div_f64s,
    mul_add_f64s,
    negate_mul_add_f64s,
    as_simd_f64s,
    as_mut_simd_f64s
);
register!(
    Singles,
    f32,
    f32s,
    u32s,
    splat_u32s,
    equal_u32s,
    and_u32s,
    xor_u32s,
    select_u32s,
    add_u32s,
    shift_u32s,
    add_f32s,
    sub_f32s,
    mul_f32s,
    div_f32s,
    mul_add_f32s,
    negate_mul_add_f32s,
    as_simd_f32s,
    as_mut_simd_f32s
);
// A single call wants no wider ones.
register!(single calls Doubles, f64, 4, less_than_or_equal_f64s, and_m64s, _mm256_movemask_pd);
register!(single calls Singles, f32, 8, less_than_or_equal_f32s, and_m32s, _mm256_movemask_ps);
