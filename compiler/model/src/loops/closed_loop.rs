//! Closed loops: a cut joint joins two places of the tree, and the positions of some joints follow from those of the
//! others.
//!
//! A loop is cut where the file says so. What is left is a tree, and the cut joint is a list of equations between two
//! places, of which each is on a link of the tree. Their axes are x₁, y₁, z₁ and x₂, y₂, z₂:
//!
//! ```text
//! revolute    p₂ - p₁ = 0,  x₁·z₂ = 0,  y₁·z₂ = 0                z₁ = z₂ is the axis
//! spherical   p₂ - p₁ = 0
//! universal   p₂ - p₁ = 0,  x₁·y₂ = 0                            it turns about x₁ and about y₂
//! weld        p₂ - p₁ = 0,  y₁·z₂ = 0,  z₁·x₂ = 0,  x₁·y₂ = 0
//! ```
//!
//! z₁ and z₂ of a revolute cut have one direction, and so have the axes of a weld: at opposite ones the equations hold,
//! too, but the loop is assembled otherwise than the places say.
//!
//! p₂ - p₁ is in the axes of the loop: those of the first joint that moves one place and not the other, as its link
//! carries it, before the joint turns.

use crate::parts::pose::own_joints;
use crate::{FixedFrame, Robot};

/// A closed loop: `loops` of a robot file, without the parallelograms, which are couplings.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoop {
    /// Its name.
    pub name: String,
    /// The joint that is cut.
    pub cut: Cut,
    /// The two places that it joins, x₁ y₁ z₁ and x₂ y₂ z₂, each on a link of the tree.
    pub between: [FixedFrame; 2],
    /// The joints that its list `dependent` names, counted from 0, in the order of the file.
    pub dependent: Vec<usize>,
}

/// The joint that closes a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// It turns about z of both places.
    Revolute,
    /// It turns about every axis.
    Spherical,
    /// It turns about x of the first place and about y of the second, which stay perpendicular.
    Universal,
    /// It does not move.
    Weld,
}

impl Cut {
    /// All of them, in the order in which documents list them.
    pub const ALL: [Self; 4] = [Self::Revolute, Self::Spherical, Self::Universal, Self::Weld];

    /// Its name in robot files: `revolute`, …
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Spherical => "spherical",
            Self::Universal => "universal",
            Self::Weld => "weld",
        }
    }

    /// The axes of the first and of the second place (0 to 2 for x to z) whose products are zero.
    #[must_use]
    pub const fn perpendicular(self) -> &'static [[usize; 2]] {
        match self {
            Self::Revolute => &[[0, 2], [1, 2]],
            Self::Spherical => &[],
            Self::Universal => &[[0, 1]],
            Self::Weld => &[[1, 2], [2, 0], [0, 1]],
        }
    }

    /// How many equations it has: three of positions, and one for each pair of perpendicular axes.
    #[must_use]
    pub const fn equations(self) -> usize {
        3 + self.perpendicular().len()
    }
}

/// The closed loops of a robot, and how their equations are solved. A robot without closed loops has none of it.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ClosedLoops {
    /// The loops, in the order of the file.
    pub loops: Vec<ClosedLoop>,
    /// The dependent joints, counted from 0, in the order of the joints. Their positions are `passive`.
    pub passive: Vec<usize>,
    /// The order of elimination: one equation for each dependent joint.
    pub elimination: Vec<Pivot>,
    /// The positions of all joints at which the loops are closed, that were found when the file was read: up to 20,
    /// within the limits as far as such were found. The dependent joints follow from the others at each.
    pub closures: Vec<Vec<f64>>,
    /// The smallest and the largest singular value of the equations that are kept, by the dependent joints, at these
    /// closures and where a search downhill from them leads within the limits; m or 1 per rad or m.
    pub singular_values: [f64; 2],
    /// The smallest pivot there, and where another such search leads: a pivot within the limits is hardly smaller.
    pub smallest_pivot: f64,
}

/// A step of the elimination: the equation that gives a dependent joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pivot {
    /// Counted from 0 through the equations of all loops: those of a loop begin behind those of the loops before it,
    /// with the three of positions.
    pub equation: usize,
    /// The place of the joint in [`ClosedLoops::passive`].
    pub passive: usize,
}

impl Robot {
    /// The joints that move one place of a loop and not the other, base first: for the first and for the second place.
    #[must_use]
    pub fn ways_of_loop(&self, closed: &ClosedLoop) -> [Vec<usize>; 2] {
        own_joints(&self.joints, &closed.between)
    }
}

impl ClosedLoops {
    /// Whether the robot has no closed loop.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.loops.is_empty()
    }

    /// How many equations all loops have.
    #[must_use]
    pub fn equations(&self) -> usize {
        self.loops.iter().map(|closed| closed.cut.equations()).sum()
    }
}
