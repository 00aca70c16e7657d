//! The order in which a kernel computes its values. A thread has at most 255 registers, and the fewer it needs, the
//! more threads run at the same time.
//!
//! The assembler reorders instructions, but only over short distances. The statements of a program go from the base to
//! the tips and back, so a tree would have values of all its branches in registers at the same time. In the order in
//! which the results need them, one branch is computed after the other. The elements of a matrix share many values,
//! which that order keeps in registers for long: for them the order of `order_for_registers` needs fewer registers.

use rne_codegen::{Program, Value, ValueId, order_for_registers};

/// Returns the order in which the results need the values, or that of `order_for_registers`, whichever needs fewer
/// registers.
pub(super) fn of(program: &Program) -> Vec<ValueId> {
    let results = || program.outputs.iter().map(|output| output.value);
    let statements = order_for_registers(program).into_iter().map(|index| program.statements[index].value);
    let (from_results, for_registers) = (computed(program, results()), computed(program, statements.chain(results())));
    let is_less = most_at_once(program, &for_registers) < most_at_once(program, &from_results);
    if is_less { for_registers } else { from_results }
}

/// Returns the values in the order in which they are computed; each comes after its operands.
fn computed(program: &Program, values: impl Iterator<Item = ValueId>) -> Vec<ValueId> {
    let mut order = Vec::with_capacity(program.values.len());
    let mut is_known = vec![false; program.values.len()];
    for value in values {
        // a value, and whether its operands were already added
        let mut open = vec![(value, false)];
        while let Some((id, has_operands)) = open.pop() {
            if has_operands {
                order.push(id);
            } else if !std::mem::replace(&mut is_known[id.index()], true) {
                open.push((id, true));
                open.extend(program.values.get(id).operands().rev().map(|operand| (operand, false)));
            }
        }
    }
    order
}

/// Returns the largest number of values that are in registers at the same time: from their computation, or for
/// arguments from their first use, to their last use. Constants are parts of instructions.
fn most_at_once(program: &Program, order: &[ValueId]) -> usize {
    let is_constant = |id: &ValueId| matches!(program.values.get(*id), Value::Constant(_));
    let operands = |id: ValueId| program.values.get(id).operands().filter(|operand| !is_constant(operand));
    let mut last = vec![0; program.values.len()];
    for (at, &id) in order.iter().enumerate() {
        operands(id).for_each(|operand| last[operand.index()] = at);
    }
    let mut is_there = vec![false; program.values.len()];
    let (mut now, mut most) = (0, 0);
    for (at, &id) in order.iter().enumerate() {
        for operand in operands(id) {
            now += usize::from(!std::mem::replace(&mut is_there[operand.index()], true));
        }
        most = most.max(now);
        for operand in operands(id) {
            now -= usize::from(last[operand.index()] == at && std::mem::replace(&mut is_there[operand.index()], false));
        }
        if last[id.index()] > at && !matches!(program.values.get(id), Value::Argument | Value::Constant(_)) {
            is_there[id.index()] = true;
            now += 1;
        }
    }
    most.max(now)
}
