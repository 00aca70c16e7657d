//! Vectors and matrices of polynomials.

use std::ops::{Add, Mul, Sub};

use crate::polynomial::Polynomial;

/// A vector of three components.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Vector(pub(crate) [Polynomial; 3]);

/// A 3 × 3 matrix of three rows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Matrix(pub(crate) [Vector; 3]);

impl Vector {
    pub(crate) fn zero() -> Self {
        Self([Polynomial::zero(), Polynomial::zero(), Polynomial::zero()])
    }

    /// Returns the vector (0, 0, z).
    pub(crate) fn along_z(z: Polynomial) -> Self {
        Self([Polynomial::zero(), Polynomial::zero(), z])
    }

    pub(crate) fn dot(&self, other: &Self) -> Polynomial {
        self.0.iter().zip(&other.0).fold(Polynomial::zero(), |sum, (x, y)| sum + x * y)
    }

    pub(crate) fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.0.iter().all(Polynomial::is_zero)
    }

    fn zip(&self, other: &Self, of: impl Fn(&Polynomial, &Polynomial) -> Polynomial) -> Self {
        Self([0, 1, 2].map(|axis| of(&self.0[axis], &other.0[axis])))
    }
}

impl Matrix {
    pub(crate) fn identity() -> Self {
        Self([0, 1, 2].map(|row| Vector([0, 1, 2].map(|column| Polynomial::integer(i64::from(row == column))))))
    }

    /// Returns a rotation about x from sine and cosine of the angle.
    pub(crate) fn about_x((sine, cosine): &(Polynomial, Polynomial)) -> Self {
        let (zero, one) = (Polynomial::zero, || Polynomial::integer(1));
        Self([
            Vector([one(), zero(), zero()]),
            Vector([zero(), cosine.clone(), -sine]),
            Vector([zero(), sine.clone(), cosine.clone()]),
        ])
    }

    /// Returns a rotation about z from sine and cosine of the angle.
    pub(crate) fn about_z((sine, cosine): &(Polynomial, Polynomial)) -> Self {
        let (zero, one) = (Polynomial::zero, || Polynomial::integer(1));
        Self([
            Vector([cosine.clone(), -sine, zero()]),
            Vector([sine.clone(), cosine.clone(), zero()]),
            Vector([zero(), zero(), one()]),
        ])
    }

    pub(crate) fn transpose(&self) -> Self {
        Self([0, 1, 2].map(|row| Vector([0, 1, 2].map(|column| self.0[column].0[row].clone()))))
    }
}

impl Add for &Vector {
    type Output = Vector;

    fn add(self, other: Self) -> Vector {
        self.zip(other, |x, y| x + y)
    }
}

impl Sub for &Vector {
    type Output = Vector;

    fn sub(self, other: Self) -> Vector {
        self.zip(other, |x, y| x - y)
    }
}

impl Add for Vector {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        &self + &other
    }
}

impl Sub for Vector {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        &self - &other
    }
}

impl Mul<&Polynomial> for &Vector {
    type Output = Vector;

    fn mul(self, factor: &Polynomial) -> Vector {
        Vector([0, 1, 2].map(|axis| &self.0[axis] * factor))
    }
}

impl Mul<&Vector> for &Matrix {
    type Output = Vector;

    fn mul(self, vector: &Vector) -> Vector {
        Vector([0, 1, 2].map(|row| self.0[row].dot(vector)))
    }
}

impl Mul for &Matrix {
    type Output = Matrix;

    fn mul(self, other: Self) -> Matrix {
        let columns = other.transpose();
        Matrix([0, 1, 2].map(|row| Vector([0, 1, 2].map(|column| self.0[row].dot(&columns.0[column])))))
    }
}
