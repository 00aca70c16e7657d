//! The arguments in the frames of the reduced form, and the rotations of the joints, with which its formulas begin.

use rne_model::QuarterTurns;

use crate::function::Argument;
use crate::ir::{
    Axis, Builder, ExactAngle, Moving, Name, Number, Quantity, Symbol, Vector, WithRespectTo, by_quarters,
};
use crate::reduced::joint_frames::Tip;
use crate::reduced::{Arm, JointFrames, Triple};

/// Returns the name of a quantity of a group of joints, or of a single joint.
fn group_name(group: Quantity, single: Quantity, first: usize, last: usize) -> Name {
    if first == last { Name::scalar(single, last + 1) } else { Name::indexed(group, last + 1, first + 1) }
}

/// Returns the variable part of the rotation by the summed angle of joints `first` to `last`: q of the first joint,
/// plus or minus the q of the others, plus a constant. Its sign is that of the first joint. Right angles are returned
/// apart, because they only permute sine and cosine.
fn angle<'s>(
    builder: &'s Builder,
    JointFrames { rows, coordinates, .. }: &JointFrames,
    first: usize,
    last: usize,
) -> (Symbol<'s>, QuarterTurns) {
    let position = |at: usize| coordinates.of_joint(builder, Quantity::Position, at);
    let theta = |at: usize| rows[first..=at].iter().fold(ExactAngle::NONE, |turn, row| turn.then(row.theta));
    let reversed = rows[first].reversed;
    let mut sum = position(first);
    for (at, row) in rows.iter().enumerate().take(last + 1).skip(first + 1) {
        sum = sum + position(at).signed(row.reversed != reversed);
        // without the constant part of the angle, unless that is a multiple of a right angle
        let kind = if theta(at).quarters().is_some() { Quantity::GroupAngle } else { Quantity::GroupPosition };
        builder.name(group_name(kind, Quantity::Angle, first, at), sum);
    }
    let theta = theta(last);
    if let Some(quarters) = theta.quarters() {
        return (sum, quarters);
    }
    let theta = builder.angle(if reversed { theta.back() } else { theta });
    let theta = builder.name(group_name(Quantity::GroupTheta, Quantity::Theta, first, last), theta);
    (builder.name(group_name(Quantity::GroupAngle, Quantity::Angle, first, last), theta + sum), QuarterTurns::Zero)
}

impl Builder {
    pub(crate) fn vector(&self, v: Triple) -> Vector<'_> {
        Vector(v.map(|x| self.number(x)))
    }

    /// Returns the vector (0, 0, x).
    pub(crate) fn along_z(&self, x: Number) -> Vector<'_> {
        self.vector([Number::ZERO, Number::ZERO, x])
    }

    /// Returns the rotation by a constant angle.
    pub(crate) fn fixed_turn(&self, turn: ExactAngle) -> SymbolicTurn<'_> {
        SymbolicTurn { s: self.number(turn.sin), c: self.number(turn.cos) }
    }

    /// Writes `formulas` for the state where one joint has the acceleration 1 and all else is at rest.
    pub(crate) fn accelerating<R>(&self, joint: usize, formulas: impl FnOnce() -> R) -> R {
        self.moving(Moving::OneAccelerates(joint), || self.by(Some(WithRespectTo::RateDot(joint + 1)), formulas))
    }

    /// Writes `formulas` for the given kind of motion of the joints, then restores the old one.
    pub(crate) fn moving<R>(&self, moving: Moving, formulas: impl FnOnce() -> R) -> R {
        let outer = self.moving.replace(moving);
        let value = formulas();
        self.moving.set(outer);
        value
    }

    /// Returns the sine and cosine of the variable part of a rotation, and the right angles that remain.
    pub(crate) fn turned(
        &self,
        joint_frames: &JointFrames,
        first: usize,
        last: usize,
    ) -> ((Symbol<'_>, Symbol<'_>), QuarterTurns) {
        let (angle, quarters) = angle(self, joint_frames, first, last);
        let (s, c) = self.sine_and_cosine(angle);
        let name = |group, single, x| self.name(group_name(group, single, first, last), x);
        ((name(Quantity::GroupSine, Quantity::Sine, s), name(Quantity::GroupCosine, Quantity::Cosine, c)), quarters)
    }
}

/// The arguments of the function, in the frames of the rows. Joints are counted from 0.
impl<'s> Arm<'_, 's> {
    /// Returns an argument of a joint, with the sign of the axis direction of its row.
    fn of_joint(&self, quantity: Quantity, joint: usize) -> Symbol<'s> {
        self.joint_frames.coordinates.of_joint(self.builder, quantity, joint).signed(self.rows()[joint].reversed)
    }

    /// Returns q of a prismatic joint.
    pub(crate) fn position(&self, joint: usize) -> Symbol<'s> {
        self.of_joint(Quantity::Position, joint)
    }

    pub(crate) fn rate(&self, joint: usize) -> Symbol<'s> {
        let builder = self.builder;
        if !builder.function.takes(Argument::Rates) || builder.moving.get() != Moving::AsGiven {
            return builder.zero();
        }
        self.of_joint(Quantity::Rate, joint)
    }

    pub(crate) fn rate_dot(&self, joint: usize) -> Symbol<'s> {
        let builder = self.builder;
        match builder.moving.get() {
            Moving::OneAccelerates(only) if only == joint => builder.one().signed(self.rows()[joint].reversed),
            Moving::RatesForAccelerations => self.of_joint(Quantity::Rate, joint),
            Moving::AsGiven if builder.function.takes(Argument::Accelerations) || builder.has_accelerations() => {
                self.of_joint(Quantity::RateDot, joint)
            }
            // in a closed loop, the dependent joints accelerate even where the independent joints do not
            Moving::AsGiven => {
                let bias = self.joint_frames.coordinates.bias(builder, joint);
                bias.map_or_else(|| builder.zero(), |bias| bias.signed(self.rows()[joint].reversed))
            }
            Moving::OneAccelerates(_) => builder.zero(),
        }
    }

    /// Returns the multiplier λ of a joint.
    pub(crate) fn multiplier(&self, joint: usize) -> Symbol<'s> {
        self.of_joint(Quantity::Multiplier, joint)
    }

    /// Returns the force and moment at each tip, if the function has them as arguments.
    pub(crate) fn wrenches(&self) -> Vec<(&Tip, [Vector<'s>; 2])> {
        let (builder, tips) = (self.builder, &self.joint_frames.tips);
        let vector =
            |joint, quantity| Vector(Axis::ALL.map(|axis| builder.argument(Name::vector(quantity, joint, axis))));
        if builder.function.takes(Argument::Wrench) {
            let parts = [Quantity::JointForce, Quantity::JointMoment];
            return vec![(&tips[0], parts.map(|part| vector(self.rows().len() + 1, part)))];
        }
        if !builder.function.takes(Argument::Wrenches) {
            return Vec::new();
        }
        // the tip frame comes first in `tips`, before the frames of the list `tips`
        let named = if tips.len() == 1 { &tips[..] } else { &tips[1..] };
        let parts = [Quantity::TipForce, Quantity::TipMoment];
        named.iter().enumerate().map(|(index, tip)| (tip, parts.map(|part| vector(index + 1, part)))).collect()
    }

    /// Returns the rotation by the summed angle of joints `first` to `last`.
    pub(crate) fn turn(&self, first: usize, last: usize) -> SymbolicTurn<'s> {
        let (builder, rows) = (self.builder, self.rows());
        if builder.function.takes(Argument::Sines) {
            return self.given_turn(first, last);
        }
        // the derivative and the accelerations that are being written do not change this angle
        builder.by(None, || {
            let ((s, c), quarters) = builder.turned(self.joint_frames, first, last);
            let (s, c) = by_quarters((s.signed(rows[first].reversed), c), quarters);
            SymbolicTurn { s, c }
        })
    }

    /// Returns the rotation if sines and cosines are arguments, by the addition theorem. For a joint that follows
    /// others, sine and cosine are computed from its position.
    fn given_turn(&self, first: usize, last: usize) -> SymbolicTurn<'s> {
        let theta = self.rows()[first..=last].iter().fold(ExactAngle::NONE, |turn, row| turn.then(row.theta));
        (first..=last).fold(self.builder.fixed_turn(theta), |SymbolicTurn { s, c }, joint| {
            let coordinates = &self.joint_frames.coordinates;
            let (sine, cosine) = if coordinates.has(joint) {
                let [sine, cosine] = [Quantity::Sine, Quantity::Cosine]
                    .map(|quantity| self.builder.argument(Name::scalar(quantity, joint + 1)));
                (sine, cosine)
            } else {
                self.builder.sine_and_cosine(coordinates.of_joint(self.builder, Quantity::Position, joint))
            };
            let sine = sine.signed(self.rows()[joint].reversed);
            SymbolicTurn { s: s * cosine + c * sine, c: c * cosine - s * sine }
        })
    }
}

/// A rotation by its sine and cosine; each use says whether it is about x or about z.
#[derive(Clone, Copy)]
pub(crate) struct SymbolicTurn<'s> {
    pub(crate) s: Symbol<'s>,
    pub(crate) c: Symbol<'s>,
}

impl<'s> SymbolicTurn<'s> {
    /// Returns Rx v.
    pub(crate) fn about_x(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x, y * c - z * s, y * s + z * c])
    }

    /// Returns Rxᵀ v.
    pub(crate) fn back_about_x(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x, y * c + z * s, z * c - y * s])
    }

    /// Returns Rz v.
    pub(crate) fn about_z(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x * c - y * s, x * s + y * c, z])
    }

    /// Returns Rzᵀ v.
    pub(crate) fn back_about_z(self, v: Vector<'s>) -> Vector<'s> {
        let ([x, y, z], Self { s, c }) = (v.0, self);
        Vector([x * c + y * s, y * c - x * s, z])
    }
}
