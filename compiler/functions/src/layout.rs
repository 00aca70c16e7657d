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

/// The shapes of results, by the names that they have in the list of functions; those of records are there, too.
#[allow(non_upper_case_globals)] // named as in the list
pub(crate) mod returned {
    use super::Length::{Bodies, Fixed, Joints, Passive, Tips, Velocities};
    use super::Shape::{self, Array};
    pub(crate) use crate::record::returned::*;

    /// One number.
    pub(crate) const Number: Shape = Shape::Number;
    /// A number per joint.
    pub(crate) const Vector: Shape = Array(Joints, &Number);
    /// A row and a column per joint.
    pub(crate) const Matrix: Shape = Array(Joints, &Vector);
    /// Three coordinates.
    pub(crate) const Point: Shape = Array(Fixed(3), &Number);
    /// Three rows with a column per joint.
    pub(crate) const PointRows: Shape = Array(Fixed(3), &Vector);
    /// Three linear coordinates, then three angular ones.
    pub(crate) const Spatial: Shape = Array(Fixed(6), &Number);
    /// Three linear rows, then three angular ones, with a column per joint.
    pub(crate) const SpatialRows: Shape = Array(Fixed(6), &Vector);
    /// A matrix for each of three linear coordinates, then of three angular ones.
    pub(crate) const SpatialMatrices: Shape = Array(Fixed(6), &Matrix);
    /// A pose per joint.
    pub(crate) const Poses: Shape = Array(Joints, &Pose);
    /// A force and a moment per joint.
    pub(crate) const Wrenches: Shape = Array(Joints, &Wrench);
    /// A force and a moment per tip.
    pub(crate) const TipWrenches: Shape = Array(Tips, &Wrench);
    /// The ten inertial parameters of a body.
    const PARAMETERS: Shape = Array(Fixed(10), &Number);
    /// Ten numbers per torque and link.
    pub(crate) const Regressor: Shape = Array(Joints, &Array(Joints, &PARAMETERS));
    /// Six rows of the base and one per joint, with ten numbers of the base and of each link.
    pub(crate) const FloatingRegressor: Shape = Array(Velocities, &Array(Bodies, &PARAMETERS));
    /// Six numbers of the base, and one per joint.
    pub(crate) const FloatingVector: Shape = Array(Velocities, &Number);
    /// Six rows and columns of the base, and one per joint.
    pub(crate) const FloatingMatrix: Shape = Array(Velocities, &FloatingVector);
    /// Six rows of the base and one per joint, with a column per joint.
    pub(crate) const RowsByJoint: Shape = Array(Velocities, &Vector);
    /// Six rows of the base and one per joint, with three columns.
    pub(crate) const RowsByAxis: Shape = Array(Velocities, &Point);
    /// Three linear rows, then three angular ones, with six columns of the base and one per joint.
    pub(crate) const FloatingRows: Shape = Array(Fixed(6), &FloatingVector);
    /// These rows for each tip.
    pub(crate) const TipRows: Shape = Array(Tips, &FloatingRows);
    /// Three linear coordinates, then three angular ones, for each tip.
    pub(crate) const TipVectors: Shape = Array(Tips, &Spatial);
    /// Three rows of three coordinates.
    pub(crate) const Rotation: Shape = Array(Fixed(3), &Point);
    /// A number per dependent joint of the loops.
    pub(crate) const PassiveVector: Shape = Array(Passive, &Number);
    /// A row per dependent joint, with a column per joint.
    pub(crate) const PassiveRows: Shape = Array(Passive, &Vector);
    /// A number per equation of the loops.
    pub(crate) const Residual: Shape = Array(super::Length::Equations, &Number);
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

    /// The number of velocities of a floating base.
    pub const OF_BASE: usize = 6;
}

impl Shape {
    /// Whether a part of it has this length.
    pub(crate) fn has(&self, length: Length) -> bool {
        match self {
            Self::Number => false,
            Self::Array(own, of) => *own == length || of.has(length),
            Self::Record(_, parts) => parts.iter().any(|part| part.has(length)),
        }
    }

    /// How many numbers there are for a robot.
    #[must_use]
    pub fn len(&self, sizes: Sizes) -> usize {
        match self {
            Self::Number => 1,
            Self::Array(length, of) => length.of(sizes) * of.len(sizes),
            Self::Record(_, parts) => parts.iter().map(|part| part.len(sizes)).sum(),
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

    /// Its elements or parts, in order.
    pub fn parts(&self) -> impl Iterator<Item = &Self> {
        let (count, of, parts) = match self {
            Self::Number => (0, None, [].as_slice()),
            Self::Array(length, of) => (*length, Some(&**of), [].as_slice()),
            Self::Record(_, parts) => (0, None, parts.as_slice()),
        };
        core::iter::repeat_n(of, count).flatten().chain(parts)
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
