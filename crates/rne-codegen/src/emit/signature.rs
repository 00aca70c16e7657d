//! The arguments of a generated function.

use crate::program::Program;
use crate::quantity::{Axis, Name, Quantity};

/// An argument array and the names of its elements; `None` for an element that is not used.
pub(super) struct ArgumentArray {
    pub(super) name: &'static str,
    pub(super) elements: Vec<Option<Name>>,
}

/// The argument arrays of a program's function, in order.
pub(super) fn arguments(program: &Program) -> Vec<ArgumentArray> {
    let used = |name: Name| program.arguments.contains(&name).then_some(name);
    let joints = |name, quantity| ArgumentArray {
        name,
        elements: (1..=program.dof).map(|joint| used(Name::scalar(quantity, joint))).collect(),
    };
    let at_tip = |name, quantity| ArgumentArray {
        name,
        elements: Axis::ALL.map(|axis| used(Name::vector(quantity, program.dof + 1, axis))).into(),
    };
    let function = program.function;
    let mut arrays = Vec::new();
    if function.has_turns() {
        arrays.push(joints("sin", Quantity::Sine));
        arrays.push(joints("cos", Quantity::Cosine));
    }
    arrays.push(joints("q", Quantity::Position));
    if function.has_rates() {
        arrays.push(joints("qd", Quantity::Rate));
    }
    if function.has_accelerations() {
        arrays.push(joints("qdd", Quantity::RateDot));
    }
    if function.has_wrench() {
        arrays.push(at_tip("force", Quantity::JointForce));
        arrays.push(at_tip("moment", Quantity::JointMoment));
    }
    arrays
}
