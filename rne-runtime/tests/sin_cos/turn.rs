//! Sines and cosines as a batch computes them.

use rne_runtime::Scalar;
use rne_runtime::batch::Torques;

/// A robot whose torques are the sine and the cosine of its first joint: what a vector unit makes of them.
pub(crate) struct Turn;

impl Torques<2, 1> for Turn {
    fn angles<T: Scalar>(&self, q: &[T; 2]) -> [T; 1] {
        [q[0]]
    }

    fn torques<T: Scalar>(&self, sin: &[T; 1], cos: &[T; 1], _: &[T; 2], _: &[T; 2], _: &[T; 2]) -> [T; 2] {
        [sin[0], cos[0]]
    }
}
