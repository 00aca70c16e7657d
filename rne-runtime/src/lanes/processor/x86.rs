//! AVX2 and fused multiply-add of an x86 processor, in a program that is compiled for a processor without them.

use core::any::{Any, TypeId};
use core::marker::PhantomData;

use super::{Arithmetic, Call, Compiled, OfType};
use crate::Scalar;
use crate::lanes::registers::{self, Computation, avx2};
use crate::number::sin_cos::array::in_registers;

/// Runs the body with AVX2 if the processor has it and numbers are `f64` or `f32`; otherwise as it is compiled.
#[inline(always)]
pub(super) fn run<C: Call, T: Scalar>(arguments: C::Arguments<'_, T>) -> C::Result<T> {
    macro_rules! detected {
        ($($float:ident)*) => {$(
            // The comparison of sizes is a constant, while that of types is not: so for other scalars nothing is
            // compiled twice.
            if const { size_of::<T>() == size_of::<$float>() }
                && TypeId::of::<T>() == TypeId::of::<$float>()
                && let Some(arguments) = OfType::<C::Arguments<'_, $float>>::of_type(arguments)
                && let Some(unit) = registers::Avx2::try_new()
            {
                return unit.vectorize(Body::<C, $float, T> { arguments, returns: PhantomData });
            }
        )*};
    }
    detected!(f64 f32);
    C::run::<T, Compiled>(arguments)
}

/// A body and its arguments as a computation. Its result type is written with `T`, which is the same type as `F`.
struct Body<'a, C: Call, F: Scalar, T> {
    arguments: C::Arguments<'a, F>,
    returns: PhantomData<T>,
}

impl<C: Call, F: Scalar, T: Scalar> Computation for Body<'_, C, F, T>
where
    Avx2: Arithmetic<F>,
{
    type Result = C::Result<T>;

    #[inline(always)]
    fn compute(self) -> Self::Result {
        // converted in here, before the result is in memory, from which it would have to be copied
        let result = C::run::<F, Avx2>(self.arguments);
        let result = (&result as &dyn Any).downcast_ref().copied();
        result.unwrap_or_else(|| unreachable!("`run` has compared the types"))
    }
}

/// The instructions that were detected on the processor. Only a [`Body`] computes with them.
enum Avx2 {}

macro_rules! detected {
    ($($float:ident in $Register:ident;)*) => {$(
        impl Arithmetic<$float> for Avx2 {
            #[inline(always)]
            fn mul_add(a: $float, b: $float, c: $float) -> $float {
                a.mul_add(b, c)
            }

            #[inline(always)]
            fn sin_cos(angle: $float) -> ($float, $float) {
                let ([sine], [cosine]) = Self::sin_cos_array([angle]);
                (sine, cosine)
            }

            #[inline(always)]
            fn sin_cos_array<const N: usize>(angles: [$float; N]) -> ([$float; N], [$float; N]) {
                let (mut sines, mut cosines) = (angles, angles);
                in_registers::<avx2::$Register, N>(&angles, &mut sines, &mut cosines);
                (sines, cosines)
            }
        }
    )*};
}
detected! {
    f64 in Doubles;
    f32 in Singles;
}

#[cfg(test)]
mod tests {
    use core::ops::{Add, Div, Mul, Neg, Sub};

    use super::{Arithmetic, Avx2, Call};
    use crate::Scalar;
    use crate::lanes::processor;
    use crate::lanes::registers;
    use crate::number::sin_cos::{Float, Lanes, kernel};

    /// An example: a b + c, and the sines and cosines of three angles.
    enum Example {}

    impl Call for Example {
        type Arguments<'a, T: Scalar> = (&'a [T; 3],);
        type Result<T: Scalar> = (T, [T; 3], [T; 3], (T, T));

        #[inline(always)]
        fn run<T: Scalar, A: Arithmetic<T>>((numbers,): Self::Arguments<'_, T>) -> Self::Result<T> {
            let [a, b, c] = *numbers;
            let (sines, cosines) = A::sin_cos_array(*numbers);
            (A::mul_add(a, b, c), sines, cosines, A::sin_cos(a))
        }
    }

    /// A number whose products are added with one rounding, as the processor does it.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Fused<T>(T);

    macro_rules! fused {
        ($($float:ident)*) => {$(
            impl Lanes for Fused<$float> {
                type Element = $float;

                const FUSED: bool = true;

                fn splat(element: $float) -> Self {
                    Self(element)
                }

                fn plus_product(self, a: Self, b: Self) -> Self {
                    Self(a.0.mul_add(b.0, self.0))
                }

                fn minus_product(self, a: Self, b: Self) -> Self {
                    Self((-a.0).mul_add(b.0, self.0))
                }

                fn in_quadrant(rounded: Self, sine: Self, cosine: Self) -> (Self, Self) {
                    let (sine, cosine) = Lanes::in_quadrant(rounded.0, sine.0, cosine.0);
                    (Self(sine), Self(cosine))
                }
            }
        )*};
    }
    fused!(f64 f32);

    macro_rules! operators {
        ($($Operator:ident :: $operator:ident, $symbol:tt;)*) => {$(
            impl<T: $Operator<Output = T>> $Operator for Fused<T> {
                type Output = Self;

                fn $operator(self, other: Self) -> Self {
                    Self(self.0 $symbol other.0)
                }
            }
        )*};
    }
    operators! { Add::add, +; Sub::sub, -; Mul::mul, *; Div::div, /; }

    impl<T: Neg<Output = T>> Neg for Fused<T> {
        type Output = Self;

        fn neg(self) -> Self {
            Self(-self.0)
        }
    }

    /// Computes sine and cosine as a target with fused multiply-add does.
    fn of_target<T: Float>(angle: T) -> (T, T)
    where
        Fused<T>: Lanes<Element = T>,
    {
        if !angle.is_within_limit() {
            return angle.std_sin_cos();
        }
        let (Fused(sine), Fused(cosine)) = kernel(Fused(angle));
        (sine, cosine)
    }

    #[test]
    fn the_processor_has_the_bits_of_a_target_with_its_instructions() {
        if registers::Avx2::try_new().is_none() {
            println!("skipped: this processor has no AVX2 with fused multiply-add");
            return;
        }
        macro_rules! check {
            ($float:ident) => {
                let epsilon = $float::EPSILON;
                let (sum, ..) =
                    processor::run::<Example, $float>((&[1.0 + epsilon, 1.0 + epsilon, -1.0 - 2.0 * epsilon],));
                assert_eq!(sum, epsilon * epsilon);
                let far = [2e5, -0.0, 1e5, -3e8];
                for start in (-300..300).map(|start: i16| $float::from(start)).chain(far) {
                    let angles = [start * 0.37, start, start * start * 1.7];
                    let (_, sines, cosines, first) = processor::run::<Example, $float>((&angles,));
                    let expected = angles.map(of_target);
                    let bits = |(sine, cosine): ($float, $float)| [sine.to_bits(), cosine.to_bits()];
                    assert_eq!(bits(first), bits(expected[0]), "{angles:?}");
                    for index in 0..3 {
                        assert_eq!(bits((sines[index], cosines[index])), bits(expected[index]), "{angles:?}");
                    }
                }
                for none in [$float::NAN, $float::INFINITY] {
                    let (_, sines, cosines, _) = processor::run::<Example, $float>((&[0.3, none, 0.4],));
                    assert_eq!([0.3, 0.4].map(of_target), [(sines[0], cosines[0]), (sines[2], cosines[2])]);
                    assert!(sines[1].is_nan() && cosines[1].is_nan());
                }
            };
        }
        check!(f64);
        check!(f32);
    }

    #[test]
    fn many_angles_are_several_blocks() {
        if registers::Avx2::try_new().is_none() {
            println!("skipped: this processor has no AVX2 with fused multiply-add");
            return;
        }
        let angles: [f64; 21] = core::array::from_fn(|index| f64::from(u8::try_from(index).expect("few")) * 7e3);
        let (sines, cosines) = Avx2::sin_cos_array(angles);
        assert_eq!(angles.map(of_target), core::array::from_fn(|index| (sines[index], cosines[index])));
    }
}
