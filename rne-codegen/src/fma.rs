//! The order of the terms of sums: for the fewest instructions, or for the shortest wait.
//!
//! A processor that has the instruction x y + z computes a sum and one product among its terms at once. How many
//! products are left over depends on the order of the terms and on which products are computed at all:
//!
//! - A sum of n terms takes n - 1 instructions, whatever they are, once there is a term to start from. So terms that
//!   are no products come first and every product is fused with what has been summed before.
//! - A product that is used in several sums is fused with each of them and never computed by itself.
//! - A sum of products alone needs one of them to start from. That costs a product, once for all sums that it can
//!   start.
//!
//! Many states one after the other are computed so ([`contracted`]). A single call waits for its longest chain of
//! operations: there the term that comes last should be added last ([`ordered_for_latency`]).

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use crate::ir::name::Name;
use crate::latency;
use crate::program::{Expression, Operator, Output, Program, Sign, SineCosine, Statement};

/// The program with its sums in the order in which most products are fused: wherever a product stands right of + or -.
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
    let (mut graph, outputs) = Graph::new(program);
    graph.flatten(Named::Too);
    let _ = graph.choose_products();
    graph.program(program, &outputs)
}

/// The program with the terms of every sum in the order in which they are known: what comes last is waited for least.
#[must_use]
pub fn ordered_for_latency(program: &Program) -> Program {
    let (mut graph, outputs) = Graph::new(program);
    graph.flatten(Named::Not);
    graph.sort_terms(&program.sines_and_cosines);
    graph.program(program, &outputs)
}

/// Instructions of one evaluation, without sines and cosines, where every product that stands right of + or - is fused.
#[must_use]
pub fn instructions(program: &Program) -> usize {
    let parts = program.values().flat_map(Expression::parts);
    let instructions = parts.map(|part| match part {
        // a minus goes into the instruction that uses it, but for an output
        Expression::Variable(_) | Expression::Zero | Expression::Negative(_) => 0,
        // its product is counted with it
        Expression::Binary(..) => usize::from(Contraction::of(part).is_none()),
        Expression::BySign(_) => 2,
    });
    instructions.sum()
}

/// A sum or difference as x y + z, which may be one instruction.
#[derive(Clone, Copy, Debug)]
pub struct Contraction<'a> {
    /// x and y.
    pub factors: [&'a Expression; 2],
    /// z.
    pub addend: &'a Expression,
    /// What a difference negates.
    pub negated: Option<Negated>,
}

/// The part of a contraction that is negated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Negated {
    /// x.
    Factor,
    /// z.
    Addend,
}

impl<'a> Contraction<'a> {
    /// Of a product and what it is added to; of two products the right one is fused.
    #[must_use]
    pub fn of(expression: &'a Expression) -> Option<Self> {
        let Expression::Binary(operator @ (Operator::Sum | Operator::Difference), a, b) = expression else {
            return None;
        };
        let (addend, product, negated) = match (&**a, &**b) {
            (a, b @ Expression::Binary(Operator::Product, ..)) => (a, b, Negated::Factor),
            (a, b) => (b, a, Negated::Addend),
        };
        let Expression::Binary(Operator::Product, x, y) = product else { return None };
        let negated = (*operator == Operator::Difference).then_some(negated);
        Some(Self { factors: [x, y], addend, negated })
    }
}

/// A node and the sign it enters with.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Term {
    sign: Sign,
    node: usize,
}

enum Kind {
    /// What the statements are made of: arguments, constants, sines and cosines.
    Leaf(Expression),
    /// A product or a quotient, whose signs are carried outwards.
    Scaled(Operator, [usize; 2]),
    BySign([Term; 3]),
    Sum(Vec<Term>),
}

impl Kind {
    fn product(&self) -> Option<&[usize; 2]> {
        if let Self::Scaled(Operator::Product, factors) = self { Some(factors) } else { None }
    }

    fn terms(&self) -> Option<&Vec<Term>> {
        if let Self::Sum(terms) = self { Some(terms) } else { None }
    }

    /// The nodes that it uses.
    fn operands(&self) -> Vec<usize> {
        let nodes = |terms: &[Term]| terms.iter().map(|term| term.node).collect();
        match self {
            Self::Leaf(_) => Vec::new(),
            Self::Scaled(_, operands) => operands.to_vec(),
            Self::BySign(operands) => nodes(operands),
            Self::Sum(terms) => nodes(terms),
        }
    }
}

struct Node {
    kind: Kind,
    /// The name under which a statement computes it, if one does.
    name: Option<Name>,
    uses: usize,
    /// Computed by itself. What is not is a term of a longer sum or fused with all sums that it is in.
    is_computed: bool,
}

#[derive(Default)]
struct Graph {
    nodes: Vec<Node>,
    known: BTreeMap<Name, Term>,
}

impl Graph {
    /// The graph of a program and its outputs.
    fn new(program: &Program) -> (Self, Vec<Term>) {
        let mut graph = Self::default();
        for statement in &program.statements {
            graph.define(statement);
        }
        let outputs: Vec<_> = program.outputs.iter().map(|output| graph.term(&output.value)).collect();
        graph.count_uses(&outputs);
        (graph, outputs)
    }

    fn define(&mut self, statement: &Statement) {
        let mut term = self.term(&statement.value);
        let node = &mut self.nodes[term.node];
        match &mut node.kind {
            // a name stands for a value with its sign
            Kind::Sum(terms) if node.name.is_none() && term.sign == Sign::Minus => {
                for term in terms {
                    *term = term.opposite();
                }
                term.sign = Sign::Plus;
            }
            Kind::Sum(_) | Kind::Scaled(Operator::Product, _) if node.name.is_none() && term.sign == Sign::Plus => {}
            // another name of what has one, or its negative
            _ => term = Term { sign: Sign::Plus, node: self.push(Kind::Sum(vec![term])) },
        }
        self.nodes[term.node].name = Some(statement.name);
        self.known.insert(statement.name, term);
    }

    fn push(&mut self, kind: Kind) -> usize {
        self.nodes.push(Node { kind, name: None, uses: 0, is_computed: true });
        self.nodes.len() - 1
    }

    fn term(&mut self, expression: &Expression) -> Term {
        let (sign, kind) = match expression {
            Expression::Variable(name) => {
                if let Some(&term) = self.known.get(name) {
                    return term;
                }
                (Sign::Plus, Kind::Leaf(expression.clone()))
            }
            Expression::Zero => (Sign::Plus, Kind::Leaf(Expression::Zero)),
            Expression::Negative(a) => return self.term(a).opposite(),
            Expression::Binary(operator, a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                match operator {
                    Operator::Sum => (Sign::Plus, Kind::Sum(vec![a, b])),
                    Operator::Difference => (Sign::Plus, Kind::Sum(vec![a, b.opposite()])),
                    Operator::Product | Operator::Quotient => {
                        let sign = if a.sign == b.sign { Sign::Plus } else { Sign::Minus };
                        (sign, Kind::Scaled(*operator, [a.node, b.node]))
                    }
                }
            }
            Expression::BySign(operands) => {
                (Sign::Plus, Kind::BySign(operands.each_ref().map(|operand| self.term(operand))))
            }
        };
        let term = Term { sign, node: self.push(kind) };
        if let Expression::Variable(name) = expression {
            self.known.insert(*name, term);
        }
        term
    }

    fn count_uses(&mut self, outputs: &[Term]) {
        for index in 0..self.nodes.len() {
            for operand in self.nodes[index].kind.operands() {
                self.nodes[operand].uses += 1;
            }
        }
        for output in outputs {
            self.nodes[output.node].uses += 1;
        }
    }

    /// Sums that are used in one sum alone become terms of it. Nodes stand behind what they use.
    fn flatten(&mut self, which: Named) {
        for index in 0..self.nodes.len() {
            let Kind::Sum(terms) = &self.nodes[index].kind else { continue };
            let mut flat = Vec::new();
            let mut inlined = Vec::new();
            for &term in terms {
                match &self.nodes[term.node] {
                    Node { kind: Kind::Sum(inner), uses: 1, name, .. } if which == Named::Too || name.is_none() => {
                        let signed = |inner: &Term| if term.sign == Sign::Minus { inner.opposite() } else { *inner };
                        flat.extend(inner.iter().map(signed));
                        inlined.push(term.node);
                    }
                    _ => flat.push(term),
                }
            }
            for node in inlined {
                (self.nodes[node].is_computed, self.nodes[node].kind) = (false, Kind::Sum(Vec::new()));
            }
            self.nodes[index].kind = Kind::Sum(flat);
        }
    }

    /// Decides which products are computed by themselves; how many candidates it looked at.
    fn choose_products(&mut self) -> usize {
        // uses as terms of sums; a product with other uses has to be computed
        let mut in_sums = vec![0; self.nodes.len()];
        let sums: Vec<_> = self.nodes.iter().filter_map(|node| node.kind.terms()).collect();
        for term in sums.iter().copied().flatten() {
            in_sums[term.node] += 1;
        }
        let mut steps = 0;
        let mut is_computed: Vec<_> = (0..self.nodes.len())
            .map(|node| {
                self.nodes[node].is_computed && !(in_sums[node] == self.nodes[node].uses && self.may_be_fused(node))
            })
            .collect();
        // sums that nothing begins yet, by their terms, and how many of them each term is in
        let mut is_started: Vec<_> = sums.iter().map(|terms| terms.iter().any(|term| is_computed[term.node])).collect();
        let mut sums_of: Vec<Vec<usize>> = vec![Vec::new(); self.nodes.len()];
        let mut counts = vec![0_usize; self.nodes.len()];
        for (index, terms) in sums.iter().enumerate().filter(|(index, _)| !is_started[*index]) {
            for term in *terms {
                counts[term.node] += 1;
                sums_of[term.node].push(index);
            }
        }
        // the first of those that begin most sums; counts fall, so what is too high in the queue goes back
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
        for (index, node) in self.nodes.iter_mut().enumerate() {
            node.is_computed = is_computed[index];
            if let Kind::Sum(terms) = &mut node.kind {
                terms.sort_by_key(|term| !is_computed[term.node]);
            }
        }
        steps
    }

    fn sort_terms(&mut self, turns: &[SineCosine]) {
        let turns: Vec<_> = turns.iter().flat_map(|turn| [turn.sine, turn.cosine]).flatten().collect();
        // nodes stand behind what they use
        let mut known: Vec<usize> = Vec::with_capacity(self.nodes.len());
        for node in &mut self.nodes {
            let last = |operands: Vec<usize>| operands.into_iter().map(|operand| known[operand]).max().unwrap_or(0);
            let at = match &mut node.kind {
                Kind::Leaf(Expression::Variable(name)) if turns.contains(name) => latency::TURN,
                Kind::Leaf(_) => 0,
                Kind::Scaled(operator, _) => latency::cycles(*operator) + last(node.kind.operands()),
                Kind::BySign(_) => latency::SUM + last(node.kind.operands()),
                Kind::Sum(terms) => {
                    terms.sort_by_key(|term| known[term.node]);
                    let times = terms.iter().map(|term| known[term.node]);
                    times.reduce(|sum, term| sum.max(term) + latency::SUM).unwrap_or(0)
                }
            };
            known.push(at);
        }
    }

    /// The program that the graph has become.
    fn program(&self, program: &Program, outputs: &[Term]) -> Program {
        let computed = |Statement { place, name, .. }: &Statement| {
            let node = self.known.get(name)?.node;
            let is_computed = self.nodes[node].is_computed;
            is_computed.then(|| Statement { place: *place, name: *name, value: self.value(node) })
        };
        let statements = program.statements.iter().filter_map(computed).collect();
        let outputs = program.outputs.iter().zip(outputs);
        let outputs = outputs.map(|(output, term)| Output { name: output.name, value: self.operand(*term) }).collect();
        program.computed_by(statements, outputs)
    }

    /// A product whose factors are not computed once more wherever it is fused.
    fn may_be_fused(&self, node: usize) -> bool {
        let is_nameless = |&factor: &usize| {
            let factor = &self.nodes[factor];
            factor.name.is_none() && !matches!(factor.kind, Kind::Leaf(_))
        };
        let product = self.nodes[node].kind.product();
        product.is_some_and(|factors| self.nodes[node].uses == 1 || !factors.iter().any(is_nameless))
    }

    /// A term where it is used: the name of what a statement computes, else its value.
    fn operand(&self, term: Term) -> Expression {
        let node = &self.nodes[term.node];
        let value = match node.name {
            Some(name) if node.is_computed => Expression::Variable(name),
            _ => self.value(term.node),
        };
        if term.sign == Sign::Minus { Expression::Negative(Box::new(value)) } else { value }
    }

    fn value(&self, node: usize) -> Expression {
        match &self.nodes[node].kind {
            Kind::Leaf(expression) => expression.clone(),
            Kind::Scaled(operator, operands) => {
                let [a, b] = operands.map(|node| self.operand(Term { sign: Sign::Plus, node }));
                Expression::binary(*operator, a, b)
            }
            Kind::BySign(operands) => Expression::BySign(Box::new(operands.map(|operand| self.operand(operand)))),
            Kind::Sum(terms) => self.sum(terms),
        }
    }

    /// The terms in their order. A sum that begins with negative terms is written without sign up to the first that has
    /// none.
    fn sum(&self, terms: &[Term]) -> Expression {
        let plain = |term: Term| self.operand(Term { sign: Sign::Plus, ..term });
        let parts = terms.iter().map(|&term| (term.sign, plain(term)));
        let sum = parts.reduce(|(sign, sum), (sign_of_term, term)| match (sign, sign_of_term) {
            (Sign::Plus, Sign::Minus) => (Sign::Plus, Expression::binary(Operator::Difference, sum, term)),
            (Sign::Minus, Sign::Plus) => (Sign::Plus, Expression::binary(Operator::Difference, term, sum)),
            (sign, _) => (sign, Expression::binary(Operator::Sum, sum, term)),
        });
        match sum {
            Some((Sign::Plus, sum)) => sum,
            Some((Sign::Minus, sum)) => Expression::Negative(Box::new(sum)),
            None => Expression::Zero,
        }
    }
}

/// Whether sums that have a name of their own become terms of others.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Named {
    Too,
    Not,
}

impl Term {
    fn opposite(self) -> Self {
        let sign = if self.sign == Sign::Plus { Sign::Minus } else { Sign::Plus };
        Self { sign, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Compiler, Form, Function};

    #[test]
    fn the_choice_of_products_is_not_quadratic() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/dense/dense7.yaml");
        let robot = rne_model::Reader::new("dense7").read(&std::fs::read(path).unwrap()).unwrap().robot;
        let program = Compiler::new(&robot).compile(Function::Regressor, Form::SevenSteps).unwrap();
        let (mut graph, _) = Graph::new(&program);
        graph.flatten(Named::Too);
        let (steps, nodes) = (graph.choose_products(), graph.nodes.len());
        assert!(steps > 100 && steps < 2 * nodes, "{steps} of {nodes}");
    }
}
