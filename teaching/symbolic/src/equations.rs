//! Splits torques into their parts: τ = M(θ)θ̈ + h(θ,θ̇) + γ(θ).

use crate::polynomial::{Monomial, Polynomial};
use crate::rational::fraction;
use crate::symbol::Symbol;

/// The parts of the equations of motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Equations {
    /// Mass matrix M_ij, by rows.
    pub(crate) mass_matrix: Vec<Vec<Polynomial>>,
    /// Christoffel symbols c_ijk of the first kind: h_i = Σ c_ijk q̇_j q̇_k over all j and k.
    pub(crate) christoffel: Vec<Vec<Vec<Polynomial>>>,
    /// Gravity torques γ_i.
    pub(crate) gravity: Vec<Polynomial>,
}

fn is_rate(symbol: Symbol) -> bool {
    matches!(symbol, Symbol::Rate(_) | Symbol::Acceleration(_))
}

impl Equations {
    /// Splits torques by their accelerations and rates. Every term in the torques of an arm is linear in the
    /// accelerations, or quadratic in the rates, or free of both; other terms are lost.
    pub(crate) fn sorted(torques: &[Polynomial]) -> Self {
        let dof = torques.len();
        let mass_matrix = torques
            .iter()
            .map(|torque| (0..dof).map(|j| torque.coefficient(&[(Symbol::Acceleration(j), 1)], is_rate)).collect())
            .collect();
        let symbol = |torque: &Polynomial, j: usize, k: usize| {
            if j == k {
                return torque.coefficient(&[(Symbol::Rate(j), 2)], is_rate);
            }
            let both = [(Symbol::Rate(j.min(k)), 1), (Symbol::Rate(j.max(k)), 1)];
            torque.coefficient(&both, is_rate).scaled(&fraction(1, 2))
        };
        let christoffel = torques
            .iter()
            .map(|torque| (0..dof).map(|j| (0..dof).map(|k| symbol(torque, j, k)).collect()).collect())
            .collect();
        let gravity = torques.iter().map(|torque| torque.coefficient(&[], is_rate)).collect();
        Self { mass_matrix, christoffel, gravity }
    }

    /// Returns the velocity torque h_i.
    pub(crate) fn velocity_torque(&self, joint: usize) -> Polynomial {
        let mut sum = Polynomial::zero();
        for (j, row) in self.christoffel[joint].iter().enumerate() {
            for (k, symbol) in row.iter().enumerate() {
                sum = sum + symbol * &(&rate(j) * &rate(k));
            }
        }
        sum
    }

    /// Returns the torque τ_i, the sum of its parts.
    pub(crate) fn torque(&self, joint: usize) -> Polynomial {
        let accelerations = self.mass_matrix[joint]
            .iter()
            .enumerate()
            .fold(Polynomial::zero(), |sum, (j, element)| sum + element * &Polynomial::symbol(Symbol::Acceleration(j)));
        accelerations + self.velocity_torque(joint) + self.gravity[joint].clone()
    }

    /// Returns all polynomials.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Polynomial> {
        let symbols = self.christoffel.iter().flatten().flatten();
        self.mass_matrix.iter().flatten().chain(symbols).chain(&self.gravity)
    }
}

pub(crate) fn rate(joint: usize) -> Polynomial {
    Polynomial::term(fraction(1, 1), Monomial(vec![(Symbol::Rate(joint), 1)]))
}
