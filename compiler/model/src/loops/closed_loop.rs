//! Closed loops: a cut joint connects two places on links of the tree, so that the positions of some joints follow from
//! those of the other joints.
//!
//! A loop is cut at the joint that the file names. The rest is a tree, and the cut joint becomes a list of equations
//! between two places, each on a link of the tree. The axes of the places are x₁, y₁, z₁ and x₂, y₂, z₂:
//!
//! ```text
//! revolute    p₂ - p₁ = 0,  x₁·z₂ = 0,  y₁·z₂ = 0                z₁ = z₂ is the axis
//! spherical   p₂ - p₁ = 0
//! universal   p₂ - p₁ = 0,  x₁·y₂ = 0                            it turns about x₁ and about y₂
//! weld        p₂ - p₁ = 0,  y₁·z₂ = 0,  z₁·x₂ = 0,  x₁·y₂ = 0
//! ```
//!
//! z₁ and z₂ of a revolute cut must have one direction, and so must the axes of a weld: with opposite directions the
//! equations are satisfied, too, but the loop is assembled otherwise than the places say.
//!
//! p₂ - p₁ is written in the axes of the loop: the frame of the first joint that moves one place and not the other, as
//! the link before that joint carries it, so that it does not turn with the joint.

use crate::parts::pose::own_joints;
use crate::{FixedFrame, Robot};

/// A closed loop: an entry of `loops` in a robot file. Parallelograms are not among them, because they become
/// couplings.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoop {
    /// The name of the loop.
    pub name: String,
    /// The kind of the joint at which the loop is cut.
    pub cut: Cut,
    /// The two places that the cut joint connects, with the axes x₁ y₁ z₁ and x₂ y₂ z₂, each on a link of the tree.
    pub between: [FixedFrame; 2],
    /// The joints of the key `dependent`, counted from 0, in the order of the file.
    pub dependent: Vec<usize>,
}

/// The kind of the cut joint, which closes a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// The joint turns about z of both places.
    Revolute,
    /// The joint turns about every axis.
    Spherical,
    /// The joint turns about x of the first place and about y of the second, which stay perpendicular.
    Universal,
    /// The joint does not move.
    Weld,
}

impl Cut {
    /// All kinds of cut joints, in the order in which documents list them.
    pub const ALL: [Self; 4] = [Self::Revolute, Self::Spherical, Self::Universal, Self::Weld];

    /// Returns the name of this kind of joint in robot files, such as `revolute`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Revolute => "revolute",
            Self::Spherical => "spherical",
            Self::Universal => "universal",
            Self::Weld => "weld",
        }
    }

    /// Returns pairs of axes, one of the first and one of the second place (0 to 2 for x to z), whose scalar product is
    /// zero.
    #[must_use]
    pub const fn perpendicular(self) -> &'static [[usize; 2]] {
        match self {
            Self::Revolute => &[[0, 2], [1, 2]],
            Self::Spherical => &[],
            Self::Universal => &[[0, 1]],
            Self::Weld => &[[1, 2], [2, 0], [0, 1]],
        }
    }

    /// Returns the number of equations of this joint: three for positions, and one for each pair of perpendicular axes.
    #[must_use]
    pub const fn equations(self) -> usize {
        3 + self.perpendicular().len()
    }
}

/// The closed loops of a robot, and how their equations are solved. Everything is empty for a robot without closed
/// loops.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ClosedLoops {
    /// The loops, in the order of the file.
    pub loops: Vec<ClosedLoop>,
    /// The dependent joints, counted from 0, in the order of the joints.
    pub passive: Vec<usize>,
    /// The order of elimination, with one equation for each dependent joint.
    pub elimination: Vec<Pivot>,
    /// Up to 20 configurations that close the loops, each with the positions of all joints; they were found when the
    /// file was read, within the position limits as far as possible. At each of them the dependent joints follow from
    /// the others.
    pub closures: Vec<Vec<f64>>,
    /// The smallest and the largest singular value of the Jacobian of the eliminated equations with respect to the
    /// dependent joints; at the closures, and at the worst configuration that a search from them found within the
    /// limits; m or 1 per rad or m.
    pub singular_values: [f64; 2],
    /// The smallest pivot at the closures and at the configuration to which a search for small pivots led; pivots
    /// within the limits are hardly smaller.
    pub smallest_pivot: f64,
}

/// A step of the elimination: which equation gives which dependent joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pivot {
    /// The equation, counted from 0 through all loops in their order. Each loop has its three position equations first.
    pub equation: usize,
    /// The index of the joint in [`ClosedLoops::passive`].
    pub passive: usize,
}

impl Robot {
    /// Returns the joints that move one place of a loop and not the other, base first: those of the first place, then
    /// those of the second.
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

    /// Returns the number of equations of all loops together.
    #[must_use]
    pub fn equations(&self) -> usize {
        self.loops.iter().map(|closed| closed.cut.equations()).sum()
    }
}
