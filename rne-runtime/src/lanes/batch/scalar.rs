//! The types of numbers of a batch, and the registers in which they are computed.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::vector::Vector;
use crate::Scalar;
use crate::number::sin_cos::{Float, kernel};

/// A type of numbers that vector units compute: `f32` and `f64`, and no other type.
pub trait BatchScalar: Scalar + Send + Sync + sealed::Machine {}

impl BatchScalar for f32 {}
impl BatchScalar for f64 {}

/// A register as a scalar, for which generated code is compiled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Register<V>(pub(super) V);

impl<V: Vector> Scalar for Register<V> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(V::splat(V::Element::rounded(value)))
    }

    /// Does not test the range of the angle, which [`blocks`](super::blocks) does.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = kernel(self.0);
        (Self(sine), Self(cosine))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(addend.0.plus_product(self.0, factor.0))
    }
}

macro_rules! operators {
    ($($Operator:ident :: $operator:ident, $Assign:ident :: $assign:ident, $symbol:tt;)*) => {$(
        impl<V: Vector> $Operator for Register<V> {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self(self.0 $symbol other.0)
            }
        }

        impl<V: Vector> $Assign for Register<V> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    )*};
}
operators! {
    Add::add, AddAssign::add_assign, +;
    Sub::sub, SubAssign::sub_assign, -;
    Mul::mul, MulAssign::mul_assign, *;
    Div::div, DivAssign::div_assign, /;
}

impl<V: Vector> Neg for Register<V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<V: Vector> Zero for Register<V> {
    #[inline(always)]
    fn zero() -> Self {
        Self(V::splat(V::Element::ZERO))
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl<V: Vector> One for Register<V> {
    #[inline(always)]
    fn one() -> Self {
        Self(V::splat(V::Element::ONE))
    }
}

mod sealed {
    use super::super::vector::Vector;
    use crate::lanes::registers;
    use crate::number::sin_cos::Float;

    /// The registers of a type of numbers.
    pub trait Machine: Float {
        /// Registers of the compiled target.
        type Compiled: Vector<Element = Self, Unit = ()>;
        /// Registers of units that are detected at run time.
        #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
        type Avx2: Vector<Element = Self, Unit = registers::Avx2>;
        #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
        type Avx512: Vector<Element = Self, Unit = registers::Avx512>;
        /// Lends memory for this many values, aligned to a cache line. The thread keeps it for later calls.
        #[cfg(feature = "machine")]
        fn with_memory<R>(length: usize, work: impl FnOnce(&mut [Self]) -> R) -> R;
    }

    /// Number of bytes of a cache line, and of the widest register.
    #[cfg(feature = "machine")]
    const LINE: usize = 64;

    macro_rules! machine {
        ($type:ident, $Register:ident) => {
            impl Machine for $type {
                type Compiled = registers::compiled::$Register;
                #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
                type Avx2 = registers::avx2::$Register;
                #[cfg(all(feature = "batch", any(target_arch = "x86", target_arch = "x86_64")))]
                type Avx512 = registers::avx512::$Register;

                #[cfg(feature = "machine")]
                fn with_memory<R>(length: usize, work: impl FnOnce(&mut [Self]) -> R) -> R {
                    std::thread_local! {
                        static MEMORY: core::cell::Cell<Vec<$type>> = const { core::cell::Cell::new(Vec::new()) };
                    }
                    // Taken and not borrowed, so that a nested call gets memory of its own.
                    let mut memory = MEMORY.take();
                    let space = length + LINE / size_of::<Self>();
                    if memory.len() < space {
                        memory.resize(space, 0.0);
                    }
                    let aligned = memory.as_ptr().align_offset(LINE).min(space - length);
                    let result = work(&mut memory[aligned..aligned + length]);
                    MEMORY.set(memory);
                    result
                }
            }
        };
    }
    machine!(f32, Singles);
    machine!(f64, Doubles);
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::Register;
    use crate::Scalar;
    use crate::lanes::batch::{Argument, BatchFunction, VectorUnit, run};
    use crate::number::sin_cos::{Float, Lanes};

    /// An example of a computation: q² + q̇.
    struct SquareAndSum;

    impl BatchFunction<2, 0, 1, 1> for SquareAndSum {
        const ARGUMENTS: &[Argument] = &[Argument::vector("q", 1), Argument::vector("qd", 1)];
        const RESULTS: &[Argument] = &[Argument::vector("tau", 1)];
        const REQUIRED: usize = 2;
        const PLACES: [u16; 1] = [0];
        const IS_WHOLE: bool = true;

        fn angles<T: Scalar>(&self, _: &[T; 2]) -> [T; 0] {
            []
        }

        fn outputs<T: Scalar>(&self, _: &[T; 0], _: &[T; 0], &[q, qd]: &[T; 2], outputs: &mut [T; 1]) {
            outputs[0] = q.mul_add(q, qd);
        }
    }

    #[test]
    fn a_product_and_a_sum_are_rounded_once_where_they_are_fused() {
        let (q, qd) = ([1.0 + f64::EPSILON], [-(1.0 + 2.0 * f64::EPSILON)]);
        for (index, unit) in VectorUnit::all().enumerate() {
            let mut tau = [f64::NAN];
            run(&SquareAndSum, unit, [&q, &qd], [&mut tau]).expect("arrays of one length");
            let is_fused = index > 0 || crate::number::sin_cos::FUSED_F64;
            assert_eq!(tau, [if is_fused { f64::EPSILON * f64::EPSILON } else { 0.0 }], "{unit}");
        }
    }

    #[test]
    fn a_register_has_the_sines_and_cosines_of_its_numbers() {
        for angle in [-0.0, 0.3, -1.7, 99_999.0] {
            let (sine, cosine) = Register(<f64 as Float>::Register::splat(angle)).sin_cos();
            let of_number = angle.sin_cos();
            assert_eq!((sine, cosine), (Register(Lanes::splat(of_number.0)), Register(Lanes::splat(of_number.1))));
        }
    }
}
