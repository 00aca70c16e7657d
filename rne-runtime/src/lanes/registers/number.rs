//! A number as a register of one lane, if there is no other register: without `std`, and on processors that are not
//! known here.
#![allow(clippy::inline_always)] // as in the kernel, which must be compiled with the target features of its caller

use crate::lanes::batch::vector::vector;
#[cfg(feature = "std")]
use crate::number::sin_cos::Float;

vector!(f64, (), [f64; 1], |[number]: [f64; 1]| number, |number| [number]);
vector!(f32, (), [f32; 1], |[number]: [f32; 1]| number, |number| [number]);

#[cfg(feature = "std")]
impl<T: Float> crate::number::sin_cos::registers::Register for T {
    const LANES: usize = 1;

    #[inline(always)]
    fn padded<const N: usize>(numbers: &[T; N], start: usize) -> T {
        if start < N { numbers[start] } else { T::ZERO }
    }

    #[inline(always)]
    fn write<const N: usize>(self, numbers: &mut [T; N], start: usize) {
        if start < N {
            numbers[start] = self;
        }
    }

    #[inline(always)]
    fn are_within_limit(angles: &[T]) -> bool {
        angles.iter().fold(true, |all, angle| all & angle.is_within_limit())
    }
}
