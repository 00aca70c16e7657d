//! Symbolic numbers, vectors and matrices, with the operators that formulas are written in.

use std::ops::{Add, Mul, Neg, Sub};

use crate::graph::Term;
use crate::quantity::Axis;
use crate::worksheet::{CausesId, Worksheet};

/// A number on a worksheet.
#[derive(Clone, Copy)]
pub(crate) struct Symbol<'s> {
    pub(crate) sheet: &'s Worksheet,
    pub(crate) term: Term,
    /// Why it is the constant that it is, if it is one.
    pub(crate) causes: CausesId,
}

impl<'s> Add for Symbol<'s> {
    type Output = Symbol<'s>;

    fn add(self, other: Self) -> Self {
        self.sheet.sum(self, other)
    }
}

impl<'s> Sub for Symbol<'s> {
    type Output = Symbol<'s>;

    fn sub(self, other: Self) -> Self {
        self.sheet.sum(self, -other)
    }
}

impl<'s> Mul for Symbol<'s> {
    type Output = Symbol<'s>;

    fn mul(self, other: Self) -> Self {
        self.sheet.product(self, other)
    }
}

impl Neg for Symbol<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        Self { term: -self.term, ..self }
    }
}

/// A vector of three symbols.
#[derive(Clone, Copy)]
pub(crate) struct Vector<'s>(pub(crate) [Symbol<'s>; 3]);

impl<'s> Vector<'s> {
    /// Applies `f` to each component.
    pub(crate) fn map(self, f: impl Fn(Axis, Symbol<'s>) -> Symbol<'s>) -> Self {
        let [x, y, z] = self.0;
        Self([f(Axis::X, x), f(Axis::Y, y), f(Axis::Z, z)])
    }

    /// Component z, along the joint axis: e · v.
    pub(crate) fn z(self) -> Symbol<'s> {
        self.0[2]
    }

    /// a × b, each component a_j b_k - a_k b_j.
    pub(crate) fn cross(self, other: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = (self.0, other.0);
        componentwise(ax.sheet, |axis| match axis {
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

    fn zip(self, other: Self, f: impl Fn(Symbol<'s>, Symbol<'s>) -> Symbol<'s>) -> Self {
        componentwise(self.0[0].sheet, |axis| f(self.0[axis as usize], other.0[axis as usize]))
    }
}

impl Add for Vector<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Vector<'_> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Neg for Vector<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        self.map(|_, x| -x)
    }
}

impl<'s> Mul<Symbol<'s>> for Vector<'s> {
    type Output = Self;

    fn mul(self, factor: Symbol<'s>) -> Self {
        componentwise(factor.sheet, |axis| self.0[axis as usize] * factor)
    }
}

/// A 3 × 3 matrix of symbols, by rows.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<'s>(pub(crate) [Vector<'s>; 3]);

impl<'s> Matrix<'s> {
    pub(crate) fn from_rows(rows: [[Symbol<'s>; 3]; 3]) -> Self {
        Self(rows.map(Vector))
    }

    /// Applies `f` to each element: row, column, element.
    pub(crate) fn map(self, f: impl Fn(Axis, Axis, Symbol<'s>) -> Symbol<'s>) -> Self {
        let [x, y, z] = self.0;
        Self([
            x.map(|column, e| f(Axis::X, column, e)),
            y.map(|column, e| f(Axis::Y, column, e)),
            z.map(|column, e| f(Axis::Z, column, e)),
        ])
    }

    pub(crate) fn transpose(self) -> Self {
        let [Vector([xx, xy, xz]), Vector([yx, yy, yz]), Vector([zx, zy, zz])] = self.0;
        Self::from_rows([[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]])
    }
}

impl<'s> Mul<Vector<'s>> for Matrix<'s> {
    type Output = Vector<'s>;

    fn mul(self, v: Vector<'s>) -> Vector<'s> {
        componentwise(v.0[0].sheet, |axis| self.0[axis as usize].dot(v))
    }
}

impl Mul for Matrix<'_> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let columns = other.transpose().0.map(|column| self * column);
        Self(columns).transpose()
    }
}

/// Computes a vector component by component and tells the sheet which one is under way.
fn componentwise<'s>(sheet: &'s Worksheet, f: impl Fn(Axis) -> Symbol<'s>) -> Vector<'s> {
    Vector(Axis::ALL.map(|axis| {
        sheet.along(axis);
        f(axis)
    }))
}
