//! Formulas as they were written, kept beside the graph: terms that folded away have no node in the graph.

use super::{CausesId, Name, Outcome, Ref};

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// a + b
    Sum,
    /// a - b
    Difference,
    /// a · b
    Product,
    /// a / b
    Quotient,
}

/// Whether a value enters as itself or negated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// The value itself.
    Plus,
    /// Negated.
    Minus,
}

/// The index of a stored term. [`TermId::NONE`] is a leaf, of which the graph has all information.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TermId(u32);

impl TermId {
    /// A term that is only a node of the graph.
    pub(crate) const NONE: Self = Self(0);
}

/// A term of a formula.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Written {
    /// A node: a number, an argument, or an operation that was written on the graph alone.
    Node(Ref, CausesId),
    /// A term with a name.
    Named(Name),
    /// -a
    Negative(TermId),
    /// An operation with its node, its outcome and the causes of folding; `counted` if it belongs to a step.
    Operation { operator: Operator, operands: [TermId; 2], at: Ref, outcome: Outcome, reason: CausesId, counted: bool },
    /// The first term selects one of the other two by its sign.
    BySign([TermId; 3]),
}

/// All terms of a graph; a term comes after the terms inside it.
#[derive(Clone, Debug, Default)]
pub(crate) struct WrittenTerms(Vec<Written>);

impl WrittenTerms {
    pub(crate) fn push(&mut self, term: Written) -> TermId {
        self.0.push(term);
        TermId(u32::try_from(self.0.len()).unwrap_or_default())
    }

    /// The term; `None` for [`TermId::NONE`].
    pub(crate) fn get(&self, id: TermId) -> Option<Written> {
        self.0.get((id.0 as usize).checked_sub(1)?).copied()
    }
}
