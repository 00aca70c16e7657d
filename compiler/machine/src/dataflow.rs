//! The values of a program for the machine and for native code, with products fused into sums where that is allowed.

use rne_codegen::fma::{self, Fusing};
use rne_codegen::{Contraction, Form, Name, Negated, Program, Value, ValueId, Values};

/// The values of a program.
#[derive(Debug)]
pub(crate) struct Dataflow {
    pub(crate) values: Values,
    /// The angles whose sines and cosines are computed; all of them are computed at once.
    pub(crate) angles: Vec<ValueId>,
    /// The number of values before the first sine or cosine.
    pub(crate) before_turns: usize,
    pub(crate) outputs: Vec<ValueId>,
    /// The names of the arguments, which are the first values.
    pub(crate) inputs: Vec<Name>,
}

impl Dataflow {
    /// Converts a program. In the reduced form, where the order of terms is free, a product and the sum to which it is
    /// added become one fused operation. In the seven steps, each is rounded by itself, as the runtime does it.
    pub(crate) fn of(program: &Program) -> Self {
        let fused = (program.form == Form::Reduced).then(|| fma::fused(program, Fusing::All));
        let program = fused.as_ref().unwrap_or(program);
        let mut values = program.values.clone();
        for (id, value) in program.values.iter() {
            let value = value.map(|operand| unaliased(&values, operand));
            values.replace(id, without_signs(&values, value));
        }
        let is_turn = |(_, value): (ValueId, Value)| matches!(value, Value::Sine(_) | Value::Cosine(_));
        let before_turns = values.iter().position(is_turn).unwrap_or_else(|| program.before_statements());
        Self {
            angles: program.sines_and_cosines.iter().map(|turn| unaliased(&values, turn.angle)).collect(),
            before_turns,
            outputs: program.outputs.iter().map(|output| unaliased(&values, output.value)).collect(),
            inputs: program.arguments().collect(),
            values,
        }
    }

    /// Returns the values from which a value is computed; none for a sine or cosine, because all of them are computed
    /// at once.
    pub(crate) fn operands(&self, id: ValueId) -> Vec<ValueId> {
        match self.values.get(id) {
            Value::Sine(_) | Value::Cosine(_) => Vec::new(),
            value => value.operands().collect(),
        }
    }

    /// Whether a value is the result of an operation of its own.
    pub(crate) fn is_computed(&self, id: ValueId) -> bool {
        !self.operands(id).is_empty()
    }

    /// Whether a value is an input or a constant.
    pub(crate) fn is_fetched(&self, id: ValueId) -> bool {
        matches!(self.values.get(id), Value::Argument | Value::Constant(_))
    }

    pub(crate) fn is_turn(&self, id: ValueId) -> bool {
        matches!(self.values.get(id), Value::Sine(_) | Value::Cosine(_))
    }

    /// Returns the number of a constant; `None` for other values.
    pub(crate) fn constant(&self, id: ValueId) -> Option<f64> {
        if let Value::Constant(number) = self.values.get(id) { Some(number) } else { None }
    }

    /// Returns for each value whether the outputs or the angles depend on it.
    pub(crate) fn live(&self) -> Vec<bool> {
        let mut is_live = vec![false; self.values.len()];
        let mut open: Vec<ValueId> = self.outputs.iter().chain(&self.angles).copied().collect();
        while let Some(value) = open.pop() {
            if !std::mem::replace(&mut is_live[value.index()], true) {
                open.extend(self.values.get(value).operands());
            }
        }
        is_live
    }
}

/// Returns the value to which `id` refers if it is only another name for it, otherwise `id`.
fn unaliased(values: &Values, id: ValueId) -> ValueId {
    if let Value::Same(of) = values.get(id) { of } else { id }
}

/// Returns the same value with fewer negations: z + (-x) y is computed as z - x y, with the same bits. Only (-x) y - z
/// has no operation without a negation.
fn without_signs(values: &Values, value: Value) -> Value {
    match value {
        Value::Negative(a) => match values.get(a) {
            Value::Constant(number) => Value::Constant(-number),
            _ => value,
        },
        Value::Fused(Contraction { factors: [x, y], addend, negated: negated @ (None | Some(Negated::Factor)) }) => {
            match values.get(x) {
                // a negated value with a name is computed in any case, so nothing would be saved
                Value::Negative(of) if values.name(x).is_none() => {
                    let negated = if negated.is_none() { Some(Negated::Factor) } else { None };
                    Value::Fused(Contraction { factors: [of, y], addend, negated })
                }
                _ => value,
            }
        }
        _ => value,
    }
}
