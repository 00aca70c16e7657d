//! A program as values that are computed from earlier ones: what the machine's instructions are made of.

use std::collections::HashMap;

use rne_codegen::{Expression, Form, Name, Operator, Program};

/// A value, by its place among all.
pub(crate) type Value = usize;

/// How a product enters a sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fused {
    /// z + x y
    Plus,
    /// z - x y
    Minus,
    /// x y - z
    Less,
}

/// What a value is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Definition {
    Input(usize),
    Constant(f64),
    /// The sine or the cosine of a turn of the program.
    Sine(usize),
    Cosine(usize),
    Negative(Value),
    Binary(Operator, Value, Value),
    /// An addend and two factors.
    Fused(Fused, [Value; 3]),
    BySign([Value; 3]),
}

impl Definition {
    /// The values that it is computed from.
    pub(crate) fn operands(&self) -> Vec<Value> {
        match *self {
            Self::Input(_) | Self::Constant(_) | Self::Sine(_) | Self::Cosine(_) => Vec::new(),
            Self::Negative(a) => vec![a],
            Self::Binary(_, a, b) => vec![a, b],
            Self::Fused(_, operands) | Self::BySign(operands) => operands.to_vec(),
        }
    }

    /// Whether something is computed for it.
    pub(crate) fn is_computed(&self) -> bool {
        !self.operands().is_empty()
    }
}

/// All values of a program.
#[derive(Debug)]
pub(crate) struct Dataflow {
    pub(crate) values: Vec<Definition>,
    /// The angle of each turn, and how many values were defined when the last of them was.
    pub(crate) angles: Vec<Value>,
    pub(crate) before_turns: usize,
    pub(crate) outputs: Vec<Value>,
    /// The arguments, in the order of the inputs.
    pub(crate) inputs: Vec<Name>,
}

impl Dataflow {
    /// Of a program. In the reduced form, where the order of terms is free, a product that is added is one operation
    /// with its sum; in the seven steps each is rounded by itself, as the runtime rounds it.
    pub(crate) fn of(program: &Program) -> Self {
        let mut reading = Reading { fuses: program.form == Form::Reduced, ..Reading::default() };
        let inputs = program.arguments.clone();
        for (index, name) in inputs.iter().enumerate() {
            let value = reading.value(Definition::Input(index));
            reading.known.insert(*name, value);
        }
        for constant in &program.constants {
            let value = reading.value(Definition::Constant(constant.value));
            reading.known.insert(constant.name, value);
        }
        // angles are sums that sines see: they are not fused, as in derived code
        let fuses = std::mem::replace(&mut reading.fuses, false);
        for statement in &program.angles {
            let value = reading.expression(&statement.value);
            reading.known.insert(statement.name, value);
        }
        let angles: Vec<Value> = program.sines_and_cosines.iter().map(|turn| reading.expression(&turn.angle)).collect();
        reading.fuses = fuses;
        let before_turns = reading.values.len();
        for (index, turn) in program.sines_and_cosines.iter().enumerate() {
            let (sine, cosine) = (reading.value(Definition::Sine(index)), reading.value(Definition::Cosine(index)));
            reading.known.extend(turn.sine.map(|name| (name, sine)));
            reading.known.extend(turn.cosine.map(|name| (name, cosine)));
        }
        for statement in &program.statements {
            let value = reading.expression(&statement.value);
            reading.known.insert(statement.name, value);
        }
        let outputs = program.outputs.iter().map(|output| reading.expression(&output.value)).collect();
        Self { values: reading.values, angles, before_turns, outputs, inputs }
    }
}

#[derive(Default)]
struct Reading {
    fuses: bool,
    values: Vec<Definition>,
    known: HashMap<Name, Value>,
}

impl Reading {
    fn value(&mut self, definition: Definition) -> Value {
        self.values.push(definition);
        self.values.len() - 1
    }

    fn expression(&mut self, expression: &Expression) -> Value {
        let definition = match expression {
            // every name is defined before it is used: programs are in order of evaluation
            Expression::Variable(name) => return self.known[name],
            Expression::Zero => Definition::Constant(0.0),
            Expression::Negative(a) => {
                let a = self.expression(a);
                if let Definition::Constant(k) = self.values[a] {
                    Definition::Constant(-k)
                } else {
                    Definition::Negative(a)
                }
            }
            Expression::Binary(operator, a, b) => match self.contraction(*operator, a, b) {
                Some(fused) => fused,
                None => Definition::Binary(*operator, self.expression(a), self.expression(b)),
            },
            Expression::BySign(operands) => {
                Definition::BySign(operands.each_ref().map(|operand| self.expression(operand)))
            }
        };
        self.value(definition)
    }

    /// A sum or difference with a product in it; of two products the right one is fused, as in derived batches.
    fn contraction(&mut self, operator: Operator, a: &Expression, b: &Expression) -> Option<Definition> {
        if !self.fuses {
            return None;
        }
        let is_difference = match operator {
            Operator::Sum => false,
            Operator::Difference => true,
            Operator::Product | Operator::Quotient => return None,
        };
        let is_product = |expression: &Expression| matches!(expression, Expression::Binary(Operator::Product, ..));
        let (addend, product, kind) = match (is_product(a), is_product(b)) {
            (_, true) => (a, b, if is_difference { Fused::Minus } else { Fused::Plus }),
            (true, false) => (b, a, if is_difference { Fused::Less } else { Fused::Plus }),
            (false, false) => return None,
        };
        let Expression::Binary(_, x, y) = product else { return None };
        let (x, is_negative) = match &**x {
            Expression::Negative(x) => (&**x, true),
            x => (x, false),
        };
        let mut operands = [addend, x, y].map(|operand| self.expression(operand));
        // z + (-x) y is z - x y, to the bit; only (-x) y - z is none of the three
        let kind = match (kind, is_negative) {
            (kind, false) => kind,
            (Fused::Plus, true) => Fused::Minus,
            (Fused::Minus, true) => Fused::Plus,
            (Fused::Less, true) => {
                operands[1] = self.value(Definition::Negative(operands[1]));
                Fused::Less
            }
        };
        Some(Definition::Fused(kind, operands))
    }
}
