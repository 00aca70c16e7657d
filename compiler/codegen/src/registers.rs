//! Chooses an order of the statements in which few values are alive at once.
//!
//! A value is alive from its statement to the last statement that uses it. A processor has 16 or 32 registers; values
//! beyond them are stored on the stack and loaded again, which takes instructions, and code that is longer than the
//! first-level cache, 32 KB, is fetched again in every call. The order of the recursion keeps many values alive: those
//! of all links from the outward pass until the inward pass uses them, and those of all columns of a matrix.
//!
//! The order here is greedy. Of all statements whose operands are known, the next one is the last user of the most
//! operands; among equals it is the first in the given order. Values do not change, so no bit of a result changes.

use std::collections::BinaryHeap;

use crate::function::Form;
use crate::program::{Order, Program};
use crate::values::ValueId;

/// A statement that is this many places before another one in the given order comes first, even if it ends the life of
/// one value less.
const FAR: i64 = 500;

/// Returns the program with its statements in an order in which few values are alive at once. This order follows no
/// recursion. Code of the seven steps keeps its order.
///
/// ```
/// use rne_codegen::ordered_for_registers;
/// # use rne_codegen::{Compiler, Form, Function};
/// # let yaml = "{format: 1, name: rod, source: own, convention: standard, gravity: [0, -9.81, 0], joints: [
/// #     {type: revolute, dh: {theta: 0, d: 0, a: 0.8, alpha: 0}, link: {mass: 2.5, com: [-0.4, 0, 0]}}]}";
/// # let robot = rne_model::Robot::from_yaml(yaml).unwrap();
/// # let program = Compiler::new(&robot).compile(Function::InverseDynamics, Form::Reduced).unwrap();
/// let ordered = ordered_for_registers(&program);
/// assert_eq!(ordered.operations(), program.operations());
/// ```
#[must_use]
pub fn ordered_for_registers(program: &Program) -> Program {
    if program.form == Form::SevenSteps {
        return program.clone();
    }
    let order = order_for_registers(program).into_iter();
    let statements = order.map(|index| program.statements[index].clone()).collect();
    Program { statements, order: Order::Registers, ..program.clone() }.in_written_order()
}

/// The places of the statements of a program, in the order of [`ordered_for_registers`].
#[must_use]
pub fn order_for_registers(program: &Program) -> Vec<usize> {
    Lives::of(program).order()
}

/// For each output, the statement after which it is known; `None` where no statement is needed.
#[must_use]
pub fn statements_of_outputs(program: &Program) -> Vec<Option<usize>> {
    let lives = Lives::of(program);
    program.outputs.iter().map(|output| lives.statements_in(program, output.value).into_iter().max()).collect()
}

/// The uses of the values of a program, by statement.
struct Lives {
    /// The statement of each value that has one.
    of_value: Vec<Option<usize>>,
    /// For each statement, the statements whose values it uses, each once.
    operands: Vec<Vec<usize>>,
    /// For each statement, the statements that use its value.
    users: Vec<Vec<usize>>,
    /// For each statement, how many of its `users` are not placed yet.
    uses: Vec<usize>,
}

impl Lives {
    fn of(program: &Program) -> Self {
        let count = program.statements.len();
        let mut lives = Self {
            of_value: vec![None; program.values.len()],
            operands: Vec::with_capacity(count),
            users: vec![Vec::new(); count],
            uses: Vec::new(),
        };
        for (index, statement) in program.statements.iter().enumerate() {
            let used = program.values.get(statement.value).operands();
            let mut operands: Vec<usize> = used.flat_map(|value| lives.statements_in(program, value)).collect();
            operands.sort_unstable();
            operands.dedup();
            for &operand in &operands {
                lives.users[operand].push(index);
            }
            lives.operands.push(operands);
            lives.of_value[statement.value.index()] = Some(index);
        }
        lives.uses = lives.users.iter().map(Vec::len).collect();
        lives
    }

    /// The statements on which a value depends. An operand without a statement of its own is part of an expression; the
    /// function follows its operands to those that have a statement.
    fn statements_in(&self, program: &Program, value: ValueId) -> Vec<usize> {
        let (mut found, mut open) = (Vec::new(), vec![value]);
        while let Some(value) = open.pop() {
            match self.of_value[value.index()] {
                Some(index) => found.push(index),
                None => open.extend(program.values.get(value).operands()),
            }
        }
        found
    }

    /// Returns the indices of the statements in the new order.
    fn order(mut self) -> Vec<usize> {
        let mut missing: Vec<usize> = self.operands.iter().map(Vec::len).collect();
        let is_known = (0..missing.len()).filter(|&index| missing[index] == 0);
        let mut ready: BinaryHeap<(i64, usize)> = is_known.map(|index| (self.rank(index), index)).collect();
        let mut order = Vec::with_capacity(missing.len());
        let mut is_placed = vec![false; missing.len()];
        while let Some((rank, index)) = ready.pop() {
            // the rank of a statement grows when other users of its operands are placed; it is then in the queue again
            // with its new rank
            if is_placed[index] || rank != self.rank(index) {
                continue;
            }
            is_placed[index] = true;
            order.push(index);
            for &user in &self.users[index] {
                missing[user] -= 1;
            }
            for &operand in &self.operands[index] {
                self.uses[operand] -= 1;
            }
            let last = self.operands[index].iter().filter(|&&operand| self.uses[operand] == 1);
            let changed = last.flat_map(|&operand| &self.users[operand]).chain(&self.users[index]);
            let is_next = |user: &&usize| !is_placed[**user] && missing[**user] == 0;
            ready.extend(changed.filter(is_next).map(|&user| (self.rank(user), user)));
        }
        order
    }

    /// The rank of a statement, by which the next one is chosen: higher if it ends the lives of more values, then if it
    /// is earlier in the given order. A value that is only returned counts as one more, because it is stored at once.
    fn rank(&self, index: usize) -> i64 {
        let ended = self.operands[index].iter().filter(|&&operand| self.uses[operand] == 1).count();
        let ended = ended + usize::from(self.users[index].is_empty());
        let (ended, index) = (i64::try_from(ended).unwrap_or(i64::MAX), i64::try_from(index).unwrap_or(i64::MAX));
        FAR * ended - index
    }
}
