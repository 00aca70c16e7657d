//! A step of the semi-implicit Euler method for CasADi, with its Jacobians, its directional derivatives and its
//! Hessian.

use std::fmt::Write;

use rne_codegen::{Function, Program};

use super::casadi::Writer;
use super::casadi_interface::{Bodies, Interface};

/// The helper function, then the function bodies, in the order of [`Writer::of_step`].
const STEP: &str = include_str!("casadi_step.c");

/// The results of the step.
const NEXT: [&str; 2] = ["next_q", "next_qd"];

impl Writer<'_> {
    /// Returns the helper function of the step's derivatives.
    pub(super) fn helper_of_step(&self) -> String {
        self.filled(STEP.split("// next function\n").next().unwrap_or_default())
    }

    /// Returns the step, with its derivatives if the file has the functions from which they are computed.
    pub(super) fn of_step(&mut self, program: &Program, given: &[(String, String)]) -> Vec<Interface> {
        let mut bodies = STEP.split("// next function\n").skip(1).map(|body| self.filled(body));
        let [value, common, forward, reverse, second] = std::array::from_fn(|_| bodies.next().unwrap_or_default());
        let dof = program.dof;
        let returned = NEXT.map(|name| (name.to_owned(), self.dense(dof, 1)));
        let Some(motion) = self.find(Function::ForwardDynamics).and_then(|_| self.motion()) else {
            let (name, inputs) = (program.name.clone(), given.to_vec());
            return vec![Interface { name, inputs, outputs: returned.into(), body: value }];
        };
        let [dq, dqd, dtau] = motion.first.clone();
        let is_diagonal = |row, column| row == column;
        let moving = dqd.or(is_diagonal);
        let jacobians = [dq.or(is_diagonal), moving.clone(), dtau.clone(), dq, moving, dtau];

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

        // columns for q, qd, tau and step, for results of the step, which are no arguments, and for the multipliers
        let columns = given.len() + 2 * returned.len();
        let nothing = self.nothing();
        let (column, row, number) = (self.dense(dof, 1), self.dense(1, dof), self.dense(1, 1));
        let no_row = self.pattern([vec![1, dof], vec![0; dof + 1]].concat());
        let mut patterns = vec![nothing; 3 * columns];
        patterns.extend([vec![row.clone(); 3], vec![number], vec![no_row; 2], vec![row; 2]].concat());
        let mut puts = String::new();
        self.put_second(&mut puts, &motion, columns, &mut patterns);
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
}
