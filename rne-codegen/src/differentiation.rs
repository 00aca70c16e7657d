//! The product rule on the graph of a worksheet.

use std::collections::HashMap;

use crate::graph::{Node, NodeId, Term};
use crate::ledger::{Cause, Place};
use crate::name::{By, Name};
use crate::symbol::Symbol;
use crate::worksheet::{Birth, Definition, Snapshot, Worksheet};

/// What is differentiated: the graph as it was before.
struct Formulas {
    nodes: Vec<Node>,
    births: Vec<Option<Birth>>,
    definitions: HashMap<usize, Vec<Definition>>,
    live: Vec<bool>,
}

impl Worksheet {
    /// The partial derivatives of some symbols by each variable, each product by the product rule and so on, in the places of
    /// what they are derivatives of and under its names.
    pub(crate) fn derivatives<'s>(&'s self, of: &[Symbol<'s>], by: impl Iterator<Item = By>) -> Vec<Vec<Symbol<'s>>> {
        let Snapshot { nodes, births, definitions: all } = self.snapshot();
        let mut definitions: HashMap<usize, Vec<Definition>> = HashMap::new();
        for definition in all.into_iter().filter(|definition| definition.name.by.is_none()) {
            definitions.entry(definition.term.node.index()).or_default().push(definition);
        }
        // what derivatives add to the graph is none of what they are derivatives of
        let formulas = Formulas { live: live(&nodes, of), nodes, births, definitions };
        by.map(|by| self.derivatives_of(&formulas, of, by)).collect()
    }

    fn derivatives_of<'s>(&'s self, formulas: &Formulas, of: &[Symbol<'s>], by: By) -> Vec<Symbol<'s>> {
        let Formulas { nodes, births, definitions, live } = formulas;
        let symbol = |term: Term| self.symbol(term);
        let (zero, one) = (self.constant(0.0, Cause::Arithmetic), self.constant(1.0, Cause::Arithmetic));
        let mut rates: Vec<Symbol<'s>> = vec![zero; nodes.len()];
        for (index, node) in nodes.iter().enumerate().filter(|(index, _)| live[*index]) {
            let rate = |term: Term| {
                let rate = rates[term.node.index()];
                if term.negative { -rate } else { rate }
            };
            let plain = |node: NodeId| Term { node, negative: false };
            if let Node::Argument(name) = node {
                rates[index] = if *name == by.variable() { one } else { zero };
                continue;
            }
            let is_zero = |terms: &[Term]| terms.iter().all(|&term| rate(term).term == zero.term);
            let birth = births[index].map(|birth| Birth { place: Place { by: Some(by), ..birth.place }, ..birth });
            rates[index] = self.at_birth(birth, || match *node {
                Node::Constant(_) | Node::Argument(_) => zero,
                Node::Sine(angle) | Node::Cosine(angle) if is_zero(&[angle]) => zero,
                Node::Sine(angle) => {
                    let cosine = self.sine_and_cosine(symbol(angle)).1;
                    rate(angle) * cosine
                }
                Node::Cosine(angle) => {
                    let sine = self.sine_and_cosine(symbol(angle)).0;
                    -(rate(angle) * sine)
                }
                Node::Sum(a, b) => rate(a) + rate(b),
                Node::Product(a, b) => {
                    let (a, b) = (plain(a), plain(b));
                    rate(a) * symbol(b) + symbol(a) * rate(b)
                }
                Node::Quotient(a, b) => {
                    let (a, b) = (plain(a), plain(b));
                    if is_zero(&[a, b]) {
                        zero
                    } else {
                        let quotient = self.quotient(symbol(a), symbol(b));
                        self.quotient(rate(a) - quotient * rate(b), symbol(b))
                    }
                }
                Node::BySign(x, positive, negative) => self.by_sign(symbol(x), rate(positive), rate(negative)),
            });
            for definition in definitions.get(&index).into_iter().flatten() {
                let rate = if definition.term.negative { -rates[index] } else { rates[index] };
                if rate.term != zero.term && definition.name.quantity.step().is_some() {
                    self.name(Name { by: Some(by), ..definition.name }, rate);
                }
            }
        }
        let rate_of = |symbol: &Symbol<'s>| {
            let rate = rates[symbol.term.node.index()];
            if symbol.term.negative { -rate } else { rate }
        };
        of.iter().map(rate_of).collect()
    }
}

/// Which nodes some symbols depend on.
fn live(nodes: &[Node], of: &[Symbol<'_>]) -> Vec<bool> {
    let mut live = vec![false; nodes.len()];
    for symbol in of {
        live[symbol.term.node.index()] = true;
    }
    for index in (0..nodes.len()).rev() {
        if live[index] {
            nodes[index].operands().for_each(|operand| live[operand.index()] = true);
        }
    }
    live
}
