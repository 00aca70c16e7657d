//! Multiplication and addition with one rounding, where the compiled target has an instruction for that.

/// Whether the target this is compiled for has the instruction and `std` is there to ask for it: `core` has no such
/// operation yet.
pub(crate) const AT_HAND: bool = cfg!(all(
    feature = "std",
    any(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "fma"), target_arch = "aarch64")
));

/// `f32` and `f64`.
pub(crate) trait Fused: Sized {
    /// `self * factor + addend`, rounded once if `ONCE` (and `std` is there), else twice.
    ///
    /// Ask for it once only where the instruction is enabled: elsewhere it is a slow call of a library, with the same
    /// result.
    fn mul_add_if<const ONCE: bool>(self, factor: Self, addend: Self) -> Self;
}

macro_rules! fused {
    ($type:ident) => {
        impl Fused for $type {
            #[inline(always)]
            #[allow(clippy::inline_always)] // must be compiled with the target features of the caller
            fn mul_add_if<const ONCE: bool>(self, factor: Self, addend: Self) -> Self {
                #[cfg(feature = "std")]
                if ONCE {
                    return self.mul_add(factor, addend);
                }
                self * factor + addend
            }
        }
    };
}
fused!(f32);
fused!(f64);
