//! The formulas before folding, with how each term was folded.

use rustc_hash::FxHashSet;

use super::{Lowering, sign};
use crate::equation::{Equation, Operation, Term};
use crate::ir::{Causes, CausesId, Fold, Number, Op, Operator, Outcome, Ref, TermId, Written};

impl Lowering<'_> {
    /// Returns the formula of every component, in the order in which they are computed; none if formulas are not kept.
    pub(super) fn equations(&self) -> Vec<Equation> {
        if self.written.trace.terms.is_none() {
            return Vec::new();
        }
        let mut seen = FxHashSet::default();
        let definitions = self.written.trace.definitions.iter().filter(|definition| seen.insert(definition.name));
        let equation = |definition: &crate::ir::Definition| {
            let term = match definition.term {
                TermId::NONE => self.of_node(definition.at, &definition.causes),
                term => self.term(term, definition.place.is_some()),
            };
            Equation { name: definition.name, place: definition.place, term }
        };
        definitions.map(equation).collect()
    }

    /// Builds a term of a formula. With `in_step`, a constant that is computed from the table beforehand becomes a
    /// number.
    fn term(&self, id: TermId, in_step: bool) -> Term {
        let inner = |id: TermId| self.term(id, in_step);
        let written = self.written.trace.terms.as_ref().and_then(|terms| terms.get(id));
        match written {
            None => Term::Number(0.0, self.causes(CausesId::ARITHMETIC)),
            Some(Written::Node(at, causes)) => self.of_node(at, &self.causes(causes)),
            Some(Written::Named(name)) => Term::Variable(name),
            Some(Written::Negative(a)) => Term::Negative(Box::new(inner(a))),
            Some(Written::BySign(operands)) => Term::BySign(Box::new(operands.map(inner))),
            Some(Written::Operation { at, counted: false, .. }) if in_step && self.written.graph.is_constant(at) => {
                self.of_node(at, &self.causes(CausesId::ARITHMETIC))
            }
            Some(Written::Operation { operator, operands: [a, b], at, outcome, reason, .. }) => {
                let (operator, operands) = match (operator, inner(a), inner(b)) {
                    // a - b is written as a + (-b)
                    (Operator::Sum, a, Term::Negative(b)) => (Operator::Difference, [a, *b]),
                    (operator, a, b) => (operator, [a, b]),
                };
                let (fold, causes) = self.fold(at, outcome, reason);
                let given = self.names[at.index()].filter(|_| fold == Fold::Kept || fold == Fold::Shared);
                let name = given.map(|given| (given.name, sign(given.negative != at.is_negative())));
                Term::Operation(Box::new(Operation { operator, operands, fold, causes, name }))
            }
        }
    }

    /// Returns how an operation was folded, and the causes.
    fn fold(&self, at: Ref, outcome: Outcome, reason: CausesId) -> (Fold, Option<Causes>) {
        let causes = self.causes(reason);
        match outcome {
            Outcome::Zero(_) => (Fold::Zero(causes.main()), Some(causes)),
            Outcome::One(_) => (Fold::One(causes.main()), Some(causes)),
            Outcome::Constants => (Fold::Constant, None),
            Outcome::Cancelled => (Fold::Cancelled, None),
            _ if !self.is_live(at.magnitude()) => (Fold::Unused, None),
            Outcome::Shared => (Fold::Shared, None),
            Outcome::Computed => (Fold::Kept, None),
        }
    }

    fn causes(&self, id: CausesId) -> Causes {
        self.written.trace.causes.get(id).clone()
    }

    /// Builds the term of a node that has no stored formula.
    fn of_node(&self, at: Ref, causes: &Causes) -> Term {
        let negative = at.is_negative();
        let at = at.magnitude();
        let inner = |at: Ref| self.of_node(at, &self.causes(CausesId::ARITHMETIC));
        let operation = |operator, a: Ref, b: Ref| {
            let operands = [inner(a), inner(b)];
            Term::Operation(Box::new(Operation { operator, operands, fold: Fold::Kept, causes: None, name: None }))
        };
        let named = self.names[at.index()].map(|given| (given.name, given.negative));
        let term = match (self.written.graph.op(at), named) {
            (Op::Constant(_), _) => {
                let value = self.written.graph.number(at).map_or(0.0, Number::to_f64);
                return Term::Number(if negative && value != 0.0 { -value } else { value }, causes.clone());
            }
            (Op::Input(input), _) => Term::Variable(input.name()),
            (Op::Sine(angle), _) => Term::Sine(Box::new(inner(angle))),
            (Op::Cosine(angle), _) => Term::Cosine(Box::new(inner(angle))),
            (_, Some((name, is_negative))) => {
                let variable = Term::Variable(name);
                if is_negative { Term::Negative(Box::new(variable)) } else { variable }
            }
            (Op::Sum(a, b), None) if b.is_negative() => operation(Operator::Difference, a, -b),
            (Op::Sum(a, b), None) => operation(Operator::Sum, a, b),
            (Op::Product(a, b), None) => operation(Operator::Product, a, b),
            (Op::Quotient(a, b), None) => operation(Operator::Quotient, a, b),
            (Op::BySign(operands), None) => Term::BySign(Box::new(operands.map(inner))),
        };
        if negative { Term::Negative(Box::new(term)) } else { term }
    }
}
