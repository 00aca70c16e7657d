//! Differentiation of formulas on a graph, forward from the variables.

use rustc_hash::FxHashMap;

use super::{Birth, Builder, Cause, Definition, Input, Name, Op, Place, Ref, Symbol, WithRespectTo, mark_live};

/// The graph before differentiation.
struct Formulas {
    ops: Vec<Op>,
    births: Vec<Option<Birth>>,
    definitions: FxHashMap<usize, Vec<Definition>>,
    live: Vec<bool>,
    /// Nodes that derivatives treat as constant.
    held: Vec<usize>,
}

impl Builder {
    /// Returns the partial derivatives of symbols with respect to each variable, by the product rule and the other
    /// rules. Each derivative has the place and the name of its function, with the variable added.
    pub(crate) fn derivatives<'s>(
        &'s self,
        of: &[Symbol<'s>],
        by: impl Iterator<Item = WithRespectTo>,
    ) -> Vec<Vec<Symbol<'s>>> {
        let (births, all) = self.told();
        let mut definitions: FxHashMap<usize, Vec<Definition>> = FxHashMap::default();
        for definition in all.into_iter().filter(|definition| definition.name.by.is_none()) {
            definitions.entry(definition.at.index()).or_default().push(definition);
        }
        let outputs: Vec<Ref> = of.iter().map(|symbol| symbol.at).collect();
        let mut live = Vec::new();
        let ops: Vec<Op> = {
            let graph = self.graph.borrow();
            mark_live(&graph.nodes, &outputs, &mut live);
            graph.nodes().map(|(_, op)| op).collect()
        };
        // the formulas as they are now: nodes that the derivatives add are not differentiated
        let formulas = Formulas { ops, births, definitions, live, held: self.held() };
        by.map(|by| self.derivatives_of(&formulas, of, by)).collect()
    }

    fn derivatives_of<'s>(&'s self, formulas: &Formulas, of: &[Symbol<'s>], by: WithRespectTo) -> Vec<Symbol<'s>> {
        let Formulas { ops, births, definitions, live, held } = formulas;
        let variable = Input::new(by.variable());
        let symbol = |at: Ref| self.symbol(at);
        let (zero, one) = (self.constant(0.0, Cause::Arithmetic), self.one());
        let mut rates: Vec<Symbol<'s>> = vec![zero; ops.len()];
        for (index, op) in ops.iter().enumerate().filter(|(index, _)| live[*index] && !held.contains(index)) {
            if let Op::Input(input) = op {
                rates[index] = if *input == variable { one } else { zero };
                continue;
            }
            let rate = |at: Ref| rates[at.index()].signed(at.is_negative());
            let is_zero = |at: &[Ref]| at.iter().all(|&at| rate(at).is_zero());
            let birth = births.get(index).copied().flatten();
            let birth = birth.map(|birth| Birth { place: Place { by: Some(by), ..birth.place }, ..birth });
            rates[index] = self.at_birth(birth, || match *op {
                Op::Constant(_) | Op::Input(_) => zero,
                Op::Sine(angle) | Op::Cosine(angle) if is_zero(&[angle]) => zero,
                Op::Sine(angle) => {
                    let cosine = self.sine_and_cosine(symbol(angle)).1;
                    rate(angle) * cosine
                }
                Op::Cosine(angle) => {
                    let sine = self.sine_and_cosine(symbol(angle)).0;
                    -(rate(angle) * sine)
                }
                Op::Sum(a, b) => rate(a) + rate(b),
                Op::Product(a, b) => rate(a) * symbol(b) + symbol(a) * rate(b),
                Op::Quotient(a, b) if is_zero(&[a, b]) => zero,
                Op::Quotient(a, b) => {
                    let quotient = self.quotient(symbol(a), symbol(b));
                    self.quotient(rate(a) - quotient * rate(b), symbol(b))
                }
                Op::BySign([x, positive, negative]) => self.by_sign(symbol(x), rate(positive), rate(negative)),
            });
            for definition in definitions.get(&index).into_iter().flatten() {
                let rate = rates[index].signed(definition.at.is_negative());
                if !rate.is_zero() && definition.name.quantity.step().is_some() {
                    self.name(Name { by: Some(by), ..definition.name }, rate);
                }
            }
        }
        of.iter().map(|symbol| rates[symbol.at.index()].signed(symbol.at.is_negative())).collect()
    }
}
