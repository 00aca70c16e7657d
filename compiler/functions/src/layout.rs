//! The shape of what a function returns.

use crate::Record;

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, vec::Vec};

/// How the numbers that a function returns are grouped, for any number of joints and tips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Number,
    /// Elements of one shape.
    Array(Length, &'static Self),
    /// Named parts.
    Record(Record, &'static [Self]),
}

const VECTOR: Shape = Shape::Array(Length::Joints, &Shape::Number);
const MATRIX: Shape = Shape::Array(Length::Joints, &VECTOR);
const TRIPLE: Shape = Shape::Array(Length::Fixed(3), &Shape::Number);
const BY_STATE_AND_TORQUES: Shape = Shape::Record(Record::StepDerivatives, &[MATRIX, MATRIX, MATRIX]);
const WRENCH: Shape = Shape::Record(Record::Wrench, &[TRIPLE, TRIPLE]);
const VELOCITIES: Shape = Shape::Array(Length::Velocities, &Shape::Number);
const PARAMETERS: Shape = Shape::Array(Length::Fixed(10), &Shape::Number);
const SIX: Shape = Shape::Array(Length::Fixed(6), &Shape::Number);
const BY_VELOCITIES: Shape = Shape::Array(Length::Velocities, &VELOCITIES);
const ROWS: Shape = Shape::Array(Length::Fixed(6), &VELOCITIES);
const BASE_ACCELERATION: Shape = Shape::Record(Record::BaseAcceleration, &[TRIPLE, TRIPLE]);
const ACCELERATIONS: Shape = Shape::Record(Record::FloatingAccelerations, &[BASE_ACCELERATION, VECTOR]);
const ROWS_BY_JOINT: Shape = Shape::Array(Length::Velocities, &VECTOR);
const PASSIVE: Shape = Shape::Array(Length::Passive, &Shape::Number);
const POSE: Shape = Shape::Record(Record::Pose, &[Shape::Array(Length::Fixed(3), &TRIPLE), TRIPLE]);
const TWIST: Shape = Shape::Record(Record::BaseTwist, &[TRIPLE, TRIPLE]);

/// The shapes of results, by the names that they have in the list of functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Returned {
    /// One number.
    Number,
    /// A number per joint.
    Vector,
    /// A row and a column per joint.
    Matrix,
    /// Three coordinates.
    Point,
    /// Three rows with a column per joint.
    PointRows,
    /// Three linear coordinates, then three angular ones.
    Spatial,
    /// Three linear rows, then three angular ones, with a column per joint.
    SpatialRows,
    /// A rotation and a translation.
    Pose,
    /// A pose per joint.
    Poses,
    /// A force and a moment per joint.
    Wrenches,
    /// Ten numbers per torque and link.
    Regressor,
    /// Two matrices.
    TorqueDerivatives,
    /// Two vectors.
    MomentumAndRate,
    /// A force and a moment, and a number per joint.
    FloatingTorques,
    /// Six numbers of the base, and one per joint.
    FloatingVector,
    /// Six rows and columns of the base, and one per joint.
    FloatingMatrix,
    /// Three linear rows, then three angular ones, with six columns of the base and one per joint.
    FloatingRows,
    /// These rows for each tip.
    TipRows,
    /// Three linear coordinates, then three angular ones, for each tip.
    TipVectors,
    /// A linear and an angular acceleration, and a number per joint.
    FloatingAccelerations,
    /// Six rows of the base and one per joint, with ten numbers of the base and of each link.
    FloatingRegressor,
    /// These, and a force and a moment for each tip.
    AccelerationsAndWrenches,
    /// Six rows of the base and one per joint, in three matrices: with a column per joint, the same, and three columns.
    FloatingTorqueDerivatives,
    /// A number per dependent joint of the loops.
    PassiveVector,
    /// A row per dependent joint, with a column per joint.
    PassiveRows,
    /// A number per dependent joint, and one per equation of the loops.
    ClosureStep,
    /// Three vectors.
    TorqueGradient,
    /// Three matrices.
    AccelerationDerivatives,
    /// A matrix for each of three linear coordinates, then of three angular ones.
    SpatialMatrices,
    /// Four matrices.
    TorqueHessian,
    /// Two vectors.
    NextState,
    /// Twice three matrices.
    NextStateDerivatives,
    /// A pose, a linear and an angular velocity, and two vectors.
    FloatingNextState,
    /// Six rows of the base and one per joint, in six matrices: twice two with as many columns, and one with a column
    /// per joint.
    FloatingStepDerivatives,
}

impl Returned {
    /// The shape.
    #[must_use]
    pub const fn shape(self) -> &'static Shape {
        match self {
            Self::Number => &Shape::Number,
            Self::Vector => &VECTOR,
            Self::Matrix => &MATRIX,
            Self::Point => &TRIPLE,
            Self::PointRows => &Shape::Array(Length::Fixed(3), &VECTOR),
            Self::Spatial => &SIX,
            Self::SpatialRows => &Shape::Array(Length::Fixed(6), &VECTOR),
            Self::Pose => &POSE,
            Self::Poses => &Shape::Array(Length::Joints, &POSE),
            Self::Wrenches => &Shape::Array(Length::Joints, &WRENCH),
            Self::Regressor => &Shape::Array(Length::Joints, &Shape::Array(Length::Joints, &PARAMETERS)),
            Self::TorqueDerivatives => &Shape::Record(Record::TorqueDerivatives, &[MATRIX, MATRIX]),
            Self::MomentumAndRate => &Shape::Record(Record::MomentumAndRate, &[VECTOR, VECTOR]),
            Self::FloatingTorques => &Shape::Record(Record::FloatingTorques, &[WRENCH, VECTOR]),
            Self::FloatingVector => &VELOCITIES,
            Self::FloatingMatrix => &BY_VELOCITIES,
            Self::FloatingRows => &ROWS,
            Self::TipRows => &Shape::Array(Length::Tips, &ROWS),
            Self::TipVectors => &Shape::Array(Length::Tips, &SIX),
            Self::FloatingAccelerations => &ACCELERATIONS,
            Self::FloatingRegressor => &Shape::Array(Length::Velocities, &Shape::Array(Length::Bodies, &PARAMETERS)),
            Self::FloatingTorqueDerivatives => &Shape::Record(
                Record::FloatingTorqueDerivatives,
                &[ROWS_BY_JOINT, ROWS_BY_JOINT, Shape::Array(Length::Velocities, &TRIPLE)],
            ),
            Self::PassiveVector => &PASSIVE,
            Self::PassiveRows => &Shape::Array(Length::Passive, &VECTOR),
            Self::ClosureStep => {
                &Shape::Record(Record::ClosureStep, &[PASSIVE, Shape::Array(Length::Equations, &Shape::Number)])
            }
            Self::TorqueGradient => &Shape::Record(Record::TorqueGradient, &[VECTOR, VECTOR, VECTOR]),
            Self::AccelerationDerivatives => &Shape::Record(Record::AccelerationDerivatives, &[MATRIX, MATRIX, MATRIX]),
            Self::SpatialMatrices => &Shape::Array(Length::Fixed(6), &MATRIX),
            Self::TorqueHessian => &Shape::Record(Record::TorqueHessian, &[MATRIX, MATRIX, MATRIX, MATRIX]),
            Self::NextState => &Shape::Record(Record::NextState, &[VECTOR, VECTOR]),
            Self::NextStateDerivatives => {
                &Shape::Record(Record::NextStateDerivatives, &[BY_STATE_AND_TORQUES, BY_STATE_AND_TORQUES])
            }
            Self::FloatingNextState => &Shape::Record(Record::FloatingNextState, &[POSE, TWIST, VECTOR, VECTOR]),
            Self::FloatingStepDerivatives => &Shape::Record(
                Record::FloatingStepDerivatives,
                &[BY_VELOCITIES, BY_VELOCITIES, ROWS_BY_JOINT, BY_VELOCITIES, BY_VELOCITIES, ROWS_BY_JOINT],
            ),
            Self::AccelerationsAndWrenches => {
                &Shape::Record(Record::AccelerationsAndWrenches, &[ACCELERATIONS, Shape::Array(Length::Tips, &WRENCH)])
            }
        }
    }
}

/// The length of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// One element per joint.
    Joints,
    /// Six elements of a floating base, and one per joint.
    Velocities,
    /// One element of a floating base, and one per link of a robot whose joints all move freely.
    Bodies,
    /// One element per tip.
    Tips,
    /// One element per dependent joint of the closed loops.
    Passive,
    /// One element per equation of the closed loops.
    Equations,
    /// As many for every robot.
    Fixed(usize),
}

/// The lengths of the arrays of a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// How many coordinates it has.
    pub dof: usize,
    /// How many tips.
    pub tips: usize,
    /// How many dependent joints its closed loops have.
    pub passive: usize,
    /// How many equations.
    pub equations: usize,
}

impl Length {
    /// The length for a robot.
    #[must_use]
    pub const fn of(self, sizes: Sizes) -> usize {
        match self {
            Self::Joints => sizes.dof,
            Self::Velocities => Self::OF_BASE + sizes.dof,
            Self::Bodies => 1 + sizes.dof,
            Self::Tips => sizes.tips,
            Self::Passive => sizes.passive,
            Self::Equations => sizes.equations,
            Self::Fixed(length) => length,
        }
    }

    /// How many velocities a base has that nothing holds.
    pub const OF_BASE: usize = 6;
}

impl Shape {
    /// Whether a part of it has an element per tip.
    pub(crate) fn has_tips(&self) -> bool {
        match self {
            Self::Number => false,
            Self::Array(length, of) => *length == Length::Tips || of.has_tips(),
            Self::Record(_, parts) => parts.iter().any(Self::has_tips),
        }
    }

    /// The shape for a robot.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn layout(&self, sizes: Sizes) -> Layout {
        match self {
            Self::Number => Layout::Number,
            Self::Array(length, of) => Layout::Array(length.of(sizes), Box::new(of.layout(sizes))),
            Self::Record(record, parts) => {
                Layout::Record(*record, parts.iter().map(|part| part.layout(sizes)).collect())
            }
        }
    }
}

/// How the numbers that a function returns are grouped.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One number.
    Number,
    /// Elements of one shape.
    Array(usize, Box<Self>),
    /// Named parts.
    Record(Record, Vec<Self>),
}

#[cfg(feature = "alloc")]
impl Layout {
    /// How many numbers there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Number => 1,
            Self::Array(length, of) => length * of.len(),
            Self::Record(_, parts) => parts.iter().map(Self::len).sum(),
        }
    }

    /// Whether there is no number.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Puts numbers, in their order, into the shape: `array` and `record` join what their elements and parts became.
    pub fn fold<R>(
        &self,
        numbers: &mut impl Iterator<Item = R>,
        array: &impl Fn(Vec<R>) -> R,
        record: &impl Fn(Record, Vec<R>) -> R,
    ) -> Option<R> {
        match self {
            Self::Number => numbers.next(),
            Self::Array(length, of) => {
                (0..*length).map(|_| of.fold(numbers, array, record)).collect::<Option<_>>().map(array)
            }
            Self::Record(kind, parts) => {
                let parts = parts.iter().map(|part| part.fold(numbers, array, record)).collect::<Option<_>>();
                parts.map(|parts| record(*kind, parts))
            }
        }
    }
}
