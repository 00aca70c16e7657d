//! Formulas of all components as they were written, before folding, with what every term became and why.
//!
//! The code of a [`Program`](crate::Program) is what remains of its equations after folding. An equation has all terms,
//! such as `w2_x = rot2_xx * w1_x + rot2_yx * w1_y + ..`, and says which ones vanish because the base does not move or
//! a rotation leaves an axis alone.

use crate::ir::{Causes, Fold, Name, Operator, Place, Sign};

/// A component of a quantity and the formula that gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// The component.
    pub name: Name,
    /// The step, joint and quantity in which its operations are counted; `None` for numbers of the table.
    pub place: Option<Place>,
    /// The formula, over names, numbers and arguments.
    pub term: Term,
}

/// A term of a formula, with the result of folding.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// Another component, an argument or a number of the table.
    Variable(Name),
    /// A number, and the reasons for its value.
    Number(f64, Causes),
    /// -a
    Negative(Box<Term>),
    /// The sine of an angle.
    Sine(Box<Term>),
    /// The cosine of an angle.
    Cosine(Box<Term>),
    /// Two operands with an operator between them.
    Operation(Box<Operation>),
    /// One of two values by the sign of the first, as in [`Value::BySign`](crate::Value::BySign).
    BySign(Box<[Term; 3]>),
}

/// An operation of a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Operation {
    /// The operator.
    pub operator: Operator,
    /// Left and right.
    pub operands: [Term; 2],
    /// How it was folded.
    pub fold: Fold,
    /// All causes that make it zero or equal to one operand; `None` if nothing of the arm is a cause.
    pub causes: Option<Causes>,
    /// The name that its value has in the code, if it has one.
    pub name: Option<(Name, Sign)>,
}

impl Term {
    /// The components, arguments and numbers of the table in it, from left to right.
    pub fn names(&self) -> Vec<Name> {
        let mut names = Vec::new();
        self.visit(&mut |term| {
            if let Self::Variable(name) = term {
                names.push(*name);
            }
        });
        names
    }

    /// Calls `visitor` with the term and every term in it, outer terms first.
    pub fn visit<'t>(&'t self, visitor: &mut impl FnMut(&'t Self)) {
        visitor(self);
        match self {
            Self::Variable(_) | Self::Number(..) => {}
            Self::Negative(a) | Self::Sine(a) | Self::Cosine(a) => a.visit(visitor),
            Self::Operation(operation) => operation.operands.iter().for_each(|operand| operand.visit(visitor)),
            Self::BySign(operands) => operands.iter().for_each(|operand| operand.visit(visitor)),
        }
    }
}
