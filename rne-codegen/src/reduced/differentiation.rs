//! The product rule on the graph of the reduced form.

use std::collections::HashMap;

use super::rows::Row;
use super::sheet::{Leaf, Op, Ref, mark_live};
use super::writer::{Angle, Symbol, Writer, byte};
use crate::exact::Number;
use crate::ledger::Place;
use crate::name::{By, Name};

impl Writer {
    /// The partial derivatives of some symbols by a variable, in the places of what they are derivatives of.
    pub(crate) fn derivatives<'s>(&'s self, rows: &[Row], of: &[Symbol<'s>], by: By) -> Vec<Symbol<'s>> {
        let (ops, births, definitions) = {
            let sheet = self.sheet.borrow();
            let ops: Vec<Op> = sheet.nodes.iter().map(|node| node.op).collect();
            let mut births = vec![None; ops.len()];
            let mut definitions: HashMap<usize, Vec<(Name, bool)>> = HashMap::new();
            if let Some(naming) = &self.naming {
                let mut naming = naming.borrow_mut();
                naming.births.resize(ops.len(), None);
                births.clone_from(&naming.births);
                for (name, at) in naming.definitions.iter().filter(|(name, _)| name.by.is_none()) {
                    definitions.entry(at.index()).or_default().push((*name, at.is_negative()));
                }
            }
            (ops, births, definitions)
        };
        let outputs: Vec<Ref> = of.iter().map(|symbol| symbol.at).collect();
        let mut live = Vec::new();
        mark_live(&self.sheet.borrow().nodes, &outputs, &mut live);
        let zero = self.zero();
        let mut rates: Vec<Symbol<'s>> = vec![zero; ops.len()];
        for (index, op) in ops.iter().enumerate().filter(|(index, _)| live[*index]) {
            let rate = |at: Ref| {
                let rate = rates[at.index()];
                if at.is_negative() { -rate } else { rate }
            };
            let value = |at: Ref| self.symbol(at);
            let rate = match *op {
                Op::Constant(_) => zero,
                Op::Leaf(leaf) => self.leaf_rate(rows, leaf, by),
                Op::Sum(a, b) => rate(a) + rate(b),
                Op::Product(a, b) => rate(a) * value(b) + value(a) * rate(b),
                Op::Inverse(a) => {
                    let inverse = value(Ref::new(index));
                    -(inverse * inverse * rate(a))
                }
            };
            rates[index] = rate;
            if let Some(naming) = &self.naming {
                let mut naming = naming.borrow_mut();
                let birth = births[index].map(|(place, component)| (Place { by: Some(by), ..place }, component));
                let len = self.sheet.borrow().nodes.len();
                naming.births.resize(len, birth);
                for (name, negative) in definitions.get(&index).into_iter().flatten().filter(|_| !rate.is_zero()) {
                    if name.quantity.step().is_some() {
                        naming.definitions.push((Name { by: Some(by), ..*name }, rate.signed(*negative).at));
                    }
                }
            }
        }
        of.iter()
            .map(|symbol| {
                let rate = rates[symbol.at.index()];
                if symbol.at.is_negative() { -rate } else { rate }
            })
            .collect()
    }

    /// The derivative of an argument, or of the sine or cosine of a sum of positions.
    fn leaf_rate<'s>(&'s self, rows: &[Row], leaf: Leaf, by: By) -> Symbol<'s> {
        let (zero, one) = (self.zero(), self.number(Number::ONE));
        let is = |joint: u8, at: usize| usize::from(joint) + 1 == at;
        match (leaf, by) {
            (Leaf::Position(joint), By::Position(at)) | (Leaf::Rate(joint), By::Rate(at)) if is(joint, at) => one,
            (Leaf::RateDot(joint), By::RateDot(at)) if is(joint, at) => one,
            (Leaf::Sine(first, last) | Leaf::Cosine(first, last), By::Position(at)) => {
                let (first, last, joint) = (usize::from(first), usize::from(last), at - 1);
                if !(first..=last).contains(&joint) {
                    return zero;
                }
                // counted with the sign of the first joint
                let same = rows[joint].reversed == rows[first].reversed;
                let (sine, cosine) = Angle::of(rows, first, last).image(rows, &self.point);
                let (from, to) = (byte(first), byte(last));
                if let Leaf::Sine(..) = leaf {
                    self.leaf(Leaf::Cosine(from, to), cosine).signed(!same)
                } else {
                    self.leaf(Leaf::Sine(from, to), sine).signed(same)
                }
            }
            _ => zero,
        }
    }
}
