//! A vector register with one number for each of several states.

use core::fmt::Debug;

use super::BatchScalar;
use crate::number::sin_cos::Lanes;

/// The registers of a vector unit for numbers of one type.
///
/// Everything is `#[inline(always)]`, here and in what uses it: a function that is not part of the code for a vector
/// unit is compiled without its instructions.
pub trait Vector: Lanes + Debug + PartialEq + 'static {
    /// A value of this type proves that the processor has the unit.
    type Unit: Copy;

    /// An array with as many numbers as a register has.
    type Numbers: Copy;

    /// Splits a slice into full registers and the remaining numbers.
    fn split(numbers: &[Self::Element]) -> (&[Self::Numbers], &[Self::Element]);

    /// Splits a slice into full registers and the remaining numbers.
    fn split_mut(numbers: &mut [Self::Element]) -> (&mut [Self::Numbers], &mut [Self::Element]);

    fn each(numbers: &Self::Numbers) -> &[Self::Element];

    fn each_mut(numbers: &mut Self::Numbers) -> &mut [Self::Element];

    fn load(unit: Self::Unit, numbers: &Self::Numbers) -> Self;

    fn store(self) -> Self::Numbers;
}

/// A computation in registers, on a unit that is chosen when the program runs.
pub(crate) trait Work<T: BatchScalar> {
    /// Runs the computation in registers `V`. Implementations are `#[inline(always)]`.
    fn run<V: Vector<Element = T>>(self, unit: V::Unit);
}

/// Implements the trait for registers whose memory is an array of their numbers.
macro_rules! vector {
    ($Vector:ty, $Unit:ty, [$element:ident; $LANES:literal], $of_numbers:expr, $numbers:expr) => {
        impl crate::lanes::batch::vector::Vector for $Vector {
            type Unit = $Unit;
            type Numbers = [$element; $LANES];

            #[inline(always)]
            fn split(numbers: &[$element]) -> (&[Self::Numbers], &[$element]) {
                numbers.as_chunks()
            }

            #[inline(always)]
            fn split_mut(numbers: &mut [$element]) -> (&mut [Self::Numbers], &mut [$element]) {
                numbers.as_chunks_mut()
            }

            #[inline(always)]
            fn each(numbers: &Self::Numbers) -> &[$element] {
                numbers
            }

            #[inline(always)]
            fn each_mut(numbers: &mut Self::Numbers) -> &mut [$element] {
                numbers
            }

            #[inline(always)]
            fn load(_: $Unit, numbers: &Self::Numbers) -> Self {
                $of_numbers(*numbers)
            }

            #[inline(always)]
            fn store(self) -> Self::Numbers {
                $numbers(self)
            }
        }
    };
}
pub(crate) use vector;
