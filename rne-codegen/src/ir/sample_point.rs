//! Random values for the arguments of a function: where two functions are compared.

use super::{Embedding, Input, Quantity, Residue};

/// Random values for all arguments. Functions are compared at these values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SamplePoint {
    embedding: Embedding,
    index: u64,
}

impl SamplePoint {
    pub(crate) const fn new(embedding: Embedding, index: u64) -> Self {
        Self { embedding, index }
    }

    fn random(&self, kind: u64, joint: usize) -> Residue {
        self.embedding.random(kind ^ (self.index << 8), joint as u64)
    }

    pub(crate) const fn embedding(&self) -> Embedding {
        self.embedding
    }

    /// An argument of any function. Positions of revolute joints are no numbers of the field by themselves, but random
    /// ones serve where only their sines and cosines matter.
    pub(crate) fn argument(&self, input: Input) -> Residue {
        let index = input.index();
        let axis = input.axis().map_or(0, |axis| axis as usize);
        match input.quantity() {
            Quantity::Position => self.random(1, index),
            Quantity::Rate => self.random(2, index),
            Quantity::RateDot => self.random(3, index),
            Quantity::JointForce => self.random(4, axis),
            Quantity::JointMoment => self.random(5, axis),
            Quantity::Sine => self.turn(index).0,
            Quantity::Cosine => self.turn(index).1,
            Quantity::AppliedTorque => self.random(7, index),
            Quantity::Omega => self.random(8, axis),
            Quantity::OmegaDot => self.random(9, axis),
            Quantity::Acceleration => self.random(10, axis),
            Quantity::Gravity => self.random(11, axis),
            Quantity::Parameter => self.random(12, index),
            // of a payload
            Quantity::Mass => self.random(13, 0),
            Quantity::Com => self.random(14, axis),
            Quantity::Inertia => self.random(15, input.element()),
            // nothing else is given
            other => self.random(64 + other as u64, index),
        }
    }

    /// Sine and cosine of the position of a joint.
    pub(crate) fn turn(&self, joint: usize) -> (Residue, Residue) {
        self.embedding.point(6 ^ (self.index << 8), joint as u64)
    }
}
