//! Products and sums as fused multiply-adds: the same polynomials in fewer instructions.
//!
//! A processor that has the instruction x y + z computes a sum and one product among its terms at once. How many products
//! are left over depends on the order of the terms and on which products are computed at all:
//!
//! - A sum of n terms takes n - 1 instructions, whatever they are, once there is a term to start from. So terms that are no
//!   products come first and every product is fused with what has been summed before.
//! - A product that is used in several sums is fused with each of them and never computed by itself.
//! - A sum of products alone needs one of them to start from. That costs a product, once for all sums that it can start.
//!
//! Terms change places, so torques differ from those of the program as written in their last digits.

use std::collections::BTreeMap;

use crate::program::{Expression, Output, Program, Sign, Statement};
use crate::quantity::Name;

/// The program with its sums in the order in which most products are fused: wherever a product stands right of + or -.
///
/// ```
/// use rne_codegen::{Expression, fusion};
/// # use rne_codegen::{Form, Function, compile};
/// # let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
/// #     {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}";
/// # let robot = rne_model::Robot::from_yaml(yaml).unwrap();
/// # let program = compile(&robot, Function::InverseDynamics, Form::SevenSteps).unwrap();
/// let fused = fusion::fused(&program);
/// assert!(fusion::instructions(&fused) <= fusion::instructions(&program));
/// ```
#[must_use]
pub fn fused(program: &Program) -> Program {
    let mut graph = Graph::default();
    for statement in &program.statements {
        graph.define(statement);
    }
    let outputs: Vec<_> = program.outputs.iter().map(|output| graph.term(&output.value)).collect();
    graph.count_uses(&outputs);
    graph.flatten();
    graph.choose_products();
    let mut statements = Vec::new();
    for (index, Statement { place, name, .. }) in program.statements.iter().enumerate() {
        let found = graph.nodes.iter().position(|node| node.statement == Some(index));
        if let Some(node) = found.filter(|&node| graph.is_named(node)) {
            statements.push(Statement { place: *place, name: *name, value: graph.value(node) });
        }
    }
    let outputs = program.outputs.iter().zip(outputs);
    let outputs = outputs.map(|(output, term)| Output { name: output.name, value: graph.operand(term) }).collect();
    Program { statements, outputs, ..program.clone() }
}

/// Instructions of one evaluation, without sines and cosines, where every product that stands right of + or - is fused.
#[must_use]
pub fn instructions(program: &Program) -> usize {
    let statements = program.statements.iter().map(|statement| &statement.value);
    statements.chain(program.outputs.iter().map(|output| &output.value)).map(expression_instructions).sum()
}

fn expression_instructions(expression: &Expression) -> usize {
    use Expression::{Difference, Negative, Product, Sum, Variable, Zero};
    match expression {
        Variable(_) | Zero => 0,
        // a sign goes into the instruction that uses it
        Negative(a) => expression_instructions(a),
        Sum(a, b) | Difference(a, b) => {
            let inner = |a: &Expression| expression_instructions(a);
            let is_product = |a: &Expression| matches!(a, Product(..));
            let saved = usize::from(is_product(a) || is_product(b));
            1 + inner(a) + inner(b) - saved
        }
        Product(a, b) => 1 + expression_instructions(a) + expression_instructions(b),
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
    Product([usize; 2]),
    Sum(Vec<Term>),
}

struct Node {
    kind: Kind,
    /// The statement that computes it, if one does.
    statement: Option<usize>,
    name: Option<Name>,
    uses: usize,
    /// Computed by itself. What is not is a term of a longer sum or fused with all sums that it is in.
    is_computed: bool,
}

#[derive(Default)]
struct Graph {
    nodes: Vec<Node>,
    known: BTreeMap<Name, Term>,
    statements: usize,
}

impl Graph {
    fn define(&mut self, statement: &Statement) {
        let term = self.term(&statement.value);
        let node = &mut self.nodes[term.node];
        if node.statement.is_none() && !matches!(node.kind, Kind::Leaf(_)) {
            (node.statement, node.name) = (Some(self.statements), Some(statement.name));
        }
        self.statements += 1;
        self.known.insert(statement.name, term);
    }

    fn push(&mut self, kind: Kind) -> usize {
        self.nodes.push(Node { kind, statement: None, name: None, uses: 0, is_computed: true });
        self.nodes.len() - 1
    }

    fn term(&mut self, expression: &Expression) -> Term {
        use Sign::{Minus, Plus};
        match expression {
            Expression::Variable(name) => {
                if let Some(&term) = self.known.get(name) {
                    return term;
                }
                let term = Term { sign: Plus, node: self.push(Kind::Leaf(expression.clone())) };
                self.known.insert(*name, term);
                term
            }
            Expression::Zero => Term { sign: Plus, node: self.push(Kind::Leaf(Expression::Zero)) },
            Expression::Negative(a) => self.term(a).opposite(),
            Expression::Sum(a, b) => {
                let terms = vec![self.term(a), self.term(b)];
                Term { sign: Plus, node: self.push(Kind::Sum(terms)) }
            }
            Expression::Difference(a, b) => {
                let terms = vec![self.term(a), self.term(b).opposite()];
                Term { sign: Plus, node: self.push(Kind::Sum(terms)) }
            }
            Expression::Product(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                let sign = if a.sign == b.sign { Plus } else { Minus };
                Term { sign, node: self.push(Kind::Product([a.node, b.node])) }
            }
        }
    }

    fn count_uses(&mut self, outputs: &[Term]) {
        let mut uses = vec![0; self.nodes.len()];
        for node in &self.nodes {
            match &node.kind {
                Kind::Leaf(_) => {}
                Kind::Product(factors) => factors.iter().for_each(|&factor| uses[factor] += 1),
                Kind::Sum(terms) => terms.iter().for_each(|term| uses[term.node] += 1),
            }
        }
        for output in outputs {
            uses[output.node] += 1;
        }
        for (node, uses) in self.nodes.iter_mut().zip(uses) {
            node.uses = uses;
        }
    }

    /// Sums that are used in one sum alone become terms of it. Nodes stand behind what they use.
    fn flatten(&mut self) {
        for index in 0..self.nodes.len() {
            let Kind::Sum(terms) = &self.nodes[index].kind else { continue };
            let mut flat = Vec::new();
            let mut inlined = Vec::new();
            for &term in terms {
                match &self.nodes[term.node] {
                    Node { kind: Kind::Sum(inner), uses: 1, .. } => {
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

    /// Decides which products are computed by themselves.
    fn choose_products(&mut self) {
        // uses as terms of sums; a product with other uses has to be computed
        let mut in_sums = vec![0; self.nodes.len()];
        let sums: Vec<_> = self
            .nodes
            .iter()
            .filter_map(|node| if let Kind::Sum(terms) = &node.kind { Some(terms) } else { None })
            .collect();
        for term in sums.iter().copied().flatten() {
            in_sums[term.node] += 1;
        }
        let mut is_computed: Vec<_> = (0..self.nodes.len())
            .map(|node| {
                self.nodes[node].is_computed && !(in_sums[node] == self.nodes[node].uses && self.may_be_fused(node))
            })
            .collect();
        let mut unstarted: Vec<_> = sums.into_iter().filter(|terms| !terms.is_empty()).collect();
        loop {
            unstarted.retain(|terms| !terms.iter().any(|term| is_computed[term.node]));
            let mut starts = BTreeMap::<usize, usize>::new();
            for term in unstarted.iter().copied().flatten() {
                *starts.entry(term.node).or_default() += 1;
            }
            // the first of those that start most sums
            let Some((&best, _)) = starts.iter().rev().max_by_key(|&(_, &count)| count) else { break };
            is_computed[best] = true;
        }
        for (node, is_computed) in self.nodes.iter_mut().zip(is_computed) {
            node.is_computed = is_computed;
        }
    }

    /// A product whose factors are not computed once more wherever it is fused.
    fn may_be_fused(&self, node: usize) -> bool {
        let is_nameless = |&factor: &usize| {
            let factor = &self.nodes[factor];
            factor.name.is_none() && !matches!(factor.kind, Kind::Leaf(_))
        };
        match &self.nodes[node].kind {
            Kind::Product(factors) => self.nodes[node].uses == 1 || !factors.iter().any(is_nameless),
            Kind::Leaf(_) | Kind::Sum(_) => false,
        }
    }

    /// Whether a statement computes the node.
    fn is_named(&self, node: usize) -> bool {
        self.nodes[node].is_computed && self.nodes[node].name.is_some()
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
            Kind::Product(factors) => {
                let [a, b] = factors.map(|node| Box::new(self.operand(Term { sign: Sign::Plus, node })));
                Expression::Product(a, b)
            }
            Kind::Sum(terms) => self.sum(terms),
        }
    }

    /// What is computed comes first, with a positive term in front if there is one; then what is fused.
    fn sum(&self, terms: &[Term]) -> Expression {
        let is_computed = |term: &&Term| self.nodes[term.node].is_computed;
        let mut ordered: Vec<Term> = terms.iter().filter(is_computed).copied().collect();
        if let Some(positive) = ordered.iter().position(|term| term.sign == Sign::Plus) {
            ordered[..=positive].rotate_right(1);
        }
        ordered.extend(terms.iter().filter(|term| !is_computed(term)));
        let mut terms = ordered.into_iter();
        let first = terms.next().map_or(Expression::Zero, |term| self.operand(term));
        terms.fold(first, |sum, term| {
            let value = Box::new(self.operand(Term { sign: Sign::Plus, ..term }));
            match term.sign {
                Sign::Plus => Expression::Sum(Box::new(sum), value),
                Sign::Minus => Expression::Difference(Box::new(sum), value),
            }
        })
    }
}

impl Term {
    fn opposite(self) -> Self {
        let sign = if self.sign == Sign::Plus { Sign::Minus } else { Sign::Plus };
        Self { sign, ..self }
    }
}
