//! Chooses the machine's operation for a value, by the places of its operands.

use rne_codegen::{Contraction, Negated, Operator, Value, ValueId};
use rne_runtime::machine::{Operation, Slot};

use crate::dataflow::Dataflow;
use Operation as O;
use Place::{Accumulator as A, Constant as K, Slot as S};

/// Where an operand is when an operation reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    Accumulator,
    Slot(Slot),
    Constant(f64),
}

/// Returns the operation that computes a value from operands at these places. `None` if the machine has no such
/// operation: then one operand must be moved to a slot.
pub(crate) fn operation(dataflow: &Dataflow, id: ValueId, place: impl Fn(ValueId) -> Place) -> Option<Operation> {
    Some(match dataflow.values.get(id) {
        // the arguments are the first values, so the number of the value is that of the input
        Value::Argument => O::Input(u32::try_from(id.index()).ok()?),
        Value::Constant(k) => O::Constant(k),
        Value::Sine(_) | Value::Cosine(_) | Value::Same(_) => return None,
        Value::Negative(x) => match place(x) {
            A => O::NegativeA(),
            S(x) => O::NegativeS(x),
            K(k) => O::Constant(-k),
        },
        Value::BySign(operands) => match operands.map(place) {
            [S(x), S(a), S(b)] => O::BySign(x, a, b),
            _ => return None,
        },
        Value::Binary(operator, x, y) => return binary(operator, place(x), place(y)),
        Value::Fused(Contraction { factors: [x, y], addend, negated }) => {
            return fused(negated, place(addend), place(x), place(y));
        }
    })
}

/// Orders two operands that commute: the accumulator first, then a slot, then a constant.
fn ordered(x: Place, y: Place) -> (Place, Place) {
    match (x, y) {
        (K(_), _) | (S(_), A) => (y, x),
        _ => (x, y),
    }
}

/// Returns the machine's operation for an operator and the places of its two operands.
fn binary(operator: Operator, x: Place, y: Place) -> Option<Operation> {
    let (x, y) = if matches!(operator, Operator::Sum | Operator::Product) { ordered(x, y) } else { (x, y) };
    Some(match (operator, x, y) {
        (Operator::Sum, S(x), S(y)) => O::SumSS(x, y),
        (Operator::Sum, A, S(y)) => O::SumAS(y),
        (Operator::Sum, S(x), K(k)) => O::SumSK(x, k),
        (Operator::Sum, A, K(k)) => O::SumAK(k),
        (Operator::Difference, S(x), S(y)) => O::DifferenceSS(x, y),
        (Operator::Difference, A, S(y)) => O::DifferenceAS(y),
        (Operator::Difference, S(x), A) => O::DifferenceSA(x),
        // x - k has the same bits as x + (-k)
        (Operator::Difference, S(x), K(k)) => O::SumSK(x, -k),
        (Operator::Difference, A, K(k)) => O::SumAK(-k),
        (Operator::Difference, K(k), S(y)) => O::DifferenceKS(y, k),
        (Operator::Difference, K(k), A) => O::DifferenceKA(k),
        (Operator::Product, S(x), S(y)) => O::ProductSS(x, y),
        (Operator::Product, A, S(y)) => O::ProductAS(y),
        (Operator::Product, S(x), K(k)) => O::ProductSK(x, k),
        (Operator::Product, A, K(k)) => O::ProductAK(k),
        (Operator::Quotient, S(x), S(y)) => O::QuotientSS(x, y),
        (Operator::Quotient, A, S(y)) => O::QuotientAS(y),
        (Operator::Quotient, S(x), A) => O::QuotientSA(x),
        (Operator::Quotient, K(k), S(y)) => O::QuotientKS(y, k),
        (Operator::Quotient, K(k), A) => O::QuotientKA(k),
        _ => return None,
    })
}

/// Returns the operation of an addend z plus a product x y, one of which may be negated.
fn fused(negated: Option<Negated>, z: Place, x: Place, y: Place) -> Option<Operation> {
    let (x, y) = ordered(x, y);
    Some(match (negated, z, x, y) {
        (None, A, S(x), S(y)) => O::PlusASS(x, y),
        (None, A, S(x), K(k)) => O::PlusASK(x, k),
        (None, S(z), S(x), S(y)) => O::PlusSSS(z, x, y),
        (None, S(z), A, S(y)) => O::PlusSAS(z, y),
        (None, S(z), S(x), K(k)) => O::PlusSSK(z, x, k),
        (None, S(z), A, K(k)) => O::PlusSAK(z, k),
        (None, K(k), S(x), S(y)) => O::PlusKSS(x, y, k),
        (None, K(k), A, S(y)) => O::PlusKAS(y, k),
        (Some(Negated::Factor), A, S(x), S(y)) => O::MinusASS(x, y),
        (Some(Negated::Factor), S(z), S(x), S(y)) => O::MinusSSS(z, x, y),
        (Some(Negated::Factor), S(z), A, S(y)) => O::MinusSAS(z, y),
        (Some(Negated::Factor), K(k), S(x), S(y)) => O::MinusKSS(x, y, k),
        (Some(Negated::Factor), K(k), A, S(y)) => O::MinusKAS(y, k),
        // z - x k has the same bits as z + x (-k)
        (Some(Negated::Factor), A, S(x), K(k)) => O::PlusASK(x, -k),
        (Some(Negated::Factor), S(z), S(x), K(k)) => O::PlusSSK(z, x, -k),
        (Some(Negated::Factor), S(z), A, K(k)) => O::PlusSAK(z, -k),
        (Some(Negated::Addend), A, S(x), S(y)) => O::LessASS(x, y),
        (Some(Negated::Addend), A, S(x), K(k)) => O::LessASK(x, k),
        (Some(Negated::Addend), S(z), S(x), S(y)) => O::LessSSS(z, x, y),
        (Some(Negated::Addend), S(z), A, S(y)) => O::LessSAS(z, y),
        (Some(Negated::Addend), S(z), S(x), K(k)) => O::LessSSK(z, x, k),
        (Some(Negated::Addend), S(z), A, K(k)) => O::LessSAK(z, k),
        // x y - k has the same bits as x y + (-k)
        (Some(Negated::Addend), K(k), S(x), S(y)) => O::PlusKSS(x, y, -k),
        (Some(Negated::Addend), K(k), A, S(y)) => O::PlusKAS(y, -k),
        _ => return None,
    })
}

/// Returns the operands of a value that can be constants of its instruction, wherever the other operands are.
pub(crate) fn constants(dataflow: &Dataflow, id: ValueId) -> Vec<ValueId> {
    let place = |left_out: &[ValueId], operand: ValueId| match dataflow.constant(operand) {
        Some(k) if !left_out.contains(&operand) => Place::Constant(k),
        _ => Place::Slot(0),
    };
    let operands = dataflow.operands(id).into_iter();
    let candidates: Vec<ValueId> = operands.filter(|operand| dataflow.constant(*operand).is_some()).collect();
    // first all constants, then all but one, then none
    let mut tries = std::iter::once(Vec::new())
        .chain(candidates.iter().map(|candidate| vec![*candidate]))
        .chain(std::iter::once(candidates.clone()));
    let left_out = tries
        .find(|left_out| operation(dataflow, id, |operand| place(left_out, operand)).is_some())
        .unwrap_or_else(|| candidates.clone());
    candidates.into_iter().filter(|candidate| !left_out.contains(candidate)).collect()
}
