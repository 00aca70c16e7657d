//! The full name of a number in the code: quantity, joint, component, and the variable if it is a derivative.

use std::fmt;

use super::{Axis, Component, Indices, Quantity};

/// The full name of a number: `w2_z` is component z of ω of link 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Name {
    /// The quantity.
    pub quantity: Quantity,
    /// The joint, counted from 1; 0 for the base and for what belongs to no joint, n + 1 for the tip.
    pub joint: usize,
    /// The component of the quantity.
    pub component: Component,
    /// Further indices, counted from 1; 0 is no index. Depending on the quantity: the column of a matrix whose row is
    /// the joint, the first joint of a group, link and parameter of the regressor, the number of a friction
    /// coefficient, or of an acceleration of the tip. For a force or moment between two links: the number of the first
    /// link plus one, if this is not the link before.
    pub indices: [usize; 2],
    /// The number of a shared term of the quantity, from 1; 0 for the quantity itself.
    pub part: usize,
    /// The variable of the derivative, if it is one: `w3_x_q2` is ∂ω₃ₓ/∂q₂.
    pub by: Option<WithRespectTo>,
}

/// The variable of a partial derivative; joints count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum WithRespectTo {
    /// A joint position.
    Position(usize),
    /// A joint rate.
    Rate(usize),
    /// A joint acceleration.
    RateDot(usize),
    /// A shift of a floating base along its axes, or a rotation about them, from 1: along x, y, z, then about x, y, z.
    BasePosition(usize),
    /// A velocity of a floating base, from 1: linear x, y, z, then angular x, y, z.
    BaseRate(usize),
    /// An acceleration of a floating base, from 1: linear x, y, z, then angular x, y, z.
    BaseRateDot(usize),
}

impl WithRespectTo {
    /// The name of the variable.
    #[must_use]
    pub const fn variable(self) -> Name {
        match self {
            Self::Position(joint) => Name::scalar(Quantity::Position, joint),
            Self::Rate(joint) => Name::scalar(Quantity::Rate, joint),
            Self::RateDot(joint) => Name::scalar(Quantity::RateDot, joint),
            Self::BasePosition(index) => {
                Name::of_base(Quantity::BaseShift, Quantity::BaseTurn, index.saturating_sub(1))
            }
            Self::BaseRate(index) => Name::of_base(Quantity::OriginVelocity, Quantity::Omega, index.saturating_sub(1)),
            Self::BaseRateDot(index) => {
                Name::of_base(Quantity::Acceleration, Quantity::OmegaDot, index.saturating_sub(1))
            }
        }
    }
}

impl Name {
    /// The name of a quantity that is one number.
    #[must_use]
    pub const fn scalar(quantity: Quantity, joint: usize) -> Self {
        Self { quantity, joint, component: Component::Scalar, indices: [0; 2], part: 0, by: None }
    }

    /// The name of the number at index `at` among the `count` numbers of a quantity: 1 is a single number, 3 are x, y,
    /// z, 6 an inertia xx, yy, zz, xy, xz, yz, and 9 a matrix by rows.
    pub(crate) const fn nth(quantity: Quantity, joint: usize, count: usize, at: usize) -> Self {
        use Axis::{X, Y, Z};
        const OF_INERTIA: [(Axis, Axis); 6] = [(X, X), (Y, Y), (Z, Z), (X, Y), (X, Z), (Y, Z)];
        match count {
            3 => Self::vector(quantity, joint, Axis::ALL[at]),
            6 => Self::matrix(quantity, joint, OF_INERTIA[at].0, OF_INERTIA[at].1),
            9 => Self::matrix(quantity, joint, Axis::ALL[at / 3], Axis::ALL[at % 3]),
            _ => Self::scalar(quantity, joint),
        }
    }

    /// The name of one of six numbers of the base, counted from 0: x, y, z of `linear`, then of `angular`.
    #[must_use]
    pub const fn of_base(linear: Quantity, angular: Quantity, index: usize) -> Self {
        Self::vector(if index < 3 { linear } else { angular }, 0, Axis::ALL[index % 3])
    }

    /// The name of a component of a vector.
    #[must_use]
    pub const fn vector(quantity: Quantity, joint: usize, axis: Axis) -> Self {
        Self { component: Component::Vector(axis), ..Self::scalar(quantity, joint) }
    }

    /// Whether the text of the name contains the joint. Names of quantities that exist once or are only counted do not.
    pub(crate) const fn tells_joint(&self) -> bool {
        !matches!(self.quantity.indices(), Indices::Alone | Indices::Counted)
    }

    /// The name of an element of a matrix.
    #[must_use]
    pub const fn matrix(quantity: Quantity, joint: usize, row: Axis, column: Axis) -> Self {
        Self { component: Component::Matrix(row, column), ..Self::scalar(quantity, joint) }
    }

    /// The index in the name of a quantity between two links that gives the first one, `parent`; both count from
    /// 1, and 0 is the base. It is 0, no index, if `parent` is the link before.
    pub(crate) const fn index_of_parent(joint: usize, parent: usize) -> usize {
        if parent + 1 == joint { 0 } else { parent + 1 }
    }

    /// The name of a quantity with one more index beside the joint.
    #[must_use]
    pub const fn indexed(quantity: Quantity, joint: usize, index: usize) -> Self {
        Self { indices: [index, 0], ..Self::scalar(quantity, joint) }
    }

    /// The name of an element of an inertia in the table, which has only the upper half. Other names stay as they are.
    #[must_use]
    pub fn of_upper_half(self) -> Self {
        match (self.quantity, self.component) {
            (Quantity::Inertia, Component::Matrix(row, column)) if row > column => {
                Self { component: Component::Matrix(column, row), ..self }
            }
            _ => self,
        }
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.quantity.prefix())?;
        let mut indices = self.indices;
        match self.quantity.indices() {
            Indices::Alone | Indices::Counted => {}
            Indices::Group => {
                write!(f, "{}_{}", indices[0], self.joint)?;
                indices[0] = 0;
            }
            Indices::Links => {
                let parent = if indices[0] > 0 { indices[0] } else { self.joint };
                write!(f, "{}_{}", parent.saturating_sub(1), self.joint)?;
                indices[0] = 0;
            }
            _ => write!(f, "{}", self.joint)?,
        }
        match self.component {
            Component::Scalar => {}
            Component::Vector(axis) => write!(f, "_{axis}")?,
            Component::Matrix(row, column) => write!(f, "_{row}{column}")?,
        }
        for count in indices.into_iter().chain([self.part]).filter(|&count| count > 0) {
            write!(f, "_{count}")?;
        }
        if let Some(by) = self.by {
            write!(f, "_{}", by.variable())?;
        }
        Ok(())
    }
}
