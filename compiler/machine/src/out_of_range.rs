//! Checks for numbers that an argument cannot have, shared by all interfaces that take arguments.

use std::fmt;

use rne_model::{Inertia, NegativeMoment};
use rne_runtime::{NegativeMass, Pose};

/// Numbers that an argument cannot have. NaN is accepted in a rotation and as a mass; it then appears in the results.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum OutOfRange {
    /// The mass of a payload is below zero.
    Mass(NegativeMass),
    /// A principal moment of inertia of a payload is below zero.
    Moment(NegativeMoment),
    /// The duration of a step, s, is not a finite number above zero.
    Step(f64),
    /// This argument does not have the elements of a rotation matrix.
    Rotation(String),
    /// There is no angle with this sine and this cosine of a joint.
    Angle {
        /// The joint, counted from 1 among those that do not depend on others.
        joint: usize,
        /// The sine and the cosine that were given.
        turn: [f64; 2],
    },
}

impl OutOfRange {
    /// Returns how many elements at the beginning of an argument are [checked](Self::check).
    #[must_use]
    pub fn elements(argument: &str) -> usize {
        match argument {
            "step" => 1,
            "payload" => 10,
            // a pose begins with its rotation; only that is checked
            "pose" | "base_rotation" => 9,
            _ => 0,
        }
    }

    /// Refuses numbers that an argument cannot have. `number` returns an element of the argument by its index.
    ///
    /// # Errors
    /// When the argument cannot have these numbers; the error says why.
    pub fn check(argument: &str, number: impl Fn(usize) -> Option<f64>) -> Result<(), Self> {
        let at = |element| number(element).unwrap_or(f64::NAN);
        match argument {
            "payload" => {
                NegativeMass::check(at(0)).map_err(Self::Mass)?;
                let [xx, yy, zz, xy, xz, yz] = [4, 5, 6, 7, 8, 9].map(at);
                Inertia { xx, yy, zz, xy, xz, yz }.check_of_payload().map_err(Self::Moment)
            }
            "step" if !(at(0) > 0.0 && at(0).is_finite()) => Err(Self::Step(at(0))),
            "pose" | "base_rotation" => {
                let rotation = [0, 3, 6].map(|row| [row, row + 1, row + 2].map(at));
                let is_rigid = Pose { rotation, translation: [0.0; 3] }.is_rigid();
                if is_rigid { Ok(()) } else { Err(Self::Rotation(argument.to_owned())) }
            }
            _ => Ok(()),
        }
    }

    /// Refuses a sine and a cosine that no angle has. As the numbers may come from half precision, the sum of their
    /// squares must be 1 to within 2e-3. `index` counts the joints that do not depend on others, from 0.
    ///
    /// # Errors
    /// When no angle has them; the error has the joint and both numbers.
    pub fn check_turn(index: usize, turn: [f64; 2]) -> Result<(), Self> {
        let [sin, cos] = turn;
        let is_none = (sin * sin + cos * cos - 1.0).abs() > 2e-3;
        if is_none { Err(Self::Angle { joint: index + 1, turn }) } else { Ok(()) }
    }
}

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mass(mass) => mass.fmt(f),
            Self::Moment(moment) => moment.fmt(f),
            Self::Step(step) => write!(f, "the step is {step} s, but it must be a finite number above 0"),
            Self::Rotation(argument) => write!(
                f,
                "`{argument}` is no rotation: its three rows must have the length 1, be at right angles to each other, \
                 and be right-handed"
            ),
            Self::Angle { joint, turn: [sin, cos] } => write!(
                f,
                "`sin` and `cos` are {sin} and {cos} for joint {joint}, but the sum of their squares must be 1: they \
                 are the sine and the cosine of its position"
            ),
        }
    }
}
