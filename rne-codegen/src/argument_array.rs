//! The arguments of a generated function.

use crate::function::Argument;
use crate::ir::name::Name;
use crate::ir::quantity::{Axis, Quantity};
use crate::program::Program;

/// An argument array and the names of its elements; `None` for an element that is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct ArgumentArray {
    /// The array's name in emitted code: `q`, `qd`, `force`, ….
    pub name: &'static str,
    /// Its elements, in order.
    pub elements: Vec<Option<Name>>,
}

impl Program {
    /// The argument arrays of its function in order, those of the run-time parameters last.
    #[must_use]
    pub fn argument_arrays(&self) -> Vec<ArgumentArray> {
        self.arrays_without_parameters().into_iter().chain(parameters(self)).collect()
    }

    /// The argument arrays of its function, in order, without run-time parameters.
    #[must_use]
    pub fn arrays_without_parameters(&self) -> Vec<ArgumentArray> {
        arguments(self)
    }

    /// The names that renderers give to variables of their own: arguments, results, what is not used. No number of a
    /// program has one of them; the first of two variables of one name would be lost.
    #[doc(hidden)]
    pub fn reserved_names(&self) -> impl Iterator<Item = &'static str> {
        let arrays = self.arrays_without_parameters().into_iter().map(|array| array.name);
        // `sin` and `cos` are functions of the C library
        arrays.chain(["cosine", "parameters", "sine", "unused", "zero", self.function.entry().output])
    }
}

fn arguments(program: &Program) -> Vec<ArgumentArray> {
    let used = |name: Name| program.arguments().any(|used| used == name).then_some(name);
    let joints = |name, quantity| ArgumentArray {
        name,
        elements: (1..=program.dof).map(|joint| used(Name::scalar(quantity, joint))).collect(),
    };
    let vector = |name, quantity, joint| ArgumentArray {
        name,
        elements: Axis::ALL.map(|axis| used(Name::vector(quantity, joint, axis))).into(),
    };
    let tip = program.dof + 1;
    let mut arrays = Vec::new();
    for argument in program.function.arguments() {
        match argument {
            Argument::Sines => arrays.push(joints("sin", Quantity::Sine)),
            Argument::Cosines => arrays.push(joints("cos", Quantity::Cosine)),
            Argument::Positions => arrays.push(joints("q", Quantity::Position)),
            Argument::Rates => arrays.push(joints("qd", Quantity::Rate)),
            Argument::Accelerations => arrays.push(joints("qdd", Quantity::RateDot)),
            Argument::Torques => arrays.push(joints("tau", Quantity::AppliedTorque)),
            Argument::Wrench => {
                arrays.push(vector("force", Quantity::JointForce, tip));
                arrays.push(vector("moment", Quantity::JointMoment, tip));
            }
            Argument::Payload => {
                arrays.push(ArgumentArray { name: "payload", elements: Name::of_payload(tip).map(used).into() });
            }
            Argument::Base => {
                arrays.push(vector("base_omega", Quantity::Omega, 0));
                arrays.push(vector("base_omega_dot", Quantity::OmegaDot, 0));
                arrays.push(vector("base_acceleration", Quantity::Acceleration, 0));
                arrays.push(vector("base_gravity", Quantity::Gravity, 0));
            }
        }
    }
    arrays
}

/// The array of the run-time parameters, where the robot has some.
fn parameters(program: &Program) -> Option<ArgumentArray> {
    let names = (1..=program.parameters).map(|index| Name::scalar(Quantity::Parameter, index));
    let elements = names.map(|name| program.arguments().any(|used| used == name).then_some(name)).collect();
    (program.parameters > 0).then_some(ArgumentArray { name: "parameters", elements })
}
