//! How the numbers of a function are laid out for people.

/// How the numbers of a function are laid out for people.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// A torque per joint, beside the arguments.
    Torques,
    /// An acceleration per joint, beside the arguments.
    Accelerations,
    /// A number, in this unit.
    Number(&'static str),
    /// Tables, one below the other, each row by row.
    Tables(&'static [AnswerTable]),
    /// A pose of the tip, or one per link.
    Poses,
    /// Torque by link by parameter.
    PerParameter,
}

/// Numbers in rows and columns that have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AnswerTable {
    /// Meaning of the numbers, and their units if those are the same for all robots.
    pub about: &'static str,
    /// Their units, where the kinds of the joints decide.
    pub unit: Option<MatrixUnit>,
    /// The names of the rows.
    pub rows: Labels,
    /// The names of the columns.
    pub columns: Labels,
}

impl AnswerTable {
    pub(crate) const fn of(about: &'static str, rows: Labels, columns: Labels) -> Self {
        Self { about, unit: None, rows, columns }
    }
}

/// The names of rows or columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Labels {
    /// The names of the joints.
    Joints,
    /// x, y, z of the base, then about x, y, z, then the names of the joints.
    BaseAndJoints,
    /// The names of the dependent joints of closed loops.
    Passive,
    /// The equations of closed loops.
    Equations,
    /// Each of these for each tip, with its name.
    OfTips(&'static [&'static str]),
    /// These.
    Names(&'static [&'static str]),
}

/// The units of a matrix by the kinds of the joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MatrixUnit {
    /// Torque per acceleration.
    Mass,
    /// Torque per position.
    PerPosition,
    /// Torque per velocity.
    PerRate,
}

/// The names of three components.
pub(crate) const AXES: Labels = Labels::Names(&["x", "y", "z"]);
