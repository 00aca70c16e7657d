//! The derivatives of the step of a robot with a floating base, on the manifold of its positions.
//!
//! Before the step, a change of the base is a shift δp and a turn δθ, in axes of frame 0: the base goes to p + R δp and
//! R exp(δθ). After the step, the change is δp' and δθ', in the axes that frame 0 has then. The step is that of
//! [`integrator`](super::integrator), with ℓ = v + h a. Newton's step is left out, because it changes only rounding
//! errors:
//!
//! ```text
//! δω' = δω + h δω̇       δθ' = Eᵀ δθ + K δω'       K = h / (1 + s) ((1 - s) 1 + 2 u uᵀ - 2 u×) / (1 + s)
//! δℓ  = δv + h δa        δp' = Eᵀ (δp + h (δℓ + δθ × ℓ))       v' = Eᵀ (ℓ + h Rᵀ g)
//! δv' = Eᵀ (δℓ + h (Rᵀ g) × δθ) + v' × K δω'
//! ```
//!
//! The matrix after the factor h / (1 + s) in K is the rotation by half the angle of E in the opposite direction. The
//! accelerations do not depend on p, R and v. With respect to q, q̇ and ω, h times their derivatives are -h M⁻¹ times
//! those of the forces; with respect to the torques, they are h M⁻¹.

use std::array::from_fn;

use crate::formulate::arguments::vector;
use crate::formulate::floating::floating_rest;
use crate::formulate::integrator::{Turn, duration};
use crate::formulate::ldlt::{Factors, System};
use crate::formulate::{Outputs, pose_of_base};
use crate::function::Length;
use crate::ir::{Builder, Matrix, Name, Quantity, Symbol, Vector, WithRespectTo};

/// Number of rows and columns of the base.
const BASE: usize = Length::OF_BASE;

/// A column of the two matrices of derivatives: the changes of the next positions and of the next velocities.
type Column<'s> = [Vec<Symbol<'s>>; 2];

/// The data for the derivatives of a step: the factors of h M⁻¹, and the base after the step.
pub(crate) struct FloatingStep<'s, 'a> {
    builder: &'s Builder,
    system: &'a System<'a>,
    step: Symbol<'s>,
    factors: Factors<'s>,
    /// ℓ = v + h a
    linear: Vector<'s>,
    /// h Rᵀ g, the change of the base's velocity due to gravity
    falling: Vector<'s>,
    /// Eᵀ, the transpose of the base's rotation in the step
    back: Matrix<'s>,
    /// K, which gives δθ' from δω'
    turning: Matrix<'s>,
    /// v', the base's velocity after the step
    velocity: Vector<'s>,
}

impl<'s, 'a> FloatingStep<'s, 'a> {
    /// Solves for the accelerations and stores them in the builder, so that later formulas use them. Row i of `upper`
    /// has the elements (i, i) to (i, n) of M; `gravity` is in axes of the world.
    pub(crate) fn new(
        builder: &'s Builder,
        system: &'a System<'a>,
        upper: &[Vec<Symbol<'s>>],
        bias: Outputs<'s>,
        gravity: Vector<'s>,
    ) -> Self {
        let step = duration(builder);
        let factors = Factors::of(builder, system, upper);
        let rest = builder.unnamed(|| floating_rest(builder, system, bias));
        let solved = factors.solved(0, &rest, |quantity, row| system.name(quantity, row));
        let solved: Vec<_> = solved.into_iter().flatten().collect();
        let of_base = |from: usize| Vector(from_fn(|axis| solved[from + axis]));
        let ([linear, angular], line) = ([0, 3].map(of_base), builder.joint(0));
        builder.keep_accelerations((0..).map(|row| system.acceleration(row)).zip(solved.iter().copied()));
        let moved = |quantity, change: Vector<'s>| vector(builder, quantity, 0) + change * step;
        let omega = line.define(Quantity::NextOmega).by(moved(Quantity::Omega, angular));
        let (back, turning) = line.within(Quantity::NextTurn, || {
            let turn = Turn::of(builder, omega * step);
            (turn.matrix(builder).transpose(), turn.by_rate(step))
        });
        let (linear, falling) = line.within(Quantity::NextVelocity, || {
            let in_base = pose_of_base(builder).rotation.transpose() * gravity;
            (moved(Quantity::OriginVelocity, linear), in_base * step)
        });
        let velocity = line.define(Quantity::NextVelocity).by(back * (linear + falling));
        let factors = factors.divided_by(step);
        Self { builder, system, step, factors, linear, falling, back, turning, velocity }
    }

    /// Returns the derivatives of the next positions with respect to the positions, the velocities and the torques,
    /// then those of the next velocities, all by rows. `forces` has the derivatives of the forces by columns: with
    /// respect to q, to q̇, and to the angular velocity of the base.
    pub(crate) fn derivatives(&self, forces: &[Vec<Symbol<'s>>]) -> Outputs<'s> {
        let (size, dof) = (self.system.size(), self.system.size() - BASE);
        let (by_q, rest) = forces.split_at(dof);
        let (by_qd, by_omega) = rest.split_at(dof);
        let nothing = vec![self.builder.zero(); size];
        let caused = |forces: &Vec<Symbol<'s>>| self.solved(&forces.iter().map(|&x| -x).collect::<Vec<_>>());
        let of_positions = (0..size).map(|at| match at.checked_sub(BASE) {
            Some(joint) => self.column([Some(at), None], &caused(&by_q[joint])),
            None => self.column_of_pose(at),
        });
        let of_velocities = (0..size).map(|at| {
            let forces = match at.checked_sub(BASE) {
                Some(joint) => Some(&by_qd[joint]),
                None => at.checked_sub(3).map(|axis| &by_omega[axis]),
            };
            self.column([None, Some(at)], &forces.map_or_else(|| nothing.clone(), caused))
        });
        // h M⁻¹ is symmetric, so its columns for the torques are also its rows
        let unit = |column: usize| -> Vec<_> {
            (0..size).map(|row| if row == BASE + column { self.builder.one() } else { self.builder.zero() }).collect()
        };
        let inverse: Vec<_> = (0..dof).map(|column| self.solved(&unit(column))).collect();
        let of_torque = |column: usize| {
            let element = |row: usize| match row.checked_sub(BASE) {
                Some(other) if self.factors.place(row) < self.factors.place(BASE + column) => {
                    inverse[other][BASE + column]
                }
                _ => inverse[column][row],
            };
            self.column([None; 2], &(0..size).map(element).collect::<Vec<_>>())
        };
        let columns: [Vec<Column<'s>>; 3] =
            [of_positions.collect(), of_velocities.collect(), (0..dof).map(of_torque).collect()];
        let mut outputs = Outputs::new();
        for half in 0..2 {
            for (kind, columns) in columns.iter().enumerate() {
                for row in 0..size {
                    outputs.extend((0..columns.len()).map(|column| {
                        let name = self.name(half, kind, [row, column]);
                        (name, self.builder.name(name, columns[column][half][row]))
                    }));
                }
            }
        }
        outputs
    }

    /// Returns h M⁻¹ times a vector.
    fn solved(&self, b: &[Symbol<'s>]) -> Vec<Symbol<'s>> {
        self.builder
            .joint(0)
            .within(Quantity::Scaled, || self.factors.backward(&self.factors.scaled(&self.factors.forward(b))))
    }

    /// Returns the column of a position or of a velocity (one of both is `Some`); `change` is the derivative of h times
    /// the accelerations.
    fn column(&self, [position, velocity]: [Option<usize>; 2], change: &[Symbol<'s>]) -> Column<'s> {
        let plus_own = |own: Option<usize>, (row, &x): (usize, &Symbol<'s>)| {
            if own == Some(row) { self.builder.one() + x } else { x }
        };
        let mut velocities: Vec<_> = change.iter().enumerate().map(|at| plus_own(velocity, at)).collect();
        let of_base = |from: usize| Vector(from_fn(|axis| velocities[from + axis]));
        let ([linear, angular], line) = ([0, 3].map(of_base), self.builder.joint(0));
        let turned = line.within(Quantity::NextTurn, || self.turning * angular);
        let linear = line.within(Quantity::NextVelocity, || self.back * linear);
        let origin = line.within(Quantity::NextOrigin, || linear * self.step);
        let linear = line.within(Quantity::NextVelocity, || linear + self.velocity.cross(turned));
        let joints: Vec<_> = self.builder.joint(0).within(Quantity::NextPosition, || {
            let moved: Vec<_> = velocities.iter().map(|&x| self.step * x).collect();
            moved.iter().enumerate().map(|at| plus_own(position, at)).skip(BASE).collect()
        });
        velocities.splice(..3, linear.0);
        [origin.0.into_iter().chain(turned.0).chain(joints).collect(), velocities]
    }

    /// Returns the column of a shift (0 to 2) or a turn (3 to 5) of the base. Neither changes any acceleration.
    fn column_of_pose(&self, at: usize) -> Column<'s> {
        let (builder, line) = (self.builder, self.builder.joint(0));
        let [mut positions, mut velocities] = [(); 2].map(|()| vec![builder.zero(); self.system.size()]);
        let unit = Vector(from_fn(|axis| if axis == at % 3 { builder.one() } else { builder.zero() }));
        let moved = self.back.transpose().0[at % 3];
        if at < 3 {
            positions.splice(..3, moved.0);
        } else {
            let swung = line.within(Quantity::NextOrigin, || (self.back * unit.cross(self.linear)) * self.step);
            positions.splice(..BASE, swung.0.into_iter().chain(moved.0));
            let fallen = line.within(Quantity::NextVelocity, || self.back * self.falling.cross(unit));
            velocities.splice(..3, fallen.0);
        }
        [positions, velocities]
    }

    /// Returns the name of the derivative of a next position or a next velocity (`half` 0 or 1) with respect to a
    /// position, a velocity or a torque (`kind` 0, 1 or 2).
    fn name(&self, half: usize, kind: usize, [row, column]: [usize; 2]) -> Name {
        let joint = |place: usize| self.system.coordinates.joints()[place] + 1;
        let [linear, angular, of_joint] = [
            [Quantity::NextOrigin, Quantity::NextTurn, Quantity::NextPosition],
            [Quantity::NextVelocity, Quantity::NextOmega, Quantity::NextRate],
        ][half];
        let own = match self.system.of_joint(row) {
            Some(place) => Name::scalar(of_joint, joint(place)),
            None => Name::of_base(linear, angular, row),
        };
        let by = match (kind, self.system.of_joint(column)) {
            (0, Some(place)) => WithRespectTo::Position(joint(place)),
            (0, None) => WithRespectTo::BasePosition(column + 1),
            (1, Some(place)) => WithRespectTo::Rate(joint(place)),
            (1, None) => WithRespectTo::BaseRate(column + 1),
            _ => return Name { indices: [joint(column), 0], ..own },
        };
        Name { by: Some(by), ..own }
    }
}
