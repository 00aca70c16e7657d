//! Symbolic numbers, vectors and matrices, with the operators that formulas are written in.

use std::ops::{Add, Mul};

use rne_model::QuarterTurns;

use super::{Axis, Builder, CausesId, Number, Ref, TermId, operators};

/// A number of a graph that is being written.
#[derive(Clone, Copy)]
pub(crate) struct Symbol<'s> {
    pub(crate) builder: &'s Builder,
    pub(crate) at: Ref,
    /// The reasons for its value, if it is a constant.
    pub(crate) causes: CausesId,
    /// The formula that computes it, if formulas are kept.
    pub(crate) term: TermId,
}

impl Symbol<'_> {
    /// Whether it is the number 0.
    pub(crate) fn is_zero(self) -> bool {
        self.builder.graph.borrow().is_zero(self.at)
    }

    /// The number, negated if `negative`.
    pub(crate) fn signed(self, negative: bool) -> Self {
        let term = if negative { self.builder.negative(self.term) } else { self.term };
        Self { at: self.at.signed(negative), term, ..self }
    }

    /// 1/x
    pub(crate) fn inverse(self) -> Self {
        self.builder.quotient(self.builder.one(), self)
    }

    /// Multiplies the number by a constant.
    pub(crate) fn times(self, factor: Number) -> Self {
        if self.is_zero() { self } else { self * self.builder.number(factor) }
    }
}

operators! { Symbol<'_>:
    a + b => a.builder.sum(a, b);
    a - b => a.builder.sum(a, -b);
    a * b => a.builder.product(a, b);
    -a => a.signed(true);
}

/// Returns sine and cosine of an angle plus `turns` from those of the angle.
pub(crate) fn by_quarters<'s>((s, c): (Symbol<'s>, Symbol<'s>), turns: QuarterTurns) -> (Symbol<'s>, Symbol<'s>) {
    match turns {
        QuarterTurns::Zero => (s, c),
        QuarterTurns::One => (c, -s),
        QuarterTurns::Two => (-s, -c),
        QuarterTurns::Three => (-c, s),
    }
}

/// A vector of three symbols.
#[derive(Clone, Copy)]
pub(crate) struct Vector<'s>(pub(crate) [Symbol<'s>; 3]);

impl<'s> Vector<'s> {
    /// Applies `f` to each component.
    pub(crate) fn map(self, f: impl Fn(Axis, Symbol<'s>) -> Symbol<'s>) -> Self {
        Self(Axis::ALL.map(|axis| f(axis, self.0[axis as usize])))
    }

    /// Component z, along the joint axis: e · v.
    pub(crate) fn z(self) -> Symbol<'s> {
        self.0[2]
    }

    /// a × b, each component a_j b_k - a_k b_j.
    pub(crate) fn cross(self, other: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        componentwise(ax.builder, |axis| match axis {
            Axis::X => ay * bz - az * by,
            Axis::Y => az * bx - ax * bz,
            Axis::Z => ax * by - ay * bx,
        })
    }

    /// Σ a_k b_k, summed from left to right.
    pub(crate) fn dot(self, other: Self) -> Symbol<'s> {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        let (x, y, z) = (ax * bx, ay * by, az * bz);
        (x + y) + z
    }

    /// Multiplies the vector by a constant.
    pub(crate) fn times(self, factor: Number) -> Self {
        Self(self.0.map(|x| x.times(factor)))
    }

    /// v + x z: adds x to the z component.
    pub(crate) fn plus_z(self, x: Symbol<'s>) -> Self {
        let [a, b, c] = self.0;
        Self([a, b, c + x])
    }

    pub(crate) fn is_zero(self) -> bool {
        self.0.iter().all(|x| x.is_zero())
    }

    fn zip(self, other: Self, f: impl Fn(Symbol<'s>, Symbol<'s>) -> Symbol<'s>) -> Self {
        componentwise(self.0[0].builder, |axis| f(self.0[axis as usize], other.0[axis as usize]))
    }
}

operators! { Vector<'_>:
    a + b => a.zip(b, |a, b| a + b);
    a - b => a.zip(b, |a, b| a - b);
    -a => a.map(|_, x| -x);
}

impl<'s> Mul<Symbol<'s>> for Vector<'s> {
    type Output = Self;

    fn mul(self, factor: Symbol<'s>) -> Self {
        componentwise(factor.builder, |axis| self.0[axis as usize] * factor)
    }
}

/// A 3 × 3 matrix of symbols, by rows.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'s>(pub(crate) [Vector<'s>; 3]);

impl<'s> Matrix<'s> {
    pub(crate) fn from_rows(rows: [[Symbol<'s>; 3]; 3]) -> Self {
        Self(rows.map(Vector))
    }

    /// Makes a matrix from its elements by rows.
    pub(crate) fn from_elements([a, b, c, d, e, f, g, h, i]: [Symbol<'s>; 9]) -> Self {
        Self::from_rows([[a, b, c], [d, e, f], [g, h, i]])
    }

    /// Applies `f` to each element: row, column, element.
    pub(crate) fn map(self, f: impl Fn(Axis, Axis, Symbol<'s>) -> Symbol<'s>) -> Self {
        Self(Axis::ALL.map(|row| self.0[row as usize].map(|column, element| f(row, column, element))))
    }

    pub(crate) fn transpose(self) -> Self {
        let [Vector([xx, xy, xz]), Vector([yx, yy, yz]), Vector([zx, zy, zz])] = self.0;
        Self::from_rows([[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]])
    }
}

impl Add for Matrix<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let [[a, b, c], [x, y, z]] = [self.0, other.0];
        Self([a + x, b + y, c + z])
    }
}

impl<'s> Mul<Vector<'s>> for Matrix<'s> {
    type Output = Vector<'s>;

    fn mul(self, v: Vector<'s>) -> Vector<'s> {
        componentwise(v.0[0].builder, |axis| self.0[axis as usize].dot(v))
    }
}

impl Mul for Matrix<'_> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let columns = other.transpose().0.map(|column| self * column);
        Self(columns).transpose()
    }
}

/// Computes a vector component by component, and tells the builder which component it computes.
fn componentwise<'s>(builder: &'s Builder, f: impl Fn(Axis) -> Symbol<'s>) -> Vector<'s> {
    Vector(Axis::ALL.map(|axis| {
        builder.along(axis);
        f(axis)
    }))
}
