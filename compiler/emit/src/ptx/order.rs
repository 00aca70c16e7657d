//! The order in which a kernel computes its values: a thread has 255 registers at most, and the fewer it needs, the
//! more threads run at once.
//!
//! The assembler orders instructions anew, but it does not leave the neighbourhood of where they stand. Programs go
//! through the robot from the base to the tips and back, so that a tree has values of all its branches in registers at
//! once. Computed from the results, it goes through one branch after the other. The elements of a matrix share many
//! values, which the order from the results has in registers for long: there the order for registers needs fewer.

use rne_codegen::{Program, Value, ValueId, order_for_registers};

/// The order from the results or the one for registers, whichever has fewer values in registers at once.
pub(super) fn of(program: &Program) -> Vec<ValueId> {
    let results = || program.outputs.iter().map(|output| output.value);
    let statements = order_for_registers(program).into_iter().map(|index| program.statements[index].value);
    let (from_results, for_registers) = (computed(program, results()), computed(program, statements.chain(results())));
    let is_less = most_at_once(program, &for_registers) < most_at_once(program, &from_results);
    if is_less { for_registers } else { from_results }
}

/// Values in the order in which they are computed, each behind what it is computed from.
fn computed(program: &Program, values: impl Iterator<Item = ValueId>) -> Vec<ValueId> {
    let mut order = Vec::with_capacity(program.values.len());
    let mut is_known = vec![false; program.values.len()];
    for value in values {
        // a value, and whether its operands have been looked at
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

/// How many values there are in registers at once: from where they are computed, or arguments first used, to their last
/// use. Constants are part of instructions.
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
