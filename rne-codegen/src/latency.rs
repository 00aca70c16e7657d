//! How long the chains of operations are that a call waits for, on a processor that computes independent ones side by
//! side.
//!
//! A fused multiply-add is one instruction, but a sum that waits for its last term waits longer for it than for an
//! addition. So a product is fused where that is sooner, or where nothing waits for the sum.

use std::collections::BTreeMap;

use crate::fma::Contraction;
use crate::ir::name::Name;
use crate::program::{Expression, Operator, Program};

/// Cycles of a multiplication and of a fused multiply-add: a model, near to the processors of servers and desktops of
/// these years.
pub const PRODUCT: usize = 4;

/// Cycles of an addition.
pub(crate) const SUM: usize = 3;

/// Cycles of a division.
const QUOTIENT: usize = 14;

/// Cycles of an operation.
#[must_use]
pub const fn cycles(operator: Operator) -> usize {
    match operator {
        Operator::Sum | Operator::Difference => SUM,
        Operator::Product => PRODUCT,
        Operator::Quotient => QUOTIENT,
    }
}

/// Cycles after which sines and cosines are there.
pub(crate) const TURN: usize = 50;

/// A sum with no more time to spare than this is waited for.
const SPARE: usize = 4;

/// When the values of a program are there, in cycles from the call on, and how long what follows takes.
#[derive(Debug)]
pub struct Latency {
    known: BTreeMap<Name, usize>,
    rest: BTreeMap<Name, usize>,
    total: usize,
}

/// The two ways to add a product.
struct Ways {
    fused: usize,
    apart: usize,
}

impl Latency {
    /// Of a program as it is written.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        let mut latency = Self { known: BTreeMap::new(), rest: BTreeMap::new(), total: 0 };
        for name in program.sines_and_cosines.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten() {
            latency.known.insert(name, TURN);
        }
        for statement in &program.statements {
            let at = latency.at(&statement.value);
            latency.known.insert(statement.name, at);
        }
        latency.total = program.outputs.iter().map(|output| latency.at(&output.value)).max().unwrap_or(0);
        for output in &program.outputs {
            latency.follow(&output.value, 0);
        }
        for statement in program.statements.iter().rev() {
            let rest = latency.rest(statement.name);
            latency.follow(&statement.value, rest);
        }
        latency
    }

    /// What follows a statement.
    #[must_use]
    pub fn rest(&self, name: Name) -> usize {
        self.rest.get(&name).copied().unwrap_or(0)
    }

    /// Whether the product of a contraction is better fused with what it is added to; `rest` follows the sum.
    #[must_use]
    pub fn is_fused(&self, contraction: &Contraction<'_>, rest: usize) -> bool {
        let Ways { fused, apart } = self.algorithms(contraction);
        fused <= apart || apart + rest + SPARE < self.total
    }

    fn algorithms(&self, Contraction { factors: [x, y], addend, .. }: &Contraction<'_>) -> Ways {
        let (addend, factors) = (self.at(addend), self.at(x).max(self.at(y)));
        Ways { fused: addend.max(factors) + PRODUCT, apart: addend.max(factors + PRODUCT) + SUM }
    }

    fn at(&self, expression: &Expression) -> usize {
        match expression {
            Expression::Variable(name) => self.known.get(name).copied().unwrap_or(0),
            Expression::Zero => 0,
            Expression::Negative(a) => self.at(a),
            Expression::Binary(operator, a, b) => match Contraction::of(expression) {
                Some(contraction) => {
                    let Ways { fused, apart } = self.algorithms(&contraction);
                    fused.min(apart)
                }
                None => self.at(a).max(self.at(b)) + cycles(*operator),
            },
            Expression::BySign(operands) => operands.iter().map(|operand| self.at(operand)).max().unwrap_or(0) + SUM,
        }
    }

    /// Notes for what an expression uses that it and `rest` follow.
    fn follow(&mut self, expression: &Expression, rest: usize) {
        match expression {
            Expression::Variable(name) => {
                let known = self.rest.entry(*name).or_default();
                *known = rest.max(*known);
            }
            Expression::Zero => {}
            Expression::Negative(a) => self.follow(a, rest),
            Expression::Binary(operator, a, b) => match Contraction::of(expression) {
                Some(contraction) => {
                    let Ways { fused, apart } = self.algorithms(&contraction);
                    let (sum, product) = if fused <= apart { (PRODUCT, PRODUCT) } else { (SUM, SUM + PRODUCT) };
                    self.follow(contraction.addend, rest + sum);
                    contraction.factors.into_iter().for_each(|factor| self.follow(factor, rest + product));
                }
                None => [a, b].into_iter().for_each(|operand| self.follow(operand, rest + cycles(*operator))),
            },
            Expression::BySign(operands) => operands.iter().for_each(|operand| self.follow(operand, rest + SUM)),
        }
    }
}
