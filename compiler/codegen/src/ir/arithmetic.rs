//! Sums, products and quotients on a graph, folded as far as its policy allows.

use super::{Graph, Op, Outcome, Policy, Ref, Residue, Side};

impl Graph {
    /// a + b
    pub(crate) fn sum(&mut self, a: Ref, b: Ref) -> (Ref, Outcome) {
        if self.is_zero(b) {
            return (a, Outcome::Zero(Side::Right));
        }
        if self.is_zero(a) {
            return (b, Outcome::Zero(Side::Left));
        }
        if let Some(constant) = self.constant_sum(a, b) {
            return (constant, Outcome::Constants);
        }
        if a == -b {
            return (self.zero(), Outcome::Cancelled);
        }
        let residue = self.residue(a) + self.residue(b);
        if self.policy == Policy::Structure {
            return self.sum_as_written(a, b, residue);
        }
        if residue.is_zero() {
            return (self.zero(), Outcome::Cancelled);
        }
        if let Some(known) = self.numbered(residue) {
            return (known, Outcome::Shared);
        }
        // c₁ x + c₂ x = (c₁ + c₂) x
        let ((x, u), (y, v)) = (self.factored(a), self.factored(b));
        if x == y
            && let Some(factor) = self.constant_sum(u, v)
        {
            return self.product(factor, x);
        }
        let (a, b) = if a.index() > b.index() { (b, a) } else { (a, b) };
        let negative = a.is_negative();
        let op = Op::Sum(a.signed(negative), b.signed(negative));
        let (at, outcome) = self.intern(op, residue.signed(negative));
        (at.signed(negative), outcome)
    }

    /// Writes a sum with its operands in the given order, because people read the code.
    fn sum_as_written(&mut self, a: Ref, b: Ref, residue: Residue) -> (Ref, Outcome) {
        // pull out the sign of the first operand: (-a) + b = -(a - b)
        let mut negative = a.is_negative();
        let (mut a, mut b) = (a.signed(negative), b.signed(negative));
        // a - b and b - a are one node: the one whose first operand is older
        if b.is_negative() && a.index() > b.index() {
            (a, b) = (-b, -a);
            negative = !negative;
        }
        let (at, outcome) = self.intern(Op::Sum(a, b), residue.signed(negative));
        (at.signed(negative), outcome)
    }

    /// a · b
    pub(crate) fn product(&mut self, a: Ref, b: Ref) -> (Ref, Outcome) {
        if self.is_zero(b) {
            return (b.magnitude(), Outcome::Zero(Side::Right));
        }
        if self.is_zero(a) {
            return (a.magnitude(), Outcome::Zero(Side::Left));
        }
        if self.is_unit(b) {
            return (a.signed(b.is_negative()), Outcome::One(Side::Right));
        }
        if self.is_unit(a) {
            return (b.signed(a.is_negative()), Outcome::One(Side::Left));
        }
        let negative = a.is_negative() != b.is_negative();
        let (mut a, mut b) = (a.magnitude(), b.magnitude());
        if let Some(constant) = self.constant_product(a, b) {
            return (constant.signed(negative), Outcome::Constants);
        }
        if self.policy != Policy::Structure {
            // a constant factor comes first, then the older one
            let is_factor = (self.is_constant(a), self.is_constant(b));
            if is_factor.1 || !is_factor.0 && a > b {
                (a, b) = (b, a);
            }
            // c₁ (c₂ x) = (c₁ c₂) x
            if (is_factor.0 || is_factor.1)
                && let Op::Product(inner, rest) = self.op(b)
                && let Some(factor) = self.constant_product(a, inner)
            {
                let (at, outcome) = self.product(factor, rest);
                return (at.signed(negative), outcome);
            }
        }
        let residue = self.residue(a) * self.residue(b);
        self.node(Op::Product(a, b), residue, negative)
    }

    /// a / b. It folds only if this is exact for every b. A division by zero stays in the code, whose result is then
    /// not finite.
    pub(crate) fn quotient(&mut self, a: Ref, b: Ref) -> (Ref, Outcome) {
        if self.is_unit(b) {
            return (a.signed(b.is_negative()), Outcome::One(Side::Right));
        }
        if let Some(quotient) = self.constant_quotient(a, b) {
            return (quotient, Outcome::Constants);
        }
        let negative = a.is_negative() != b.is_negative();
        let (a, b) = (a.magnitude(), b.magnitude());
        let residue = self.residue(a) * self.residue(b).inverse().unwrap_or(Residue::ZERO);
        self.node(Op::Quotient(a, b), residue, negative)
    }

    /// `positive` where x > 0, `negative` where x < 0, else 0.
    pub(crate) fn by_sign(&mut self, x: Ref, positive: Ref, negative: Ref) -> (Ref, Outcome) {
        if self.is_zero(positive) && self.is_zero(negative) {
            return (self.zero(), Outcome::Constants);
        }
        let operands = [x, positive, negative];
        let residue = Residue::by_sign(operands.map(|at| self.residue(at)));
        self.node(Op::BySign(operands), residue, false)
    }

    /// Splits a term into a constant and the rest; returns the rest and a reference to the constant.
    fn factored(&self, at: Ref) -> (Ref, Ref) {
        if let Op::Product(factor, rest) = self.op(at)
            && let Op::Constant(_) = self.op(factor)
        {
            return (rest, factor.signed(at.is_negative()));
        }
        (at.magnitude(), Ref::new(1).signed(at.is_negative()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::{Embedding, Input, Name, Number, Quantity};

    fn inputs(policy: Policy) -> (Graph, Ref, Ref) {
        let mut graph = Graph::new(policy, Embedding::default());
        let [a, b] = [0, 1].map(|joint| graph.input(Input::new(Name::scalar(Quantity::Rate, joint + 1))));
        (graph, a, b)
    }

    fn constant(graph: &mut Graph, value: f64) -> Ref {
        graph.constant(graph.embedding().decimal(value))
    }

    #[test]
    fn exact_identities_fold() {
        for policy in [Policy::Structure, Policy::Value, Policy::Numbered] {
            let (mut graph, a, _) = inputs(policy);
            let [zero, one, two] = [0.0, 1.0, 2.0].map(|value| constant(&mut graph, value));
            assert_eq!(graph.product(zero, a), (zero, Outcome::Zero(Side::Left)));
            assert_eq!(graph.product(a, zero), (zero, Outcome::Zero(Side::Right)));
            assert_eq!(graph.product(one, a), (a, Outcome::One(Side::Left)));
            assert_eq!(graph.product(a, -one), (-a, Outcome::One(Side::Right)));
            assert_eq!(graph.sum(a, zero), (a, Outcome::Zero(Side::Right)));
            assert_eq!(graph.sum(zero, -a), (-a, Outcome::Zero(Side::Left)));
            assert_eq!(graph.sum(a, -a), (zero, Outcome::Cancelled));
            assert_eq!(graph.sum(one, one), (two, Outcome::Constants));
        }
    }

    #[test]
    fn signs_and_order_do_not_make_new_nodes() {
        for policy in [Policy::Structure, Policy::Value, Policy::Numbered] {
            let (mut graph, a, b) = inputs(policy);
            let (difference, _) = graph.sum(a, -b);
            assert_eq!(graph.sum(b, -a), (-difference, Outcome::Shared));
            assert_eq!(graph.sum(-b, a), (difference, Outcome::Shared));
            assert_eq!(graph.sum(-a, b), (-difference, Outcome::Shared));
            let (sum, _) = graph.sum(b, a);
            assert_eq!(graph.sum(-a, -b), (-sum, Outcome::Shared));
            let (product, _) = graph.product(a, -b);
            assert_eq!(graph.product(b, a), (-product, Outcome::Shared));
            assert_eq!(graph.product(-b, -a), (-product, Outcome::Shared));
        }
    }

    #[test]
    fn structure_leaves_alone_what_is_not_exact() {
        let (mut graph, a, b) = inputs(Policy::Structure);
        let (two, three) = (constant(&mut graph, 2.0), constant(&mut graph, 3.0));
        let (inner, _) = graph.product(three, a);
        assert_eq!(graph.product(two, inner).1, Outcome::Computed, "2·(3·a) is not 6·a in floating point");
        let (sum, _) = graph.sum(a, b);
        let (other, _) = graph.sum(sum, -b);
        assert_ne!(other, a, "(a + b) - b is not a");
        let [zero, one] = [0.0, 1.0].map(|value| constant(&mut graph, value));
        assert_eq!(graph.quotient(one, zero).1, Outcome::Computed, "infinity is no number of the table");
        let [x, y] = [0.1, 0.2].map(|value| constant(&mut graph, value));
        let (sum, _) = graph.sum(x, y);
        assert_eq!(graph.number(sum).map(Number::to_f64), Some(0.1 + 0.2), "constants are rounded as the runtime does");
    }

    #[test]
    fn values_fold_what_is_equal() {
        let (mut graph, a, b) = inputs(Policy::Value);
        let (two, three, six) = (constant(&mut graph, 2.0), constant(&mut graph, 3.0), constant(&mut graph, 6.0));
        let (inner, _) = graph.product(three, a);
        assert_eq!(graph.product(two, inner).0, graph.product(six, a).0);
        let (twice, _) = graph.product(two, a);
        assert_eq!(graph.sum(inner, -twice).0, a);
        let (sum, _) = graph.sum(a, b);
        assert_ne!(graph.sum(sum, -b).0, a, "only a numbered graph looks at values");
        let (mut graph, a, b) = inputs(Policy::Numbered);
        let (sum, _) = graph.sum(a, b);
        assert_eq!(graph.sum(sum, -b), (a, Outcome::Shared));
        // (a + b)(a - b) = a² - b²
        let (difference, _) = graph.sum(a, -b);
        let (product, _) = graph.product(sum, difference);
        let (squares, _) = (graph.product(a, a), graph.product(b, b));
        let (b_squared, _) = graph.product(b, b);
        assert_eq!(graph.sum(squares.0, -b_squared), (product, Outcome::Shared));
    }
}
