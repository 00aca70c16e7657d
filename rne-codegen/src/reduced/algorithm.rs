//! The ways in which a function can be written under a plan, and which of them takes the fewest operations.

use crate::reduced::aba;
use crate::reduced::backward::torques;
use crate::reduced::crba::{self, Gathering};
use crate::reduced::forward::{Arm, motions};
use crate::reduced::joint_frames::Table;
use crate::reduced::rnea_derivatives::sensitivity;

use serde::{Deserialize, Serialize};

use crate::formulate::ldlt;
use crate::formulate::square;
use crate::function::Function;
use crate::ir::name::{By, Name};
use crate::ir::quantity::Quantity;
use crate::ir::{Builder, Number, Symbol};

/// How a function is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Way {
    /// The recursion, out and back, and what follows from its torques.
    #[default]
    Recursion,
    /// Composite bodies.
    Composite(Gathering),
    /// The recursion, once per joint that accelerates.
    Columns,
    /// Articulated bodies.
    Articulated(Gathering),
}

impl Way {
    /// All of them, with their names in plan files.
    const NAMES: [(Self, &'static str); 6] = [
        (Self::Recursion, "rnea"),
        (Self::Composite(Gathering::Groups), "crba_by_groups"),
        (Self::Composite(Gathering::Joints), "crba_by_joints"),
        (Self::Columns, "unit_columns"),
        (Self::Articulated(Gathering::Groups), "aba_by_groups"),
        (Self::Articulated(Gathering::Joints), "aba_by_joints"),
    ];

    pub(crate) fn is_rnea(&self) -> bool {
        *self == Self::Recursion
    }

    /// The ways of a function; none for what has no reduced recursion.
    pub(crate) const fn of(function: Function) -> &'static [Self] {
        const BY_GROUPS: Way = Way::Composite(Gathering::Groups);
        const BY_JOINTS: Way = Way::Composite(Gathering::Joints);
        match function {
            Function::InverseDynamics
            | Function::InverseDynamicsWithWrench
            | Function::InverseDynamicsSc
            | Function::BiasTorques => &[Way::Recursion],
            Function::CoriolisMatrix | Function::InverseDynamicsDerivatives => &[BY_GROUPS, BY_JOINTS, Way::Recursion],
            Function::GravityTorques => &[Way::Recursion, BY_GROUPS, BY_JOINTS],
            Function::MassMatrix => &[BY_GROUPS, BY_JOINTS, Way::Columns],
            Function::ForwardDynamics => &[
                BY_GROUPS,
                BY_JOINTS,
                Way::Columns,
                Way::Articulated(Gathering::Groups),
                Way::Articulated(Gathering::Joints),
            ],
            _ => &[],
        }
    }

    /// The ways of a function for so many joints that are worth counting. Those that write the recursion anew for every
    /// joint grow faster than composite bodies, and lose long before `MANY`.
    pub(crate) fn of_so_many(function: Function, joints: usize) -> Vec<Self> {
        const MANY: usize = 10;
        let is_of_columns = |way: Self| {
            way == Way::Columns
                || way == Way::Recursion
                    && matches!(function, Function::CoriolisMatrix | Function::InverseDynamicsDerivatives)
        };
        Self::of(function).iter().copied().filter(|way| joints < MANY || !is_of_columns(*way)).collect()
    }

    /// In words, for the choices of a program; nothing is said of the recursion.
    pub(crate) const fn words(self) -> Option<&'static str> {
        match self {
            Self::Recursion => None,
            Self::Composite(Gathering::Groups) => Some("composite bodies, gathered per group of parallel axes"),
            Self::Composite(Gathering::Joints) => Some("composite bodies, gathered joint by joint"),
            Self::Columns => Some("columns: one recursion per joint that accelerates"),
            Self::Articulated(Gathering::Groups) => Some("articulated bodies, gathered per group of parallel axes"),
            Self::Articulated(Gathering::Joints) => Some("articulated bodies, gathered joint by joint"),
        }
    }
}

impl From<Way> for String {
    fn from(way: Way) -> Self {
        Way::NAMES.into_iter().find(|(other, _)| *other == way).map_or("", |(_, name)| name).to_owned()
    }
}

impl TryFrom<String> for Way {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let known = Self::NAMES.into_iter().find(|(_, name)| *name == text);
        known.map(|(way, _)| way).ok_or_else(|| {
            let names = Self::NAMES.map(|(_, name)| name).join("`, `");
            format!("`{}` is no algorithm; expected one of `{names}`", text.escape_debug())
        })
    }
}

/// Writes a function on the builder's sheet: what it returns, by name, in the order of its layout.
pub(crate) fn write<'s>(builder: &'s Builder, arm: &Arm<'_>, function: Function, way: Way) -> Vec<(Name, Symbol<'s>)> {
    let by_joint = |quantity: Quantity, values: Vec<Symbol<'s>>| -> Vec<(Name, Symbol<'s>)> {
        values.into_iter().enumerate().map(|(index, value)| (Name::scalar(quantity, index + 1), value)).collect()
    };
    match (function, way) {
        (Function::GravityTorques, Way::Composite(gathering)) => {
            by_joint(Quantity::Torque, crba::gravity_torques(builder, arm, gathering))
        }
        (Function::MassMatrix, _) => {
            let upper = mass_matrix(builder, arm, way);
            square(arm.rows().len(), |row, column| {
                let (row, column) = (row.min(column), row.max(column));
                let by = Some(By::RateDot(column + 1));
                (Name { by, ..Name::scalar(Quantity::Torque, row + 1) }, upper[row][column - row])
            })
        }
        (Function::ForwardDynamics, Way::Articulated(gathering)) => {
            by_joint(Quantity::RateDot, aba::forward_dynamics(builder, arm, gathering))
        }
        (Function::ForwardDynamics, _) => {
            let upper = mass_matrix(builder, arm, way);
            let bias = recursion(builder, arm);
            let rest: Vec<_> = bias
                .into_iter()
                .enumerate()
                .map(|(index, torque)| {
                    builder.at(Quantity::Reduced, index + 1);
                    builder.torque(index) - torque
                })
                .collect();
            by_joint(Quantity::RateDot, ldlt::solved(builder, &upper, &rest))
        }
        (Function::InverseDynamicsDerivatives, Way::Composite(gathering)) => {
            let found = sensitivity(builder, arm, gathering, Number::integer(2));
            let by = |kind: fn(usize) -> By, matrix: &[Vec<Symbol<'s>>]| {
                square(arm.rows().len(), |row, column| {
                    let name = Name { by: Some(kind(column + 1)), ..Name::scalar(Quantity::Torque, row + 1) };
                    builder.name(name, matrix[row][column]);
                    (name, matrix[row][column])
                })
            };
            [by(By::Position, &found.by_position), by(By::Rate, &found.by_rate)].concat()
        }
        (Function::CoriolisMatrix, Way::Composite(gathering)) => {
            let found = sensitivity(builder, arm, gathering, Number::ONE);
            square(arm.rows().len(), |row, column| {
                let name = Name::indexed(Quantity::CoriolisElement, row + 1, column + 1);
                builder.name(name, found.by_rate[row][column]);
                (name, found.by_rate[row][column])
            })
        }
        (Function::InverseDynamicsDerivatives, _) => {
            let torques = recursion(builder, arm);
            let by = |kind: fn(usize) -> By| {
                let columns = builder.derivatives(&torques, (1..=torques.len()).map(kind));
                square(torques.len(), |row, column| {
                    let by = Some(kind(column + 1));
                    (Name { by, ..Name::scalar(Quantity::Torque, row + 1) }, columns[column][row])
                })
            };
            [by(By::Position), by(By::Rate)].concat()
        }
        (Function::CoriolisMatrix, _) => {
            let torques = recursion(builder, arm);
            let half = builder.number(Number::integer(2).inverse().unwrap_or_default());
            let columns = builder.derivatives(&torques, (1..=torques.len()).map(By::Rate));
            square(torques.len(), |row, column| {
                builder.at(Quantity::CoriolisElement, row + 1);
                let name = Name::indexed(Quantity::CoriolisElement, row + 1, column + 1);
                let element = columns[column][row] * half;
                builder.name(name, element);
                (name, element)
            })
        }
        _ => by_joint(Quantity::Torque, recursion(builder, arm)),
    }
}

fn recursion<'s>(builder: &'s Builder, arm: &Arm<'_>) -> Vec<Symbol<'s>> {
    let moved = motions(builder, arm);
    torques(builder, arm, &moved)
}

/// The upper half of M.
fn mass_matrix<'s>(builder: &'s Builder, arm: &Arm<'_>, way: Way) -> Vec<Vec<Symbol<'s>>> {
    let Way::Columns = way else {
        let gathering = if let Way::Composite(gathering) = way { gathering } else { Gathering::Joints };
        return crba::mass_matrix(builder, arm, gathering);
    };
    let table = Table { gravity: [Number::ZERO; 3], ..arm.table.clone() };
    let still = Arm { table: &table, plan: arm.plan, parameters: arm.parameters };
    let dof = arm.rows().len();
    let mut rows: Vec<Vec<_>> = vec![Vec::new(); dof];
    for column in 0..dof {
        let torques = builder.accelerating(column, || recursion(builder, &still));
        for (row, torque) in torques.into_iter().take(column + 1).enumerate() {
            rows[row].push(torque);
        }
    }
    rows
}
