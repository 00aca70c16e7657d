//! Where the processor is not asked: the compiled target has its instructions, or they are not known here.

use super::{Call, Compiled};
use crate::Scalar;

/// The body, as it is compiled.
#[inline(always)]
pub(super) fn run<C: Call, T: Scalar>(arguments: C::Arguments<'_, T>) -> C::Result<T> {
    C::run::<T, Compiled>(arguments)
}
