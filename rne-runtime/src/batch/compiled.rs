//! The vector unit of the compiled target: no proof is needed, the program would not run without it.

use super::vector::Vector;

macro_rules! vector {
    ($($Vector:ty: [$element:ident; $LANES:literal], $load:expr, $store:expr;)*) => {$(
        impl Vector for $Vector {
            type Unit = ();
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
            fn load((): (), numbers: &Self::Numbers) -> Self {
                $load(*numbers)
            }

            #[inline(always)]
            fn store(self) -> Self::Numbers {
                $store(self)
            }
        }
    )*};
}

// Without `std` numbers come one by one.
vector! {
    f64: [f64; 1], |[number]: [f64; 1]| number, |number| [number];
    f32: [f32; 1], |[number]: [f32; 1]| number, |number| [number];
}

#[cfg(feature = "std")]
vector! {
    wide::f64x4: [f64; 4], wide::f64x4::new, wide::f64x4::to_array;
    wide::f64x2: [f64; 2], wide::f64x2::new, wide::f64x2::to_array;
    wide::f32x8: [f32; 8], wide::f32x8::new, wide::f32x8::to_array;
    wide::f32x4: [f32; 4], wide::f32x4::new, wide::f32x4::to_array;
}
