//! Algebraic rewriting of a finished graph: local, exact moves under annealing (the reduced form, section 10).
//!
//! What comes out no longer resembles a recursion. Every move is an identity of real numbers, and equal values stay one node
//! whatever their history.

use super::search::{Clock, Over, Progress};
use super::sheet::{Cost, Dag, Identity, Leaf, Op, Ref, Sheet, mark_live};

/// Factors that a move introduces stay within these bounds.
const FACTORS: std::ops::Range<f64> = 1e-4..1e4;

/// A graph that is being made smaller.
pub(crate) struct Rewriting<C> {
    current: Dag,
    next: Dag,
    live: Vec<bool>,
    map: Vec<Ref>,
    cost: C,
    rng: fastrand::Rng,
    best: (Cost, Dag),
}

impl<C: Fn(&Dag, &mut Vec<bool>) -> Cost> Rewriting<C> {
    pub(crate) fn new(dag: Dag, seed: u64, cost: C) -> Self {
        let mut live = Vec::new();
        let best = (cost(&dag, &mut live), dag.clone());
        let next = Dag { sheet: Sheet::new(Identity::Value), outputs: Vec::new() };
        Self { current: dag, next, live, map: Vec::new(), cost, rng: fastrand::Rng::with_seed(seed), best }
    }

    /// The smallest graph seen.
    pub(crate) fn best(self) -> (Cost, Dag) {
        self.best
    }

    /// Anneals until the clock says that all of its time is over.
    pub(crate) fn anneal(
        &mut self,
        hottest: f64,
        mut progress: impl FnMut(Cost) -> Progress,
        clock: Clock<'_>,
    ) -> Result<(), Over> {
        let mut weight = (self.cost)(&self.current, &mut self.live).weight();
        let mut over = 0.0;
        for step in 0_u64.. {
            if step % 512 == 0 {
                over = clock(&progress(self.best.0)).ok_or(Over)?;
                if over >= 1.0 {
                    break;
                }
            }
            if !self.step() {
                continue;
            }
            let cost = (self.cost)(&self.next, &mut self.live);
            #[allow(clippy::cast_precision_loss)] // small integers
            let worse = cost.weight() as f64 - weight as f64;
            let temperature = hottest * (1.0 - over) + 0.03;
            if worse <= 0.0 || self.rng.f64() < (-worse / temperature).exp() {
                std::mem::swap(&mut self.current, &mut self.next);
                weight = cost.weight();
                if weight < self.best.0.weight() {
                    self.best = (cost, self.current.clone());
                }
            } else {
                // constants keep their places, so that both graphs can have all of them
                std::mem::swap(&mut self.current.sheet.numbers, &mut self.next.sheet.numbers);
            }
        }
        Ok(())
    }

    /// Writes the current graph once more with one node rewritten; false when nothing came of it. The constants move
    /// along.
    fn step(&mut self) -> bool {
        let nodes = self.current.sheet.nodes.len();
        let target = self.rng.usize(..nodes);
        if !matches!(self.current.sheet.nodes[target].op, Op::Sum(..) | Op::Product(..)) {
            return false;
        }
        mark_live(&self.current.sheet.nodes, &self.current.outputs, &mut self.live);
        if !self.live[target] {
            return false;
        }
        std::mem::swap(&mut self.current.sheet.numbers, &mut self.next.sheet.numbers);
        let next = &mut self.next.sheet;
        next.clear_nodes();
        self.map.clear();
        self.map.resize(nodes, Sheet::zero());
        for (index, node) in self.current.sheet.nodes.iter().enumerate() {
            if !self.live[index] {
                continue;
            }
            let map = &self.map;
            let mapped = |at: Ref| map[at.index()].signed(at.is_negative());
            self.map[index] = match node.op {
                Op::Constant(place) => next.constant_at(place),
                Op::Leaf(leaf) => next.leaf(leaf, node.image),
                Op::Inverse(a) => next.inverse(mapped(a)),
                Op::Sum(a, b) => {
                    let (a, b) = (mapped(a), mapped(b));
                    if index == target {
                        match rewritten_sum(next, a, b, &mut self.rng) {
                            Some(other) => other,
                            None => return self.give_up(),
                        }
                    } else {
                        next.sum(a, b)
                    }
                }
                Op::Product(a, b) => {
                    let (a, b) = (mapped(a), mapped(b));
                    if index == target {
                        match rewritten_product(next, a, b, &mut self.rng) {
                            Some(other) => other,
                            None => return self.give_up(),
                        }
                    } else {
                        next.product(a, b)
                    }
                }
            };
        }
        self.next.outputs.clear();
        let map = &self.map;
        self.next.outputs.extend(self.current.outputs.iter().map(|at| map[at.index()].signed(at.is_negative())));
        true
    }

    fn give_up(&mut self) -> bool {
        std::mem::swap(&mut self.current.sheet.numbers, &mut self.next.sheet.numbers);
        false
    }
}

/// Two operands.
type Pair = (Ref, Ref);

/// How often another move is tried on the node at hand.
const TRIES: usize = 6;

/// The operands of a sum, and those of a product.
fn operands(sheet: &Sheet, at: Ref) -> (Option<Pair>, Option<Pair>) {
    match sheet.op(at) {
        Op::Sum(a, b) => (Some((a, b)), None),
        Op::Product(a, b) => (None, Some((a, b))),
        _ => (None, None),
    }
}

fn swapped<T>((a, b): (T, T), swap: bool) -> (T, T) {
    if swap { (b, a) } else { (a, b) }
}

/// a + b in another way.
fn rewritten_sum(sheet: &mut Sheet, a: Ref, b: Ref, rng: &mut fastrand::Rng) -> Option<Ref> {
    for _ in 0..TRIES {
        let (a, b) = swapped((a, b), rng.bool());
        let (sum_a, product_a) = operands(sheet, a);
        let (sum_b, product_b) = operands(sheet, b);
        match rng.u32(..12) {
            0..5 => {
                // (u + v) + b = u + (v + b)
                if let Some(pair) = sum_a {
                    let (u, v) = swapped(pair, rng.bool());
                    let (u, v) = (u.signed(a.is_negative()), v.signed(a.is_negative()));
                    let rest = sheet.sum(v, b);
                    return Some(sheet.sum(u, rest));
                }
            }
            5..10 => {
                let other = match (product_a, product_b) {
                    (Some(p), Some(q)) => factored(sheet, (a, p), (b, q), rng),
                    (Some(p), None) => factored_one(sheet, (a, p), b),
                    _ => None,
                };
                if other.is_some() {
                    return other;
                }
            }
            10 => {
                // (u + v) + (p + q) = (u + p) + (v + q)
                if let (Some((u, v)), Some(pair)) = (sum_a, sum_b) {
                    let (p, q) = swapped(pair, rng.bool());
                    let first = sheet.sum(u.signed(a.is_negative()), p.signed(b.is_negative()));
                    let second = sheet.sum(v.signed(a.is_negative()), q.signed(b.is_negative()));
                    return Some(sheet.sum(first, second));
                }
            }
            _ => {
                // 1 - s² = c²
                if a.magnitude() == Ref::new(1)
                    && a.is_negative() != b.is_negative()
                    && let Some((p, q)) = product_b
                    && p == q
                    && let Some(partner) = partner(sheet, p)
                {
                    return Some(sheet.product(partner, partner).signed(a.is_negative()));
                }
            }
        }
    }
    None
}

/// Two products with something in common.
fn factored(sheet: &mut Sheet, (a, p): (Ref, Pair), (b, q): (Ref, Pair), rng: &mut fastrand::Rng) -> Option<Ref> {
    let (sa, sb) = (a.is_negative(), b.is_negative());
    let (p, q) = (swapped(p, rng.bool()), swapped(q, rng.bool()));
    let pairs = |(x, y): (Ref, Ref)| [(x, y), (y, x)];
    // u w ± v w = (u ± v) w
    for (common, u) in pairs(p) {
        for (other, v) in pairs(q) {
            if common == other {
                let rest = sheet.sum(u.signed(sa), v.signed(sb));
                return Some(sheet.product(common, rest));
            }
        }
    }
    // u² - v² = (u + v) (u - v)
    if p.0 == p.1 && q.0 == q.1 && sa != sb {
        let (plus, minus) = (sheet.sum(p.0, q.0), sheet.sum(p.0, -q.0));
        return Some(sheet.product(plus, minus).signed(sa));
    }
    // p (u v) + u w = u (p v + w)
    for (rest, inner) in pairs(p) {
        if let (_, Some(inner)) = operands(sheet, inner) {
            for (u, v) in pairs(inner) {
                for (other, w) in pairs(q) {
                    if u == other {
                        let product = sheet.product(v, rest).signed(sa);
                        let sum = sheet.sum(product, w.signed(sb));
                        return Some(sheet.product(u, sum));
                    }
                }
            }
        }
    }
    // c₁ x + c₂ y = c₁ (x + (c₂/c₁) y)
    for (c, x) in pairs(p) {
        for (d, y) in pairs(q) {
            if sheet.is_constant(c) && sheet.is_constant(d) {
                let ratio = bounded_quotient(sheet, d, c)?;
                let scaled = sheet.product(ratio, y).signed(sb);
                let sum = sheet.sum(x.signed(sa), scaled);
                return Some(sheet.product(c, sum));
            }
        }
    }
    None
}

/// A product and something else.
fn factored_one(sheet: &mut Sheet, (a, p): (Ref, Pair), b: Ref) -> Option<Ref> {
    let sa = a.is_negative();
    for (x, y) in [p, (p.1, p.0)] {
        // u v + u = u (v + 1)
        if x == b.magnitude() {
            let sum = sheet.sum(y.signed(sa), Ref::new(1).signed(b.is_negative()));
            return Some(sheet.product(x, sum));
        }
    }
    for (c, x) in [p, (p.1, p.0)] {
        // c x + y = c (x + y/c)
        if sheet.is_constant(c) {
            let inverse = bounded_quotient(sheet, Ref::new(1), c)?;
            let scaled = sheet.product(inverse, b);
            let sum = sheet.sum(x.signed(sa), scaled);
            return Some(sheet.product(c, sum));
        }
    }
    None
}

/// A quotient of two constants that is neither huge nor tiny.
fn bounded_quotient(sheet: &mut Sheet, a: Ref, b: Ref) -> Option<Ref> {
    let quotient = sheet.number(a)?.to_f64() / sheet.number(b)?.to_f64();
    if !FACTORS.contains(&quotient.abs()) {
        return None;
    }
    let inverse = sheet.constant_inverse(b)?;
    Some(sheet.product(a, inverse))
}

/// a · b in another way.
fn rewritten_product(sheet: &mut Sheet, a: Ref, b: Ref, rng: &mut fastrand::Rng) -> Option<Ref> {
    for _ in 0..TRIES {
        let (a, b) = swapped((a, b), rng.bool());
        let (sum_a, product_a) = operands(sheet, a);
        let (_, product_b) = operands(sheet, b);
        let sign = a.is_negative();
        match rng.u32(..9) {
            0..4 => {
                // (u v) b = u (v b)
                if let Some(pair) = product_a {
                    let (u, v) = swapped(pair, rng.bool());
                    let rest = sheet.product(v, b);
                    return Some(sheet.product(u, rest).signed(sign));
                }
            }
            4..7 => {
                // (u + v) b = u b + v b
                if let Some((u, v)) = sum_a {
                    let (first, second) = (sheet.product(u.signed(sign), b), sheet.product(v.signed(sign), b));
                    return Some(sheet.sum(first, second));
                }
            }
            7 => {
                // (u v) (p q) = (u p) (v q)
                if let (Some((u, v)), Some(pair)) = (product_a, product_b) {
                    let (p, q) = swapped(pair, rng.bool());
                    let (first, second) = (sheet.product(u, p), sheet.product(v, q));
                    return Some(sheet.product(first, second).signed(sign != b.is_negative()));
                }
            }
            _ => {
                // c² = 1 - s²
                if a.magnitude() == b.magnitude()
                    && rng.u32(..4) == 0
                    && let Some(partner) = partner(sheet, a)
                {
                    let square = sheet.product(partner, partner);
                    return Some(sheet.sum(Ref::new(1), -square).signed(sign != b.is_negative()));
                }
            }
        }
    }
    None
}

/// The cosine beside a sine and the other way round.
fn partner(sheet: &Sheet, at: Ref) -> Option<Ref> {
    let wanted = match sheet.op(at) {
        Op::Leaf(Leaf::Sine(first, last)) => Leaf::Cosine(first, last),
        Op::Leaf(Leaf::Cosine(first, last)) => Leaf::Sine(first, last),
        _ => return None,
    };
    sheet.nodes.iter().position(|node| node.op == Op::Leaf(wanted)).map(Ref::new)
}
