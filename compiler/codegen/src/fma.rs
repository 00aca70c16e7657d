//! Chooses the order of the terms of sums and the products that are fused with them: for the fewest instructions, or
//! for the shortest latency.
//!
//! The instruction x y + z computes a product and adds it to a sum at once. How many products need an instruction of
//! their own depends on the order of the terms and on which products are computed at all:
//!
//! - A sum of n terms takes n - 1 instructions, even if terms are products, once its first term is known. So terms that
//!   are no products come first, and every product is fused with the sum of the terms before it.
//! - A product that is used in several sums is fused with each of them and never computed by itself.
//! - A sum that has only products needs one of them as first term. This product takes one instruction, for all sums
//!   that it can start.
//!
//! [`contracted`] does this for code that evaluates many states one after another. A single call waits for its longest
//! chain of operations: then the term that is known last should be added last ([`ordered_for_latency`]).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::ir::{Name, Operator, Sign};
use crate::latency::{self, Latency};
use crate::program::{Output, Program, Statement};
use crate::values::{Contraction, Value, ValueId, Values};

/// Returns the program with its sums in the order in which most products can be fused with the sums.
///
/// ```
/// use rne_codegen::fma;
/// # use rne_codegen::{Compiler, Form, Function};
/// # let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
/// #     {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}";
/// # let robot = rne_model::Robot::from_yaml(yaml).unwrap();
/// # let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::SevenSteps).unwrap();
/// let fused = fma::contracted(&program);
/// assert!(fma::instructions(&fused) <= fma::instructions(&program));
/// ```
#[must_use]
pub fn contracted(program: &Program) -> Program {
    let mut sums = Sums::of(program);
    sums.flatten(Named::Too);
    let _ = sums.choose_products();
    sums.program()
}

/// Returns the program with the terms of every sum in the order in which they become known, so that the last term
/// causes the shortest wait.
#[must_use]
pub fn ordered_for_latency(program: &Program) -> Program {
    let mut sums = Sums::of(program);
    sums.flatten(Named::Not);
    sums.sort_terms();
    sums.program()
}

/// Counts the instructions of one evaluation, without sines and cosines, if every product that is added is fused with
/// its sum.
#[must_use]
pub fn instructions(program: &Program) -> usize {
    let instructions = program.values.iter().skip(program.before_statements()).map(|(id, value)| match value {
        // the product is counted as an instruction of its own
        Value::Binary(..) => usize::from(program.values.contraction(id).is_none()),
        Value::Fused(_) => 1,
        Value::BySign(_) => 2,
        // a minus is part of the instruction that uses the value; only an output needs an instruction for it
        _ => 0,
    });
    instructions.sum()
}

/// The choice of the products that are fused with what they are added to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fusing {
    /// All products.
    All,
    /// All products, except those for which a call would wait longer than for a product and a sum.
    Soonest,
}

/// Returns the program with each chosen product and its sum as one value. Only this function decides which products are
/// fused, so derived code, machines and native code fuse the same ones and return the same bits.
#[must_use]
pub fn fused(program: &Program, fusing: Fusing) -> Program {
    let first = program.before_statements();
    let contractions = match fusing {
        Fusing::All => program.values.iter().map(|(id, _)| program.values.contraction(id)).collect(),
        Fusing::Soonest => soonest(program),
    };
    let mut fused = program.clone();
    for (index, contraction) in contractions.into_iter().enumerate().skip(first) {
        if let Some((contraction, _)) = contraction {
            fused.values.replace(ValueId::at(index), Value::Fused(contraction));
        }
    }
    fused.in_written_order()
}

/// Returns, for each value, its contraction if that makes no result wait longer.
fn soonest(program: &Program) -> Vec<Option<(Contraction, ValueId)>> {
    let (values, latency) = (&program.values, Latency::of(program));
    let mut contractions = vec![None; values.len()];
    // for a value without a name, the cycles from it to the last result; `None` if it is part of a contraction
    let mut rests = vec![Some(0); values.len()];
    for (id, value) in values.iter().skip(program.before_statements()).rev() {
        let Some(rest) = rests[id.index()] else { continue };
        let rest = if values.name(id).is_some() { latency.rest(id) } else { rest };
        let contraction = values.contraction(id).filter(|(contraction, _)| latency.is_fused(contraction, rest));
        let of_operands = rest
            + match value {
                Value::Negative(_) | Value::Same(_) => 0,
                Value::Binary(operator, ..) if contraction.is_none() => latency::cycles(operator),
                _ => latency::PRODUCT,
            };
        let written = contraction.map_or(value, |(contraction, product)| {
            rests[product.index()] = None;
            Value::Fused(contraction)
        });
        written.operands().for_each(|operand| rests[operand.index()] = Some(of_operands));
        contractions[id.index()] = contraction;
    }
    contractions
}

/// A value by its place among the nodes of [`Sums`], and the sign with which a sum uses it.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Term {
    sign: Sign,
    node: usize,
}

impl Term {
    const fn plus(node: usize) -> Self {
        Self { sign: Sign::Plus, node }
    }

    fn opposite(self) -> Self {
        let sign = if self.sign == Sign::Plus { Sign::Minus } else { Sign::Plus };
        Self { sign, ..self }
    }

    fn with(self, sign: Sign) -> Self {
        if sign == Sign::Minus { self.opposite() } else { self }
    }
}

/// Whether sums that have a name of their own become terms of others.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Named {
    Too,
    Not,
}

/// The values of a program with their signs moved outwards, and its sums as lists of terms. Each value has two nodes:
/// the value itself, and after it a sum of one term, for a statement that gives the value another name.
struct Sums<'p> {
    program: &'p Program,
    /// The number of values before the statements. It is stored, because it is needed for every value.
    before_statements: usize,
    /// The node of each value.
    terms: Vec<Term>,
    /// For each node, the terms of the sum, if it is a sum.
    terms_of: Vec<Option<Vec<Term>>>,
    /// For each node, the name of the statement that computes it, if there is one.
    names: Vec<Option<Name>>,
    uses: Vec<usize>,
    /// For each node, whether it is computed by itself. Other nodes are terms of sums, or fused with all their sums.
    is_computed: Vec<bool>,
}

impl<'p> Sums<'p> {
    fn of(program: &'p Program) -> Self {
        let nodes = 2 * program.values.len();
        let mut sums = Self {
            program,
            before_statements: program.before_statements(),
            terms: Vec::with_capacity(program.values.len()),
            terms_of: vec![None; nodes],
            names: vec![None; nodes],
            uses: vec![0; nodes],
            is_computed: vec![true; nodes],
        };
        for (id, value) in program.values.iter() {
            let mut term = sums.term(id, value);
            if !sums.is_leaf(id) && program.values.name(id).is_some() {
                term = sums.named(id, term);
            }
            sums.terms.push(term);
        }
        for node in 0..nodes {
            sums.operands(node).into_iter().for_each(|operand| sums.uses[operand] += 1);
        }
        for output in &program.outputs {
            sums.uses[sums.terms[output.value.index()].node] += 1;
        }
        sums
    }

    fn term(&mut self, id: ValueId, value: Value) -> Term {
        let term = |id: ValueId| self.terms[id.index()];
        let node = 2 * id.index();
        match value {
            Value::Same(a) if !self.is_leaf(id) => term(a),
            Value::Negative(a) if !self.is_leaf(id) => term(a).opposite(),
            Value::Binary(Operator::Sum, a, b) if !self.is_leaf(id) => {
                self.terms_of[node] = Some(vec![term(a), term(b)]);
                Term::plus(node)
            }
            Value::Binary(Operator::Difference, a, b) if !self.is_leaf(id) => {
                self.terms_of[node] = Some(vec![term(a), term(b).opposite()]);
                Term::plus(node)
            }
            Value::Binary(_, a, b) if !self.is_leaf(id) => Term::plus(node).with(term(a).sign).with(term(b).sign),
            _ => Term::plus(node),
        }
    }

    /// Returns the term of a statement; the name means the value together with its sign.
    fn named(&mut self, id: ValueId, term: Term) -> Term {
        let node = term.node;
        let is_free = self.names[node].is_none();
        let is_product = self.factors(node).is_some();
        let named = match (&mut self.terms_of[node], term.sign) {
            (Some(terms), Sign::Minus) if is_free => {
                for term in terms {
                    *term = term.opposite();
                }
                node
            }
            (Some(_), Sign::Plus) if is_free => node,
            (None, Sign::Plus) if is_free && is_product => node,
            // the value has a name already: this is a second name, or its negative
            _ => {
                let node = 2 * id.index() + 1;
                self.terms_of[node] = Some(vec![term]);
                node
            }
        };
        self.names[named] = self.program.values.name(id);
        Term::plus(named)
    }

    /// Whether a value is an argument, a constant, an angle, a sine or a cosine, from which statements are computed.
    fn is_leaf(&self, id: ValueId) -> bool {
        id.index() < self.before_statements
    }

    /// Returns the value of a node, unless the node is a sum.
    fn value(&self, node: usize) -> Option<(ValueId, Value)> {
        let is_value = node.is_multiple_of(2) && self.terms_of[node].is_none();
        let id = ValueId::at(node / 2);
        let value = self.program.values.get(id);
        (is_value && !matches!(value, Value::Same(_) | Value::Negative(_))).then_some((id, value))
    }

    /// The factors of a product, without their signs.
    fn factors(&self, node: usize) -> Option<[usize; 2]> {
        match self.value(node)? {
            (id, Value::Binary(Operator::Product, a, b)) if !self.is_leaf(id) => {
                Some([a, b].map(|id| self.terms[id.index()].node))
            }
            _ => None,
        }
    }

    /// The nodes that a node uses.
    fn operands(&self, node: usize) -> Vec<usize> {
        if let Some(terms) = &self.terms_of[node] {
            return terms.iter().map(|term| term.node).collect();
        }
        match self.value(node) {
            Some((id, value)) if !self.is_leaf(id) => {
                value.operands().map(|operand| self.terms[operand.index()].node).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Replaces sums that are used in only one sum by their terms in this sum. A node comes after the nodes that it
    /// uses.
    fn flatten(&mut self, which: Named) {
        for index in 0..self.terms_of.len() {
            let Some(terms) = self.terms_of[index].take() else { continue };
            let mut flat = Vec::new();
            for term in terms {
                let is_inlined = self.uses[term.node] == 1 && (which == Named::Too || self.names[term.node].is_none());
                match &mut self.terms_of[term.node] {
                    Some(inner) if is_inlined => {
                        flat.extend(std::mem::take(inner).into_iter().map(|inner| inner.with(term.sign)));
                        self.is_computed[term.node] = false;
                    }
                    _ => flat.push(term),
                }
            }
            self.terms_of[index] = Some(flat);
        }
    }

    /// Decides which products are computed by themselves, and returns the number of candidates that were considered.
    fn choose_products(&mut self) -> usize {
        let nodes = self.terms_of.len();
        // uses as terms of sums; a product with other uses has to be computed
        let mut in_sums = vec![0; nodes];
        let sums: Vec<&Vec<Term>> = self.terms_of.iter().flatten().collect();
        for term in sums.iter().copied().flatten() {
            in_sums[term.node] += 1;
        }
        let mut steps = 0;
        let mut is_computed: Vec<_> = (0..nodes)
            .map(|node| self.is_computed[node] && !(in_sums[node] == self.uses[node] && self.may_be_fused(node)))
            .collect();
        // for each node, the sums without a computed term that contain it, and the number of these sums
        let mut is_started: Vec<_> = sums.iter().map(|terms| terms.iter().any(|term| is_computed[term.node])).collect();
        let mut sums_of: Vec<Vec<usize>> = vec![Vec::new(); nodes];
        let mut counts = vec![0_usize; nodes];
        for (index, terms) in sums.iter().enumerate().filter(|(index, _)| !is_started[*index]) {
            for term in *terms {
                counts[term.node] += 1;
                sums_of[term.node].push(index);
            }
        }
        // the node in the most of these sums comes first; counts become smaller, so an outdated entry is put back
        let counted = counts.iter().enumerate().filter(|(_, count)| **count > 0);
        let mut queue: BinaryHeap<_> = counted.map(|(node, &count)| (count, Reverse(node))).collect();
        while let Some((count, Reverse(node))) = queue.pop() {
            steps += 1;
            if count != counts[node] {
                if counts[node] > 0 {
                    queue.push((counts[node], Reverse(node)));
                }
                continue;
            }
            is_computed[node] = true;
            for &sum in &sums_of[node] {
                if !std::mem::replace(&mut is_started[sum], true) {
                    sums[sum].iter().for_each(|term| counts[term.node] -= 1);
                }
            }
        }
        for terms in self.terms_of.iter_mut().flatten() {
            terms.sort_by_key(|term| !is_computed[term.node]);
        }
        self.is_computed = is_computed;
        steps
    }

    /// Whether a node is a product that can be fused in every sum without computing its factors again.
    fn may_be_fused(&self, node: usize) -> bool {
        let is_nameless = |&node: &usize| self.names[node].is_none() && !self.operands(node).is_empty();
        self.factors(node).is_some_and(|factors| self.uses[node] == 1 || !factors.iter().any(is_nameless))
    }

    fn sort_terms(&mut self) {
        // nodes come after the nodes that they use
        let mut known: Vec<usize> = Vec::with_capacity(self.terms_of.len());
        for node in 0..self.terms_of.len() {
            let at = if let Some(terms) = &mut self.terms_of[node] {
                terms.sort_by_key(|term| known[term.node]);
                let times = terms.iter().map(|term| known[term.node]);
                times.reduce(|sum, term| sum.max(term) + latency::SUM).unwrap_or(0)
            } else {
                let last = self.operands(node).into_iter().map(|operand| known[operand]).max();
                let (id, value) = self.value(node).unwrap_or((ValueId::at(node / 2), Value::Argument));
                let is_angle = self.is_leaf(id) && !matches!(value, Value::Sine(_) | Value::Cosine(_));
                last.unwrap_or(0) + if is_angle { 0 } else { latency::cycles_of(value) }
            };
            known.push(at);
        }
    }

    /// The program after the sums have been rearranged.
    fn program(&self) -> Program {
        let program = self.program;
        let mut writing = Writing {
            sums: self,
            values: program.values.first(program.before_statements()),
            known: vec![None; self.terms_of.len()],
        };
        let mut statements = Vec::new();
        for Statement { place, name, value } in &program.statements {
            let node = self.terms[value.index()].node;
            if self.is_computed[node] {
                let value = writing.statement(*name, node);
                statements.push(Statement { place: *place, name: *name, value });
            }
        }
        let mut output =
            |Output { name, value }: &Output| Output { name: *name, value: writing.operand(self.terms[value.index()]) };
        let outputs = program.outputs.iter().map(&mut output).collect();
        Program { values: writing.values, statements, outputs, ..program.clone() }.in_written_order()
    }
}

/// Writes sums as values.
struct Writing<'s> {
    sums: &'s Sums<'s>,
    values: Values,
    /// For each node, the value that was written under its name.
    known: Vec<Option<ValueId>>,
}

impl Writing<'_> {
    fn statement(&mut self, name: Name, node: usize) -> ValueId {
        let value = self.value(node);
        let id = self.values.named(name, value);
        self.known[node] = Some(id);
        id
    }

    /// Writes a term where it is used: as the value of its statement if there is one, else as an expression.
    fn operand(&mut self, term: Term) -> ValueId {
        let known = self.known[term.node].filter(|_| self.sums.is_computed[term.node]);
        let value = known.unwrap_or_else(|| self.value(term.node));
        if term.sign == Sign::Minus { self.values.push(None, Value::Negative(value)) } else { value }
    }

    fn value(&mut self, node: usize) -> ValueId {
        if let Some(terms) = &self.sums.terms_of[node] {
            return self.sum(terms);
        }
        let Some((id, value)) = self.sums.value(node) else { return self.values.push(None, Value::Constant(0.0)) };
        if self.sums.is_leaf(id) {
            return id;
        }
        // the sign of a product is applied after the product
        let is_scaled = matches!(value, Value::Binary(..));
        let value = value.map(|operand| {
            let term = self.sums.terms[operand.index()];
            self.operand(if is_scaled { Term::plus(term.node) } else { term })
        });
        self.values.push(None, value)
    }

    /// Writes the sum of terms in their order. Negative terms at the beginning are summed without sign, until the first
    /// term that is not negative.
    fn sum(&mut self, terms: &[Term]) -> ValueId {
        let mut sum: Option<(Sign, ValueId)> = None;
        for term in terms {
            let value = self.operand(Term::plus(term.node));
            let mut binary = |operator, a, b| self.values.push(None, Value::Binary(operator, a, b));
            sum = Some(match (sum, term.sign) {
                (None, sign) => (sign, value),
                (Some((Sign::Plus, sum)), Sign::Minus) => (Sign::Plus, binary(Operator::Difference, sum, value)),
                (Some((Sign::Minus, sum)), Sign::Plus) => (Sign::Plus, binary(Operator::Difference, value, sum)),
                (Some((sign, sum)), _) => (sign, binary(Operator::Sum, sum, value)),
            });
        }
        match sum {
            Some((Sign::Plus, sum)) => sum,
            Some((Sign::Minus, sum)) => self.values.push(None, Value::Negative(sum)),
            None => self.values.push(None, Value::Constant(0.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Compiler, Form, Function};

    #[test]
    fn the_choice_of_products_is_not_quadratic() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/dense/dense7.yaml");
        let robot = rne_model::Reader::new("dense7").read(&std::fs::read(path).unwrap()).unwrap().robot;
        let program = Compiler::new(&robot).compile(Function::Regressor, Form::SevenSteps).unwrap();
        let mut sums = Sums::of(&program);
        sums.flatten(Named::Too);
        let (steps, nodes) = (sums.choose_products(), program.values.len());
        assert!(steps > 100 && steps < 2 * nodes, "{steps} of {nodes}");
    }
}
