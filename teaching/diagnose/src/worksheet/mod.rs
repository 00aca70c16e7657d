//! The worksheet of the seven steps: every line of a calculation by hand, in order, with its formula, terms and inputs.
//! It also finds the first line in which given values differ.
//!
//! The numbers are those of [`DynArm::trace`]. This module does not read files and does not print.

mod comparison;
mod followed;
mod formulas;
mod given;
mod local;
mod other_axes;
mod quantity;
mod slipped;

use rne_model::{Convention, JointKind, Robot};
use rne_runtime::{BaseMotion, DynArm, LinkTrace, Payload, Wrench, WrongLength};

pub use self::comparison::{Comparison, Difference, GivenValue, Reach, Reason, Verdict};
use self::formulas::Formulas;
pub use self::quantity::{Quantity, UnknownQuantity};

/// Error of a computation in double precision, as a part of the largest value of the same unit.
const ROUNDING: f64 = 1e-9;

/// Axes in which the vectors of a joint's lines are expressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axes {
    /// Axes fixed to link i, with z along joint i: those of the generated code.
    Link,
    /// Axes fixed to link i-1, with z along joint i: those of the lecture, for both conventions.
    Joint,
    /// The axes of frame 0.
    Base,
}

impl Axes {
    /// Returns the name of the axes in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Link => "link",
            Self::Joint => "joint",
            Self::Base => "base",
        }
    }

    /// Describes the axes in words, for people who fill in a worksheet.
    #[must_use]
    pub const fn explained(self) -> &'static str {
        match self {
            Self::Link => "fixed to link i, z along joint i",
            Self::Joint => "fixed to link i - 1, z along joint i",
            Self::Base => "those of frame 0",
        }
    }

    /// Returns the axes with this name; `lecture` also means [`Axes::Joint`].
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        match name {
            "link" => Some(Self::Link),
            "joint" | "lecture" => Some(Self::Joint),
            "base" => Some(Self::Base),
            _ => None,
        }
    }
}

/// The motion of an arm, and the forces on it. Lists run from base to tip, in rad or m, rad/s or m/s, and rad/s² or
/// m/s².
#[derive(Clone, Debug, PartialEq)]
pub struct Situation {
    /// Joint positions.
    pub q: Vec<f64>,
    /// Joint velocities.
    pub qd: Vec<f64>,
    /// Joint accelerations.
    pub qdd: Vec<f64>,
    /// The motion of the base, and gravity, in frame 0; `None` for a base at rest under the robot's gravity.
    pub base: Option<BaseMotion<f64>>,
    /// The wrench that the last link exerts on its environment, at the tip, in tip axes.
    pub wrench: Option<Wrench<f64>>,
    /// The payload that is fixed to the tip of an arm with a fixed base; `wrench` is ignored then.
    pub payload: Option<Payload<f64>>,
}

/// The seven steps of one state in one set of axes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Worksheet {
    /// The axes of its vectors.
    pub axes: Axes,
    /// Every line in the order of computation: inputs and steps 1 to 5 from base to tip, then steps 6 and 7 from tip to
    /// base.
    pub lines: Vec<Line>,
}

/// A line of a worksheet: a quantity of a joint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Line {
    /// The joint, from 1 at the base.
    pub joint: usize,
    /// Whether the joint is revolute or prismatic.
    pub kind: JointKind,
    /// The quantity of the line.
    pub quantity: Quantity,
    /// A number for each of [`Quantity::components`].
    pub values: Vec<f64>,
    /// Right side of the formula, or a description such as `given`.
    pub formula: String,
    /// The terms of the sum; empty if the value is given.
    pub terms: Vec<Term>,
    /// The inputs of the formula, in its order.
    pub inputs: Vec<Input>,
}

/// A term of a formula.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Term {
    /// The term as in the formula, such as `ω2 × (ω2 × d2)`.
    pub text: String,
    /// The components of the term, including its sign.
    pub values: Vec<f64>,
    /// Slips in this term only: a description, and the resulting components of the term.
    pub slips: Vec<(String, Vec<f64>)>,
}

/// An input of a formula.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Input {
    /// The symbol, such as `ω1`.
    pub symbol: String,
    /// The value: one number, a vector of three, or a matrix of nine, row by row.
    pub values: Vec<f64>,
    /// The unit; 1 for a number without one.
    pub unit: &'static str,
}

impl Line {
    /// Returns the symbol of the quantity, such as `ω̇2`.
    #[must_use]
    pub fn symbol(&self) -> String {
        self.quantity.symbol(self.joint)
    }

    /// Returns the unit; 1 for a number without one.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.quantity.unit(self.kind)
    }

    /// Returns the largest norm among the values, the terms, and the inputs with the same unit. Rounding errors of a
    /// calculation by hand are relative to it.
    #[must_use]
    pub fn size(&self) -> f64 {
        let inputs = self.inputs.iter().filter(|input| input.unit == self.unit() && input.unit != "1");
        let values_of_terms = self.terms.iter().map(|term| &term.values).chain(inputs.map(|input| &input.values));
        values_of_terms.map(|values| norm(values)).fold(norm(&self.values), f64::max)
    }
}

impl Worksheet {
    /// Computes the worksheet of a robot.
    ///
    /// # Errors
    /// When a list of the situation does not have one number per joint.
    pub fn new(robot: &Robot, at: &Situation, axes: Axes) -> Result<Self, WrongLength> {
        let computed = Computed::new(robot, at, axes)?;
        let lines = computed.formulas(robot, at, &computed.links).lines();
        Ok(Self { axes, lines })
    }

    /// Returns the line of a quantity for a joint, counted from 1.
    #[must_use]
    pub fn line(&self, joint: usize, quantity: Quantity) -> Option<&Line> {
        self.lines.iter().find(|line| line.joint == joint && line.quantity == quantity)
    }

    /// Returns the largest [`size`](Line::size) of the lines with a unit.
    fn largest(&self, unit: &str) -> f64 {
        self.lines.iter().filter(|line| line.unit() == unit).map(Line::size).fold(0.0, f64::max)
    }

    /// Returns the torques and forces of the actuators, base to tip.
    #[must_use]
    pub fn tau(&self) -> Vec<f64> {
        let is_torque = |line: &&Line| line.quantity == Quantity::Tau;
        let mut lines: Vec<&Line> = self.lines.iter().filter(is_torque).collect();
        lines.sort_by_key(|line| line.joint);
        lines.iter().flat_map(|line| line.values.iter().copied()).collect()
    }
}

/// The numbers from which the lines are made.
struct Computed {
    base: BaseMotion<f64>,
    axes: Axes,
    /// The vectors of the links in the axes of the worksheet.
    links: Vec<LinkTrace<f64>>,
    /// The vectors of the links in axes fixed to each link.
    fixed: Vec<LinkTrace<f64>>,
}

impl Computed {
    fn new(robot: &Robot, at: &Situation, axes: Axes) -> Result<Self, WrongLength> {
        let arm = DynArm::from_robot(robot);
        let base = at.base.unwrap_or_else(|| arm.fixed_base());
        let trace = match &at.payload {
            Some(payload) => arm.trace_with_payload(&at.q, &at.qd, &at.qdd, payload)?,
            None => arm.trace(&at.q, &at.qd, &at.qdd, &base, at.wrench.as_ref())?,
        };
        let links = match axes {
            Axes::Link => trace.links.clone(),
            Axes::Joint => trace.to_lecture(),
            Axes::Base => trace.to_base(),
        };
        Ok(Self { base, axes, links, fixed: trace.links })
    }

    /// Returns the formulas with the values of `links`.
    fn formulas<'a>(&'a self, robot: &'a Robot, at: &'a Situation, links: &'a [LinkTrace<f64>]) -> Formulas<'a> {
        Formulas { robot, at, base: self.base, axes: self.axes, links, fixed: &self.fixed }
    }
}

/// Returns r_0, the vector from the origin of frame 0 to joint 1.
fn first_lever(robot: &Robot) -> [f64; 3] {
    let a = robot.rows().next().map_or(0.0, |row| row.dh.a);
    match robot.convention {
        Convention::Standard => [0.0; 3],
        Convention::Modified => [a, 0.0, 0.0],
    }
}

/// Returns the orientations of the links, products of their rotations A_i = R_1 R_2 ⋯ R_i, from a trace in axes fixed
/// to the links.
fn orientations(fixed: &[LinkTrace<f64>]) -> Vec<nalgebra::Matrix3<f64>> {
    let mut turn = nalgebra::Matrix3::identity();
    let next = |link: &LinkTrace<f64>| {
        turn *= link.rotation_matrix();
        turn
    };
    fixed.iter().map(next).collect()
}

/// Returns the six components of a symmetric matrix.
fn symmetric(matrix: &nalgebra::Matrix3<f64>) -> Vec<f64> {
    [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(|at| matrix[at]).to_vec()
}

pub(crate) fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
