//! Sample points: random values for the arguments of a function, at which two functions are compared.

use super::{Embedding, Input, Quantity, Residue, numbers::canonical};

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

    /// Returns the value of an argument of any function. The position of a revolute joint is no number of a field, but
    /// a random one serves, because only its sine and cosine are used.
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
            // no function has both of these arguments
            Quantity::AppliedTorque | Quantity::Multiplier => self.random(7, index),
            Quantity::Omega => self.random(8, axis),
            Quantity::OmegaDot => self.random(9, axis),
            Quantity::Acceleration => self.random(10, axis),
            Quantity::Gravity => self.random(11, axis),
            Quantity::Parameter => self.random(12, index),
            // arguments of a payload
            Quantity::Mass => self.random(13, 0),
            Quantity::Com => self.random(14, axis),
            Quantity::Inertia => self.random(15, input.element()),
            Quantity::TipForce => self.random(18, 3 * index + axis),
            Quantity::TipMoment => self.random(19, 3 * index + axis),
            Quantity::OriginVelocity => self.random(20, axis),
            // arguments of the pose of a base
            Quantity::FrameRotation => self.random(21, input.element()),
            Quantity::FrameOrigin => self.random(22, axis),
            Quantity::BaseRotation => self.random(23, input.element()),
            // all other quantities
            other => self.random(64 + other as u64, index),
        }
    }

    /// Sine and cosine of the position of a joint.
    pub(crate) fn turn(&self, joint: usize) -> (Residue, Residue) {
        self.embedding.point(6 ^ (self.index << 8), joint as u64)
    }

    /// Sine and cosine of the position of a joint, times a ratio.
    ///
    /// Sine and cosine of a fraction of an angle are no rational functions of those of the angle. So a ratio is split
    /// into a whole number and billionths: the whole number uses the point of the position, and a billionth of the
    /// position has a random point of its own. A ratio with more digits has a point of its own, too. An identity that
    /// holds for all such points also holds for those of one position.
    pub(crate) fn turn_times(&self, joint: usize, ratio: Residue) -> (Residue, Residue) {
        const BILLION: u64 = 1_000_000_000;
        const PART: u64 = 16;
        let point = |kind: u64, of: u64| self.embedding.point(kind ^ (self.index << 8), of);
        let of_billionths = |billionths: u64, negative: bool| {
            let whole = repeated(self.turn(joint), billionths / BILLION);
            let part = repeated(point(PART, joint as u64), billionths % BILLION);
            let (sine, cosine) = composed(whole, part);
            (sine.signed(negative), cosine)
        };
        let billionths = ratio * Residue::integer(BILLION);
        match (billionths.to_integer(), (-billionths).to_integer()) {
            (Some(positive), _) => of_billionths(positive, false),
            (None, Some(negative)) => of_billionths(negative, true),
            (None, None) => {
                let (magnitude, negative) = canonical(ratio);
                let (sine, cosine) = point(PART + 1, magnitude.key() ^ joint as u64);
                (sine.signed(negative), cosine)
            }
        }
    }
}

/// Sine and cosine of the sum of two angles: the addition theorem.
pub(crate) fn composed((s, c): (Residue, Residue), (sine, cosine): (Residue, Residue)) -> (Residue, Residue) {
    (s * cosine + c * sine, c * cosine - s * sine)
}

/// Sine and cosine of an angle times a whole number.
fn repeated(mut turn: (Residue, Residue), mut times: u64) -> (Residue, Residue) {
    let mut sum = (Residue::ZERO, Residue::ONE);
    while times > 0 {
        if times & 1 == 1 {
            sum = composed(sum, turn);
        }
        turn = composed(turn, turn);
        times >>= 1;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_by_parts_of_an_angle_add_up() {
        let point = SamplePoint::new(Embedding::default(), 1);
        let embedding = Embedding::default();
        let turn = |ratio: f64| point.turn_times(2, embedding.decimal(ratio).residue);
        assert_eq!(turn(1.0), point.turn(2));
        assert_eq!(turn(2.0), composed(point.turn(2), point.turn(2)));
        assert_eq!(composed(turn(1.0), turn(-1.0)), (Residue::ZERO, Residue::ONE));
        assert_eq!(composed(turn(1.0), turn(1.13)), turn(2.13));
        assert_eq!(composed(turn(-0.7), turn(0.35)), turn(-0.35));
        assert_ne!(turn(0.5), turn(0.25));
        // a ratio with more than nine decimals
        let fine = turn(0.123_456_789_123);
        assert_eq!(fine.0 * fine.0 + fine.1 * fine.1, Residue::ONE);
        assert_ne!(fine, turn(0.123_456_789_124));
    }
}
