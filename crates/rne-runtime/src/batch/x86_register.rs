//! Registers of the vector units that pulp finds at run time.
//!
//! This is the one module with `unsafe` in it. Every operation of pulp wants its proof that the processor has the unit, a value
//! of no size. Generic code cannot hand it on: `a + b` has two operands, and a constant is made from nothing. A register that
//! carried the proof along would be a byte longer, and the processor would stall on every copy. So operations say that the
//! unit is there ([`proven`]), and the only code that has registers at all shows that it is:
//!
//! - The types are private to [`batch`](super). Generic code gets to know them as the parameter of
//!   [`States::run`](super::blocks::States::run) alone, which takes the proof as an argument.
//! - A processor that has a unit keeps it.
#![allow(unsafe_code)]

use core::fmt;
use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Neg, Sub};
use core::ptr::NonNull;
use core::slice;

use bytemuck::{Zeroable, cast, cast_slice, cast_slice_mut};
use pulp::Simd;

use super::vector::Vector;
use crate::sin_cos::Lanes;

/// The proof that the processor has the unit.
///
/// # Safety
/// There has been such a proof before.
#[inline(always)]
unsafe fn proven<S: Simd>() -> S {
    const { assert!(size_of::<S>() == 0, "a proof is nothing to read") };
    // SAFETY: any aligned pointer is valid for reading no bytes, and the caller knows that the type has a value, which it
    // may copy.
    unsafe { NonNull::dangling().read() }
}

macro_rules! register {
    (
        $Register:ident, $element:ident, $lanes:ident, $bits:ident,
        $splat_bits:ident, $equal_bits:ident, $and_bits:ident, $xor_bits:ident, $select_bits:ident,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $mul_add:ident, $negate_mul_add:ident,
        $split:ident, $split_mut:ident
    ) => {
        /// A register of numbers.
        #[derive(Clone, Copy)]
        pub struct $Register<S: Simd> {
            lanes: S::$lanes,
            unit: PhantomData<S>,
        }

        impl<S: Simd> $Register<S> {
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

            fn numbers(&self) -> &[$element] {
                cast_slice(slice::from_ref(&self.lanes))
            }
        }

        register!(operators $Register, Add::add, $add, Sub::sub, $sub, Mul::mul, $mul, Div::div, $div);

        impl<S: Simd> Neg for $Register<S> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self::of(cast(Self::opposite(cast(self.lanes))))
            }
        }

        impl<S: Simd> PartialEq for $Register<S> {
            fn eq(&self, other: &Self) -> bool {
                self.numbers() == other.numbers()
            }
        }

        impl<S: Simd> fmt::Debug for $Register<S> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.numbers().fmt(f)
            }
        }

        impl<S: Simd> Lanes for $Register<S> {
            type Element = $element;

            /// The units that are looked for all have it.
            const FUSED: bool = true;

            #[inline(always)]
            fn splat(element: $element) -> Self {
                let mut lanes = S::$lanes::zeroed();
                let numbers: &mut [$element] = cast_slice_mut(slice::from_mut(&mut lanes));
                numbers.fill(element);
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
                let (one, two) = (unit.$splat_bits(1), unit.$splat_bits(2));
                let is_odd = unit.$equal_bits(unit.$and_bits(n, one), one);
                let is_opposite = unit.$equal_bits(unit.$and_bits(n, two), two);
                let minus_sine = Self::opposite(sine);
                let (sine, cosine) =
                    (unit.$select_bits(is_odd, cosine, sine), unit.$select_bits(is_odd, minus_sine, cosine));
                let (minus_sine, minus_cosine) = (Self::opposite(sine), Self::opposite(cosine));
                (
                    Self::of(cast(unit.$select_bits(is_opposite, minus_sine, sine))),
                    Self::of(cast(unit.$select_bits(is_opposite, minus_cosine, cosine))),
                )
            }
        }

        impl<S: Simd> Vector for $Register<S> {
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
            fn load(_: S, numbers: &Self::Numbers) -> Self {
                Self::of(*numbers)
            }

            #[inline(always)]
            fn store(self) -> Self::Numbers {
                self.lanes
            }
        }
    };
    (operators $Register:ident, $($Operator:ident :: $operator:ident, $function:ident),*) => {$(
        impl<S: Simd> $Operator for $Register<S> {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self::of(Self::unit().$function(self.lanes, other.lanes))
            }
        }
    )*};
}
register!(
    Doubles, f64, f64s, u64s, splat_u64s, equal_u64s, and_u64s, xor_u64s, select_u64s,
    add_f64s, sub_f64s, mul_f64s, div_f64s, mul_add_f64s, negate_mul_add_f64s, as_simd_f64s, as_mut_simd_f64s
);
register!(
    Singles, f32, f32s, u32s, splat_u32s, equal_u32s, and_u32s, xor_u32s, select_u32s,
    add_f32s, sub_f32s, mul_f32s, div_f32s, mul_add_f32s, negate_mul_add_f32s, as_simd_f32s, as_mut_simd_f32s
);
