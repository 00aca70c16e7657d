//! Reverse-mode differentiation on a graph: the derivatives of one number with respect to all variables at once, from
//! the number back to its arguments.
//!
//! The adjoint of a node is the derivative of the number with respect to the node. A sum passes its adjoint to its
//! terms; a product passes it to each factor, times the other factor (S. Linnainmaa, 1976). Two rules keep the formulas
//! short:
//!
//! - Terms `adjoint · partial` of a node that have a factor in common are gathered before they are multiplied.
//! - A rotated component u = x c + y s has the other rotated component, y c - x s, as derivative with respect to its
//!   angle. If the graph has that number, the adjoint of the angle takes one product of it instead of the adjoints of s
//!   and c.

use rustc_hash::FxHashMap;

use super::numbers::canonical;
use super::{Builder, Graph, Input, Name, Op, Policy, Ref, Residue, Symbol, mark_live};

/// The formulas before differentiation. If values may be merged, each value occurs once.
struct Formulas {
    ops: Vec<Op>,
    /// The nodes that the result depends on, and that depend on a variable.
    active: Vec<bool>,
    /// Nodes by their values without sign; empty where values are not merged.
    values: FxHashMap<Residue, Ref>,
    residues: Vec<Residue>,
}

/// Contributions of a node's users to its adjoint: products of an adjoint and a partial derivative.
type Terms<'s> = Vec<(Symbol<'s>, Symbol<'s>)>;

impl Builder {
    /// Returns the partial derivatives of a symbol with respect to the variables with these names.
    pub(crate) fn gradient<'s>(&'s self, of: Symbol<'s>, by: &[Name]) -> Vec<Symbol<'s>> {
        let variables: Vec<Input> = by.iter().map(|name| Input::new(*name)).collect();
        let (formulas, of) = Formulas::of(&self.graph.borrow(), of.at, &variables);
        let mut terms: Vec<Terms<'s>> = vec![Vec::new(); formulas.ops.len()];
        terms[of.index()].push((self.one().signed(of.is_negative()), self.one()));
        let mut found = vec![self.zero(); by.len()];
        for index in (0..formulas.ops.len()).rev() {
            if !formulas.active[index] || terms[index].is_empty() {
                continue;
            }
            let adjoint = self.gathered(std::mem::take(&mut terms[index]));
            if let Op::Input(input) = formulas.ops[index] {
                if let Some(place) = variables.iter().position(|variable| *variable == input) {
                    found[place] = adjoint;
                }
            } else if !adjoint.is_zero() {
                self.hand_on(&formulas, index, adjoint, &mut terms);
            }
        }
        found
    }

    /// Adds the contributions of a node to the adjoints of its operands.
    fn hand_on<'s>(&'s self, formulas: &Formulas, index: usize, adjoint: Symbol<'s>, terms: &mut [Terms<'s>]) {
        let mut give = |to: Ref, adjoint: Symbol<'s>, partial: Symbol<'s>| {
            if formulas.active[to.index()] {
                terms[to.index()].push((adjoint.signed(to.is_negative()), partial));
            }
        };
        let (symbol, one) = (|at: Ref| self.symbol(at), self.one());
        match formulas.ops[index] {
            Op::Constant(_) | Op::Input(_) => {}
            Op::Sine(angle) => give(angle, adjoint, self.sine_and_cosine(symbol(angle)).1),
            Op::Cosine(angle) => give(angle, -adjoint, self.sine_and_cosine(symbol(angle)).0),
            Op::Sum(a, b) => {
                if let Some(turned) = formulas.turned([a, b]) {
                    give(turned.angle, adjoint, symbol(turned.other));
                    for (at, turn) in turned.terms {
                        give(at, adjoint, symbol(turn));
                    }
                } else {
                    give(a, adjoint, one);
                    give(b, adjoint, one);
                }
            }
            Op::Product(a, b) => {
                give(a, adjoint, symbol(b));
                give(b, adjoint, symbol(a));
            }
            Op::Quotient(a, b) => {
                let per_b = self.quotient(adjoint, symbol(b));
                give(a, per_b, one);
                give(b, -per_b, self.quotient(symbol(a), symbol(b)));
            }
            Op::BySign([x, positive, negative]) => {
                give(positive, self.by_sign(symbol(x), adjoint, self.zero()), one);
                give(negative, self.by_sign(symbol(x), self.zero(), adjoint), one);
            }
        }
    }

    /// Returns the sum of products, after gathering those with a common factor.
    fn gathered<'s>(&'s self, mut terms: Terms<'s>) -> Symbol<'s> {
        let mut sum: Option<Symbol<'s>> = None;
        while let Some((adjoint, mut partial)) = (!terms.is_empty()).then(|| terms.remove(0)) {
            terms.retain(|(other, also)| {
                let is_common = other.at.magnitude() == adjoint.at.magnitude();
                if is_common {
                    partial = partial + also.signed(other.at != adjoint.at);
                }
                !is_common
            });
            let term = adjoint * partial;
            sum = Some(sum.map_or(term, |sum| sum + term));
        }
        sum.unwrap_or_else(|| self.zero())
    }
}

/// A component of a rotated vector: a sum of two `terms`, each a number times the sine or cosine of one angle.
struct TurnedComponent {
    angle: Ref,
    terms: [(Ref, Ref); 2],
    /// Its derivative with respect to the angle, a node of the graph.
    other: Ref,
}

impl Formulas {
    fn of(graph: &Graph, of: Ref, variables: &[Input]) -> (Self, Ref) {
        let mut live = Vec::new();
        mark_live(&graph.nodes, &[of], &mut live);
        let is_merged = graph.policy() != Policy::Structure;
        let (mut values, mut map) = (FxHashMap::default(), Vec::with_capacity(graph.len()));
        let mut formulas = Self {
            ops: Vec::with_capacity(graph.len()),
            active: vec![false; graph.len()],
            values: FxHashMap::default(),
            residues: graph.nodes.iter().map(|node| node.residue).collect(),
        };
        for (at, op) in graph.nodes() {
            let op = op.mapped(&map);
            formulas.ops.push(op);
            map.push(at);
            if !live[at.index()] {
                continue;
            }
            if is_merged {
                let (value, negative) = canonical(graph.residue(at));
                let known = *values.entry(value).or_insert_with(|| at.signed(negative));
                map[at.index()] = known.signed(negative);
                if known.index() != at.index() {
                    continue;
                }
            }
            formulas.active[at.index()] = match op {
                Op::Input(input) => variables.contains(&input),
                _ => op.operands().any(|operand| formulas.active[operand.index()]),
            };
        }
        formulas.values = values;
        (formulas, of.mapped(&map))
    }

    /// Reads a sum as a component of a rotated vector, if the graph has the other component.
    fn turned(&self, terms: [Ref; 2]) -> Option<TurnedComponent> {
        if self.values.is_empty() {
            return None;
        }
        let mut angle = None;
        let mut derivative = Residue::ZERO;
        let mut turned = [(terms[0], terms[0]); 2];
        for (place, term) in terms.into_iter().enumerate() {
            let Op::Product(a, b) = self.ops[term.index()] else { return None };
            let turn = |at: Ref| match self.ops[at.index()] {
                Op::Sine(of) | Op::Cosine(of) => Some(of),
                _ => None,
            };
            let (x, by, of) = match (turn(a), turn(b)) {
                (Some(of), None) => (b, a, of),
                (None, Some(of)) => (a, b, of),
                _ => return None,
            };
            if angle.is_some_and(|angle| angle != of) || !self.active[of.index()] {
                return None;
            }
            angle = Some(of);
            let is_sine = matches!(self.ops[by.index()], Op::Sine(_));
            // the derivative of the sine is the cosine, that of the cosine is minus the sine
            let other = self.other_of(of, is_sine)?;
            let by_angle = other.residue(&self.residues).signed(is_sine == by.is_negative());
            derivative = derivative + (x.residue(&self.residues) * by_angle).signed(term.is_negative());
            turned[place] = (x.signed(term.is_negative()), by);
        }
        let (value, negative) = canonical(derivative);
        let other = self.values.get(&value)?.signed(negative);
        Some(TurnedComponent { angle: angle?, terms: turned, other })
    }

    /// The node of the cosine of an angle, or of its sine if `cosine` is false.
    fn other_of(&self, angle: Ref, cosine: bool) -> Option<Ref> {
        let is_it = |op: &Op| match op {
            Op::Sine(of) => !cosine && *of == angle,
            Op::Cosine(of) => cosine && *of == angle,
            _ => false,
        };
        self.ops.iter().position(is_it).map(Ref::new)
    }
}
