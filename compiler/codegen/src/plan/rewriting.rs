//! Algebraic rewriting of a finished graph: simulated annealing with local, exact moves (docs/teaching/reduced-form.md,
//! section 10).
//!
//! The result no longer resembles a recursion. Every move is an identity of real numbers, and equal values stay one
//! node, however they were computed.

use std::ops::ControlFlow;

use rne_model::Robot;

use crate::CompileError;
use crate::function::Function;
use crate::ir::{Cost, Graph, Op, Ref, mark_live, mark_live_outside_angles};
use crate::plan::graph_text;
use crate::plan::rewritten::Rewritten;

/// Factors that a move introduces stay within these bounds.
const FACTORS: std::ops::Range<f64> = 1e-4..1e4;

/// The graph of a function while algebra makes it smaller.
#[derive(Clone, Debug)]
pub struct Rewriting {
    /// The entry of the plan file, without the graph as text.
    rewritten: Rewritten,
    graph: Graph,
    /// The places of the numbers that the graph had before rewriting.
    given: Vec<u32>,
}

impl Rewriting {
    /// Continues with a rewritten graph, or starts from the graph of the plan if there is no text of a rewritten one.
    ///
    /// # Errors
    /// When the plan does not fit the robot.
    pub fn of(robot: &Robot, function: Function, rewritten: Rewritten) -> Result<Self, CompileError> {
        let before = rewritten.before(robot, function)?.traced.graph;
        let given = before.factors();
        // the graph's own constants follow those of the plan, as in a graph that has just been rewritten
        let read = graph_text::read(&rewritten.graph, &before, function).ok();
        let graph = read.map(|read| graph_text::on_numbers_of(&read.graph, &before)).unwrap_or(before);
        Ok(Self { rewritten: Rewritten { operations: graph.cost(&mut Vec::new()), ..rewritten }, graph, given })
    }

    /// The cost of the graph.
    #[must_use]
    pub const fn cost(&self) -> Cost {
        self.rewritten.operations
    }

    /// Anneals from a temperature downwards until the clock says that all of its time is over, and keeps the smallest
    /// graph. `clock` gets the smallest cost so far. It returns the elapsed part of the time, 0 to 1, or `None` to stop
    /// the annealing.
    pub fn anneal(&mut self, seed: u64, hottest: f64, clock: &mut dyn FnMut(Cost) -> Option<f64>) -> ControlFlow<()> {
        let mut annealing = Annealing::new(self.graph.clone(), seed, Graph::cost);
        let ended = annealing.anneal(hottest, clock);
        (self.rewritten.operations, self.graph) = annealing.best;
        ended
    }

    /// Returns the graph as a plan file keeps it.
    #[must_use]
    pub fn written(self) -> Rewritten {
        Rewritten { graph: graph_text::written(&self.graph, &self.given), ..self.rewritten }
    }
}

/// A graph under annealing.
pub(super) struct Annealing<C> {
    current: Graph,
    next: Graph,
    live: Vec<bool>,
    /// For each node, whether something other than an angle needs it.
    computed: Vec<bool>,
    map: Vec<Ref>,
    cost: C,
    rng: fastrand::Rng,
    /// The smallest graph seen.
    pub(super) best: (Cost, Graph),
}

impl<C: Fn(&Graph, &mut Vec<bool>) -> Cost> Annealing<C> {
    /// Starts from a numbered graph.
    pub(super) fn new(graph: Graph, seed: u64, cost: C) -> Self {
        let mut live = Vec::new();
        let best = (cost(&graph, &mut live), graph.clone());
        let next = graph.clone();
        Self {
            current: graph,
            next,
            live,
            computed: Vec::new(),
            map: Vec::new(),
            cost,
            rng: fastrand::Rng::with_seed(seed),
            best,
        }
    }

    /// Anneals until the clock returns that the time is over.
    pub(super) fn anneal(&mut self, hottest: f64, clock: &mut dyn FnMut(Cost) -> Option<f64>) -> ControlFlow<()> {
        let mut weight = (self.cost)(&self.current, &mut self.live).weight();
        let mut over = 0.0;
        for step in 0_u64.. {
            if step % 512 == 0 {
                let Some(part) = clock(self.best.0) else { return ControlFlow::Break(()) };
                over = part;
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
                // the constants go back to the current graph; they keep their places, so that both graphs can have all
                // of them
                std::mem::swap(&mut self.current.numbers, &mut self.next.numbers);
            }
        }
        ControlFlow::Continue(())
    }

    /// Writes the current graph again with one node rewritten; returns false if no move was possible. The constants
    /// move to the new graph.
    fn step(&mut self) -> bool {
        let nodes = self.current.len();
        let target = self.rng.usize(..nodes);
        if !matches!(self.current.nodes[target].op, Op::Sum(..) | Op::Product(..)) {
            return false;
        }
        mark_live(&self.current.nodes, &self.current.outputs, &mut self.live);
        mark_live_outside_angles(&self.current.nodes, &self.current.outputs, &mut self.computed);
        if !self.computed[target] {
            return false;
        }
        std::mem::swap(&mut self.current.numbers, &mut self.next.numbers);
        let next = &mut self.next;
        next.clear_nodes();
        self.map.clear();
        self.map.resize(nodes, Ref::new(0));
        for (index, node) in self.current.nodes.iter().enumerate().filter(|(index, _)| self.live[*index]) {
            let map = &self.map;
            let rewritten = match node.op {
                Op::Sum(a, b) if index == target => rewritten_sum(next, a.mapped(map), b.mapped(map), &mut self.rng),
                Op::Product(a, b) if index == target => {
                    rewritten_product(next, a.mapped(map), b.mapped(map), &mut self.rng)
                }
                op => Some(next.transcribed(op, node.residue, map)),
            };
            match rewritten {
                Some(at) => self.map[index] = at,
                None => return self.give_up(),
            }
        }
        let map = &self.map;
        next.outputs.extend(self.current.outputs.iter().map(|at| at.mapped(map)));
        true
    }

    fn give_up(&mut self) -> bool {
        std::mem::swap(&mut self.current.numbers, &mut self.next.numbers);
        false
    }
}

fn sum(graph: &mut Graph, a: Ref, b: Ref) -> Ref {
    graph.sum(a, b).0
}

fn product(graph: &mut Graph, a: Ref, b: Ref) -> Ref {
    graph.product(a, b).0
}

/// Two operands.
type Pair = (Ref, Ref);

/// The number of random moves that are tried on one node.
const TRIES: usize = 6;

/// Returns the operands of a node: first those of a sum, second those of a product; `None` for other nodes.
fn operands(graph: &Graph, at: Ref) -> (Option<Pair>, Option<Pair>) {
    match graph.op(at) {
        Op::Sum(a, b) => (Some((a, b)), None),
        Op::Product(a, b) => (None, Some((a, b))),
        _ => (None, None),
    }
}

fn swapped<T>((a, b): (T, T), swap: bool) -> (T, T) {
    if swap { (b, a) } else { (a, b) }
}

/// Writes a + b in another way; `None` if no move is possible.
fn rewritten_sum(graph: &mut Graph, a: Ref, b: Ref, rng: &mut fastrand::Rng) -> Option<Ref> {
    for _ in 0..TRIES {
        let (a, b) = swapped((a, b), rng.bool());
        let (sum_a, product_a) = operands(graph, a);
        let (sum_b, product_b) = operands(graph, b);
        match rng.u32(..12) {
            0..5 => {
                // (u + v) + b = u + (v + b)
                if let Some(pair) = sum_a {
                    let (u, v) = swapped(pair, rng.bool());
                    let (u, v) = (u.signed(a.is_negative()), v.signed(a.is_negative()));
                    let rest = sum(graph, v, b);
                    return Some(sum(graph, u, rest));
                }
            }
            5..10 => {
                let other = match (product_a, product_b) {
                    (Some(p), Some(q)) => factored(graph, (a, p), (b, q), rng),
                    (Some(p), None) => factored_one(graph, (a, p), b),
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
                    let first = sum(graph, u.signed(a.is_negative()), p.signed(b.is_negative()));
                    let second = sum(graph, v.signed(a.is_negative()), q.signed(b.is_negative()));
                    return Some(sum(graph, first, second));
                }
            }
            _ => {
                // 1 - s² = c²
                if a.magnitude() == Ref::new(1)
                    && a.is_negative() != b.is_negative()
                    && let Some((p, q)) = product_b
                    && p == q
                    && let Some(partner) = partner(graph, p)
                {
                    return Some(product(graph, partner, partner).signed(a.is_negative()));
                }
            }
        }
    }
    None
}

/// Writes the sum of two products that have something in common in another way. `p` and `q` are their factors.
fn factored(graph: &mut Graph, (a, p): (Ref, Pair), (b, q): (Ref, Pair), rng: &mut fastrand::Rng) -> Option<Ref> {
    let (sa, sb) = (a.is_negative(), b.is_negative());
    let (p, q) = (swapped(p, rng.bool()), swapped(q, rng.bool()));
    let pairs = |(x, y): (Ref, Ref)| [(x, y), (y, x)];
    // u w ± v w = (u ± v) w
    for (common, u) in pairs(p) {
        for (other, v) in pairs(q) {
            if common == other {
                let rest = sum(graph, u.signed(sa), v.signed(sb));
                return Some(product(graph, common, rest));
            }
        }
    }
    // u² - v² = (u + v) (u - v)
    if p.0 == p.1 && q.0 == q.1 && sa != sb {
        let (plus, minus) = (sum(graph, p.0, q.0), sum(graph, p.0, -q.0));
        return Some(product(graph, plus, minus).signed(sa));
    }
    // p (u v) + u w = u (p v + w)
    for (rest, inner) in pairs(p) {
        if let (_, Some(inner)) = operands(graph, inner) {
            for (u, v) in pairs(inner) {
                for (other, w) in pairs(q) {
                    if u == other {
                        let scaled = product(graph, v, rest).signed(sa);
                        let rest = sum(graph, scaled, w.signed(sb));
                        return Some(product(graph, u, rest));
                    }
                }
            }
        }
    }
    // c₁ x + c₂ y = c₁ (x + (c₂/c₁) y)
    for (c, x) in pairs(p) {
        for (d, y) in pairs(q) {
            if graph.is_constant(c) && graph.is_constant(d) {
                let ratio = bounded_quotient(graph, d, c)?;
                let scaled = product(graph, ratio, y).signed(sb);
                let rest = sum(graph, x.signed(sa), scaled);
                return Some(product(graph, c, rest));
            }
        }
    }
    None
}

/// Writes the sum of a product and another term in another way. `p` are the factors of the product.
fn factored_one(graph: &mut Graph, (a, p): (Ref, Pair), b: Ref) -> Option<Ref> {
    let sa = a.is_negative();
    for (x, y) in [p, (p.1, p.0)] {
        // u v + u = u (v + 1)
        if x == b.magnitude() {
            let rest = sum(graph, y.signed(sa), Ref::new(1).signed(b.is_negative()));
            return Some(product(graph, x, rest));
        }
    }
    for (c, x) in [p, (p.1, p.0)] {
        // c x + y = c (x + y/c)
        if graph.is_constant(c) {
            let inverse = bounded_quotient(graph, Ref::new(1), c)?;
            let scaled = product(graph, inverse, b);
            let rest = sum(graph, x.signed(sa), scaled);
            return Some(product(graph, c, rest));
        }
    }
    None
}

/// The quotient of two constants; `None` if it is huge or tiny.
fn bounded_quotient(graph: &mut Graph, a: Ref, b: Ref) -> Option<Ref> {
    let quotient = graph.number(a)?.to_f64() / graph.number(b)?.to_f64();
    if !FACTORS.contains(&quotient.abs()) {
        return None;
    }
    let inverse = graph.constant_inverse(b)?;
    Some(product(graph, a, inverse))
}

/// Writes a · b in another way; `None` if no move is possible.
fn rewritten_product(graph: &mut Graph, a: Ref, b: Ref, rng: &mut fastrand::Rng) -> Option<Ref> {
    for _ in 0..TRIES {
        let (a, b) = swapped((a, b), rng.bool());
        let (sum_a, product_a) = operands(graph, a);
        let (_, product_b) = operands(graph, b);
        let sign = a.is_negative();
        match rng.u32(..9) {
            0..4 => {
                // (u v) b = u (v b)
                if let Some(pair) = product_a {
                    let (u, v) = swapped(pair, rng.bool());
                    let rest = product(graph, v, b);
                    return Some(product(graph, u, rest).signed(sign));
                }
            }
            4..7 => {
                // (u + v) b = u b + v b
                if let Some((u, v)) = sum_a {
                    let (first, second) = (product(graph, u.signed(sign), b), product(graph, v.signed(sign), b));
                    return Some(sum(graph, first, second));
                }
            }
            7 => {
                // (u v) (p q) = (u p) (v q)
                if let (Some((u, v)), Some(pair)) = (product_a, product_b) {
                    let (p, q) = swapped(pair, rng.bool());
                    let (first, second) = (product(graph, u, p), product(graph, v, q));
                    return Some(product(graph, first, second).signed(sign != b.is_negative()));
                }
            }
            _ => {
                // c² = 1 - s²
                if a.magnitude() == b.magnitude()
                    && rng.u32(..4) == 0
                    && let Some(partner) = partner(graph, a)
                {
                    let square = product(graph, partner, partner);
                    return Some(sum(graph, Ref::new(1), -square).signed(sign != b.is_negative()));
                }
            }
        }
    }
    None
}

/// Returns the cosine of the same angle for a sine, and the sine for a cosine.
fn partner(graph: &Graph, at: Ref) -> Option<Ref> {
    let wanted = match graph.op(at) {
        Op::Sine(angle) => Op::Cosine(angle),
        Op::Cosine(angle) => Op::Sine(angle),
        _ => return None,
    };
    graph.nodes.iter().position(|node| node.op == wanted).map(Ref::new)
}
