//! The worksheet of the seven steps: every line that a hand fills in, in the order in which it does, with its formula,
//! its terms and what goes into them; and the first line in which somebody else's values differ.
//!
//! The numbers are those of [`DynArm::trace`]. Numbers in, data out: nothing here reads a file or prints.

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

/// The error of a double-precision computation, in parts of the largest value of that unit.
const ROUNDING: f64 = 1e-9;

/// Axes in which the vectors of a joint's entry are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axes {
    /// Fixed to link i, z along joint i: those of the generated code.
    Link,
    /// Fixed to link i-1, z along joint i: the lecture's, for both conventions.
    Joint,
    /// The axes of frame 0.
    Base,
}

impl Axes {
    /// The word for them in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Link => "link",
            Self::Joint => "joint",
            Self::Base => "base",
        }
    }

    /// The axes in words, for people who fill in a worksheet.
    #[must_use]
    pub const fn explained(self) -> &'static str {
        match self {
            Self::Link => "fixed to link i, z along joint i",
            Self::Joint => "fixed to link i - 1, z along joint i",
            Self::Base => "those of frame 0",
        }
    }

    /// The axes of a word; the lecture's are the joint's.
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

/// The motion of an arm, and the forces on it. Lists run from base to tip; rad or m, and per second.
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
    /// The payload that is fixed to the tip of an arm on a base at rest; then there is no other wrench.
    pub payload: Option<Payload<f64>>,
}

/// The seven steps of one state in one set of axes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Worksheet {
    /// The axes of its vectors.
    pub axes: Axes,
    /// Every line, in the order of computation: what is given and steps 1 to 5 from base to tip, steps 6 and 7 back.
    pub lines: Vec<Line>,
}

/// A quantity of a joint.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Line {
    /// The joint, from 1 at the base.
    pub joint: usize,
    /// Whether it turns or slides.
    pub kind: JointKind,
    /// The quantity of the line.
    pub quantity: Quantity,
    /// A number for each of [`Quantity::components`].
    pub values: Vec<f64>,
    /// Right side of its formula, or what it is.
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
    /// As the formula has it: `ω2 × (ω2 × d2)`.
    pub text: String,
    /// Its numbers, with its sign.
    pub values: Vec<f64>,
    /// Slips in this term alone: the words for the slip, and the numbers that it gives.
    pub slips: Vec<(String, Vec<f64>)>,
}

/// Something that goes into a formula.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Input {
    /// `ω1`.
    pub symbol: String,
    /// The value: one number, a vector of three, or a matrix of nine, row by row.
    pub values: Vec<f64>,
    /// The unit; 1 for a number without one.
    pub unit: &'static str,
}

impl Line {
    /// Its symbol: `ω̇2`.
    #[must_use]
    pub fn symbol(&self) -> String {
        self.quantity.symbol(self.joint)
    }

    /// The unit; 1 for a number without one.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.quantity.unit(self.kind)
    }

    /// How large it is, its terms, and what goes into it in the same unit: in parts of this a hand that rounds each
    /// number is off.
    #[must_use]
    pub fn size(&self) -> f64 {
        let inputs = self.inputs.iter().filter(|input| input.unit == self.unit() && input.unit != "1");
        let values_of_terms = self.terms.iter().map(|term| &term.values).chain(inputs.map(|input| &input.values));
        values_of_terms.map(|values| norm(values)).fold(norm(&self.values), f64::max)
    }
}

impl Worksheet {
    /// The worksheet of a robot.
    ///
    /// # Errors
    /// When a list of the situation does not have one number per joint.
    pub fn new(robot: &Robot, at: &Situation, axes: Axes) -> Result<Self, WrongLength> {
        let computed = Computed::new(robot, at, axes)?;
        let lines = computed.formulas(robot, at, &computed.links).lines();
        Ok(Self { axes, lines })
    }

    /// The line of a quantity of a joint, counted from 1.
    #[must_use]
    pub fn line(&self, joint: usize, quantity: Quantity) -> Option<&Line> {
        self.lines.iter().find(|line| line.joint == joint && line.quantity == quantity)
    }

    /// The largest size of a line in a unit.
    fn largest(&self, unit: &str) -> f64 {
        self.lines.iter().filter(|line| line.unit() == unit).map(Line::size).fold(0.0, f64::max)
    }

    /// The torques and forces of the actuators, base to tip.
    #[must_use]
    pub fn tau(&self) -> Vec<f64> {
        let is_torque = |line: &&Line| line.quantity == Quantity::Tau;
        let mut lines: Vec<&Line> = self.lines.iter().filter(is_torque).collect();
        lines.sort_by_key(|line| line.joint);
        lines.iter().flat_map(|line| line.values.iter().copied()).collect()
    }
}

/// The numbers that the lines are made of.
struct Computed {
    base: BaseMotion<f64>,
    axes: Axes,
    /// In these axes.
    links: Vec<LinkTrace<f64>>,
    /// In axes fixed to each link.
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

    /// The formulas with the values of `links`.
    fn formulas<'a>(&'a self, robot: &'a Robot, at: &'a Situation, links: &'a [LinkTrace<f64>]) -> Formulas<'a> {
        Formulas { robot, at, base: self.base, axes: self.axes, links, fixed: &self.fixed }
    }
}

/// The vector from the origin of frame 0 to joint 1: r_0.
fn first_lever(robot: &Robot) -> [f64; 3] {
    let a = robot.rows().next().map_or(0.0, |row| row.dh.a);
    match robot.convention {
        Convention::Standard => [0.0; 3],
        Convention::Modified => [a, 0.0, 0.0],
    }
}

/// Orientations A_i = R_1 … R_i of the links of a trace in axes fixed to them.
fn orientations(fixed: &[LinkTrace<f64>]) -> Vec<nalgebra::Matrix3<f64>> {
    let mut turn = nalgebra::Matrix3::identity();
    let next = |link: &LinkTrace<f64>| {
        turn *= link.rotation_matrix();
        turn
    };
    fixed.iter().map(next).collect()
}

/// The components of a symmetric matrix.
fn symmetric(matrix: &nalgebra::Matrix3<f64>) -> Vec<f64> {
    [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(|at| matrix[at]).to_vec()
}

pub(crate) fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
