//! From the rows of the table to the constants of the seven steps, in form P: frame i at joint i, fixed to link i, z
//! along the joint's axis.
//!
//! ```text
//!            R_i                    d_i                        r_i                       I_i
//! standard   Rx(α_{i-1}) Rz(θ_i)    (a_i, 0, d_i) + Rx(α_i) c̄   -Rx(α_i) c̄               Rx(α_i) Ī Rx(α_i)ᵀ    α_0 = 0
//! modified   Rx(α_{i-1}) Rz(θ_i)    (0, 0, d_i) + c̄             (a_i, 0, 0) - c̄           Ī
//! ```
//!
//! c̄ and Ī are the table's. r_i goes from the centre of mass of link i to joint i + 1; the last link has none, for
//! nothing touches the tip.

use rne_model::{Convention, JointKind};

use crate::polynomial::Polynomial;
use crate::table::Table;
use crate::vector::{Matrix, Vector};

/// The constants of one link and of the joint that moves it.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) kind: JointKind,
    /// R_i: turns components in frame i into components in frame i - 1.
    pub(crate) rotation: Matrix,
    /// Joint i → centre of mass.
    pub(crate) d: Vector,
    /// Centre of mass → joint i + 1.
    pub(crate) r: Vector,
    pub(crate) mass: Polynomial,
    /// About the centre of mass.
    pub(crate) inertia: Matrix,
    /// First moment about the centre of mass; zero of every body.
    pub(crate) first_moment: Vector,
    /// G² Jm of the joint's rotor.
    pub(crate) rotor: Polynomial,
}

/// The links, base to tip.
pub(crate) fn links(table: &Table) -> Vec<Link> {
    let twist = |index: usize| table.rows.get(index).map_or_else(Matrix::identity, |row| Matrix::about_x(&row.alpha));
    let link = |(index, row): (usize, &crate::table::Row)| {
        let turned = Matrix::about_z(&row.theta);
        let zero = Polynomial::zero;
        match table.convention {
            Convention::Standard => {
                let before = index.checked_sub(1).map_or_else(Matrix::identity, twist);
                let own = twist(index);
                let com = &own * &row.com;
                Link {
                    kind: row.kind,
                    rotation: &before * &turned,
                    d: &Vector([row.a.clone(), zero(), row.d.clone()]) + &com,
                    r: &Vector::zero() - &com,
                    mass: row.mass.clone(),
                    inertia: &(&own * &row.inertia) * &own.transpose(),
                    first_moment: &own * &row.first_moment,
                    rotor: row.rotor.clone(),
                }
            }
            Convention::Modified => {
                let lever = table.rows.get(index + 1).map_or_else(zero, |next| next.a.clone());
                Link {
                    kind: row.kind,
                    rotation: &twist(index) * &turned,
                    d: &Vector::along_z(row.d.clone()) + &row.com,
                    r: &Vector([lever, zero(), zero()]) - &row.com,
                    mass: row.mass.clone(),
                    inertia: row.inertia.clone(),
                    first_moment: row.first_moment.clone(),
                    rotor: row.rotor.clone(),
                }
            }
        }
    };
    table.rows.iter().enumerate().map(link).collect()
}
