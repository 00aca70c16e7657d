//! The lengths of the chains of operations that a call waits for, on a processor that computes independent operations
//! in parallel.
//!
//! A fused multiply-add is one instruction, but it takes longer than an addition after the last term of a sum. So a
//! product is fused if the sum is then known sooner, or if no result waits for the sum.

use crate::ir::Operator;
use crate::program::Program;
use crate::values::{Contraction, Value, ValueId};

/// Cycles of a multiplication and of a fused multiply-add: a model, close to current processors of servers and
/// desktops.
pub(crate) const PRODUCT: usize = 4;

/// Cycles of an addition.
pub(crate) const SUM: usize = 3;

/// Cycles of a division.
const QUOTIENT: usize = 14;

/// Cycles from the call until sines and cosines are computed.
const TURN: usize = 50;

/// A result waits for a sum if the sum could be at most this many cycles later without delaying the result.
const SPARE: usize = 4;

/// Cycles of an operation.
pub(crate) const fn cycles(operator: Operator) -> usize {
    match operator {
        Operator::Sum | Operator::Difference => SUM,
        Operator::Product => PRODUCT,
        Operator::Quotient => QUOTIENT,
    }
}

/// Cycles from the operands of a value to the value. Arguments are known from the beginning, and the time of angles is
/// part of that of their sines.
pub(crate) const fn cycles_of(value: Value) -> usize {
    match value {
        Value::Argument | Value::Constant(_) | Value::Same(_) | Value::Negative(_) => 0,
        Value::Sine(_) | Value::Cosine(_) => TURN,
        Value::Binary(operator, ..) => cycles(operator),
        Value::Fused(_) => PRODUCT,
        Value::BySign(_) => SUM,
    }
}

/// For each value of a program, the cycles from the call until it is known, and the cycles from there to the last
/// result.
#[derive(Debug)]
pub(crate) struct Latency {
    known: Vec<usize>,
    rests: Vec<usize>,
    total: usize,
}

/// The cycles from the call to the sum in the two ways to add a product: fused, or by a product and a sum.
struct Ways {
    fused: usize,
    apart: usize,
}

impl Latency {
    /// The latency of a program as it is written.
    pub(crate) fn of(program: &Program) -> Self {
        let (values, first) = (&program.values, program.before_statements());
        let mut latency = Self { known: Vec::with_capacity(values.len()), rests: vec![0; values.len()], total: 0 };
        for (id, value) in values.iter() {
            let operands = value.operands().map(|operand| latency.known[operand.index()]).max().unwrap_or(0);
            let at = match (values.contraction(id), value) {
                (_, Value::Sine(_) | Value::Cosine(_)) => TURN,
                _ if id.index() < first => 0,
                (Some((contraction, _)), _) => {
                    let Ways { fused, apart } = latency.ways(&contraction);
                    fused.min(apart)
                }
                (None, value) => operands + cycles_of(value),
            };
            latency.known.push(at);
        }
        latency.total = program.outputs.iter().map(|output| latency.known[output.value.index()]).max().unwrap_or(0);
        // a value comes after its operands, so in this direction all its uses are known
        for (id, value) in values.iter().skip(first).rev() {
            let rest = latency.rests[id.index()];
            if let Some((contraction, _)) = values.contraction(id) {
                let Ways { fused, apart } = latency.ways(&contraction);
                let (sum, product) = if fused <= apart { (PRODUCT, PRODUCT) } else { (SUM, SUM + PRODUCT) };
                latency.follow(contraction.addend, rest + sum);
                contraction.factors.into_iter().for_each(|factor| latency.follow(factor, rest + product));
            } else {
                value.operands().for_each(|operand| latency.follow(operand, rest + cycles_of(value)));
            }
        }
        latency
    }

    /// Cycles from a value to the last result that needs it.
    pub(crate) fn rest(&self, id: ValueId) -> usize {
        self.rests[id.index()]
    }

    /// Whether it is faster to fuse the product of a contraction with the addend; `rest` is the number of cycles after
    /// the sum.
    pub(crate) fn is_fused(&self, contraction: &Contraction, rest: usize) -> bool {
        let Ways { fused, apart } = self.ways(contraction);
        fused <= apart || apart + rest + SPARE < self.total
    }

    fn ways(&self, Contraction { factors, addend, .. }: &Contraction) -> Ways {
        let [addend, x, y] = [*addend, factors[0], factors[1]].map(|id| self.known[id.index()]);
        let factors = x.max(y);
        Ways { fused: addend.max(factors) + PRODUCT, apart: addend.max(factors + PRODUCT) + SUM }
    }

    /// Notes that `rest` cycles follow a value.
    fn follow(&mut self, id: ValueId, rest: usize) {
        let known = &mut self.rests[id.index()];
        *known = rest.max(*known);
    }
}
