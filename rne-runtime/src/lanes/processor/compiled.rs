//! Single calls without a test of the processor: the compiled target already has the instructions, or they are not
//! known here.

use super::{Call, Compiled};
use crate::Scalar;

/// Runs the body as it is compiled.
#[inline(always)]
pub(super) fn run<C: Call, T: Scalar>(arguments: C::Arguments<'_, T>) -> C::Result<T> {
    C::run::<T, Compiled>(arguments)
}
