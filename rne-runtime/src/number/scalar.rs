//! The number type that every function of a robot is generic over.

#[cfg(feature = "simba")]
mod field;
#[cfg(not(feature = "simba"))]
mod float;

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

/// A real number, or a bundle of them: `f32`, `f64`, SIMD lanes, dual numbers, fixed point.
///
/// Implemented for `f32` and `f64`, and with the feature `simba` (on by default) for everything that is simba's
/// `SimdRealField` and `Copy`. A type of your own that is no such field (an interval, say) implements this trait
/// itself; a foreign one needs a newtype.
///
/// The ring operators come with their assigning forms, `+=` and so on: nalgebra's sums and products of matrices ask for
/// them, and the generic recursion is written in nalgebra.
#[diagnostic::on_unimplemented(
    message = "dynamics cannot compute with `{Self}`",
    label = "no real number",
    note = "positions, velocities and torques are real numbers: write `0.0`, not `0`; there are `f32`, `f64`, and what \
            implements `Scalar`"
)]
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Zero
    + One
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// A constant, rounded once to this type.
    #[must_use]
    fn from_f64(value: f64) -> Self;

    /// A constant that is stored in single precision; never passes through `f64` when this type is `f32`. A type of
    /// your own may leave it out.
    #[must_use]
    fn from_f32(value: f32) -> Self {
        Self::from_f64(value.into())
    }

    /// Sine and cosine of an angle in rad.
    ///
    /// For `f32` and `f64` these are kernels of this crate, `f32`'s in `f32` alone: errors below 1 ulp for angles up to
    /// 10⁵ rad, as `cargo run --release -p rne-runtime --features batch --example sin_cos_accuracy` shows, and the same
    /// bits with and without `std` on targets compiled without fused multiply-add. Beyond that range they are `std`'s
    /// functions; without `std` results there mean nothing. NaN and infinities give NaN, and sin(-0) is -0.
    ///
    /// Other scalars of simba keep their own sine and cosine.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);

    /// Sines and cosines of several angles in rad, each equal, bit for bit, to [`sin_cos`](Self::sin_cos) of that
    /// angle.
    #[must_use]
    fn sin_cos_array<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let (mut sines, mut cosines) = (angles, angles);
        for (sine, cosine) in sines.iter_mut().zip(&mut cosines) {
            (*sine, *cosine) = sine.sin_cos();
        }
        (sines, cosines)
    }

    /// `self * factor + addend`: rounded once where the compiled target has an instruction for that, else a product and
    /// a sum.
    ///
    /// Of the scalars here, only `f32` and `f64` can be rounded once: on x86-64 built with the target feature `fma` and
    /// on AArch64, with `std`; without it, and on Cortex-M (`f32` alone) and RISC-V, with the feature
    /// `core_float_math`, which needs a nightly compiler, for `core` has the operation in no stable one yet. It is
    /// never a call of a library.
    ///
    /// Derived code of the reduced form does not stop at the compiled target: in `f64` and `f32`, with the feature
    /// `batch`, a plain build for x86-64 has it rounded once where the processor does that, unless the robot says
    /// `inline`. This function is what such code calls for all other numbers, and on all other processors.
    #[must_use]
    #[inline]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }

    /// `positive` where this number is above zero, `negative` where it is below, zero where it is zero (or NaN): lane
    /// by lane, without a branch. Coulomb friction needs it, and [`Actuation`](crate::Actuation) alone.
    ///
    /// A type of your own may leave it out; calling it then, directly or through `Actuation`, fails to compile.
    #[must_use]
    #[inline]
    fn by_sign(self, positive: Self, negative: Self) -> Self {
        const {
            assert!(
                size_of::<Self>() == usize::MAX,
                "this scalar has no sign: implement `Scalar::by_sign` for its type"
            );
        }
        positive + negative
    }

    /// The square root, NaN below zero. Smooth Coulomb friction needs it, and
    /// [`Actuation::actuator_torques_smooth`](crate::Actuation::actuator_torques_smooth) alone.
    ///
    /// A type of your own may leave it out; calling it then fails to compile.
    #[must_use]
    #[inline]
    fn sqrt(self) -> Self {
        const {
            assert!(size_of::<Self>() == usize::MAX, "this scalar has no root: implement `Scalar::sqrt` for its type");
        }
        self
    }
}

/// The scalar in which a robot's constants are stored: `f64`, or `f32` to keep double precision off a target without
/// it.
pub trait Constant: Scalar + sealed::Sealed {
    /// This constant in the scalar of a computation.
    #[must_use]
    fn to<T: Scalar>(self) -> T;
}

impl Constant for f64 {
    #[inline]
    fn to<T: Scalar>(self) -> T {
        T::from_f64(self)
    }
}

impl Constant for f32 {
    #[inline]
    fn to<T: Scalar>(self) -> T {
        T::from_f32(self)
    }
}

/// A field of a robot's type that is a parameter of its file: `f64` or `f32`. Only derived code uses it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be a run-time parameter",
    label = "`f64` or `f32` is needed",
    note = "each field of a robot is a parameter of its robot file whose value is given at run time; for any other \
            field, write `#[robot(skip)]` before it"
)]
pub trait RunTimeParameter {
    /// This number in the scalar of a computation.
    #[must_use]
    fn to<T: Scalar>(self) -> T;
}

impl RunTimeParameter for f64 {
    #[inline]
    fn to<T: Scalar>(self) -> T {
        T::from_f64(self)
    }
}

impl RunTimeParameter for f32 {
    #[inline]
    fn to<T: Scalar>(self) -> T {
        T::from_f32(self)
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}
