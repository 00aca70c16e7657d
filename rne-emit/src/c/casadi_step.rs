//! A step of semi-implicit Euler for CasADi, with its Jacobians, its directional derivatives and its Hessian.

use std::fmt::Write;

use rne_codegen::{Function, Program};

use super::casadi::{Writer, is_there};
use super::casadi_interface::{Bodies, Interface};

/// The helper of the bodies, and these, in the order of [`Writer::of_step`].
const STEP: &str = include_str!("casadi_step.c");

/// The results of the step.
const NEXT: [&str; 2] = ["next_q", "next_qd"];

/// The elements of a square matrix that are not zero in every state.
#[derive(Clone)]
struct Presence(Vec<Vec<bool>>);

impl Presence {
    /// The block of a program's outputs with this number.
    fn of(program: &Program, block: usize) -> Self {
        let dof = program.dof;
        let skipped = block * dof * dof;
        let row = |row| (0..dof).map(|column| is_there(program, skipped, row, column)).collect();
        Self((0..dof).map(row).collect())
    }

    fn by(size: usize, is_there: impl Fn(usize, usize) -> bool) -> Self {
        Self((0..size).map(|row| (0..size).map(|column| is_there(row, column)).collect()).collect())
    }

    fn or(&self, other: impl Fn(usize, usize) -> bool) -> Self {
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

impl Writer<'_> {
    /// The helper of the step's derivatives.
    pub(super) fn helper_of_step(&self) -> String {
        self.filled(STEP.split("// next function\n").next().unwrap_or_default())
    }

    /// The step, with its derivatives if the file has the functions that they are computed by.
    pub(super) fn of_step(&mut self, program: &Program, given: &[(String, String)]) -> Vec<Interface> {
        let mut bodies = STEP.split("// next function\n").skip(1).map(|body| self.filled(body));
        let [value, common, forward, reverse, second] = std::array::from_fn(|_| bodies.next().unwrap_or_default());
        let dof = program.dof;
        let returned = NEXT.map(|name| (name.to_owned(), self.dense(dof, 1)));
        let needed = [Function::ForwardDynamics, Function::ForwardDynamicsDerivatives, Function::TorqueHessian];
        let [Some(_), Some(of_motion), Some(of_torques)] = needed.map(|function| self.find(function)) else {
            let (name, inputs) = (program.name.clone(), given.to_vec());
            return vec![Interface { name, inputs, outputs: returned.into(), body: value }];
        };
        let [dq, dqd, dtau] = [0, 1, 2].map(|block| Presence::of(of_motion, block));
        let [dq_dq, dq_dqd, dqd_dqd, dq_dqdd] = [0, 1, 2, 3].map(|block| Presence::of(of_torques, block));
        let is_diagonal = |row, column| row == column;
        let moving = dqd.or(is_diagonal);
        let jacobians = [dq.or(is_diagonal), moving.clone(), dtau.clone(), dq.clone(), moving, dtau.clone()];
        let through_motion = dq_dqdd.times(&dq);
        let turned = through_motion.transposed();
        let of_velocities = dq_dqdd.times(&dqd);
        let second_blocks = [
            dq_dq.or(|row, column| through_motion.0[row][column] || turned.0[row][column]),
            dq_dqd.or(|row, column| of_velocities.0[row][column]),
            dq_dqdd.times(&dtau),
            dqd_dqd,
        ];

        let prefix = self.file.prefix.to_string();
        let mut puts = String::new();
        let mut blocks = Vec::new();
        for (output, of) in jacobians.chunks(3).enumerate() {
            for (input, presence) in of.iter().enumerate() {
                let (pattern, place) = (self.compressed(presence), 4 * output + input);
                let _ = writeln!(puts, "    {prefix}_put(jacobians[{}], {pattern}, res[{place}]);", 3 * output + input);
                blocks.push(pattern);
            }
            let _ = writeln!(puts, "    {prefix}_copy(by_step[{output}], res[{}]);", 4 * output + 3);
            blocks.push(self.dense(dof, 1));
        }
        let bodies = Bodies {
            value,
            jacobian: format!("{common}{puts}"),
            forward: format!("{common}{forward}"),
            reverse: format!("{common}{reverse}"),
        };
        let [value, jacobian, forward, reverse] = self.family(&program.name, given, &returned, &blocks, bodies);

        // by q, qd, tau and step, by what the file does not take, and by the multipliers
        let columns = given.len() + 2 * returned.len();
        let nothing = self.nothing();
        let (column, row, number) = (self.dense(dof, 1), self.dense(1, dof), self.dense(1, 1));
        let no_row = self.pattern([vec![1, dof], vec![0; dof + 1]].concat());
        let mut patterns = vec![nothing; 3 * columns];
        patterns.extend([vec![row.clone(); 3], vec![number], vec![no_row; 2], vec![row; 2]].concat());
        let mut puts = String::new();
        let places = [(0, 0, 0, false), (0, 1, 1, false), (0, 2, 2, false), (1, 1, 3, false)];
        for (from, to, block, is_transposed) in [&places[..], &[(1, 0, 1, true), (2, 0, 2, true)]].concat() {
            let (place, presence) = (from * columns + to, &second_blocks[block]);
            let matrix = format!("second[{block}]");
            patterns[place] = self.put(&mut puts, &matrix, presence, is_transposed, place);
        }
        for input in 0..3 {
            patterns[input * columns + 3].clone_from(&column);
            for output in 0..2 {
                let (block, place) = (3 * output + input, input * columns + 6 + output);
                let matrix = format!("jacobians[{block}]");
                patterns[place] = self.put(&mut puts, &matrix, &jacobians[block], true, place);
            }
        }
        let second = self.jacobian_of(&reverse, &patterns, format!("{common}{second}{puts}"));
        vec![value, jacobian, forward, reverse, second]
    }

    /// Writes a call that puts a matrix or its transpose, and returns the compressed columns.
    fn put(
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

    fn compressed(&mut self, presence: &Presence) -> String {
        self.square(presence.0.len(), |row, column| presence.0[row][column])
    }
}
