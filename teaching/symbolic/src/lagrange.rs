//! Derives the equations of motion by Lagrange's method, from the energies, as an independent check.
//!
//! It has only the letters of the table in common with the seven steps: frames are placed in the base frame by the four
//! rotations and translations of a row, velocities are given by Jacobians, which are derivatives of positions, and
//!
//! ```text
//! M = Σ m Jvᵀ Jv + Jωᵀ (R Ī Rᵀ) Jω      c_ijk = ½ (∂M_ij/∂q_k + ∂M_ik/∂q_j - ∂M_jk/∂q_i)      γ_i = -∂/∂q_i Σ m g·c
//! ```
//!
//! A first moment h in addition to the mass adds v · (ω × R h) to the kinetic and -g · R h to the potential energy.

use rne_model::{Convention, JointKind};

use crate::derivation::TooLong;
use crate::equations::Equations;
use crate::polynomial::Polynomial;
use crate::rational::{exact, fraction};
use crate::table::{Row, Table};
use crate::vector::{Matrix, Vector};

/// Rotation and origin of a frame, in the base frame.
#[derive(Clone)]
struct Frame {
    rotation: Matrix,
    origin: Vector,
}

impl Frame {
    fn turned(&self, turn: &Matrix) -> Self {
        Self { rotation: &self.rotation * turn, origin: self.origin.clone() }
    }

    fn shifted(&self, by: &Vector) -> Self {
        Self { rotation: self.rotation.clone(), origin: &self.origin + &(&self.rotation * by) }
    }

    fn z(&self) -> Vector {
        let [x, y, z] = &self.rotation.0;
        Vector([x, y, z].map(|row| row.0[2].clone()))
    }
}

/// Returns the axis of a joint and the frame of its link: Rz(θ) Tz(d) Tx(a) Rx(α) for standard rows, Rx(α) Tx(a) Rz(θ)
/// Tz(d) for modified ones.
fn placed(before: &Frame, row: &Row, convention: Convention) -> (Vector, Frame) {
    let along_x = Vector([row.a.clone(), Polynomial::zero(), Polynomial::zero()]);
    let along_z = Vector::along_z(row.d.clone());
    let (about_z, about_x) = (Matrix::about_z(&row.theta), Matrix::about_x(&row.alpha));
    match convention {
        Convention::Standard => {
            (before.z(), before.turned(&about_z).shifted(&along_z).shifted(&along_x).turned(&about_x))
        }
        Convention::Modified => {
            let joint = before.turned(&about_x).shifted(&along_x);
            (joint.z(), joint.turned(&about_z).shifted(&along_z))
        }
    }
}

/// Returns the frame where the row of a joint begins: the frame of its parent, moved by a placement with right angles,
/// Rz(yaw) Ry(pitch) Rx(roll).
fn beginning(parent: &Frame, table: &Table, joint: usize) -> Frame {
    let Some(branch) = &table.robot.joints[joint].branch else { return parent.clone() };
    let number = |value: f64| Polynomial::number(exact(value));
    let [roll, pitch, yaw] = branch.placement.rpy.map(|angle| (number(angle.sin), number(angle.cos)));
    // Ry = Rz(π/2) Rx Rz(-π/2)
    let quarter = Matrix::about_z(&(Polynomial::integer(1), Polynomial::zero()));
    let about_y = &(&quarter * &Matrix::about_x(&pitch)) * &quarter.transpose();
    let placed = parent.shifted(&Vector(branch.placement.xyz.map(number)));
    placed.turned(&Matrix::about_z(&yaw)).turned(&about_y).turned(&Matrix::about_x(&roll))
}

/// Whether a joint is revolute and moves a link.
fn turns(table: &Table, joint: usize, link: usize) -> bool {
    let mut carriers = std::iter::successors(Some(link), |&link| table.robot.parent(link));
    table.rows[joint].kind == JointKind::Revolute && carriers.any(|carrier| carrier == joint)
}

/// Derives M, the Christoffel symbols and γ.
pub(crate) fn equations(table: &Table) -> Result<Equations, TooLong> {
    let dof = table.rows.len();
    let zero = Polynomial::zero();
    let mut mass_matrix = vec![vec![zero.clone(); dof]; dof];
    let mut potential = zero.clone();
    let base = Frame { rotation: Matrix::identity(), origin: Vector::zero() };
    let (mut axes, mut frames): (Vec<Vector>, Vec<Frame>) = (Vec::new(), Vec::new());
    for (i, row) in table.rows.iter().enumerate() {
        let parent = table.robot.parent(i).map_or(&base, |parent| &frames[parent]);
        let (axis, frame) = placed(&beginning(parent, table, i), row, table.convention);
        axes.push(axis);
        let com = frame.shifted(&row.com).origin;
        potential = potential - &row.mass * &table.gravity.dot(&com);
        let moment = &frame.rotation * &row.first_moment;
        if !moment.is_zero() {
            potential = potential - table.gravity.dot(&moment);
        }
        let inertia = &(&frame.rotation * &row.inertia) * &frame.rotation.transpose();
        let linear: Vec<Vector> = (0..=i).map(|j| Vector(com.0.clone().map(|x| x.by_joint(j)))).collect();
        let angular: Vec<Vector> =
            (0..=i).map(|j| if turns(table, j, i) { axes[j].clone() } else { Vector::zero() }).collect();
        for j in 0..=i {
            for k in j..=i {
                let mut energy = &row.mass * &linear[j].dot(&linear[k]) + angular[j].dot(&(&inertia * &angular[k]));
                if !moment.is_zero() {
                    energy = energy + linear[j].dot(&angular[k].cross(&moment));
                    energy = energy + linear[k].dot(&angular[j].cross(&moment));
                }
                if energy.is_too_long() {
                    return Err(TooLong);
                }
                mass_matrix[j][k] = &mass_matrix[j][k] + &energy;
            }
        }
        mass_matrix[i][i] = &mass_matrix[i][i] + &row.rotor;
        frames.push(frame);
    }
    // only the upper triangle was computed
    let element = |j: usize, k: usize| mass_matrix[j.min(k)][j.max(k)].clone();
    let mass_matrix: Vec<Vec<Polynomial>> = (0..dof).map(|j| (0..dof).map(|k| element(j, k)).collect()).collect();
    let symbol = |i: usize, j: usize, k: usize| {
        let sum = mass_matrix[i][j].by_joint(k) + mass_matrix[i][k].by_joint(j) - mass_matrix[j][k].by_joint(i);
        sum.scaled(&fraction(1, 2))
    };
    let all = |of: &dyn Fn(usize) -> Vec<Polynomial>| (0..dof).map(of).collect::<Vec<_>>();
    let christoffel = (0..dof).map(|i| all(&|j| (0..dof).map(|k| symbol(i, j, k)).collect())).collect();
    let gravity = (0..dof).map(|i| potential.by_joint(i)).collect();
    let equations = Equations { mass_matrix, christoffel, gravity };
    if equations.all().any(Polynomial::is_too_long) { Err(TooLong) } else { Ok(equations) }
}
