//! Sines and cosines as a batch computes them.

use rne_runtime::Scalar;
use rne_runtime::batch::{Argument, BatchFunction};

/// A function that gives the sine and the cosine of its input: what a vector unit makes of them.
pub(crate) struct Turn;

impl BatchFunction<1, 1, 2, 2> for Turn {
    const ARGUMENTS: &[Argument] = &[Argument::vector("q", 1)];
    const RESULTS: &[Argument] = &[Argument::vector("turn", 2)];
    const REQUIRED: usize = 1;
    const PLACES: [u16; 2] = [0, 1];
    const IS_WHOLE: bool = true;

    fn angles<T: Scalar>(&self, q: &[T; 1]) -> [T; 1] {
        *q
    }

    fn outputs<T: Scalar>(&self, &[sin]: &[T; 1], &[cos]: &[T; 1], _: &[T; 1], outputs: &mut [T; 2]) {
        *outputs = [sin, cos];
    }
}
