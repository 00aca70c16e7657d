//! States at which C and Rust are compared.

use rne::model::Inertia;
use rne::{Payload, Quaternion, Scalar};

/// All that functions are asked with; in single precision, the same numbers rounded.
#[derive(Debug)]
pub(crate) struct State {
    /// q, q̇, q̈, τ.
    pub(crate) joints: [Vec<f64>; 4],
    /// Force, moment; ω, ω̇, acceleration and gravity of the base; a payload.
    pub(crate) vectors: [[f64; 3]; 10],
    /// Axes of the base in the world, as columns.
    pub(crate) rotation: [[f64; 3]; 3],
}

/// The same in a number type, with the sines and cosines of the positions.
pub(crate) struct Numbers<T> {
    pub(crate) joints: [Vec<T>; 4],
    pub(crate) vectors: [[T; 3]; 10],
    pub(crate) rotation: [[T; 3]; 3],
    pub(crate) sine: Vec<T>,
    pub(crate) cosine: Vec<T>,
}

impl State {
    #[allow(clippy::cast_possible_truncation)]
    pub(crate) fn single(&self) -> Numbers<f32> {
        self.numbers(|x| x as f32)
    }

    pub(crate) fn double(&self) -> Numbers<f64> {
        self.numbers(|x| x)
    }

    fn numbers<T: Scalar>(&self, rounded: impl Fn(f64) -> T) -> Numbers<T> {
        let joints = self.joints.each_ref().map(|array| array.iter().map(|&x| rounded(x)).collect::<Vec<T>>());
        let (sine, cosine) = joints[0].iter().map(|&q| Scalar::sin_cos(q)).unzip();
        let vectors = self.vectors.map(|vector| vector.map(&rounded));
        let rotation = self.rotation.map(|row| row.map(&rounded));
        Numbers { joints, vectors, rotation, sine, cosine }
    }
}

/// A rotation of any axis and angle, from four numbers of any size.
pub(crate) fn rotation(numbers: [f64; 4]) -> [[f64; 3]; 3] {
    let length = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
    Quaternion::from_wxyz(numbers.map(|x| x / length)).rotation()
}

/// A payload of four vectors: its mass is the last element of the first, then come centre of mass, moments and products
/// of inertia.
pub(crate) fn payload<T: Scalar>(vectors: &[[T; 3]; 4]) -> Payload<T> {
    let [[_, _, mass], com, [xx, yy, zz], [xy, xz, yz]] = *vectors;
    Payload { mass, com, inertia: Inertia { xx, yy, zz, xy, xz, yz } }
}
