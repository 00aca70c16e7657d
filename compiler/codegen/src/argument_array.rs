//! The arguments of a generated function.

use crate::function::{ArgumentPart, Owner};
use crate::ir::{Name, Quantity, names_of};
use crate::program::Program;

/// An argument array and the names of its elements; `None` for an element that is not used.
#[derive(Clone, Debug, PartialEq)]
pub struct ArgumentArray {
    /// The array's name in emitted code, such as `q`, `qd` or `force`.
    pub name: &'static str,
    /// Its elements, in order.
    pub elements: Vec<Option<Name>>,
    /// How many elements each of its rows has, if it is an array of rows.
    pub row: Option<usize>,
    /// Whether it is one number, which is passed by itself.
    pub is_number: bool,
}

impl ArgumentArray {
    /// The lengths of the nested arrays that it consists of, the outer one first; none for a number.
    #[must_use]
    pub fn lengths(&self) -> Vec<usize> {
        match self.row {
            Some(row) => vec![self.elements.len() / row, row],
            None if self.is_number => Vec::new(),
            None => vec![self.elements.len()],
        }
    }

    /// The indices of an element in the nested arrays, the outer one first.
    #[must_use]
    pub fn places(&self, element: usize) -> Vec<usize> {
        match self.row {
            Some(row) => vec![element / row, element % row],
            None if self.is_number => Vec::new(),
            None => vec![element],
        }
    }
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

    /// The names that renderers give to variables of their own: arguments, results, unused elements. No number of a
    /// program may have one of them, because the second of two variables of one name would hide the first.
    #[doc(hidden)]
    pub fn reserved_names(&self) -> impl Iterator<Item = &'static str> {
        let arrays = self.arrays_without_parameters().into_iter().map(|array| array.name);
        // `sin` and `cos` are functions of the C library
        arrays.chain(["cosine", "parameters", "sine", "unused", "zero", self.function.entry().output])
    }
}

fn arguments(program: &Program) -> Vec<ArgumentArray> {
    let used = |name: Name| program.arguments().any(|used| used == name).then_some(name);
    let elements = |part: &ArgumentPart| {
        let joints = match part.owner {
            Owner::Joints => program.coordinates.clone(),
            Owner::Passive => program.passive.clone(),
            Owner::Base => vec![0],
            Owner::Tip => vec![program.joints + 1],
            Owner::EachTip => (1..=program.tips.len()).collect(),
        };
        joints.into_iter().flat_map(|joint| names_of(part.name, joint)).map(used).collect()
    };
    let parts = program.function.arguments().iter().flat_map(|argument| argument.parts());
    let array = |part: &ArgumentPart| ArgumentArray {
        name: part.name,
        elements: elements(part),
        row: part.argument.row(),
        is_number: part.argument.is_number(),
    };
    parts.map(array).collect()
}

/// The array of the run-time parameters, where the robot has some.
fn parameters(program: &Program) -> Option<ArgumentArray> {
    let names = (1..=program.parameters).map(|index| Name::scalar(Quantity::Parameter, index));
    let elements = names.map(|name| program.arguments().any(|used| used == name).then_some(name)).collect();
    (program.parameters > 0).then_some(ArgumentArray { name: "parameters", elements, row: None, is_number: false })
}
