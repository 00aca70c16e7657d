//! The second derivatives of accelerations for CasADi, from which those of a step and of acados are also computed.

use std::fmt::Write;

use rne_codegen::{Function, Program};

use super::casadi::{Writer, hessian, is_there};
use super::casadi_interface::Interface;

/// The helper function, and the beginning of the derivatives of `adj1_forward_dynamics`.
const MOTION: &str = include_str!("casadi_motion.c");

/// For each element of a square matrix, whether it can differ from zero.
#[derive(Clone)]
pub(super) struct Presence(Vec<Vec<bool>>);

impl Presence {
    /// Reads one block of a program's outputs; `block` counts the blocks from 0.
    fn of(program: &Program, block: usize) -> Self {
        let dof = program.dof;
        let skipped = block * dof * dof;
        let row = |row| (0..dof).map(|column| is_there(program, skipped, row, column)).collect();
        Self((0..dof).map(row).collect())
    }

    fn by(size: usize, is_there: impl Fn(usize, usize) -> bool) -> Self {
        Self((0..size).map(|row| (0..size).map(|column| is_there(row, column)).collect()).collect())
    }

    pub(super) fn or(&self, other: impl Fn(usize, usize) -> bool) -> Self {
        Self::by(self.0.len(), |row, column| self.0[row][column] || other(row, column))
    }

    fn times(&self, other: &Self) -> Self {
        let size = self.0.len();
        Self::by(size, |row, column| (0..size).any(|index| self.0[row][index] && other.0[index][column]))
    }

    fn transposed(&self) -> Self {
        Self::by(self.0.len(), |row, column| self.0[column][row])
    }
}

/// For the derivatives of the accelerations, which elements can differ from zero.
pub(super) struct Motion {
    /// First derivatives with respect to q, q̇ and τ.
    pub(super) first: [Presence; 3],
    /// Second derivatives of λᵀ q̈ with respect to (q, q), (q, q̇), (q, τ) and (q̇, q̇). There are no others, because
    /// accelerations are linear in τ with the factor M⁻¹, which depends only on q.
    second: [Presence; 4],
}

impl Writer<'_> {
    /// Returns the helper function that computes the second derivatives.
    pub(super) fn helper_of_motion(&self) -> String {
        self.filled(MOTION.split("// next function\n").next().unwrap_or_default())
    }

    /// Returns which derivatives of the accelerations can differ from zero, if the file has the functions for them.
    pub(super) fn motion(&self) -> Option<Motion> {
        let of_motion = self.find(Function::ForwardDynamicsDerivatives)?;
        let of_torques = hessian(self.file)?;
        let first @ [dq, dqd, dtau] = &[0, 1, 2].map(|block| Presence::of(of_motion, block));
        let [dq_dq, dq_dqd, dqd_dqd, dq_dqdd] = [0, 1, 2, 3].map(|block| Presence::of(of_torques, block));
        let through_motion = dq_dqdd.times(dq);
        let turned = through_motion.transposed();
        let of_velocities = dq_dqdd.times(dqd);
        let second = [
            dq_dq.or(|row, column| through_motion.0[row][column] || turned.0[row][column]),
            dq_dqd.or(|row, column| of_velocities.0[row][column]),
            dq_dqdd.times(dtau),
            dqd_dqd,
        ];
        Some(Motion { first: first.clone(), second })
    }

    /// Returns the Jacobian of the reverse derivatives of the accelerations, if the file has the functions for it.
    pub(super) fn second_of_motion(&mut self, reverse: &Interface) -> Option<Interface> {
        let motion = self.motion()?;
        // for each derivative one column for q, qd and tau, one for the result, which is no argument, and one for the
        // multipliers
        let columns = 5;
        let mut patterns = vec![self.nothing(); 3 * columns];
        let mut body = self.filled(MOTION.split("// next function\n").nth(1).unwrap_or_default());
        self.put_second(&mut body, &motion, columns, &mut patterns);
        for (input, (field, presence)) in ["dq", "dqd", "dtau"].iter().zip(&motion.first).enumerate() {
            let place = input * columns + 4;
            patterns[place] = self.put(&mut body, &format!("by.{field}"), presence, true, place);
        }
        Some(self.jacobian_of(reverse, &patterns, body))
    }

    /// Writes the calls that copy the second derivatives into a table of `columns` columns, and stores their patterns.
    pub(super) fn put_second(&mut self, text: &mut String, motion: &Motion, columns: usize, patterns: &mut [String]) {
        let places =
            [(0, 0, 0, false), (0, 1, 1, false), (0, 2, 2, false), (1, 1, 3, false), (1, 0, 1, true), (2, 0, 2, true)];
        for (from, to, block, is_transposed) in places {
            let (place, presence) = (from * columns + to, &motion.second[block]);
            patterns[place] = self.put(text, &format!("second[{block}]"), presence, is_transposed, place);
        }
    }

    /// Writes a call that copies a matrix or its transpose, and returns the pattern.
    pub(super) fn put(
        &mut self,
        text: &mut String,
        matrix: &str,
        presence: &Presence,
        is_transposed: bool,
        place: usize,
    ) -> String {
        let pattern = if is_transposed { self.compressed(&presence.transposed()) } else { self.compressed(presence) };
        let (prefix, put) = (self.file.prefix, if is_transposed { "put_transposed" } else { "put" });
        let _ = writeln!(text, "    {prefix}_{put}({matrix}, {pattern}, res[{place}]);");
        pattern
    }

    pub(super) fn compressed(&mut self, presence: &Presence) -> String {
        self.square(presence.0.len(), |row, column| presence.0[row][column])
    }
}
