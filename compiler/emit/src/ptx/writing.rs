//! Writes the instructions of a program in a kernel.

use std::collections::HashMap;
use std::fmt::Write as _;

use rne_codegen::{Contraction, Name, Negated, Operator, Value, ValueId};

use super::kernel::Kernel;
use super::{Arrangement, order};
use crate::syntax::Precision;

/// Sine and cosine as a block of instructions; ANGLE, SINE and COSINE are replaced by registers.
const SIN_COS: [&str; 2] = [include_str!("sin_cos_f32.ptx"), include_str!("sin_cos_f64.ptx")];

/// The instructions of a kernel.
pub(super) struct Writing<'k, 'p> {
    kernel: &'k Kernel<'p>,
    pub(super) arrangement: Arrangement,
    /// The kind of memory from which a thread reads its arguments and to which it writes its results.
    memory: &'static str,
    real: &'static str,
    bytes: usize,
    pub(super) registers: Vec<String>,
    pub(super) addresses: usize,
    /// The register or the literal of each value; empty as long as it is not computed.
    pub(super) known: Vec<String>,
    pub(super) body: String,
}

impl<'k, 'p> Writing<'k, 'p> {
    pub(super) fn of(kernel: &'k Kernel<'p>, arrangement: Arrangement, memory: &'static str) -> Self {
        let (real, bytes) = kernel.number();
        let known = vec![String::new(); kernel.program.values.len()];
        let (registers, body) = (Vec::new(), String::new());
        Self { kernel, arrangement, memory, real, bytes, registers, addresses: 0, known, body }
    }

    /// Writes all values in their order. An argument is read just before its first use, and a result is stored, if
    /// `are_stored`, as soon as it is known, so that few registers are in use at the same time.
    pub(super) fn values(&mut self, are_stored: bool) {
        let program = &*self.kernel.program;
        let mut results: Vec<Vec<usize>> = vec![Vec::new(); program.values.len()];
        for (index, output) in program.outputs.iter().enumerate() {
            results[output.value.index()].push(index);
        }
        let turns: HashMap<_, _> = program
            .values
            .iter()
            .filter_map(|(id, value)| match value {
                Value::Sine(angle) => Some(((angle, 0), id)),
                Value::Cosine(angle) => Some(((angle, 1), id)),
                _ => None,
            })
            .collect();
        for id in order::of(program) {
            let value = program.values.get(id);
            match value {
                Value::Sine(angle) | Value::Cosine(angle) => self.turn(angle, [0, 1].map(|of| turns.get(&(angle, of)))),
                // arguments and constants are read where they are used
                Value::Argument | Value::Constant(_) => {}
                _ => self.compute(id, value),
            }
            for &index in results[id.index()].iter().filter(|_| are_stored) {
                let result = self.operand(id);
                let register = if result.starts_with('0') {
                    let register = self.register(None, id);
                    let _ = writeln!(self.body, "    mov.{} {register}, {result};", self.real);
                    self.known[id.index()].clone_from(&register);
                    register
                } else {
                    result
                };
                let place = self.place("%out", index);
                let _ = writeln!(self.body, "    st.{}.{} {place}, {register};", self.memory, self.real);
            }
        }
    }

    /// Declares a register: `$w2_z` for a number with this name; no word of PTX begins with `$`.
    fn register(&mut self, name: Option<Name>, id: ValueId) -> String {
        let register = name.map_or_else(|| format!("$_{}", id.index()), |name| format!("${name}"));
        self.registers.push(register.clone());
        register
    }

    /// Returns the address of an element in square brackets.
    pub(super) fn place(&mut self, array: &str, element: usize) -> String {
        match (self.arrangement, element * self.bytes) {
            (_, 0) => format!("[{array}]"),
            (Arrangement::Rows, offset) => format!("[{array}+{offset}]"),
            (Arrangement::Columns, offset) => {
                let address = self.addresses;
                self.addresses += 1;
                let _ = writeln!(self.body, "    mad.wide.u32 %a{address}, %states, {offset}, {array};");
                format!("[%a{address}]")
            }
        }
    }

    /// Returns the register or the literal of a value.
    pub(super) fn operand(&mut self, id: ValueId) -> String {
        let program = &*self.kernel.program;
        let found = &self.known[id.index()];
        if !found.is_empty() {
            return found.clone();
        }
        let operand = match program.values.get(id) {
            Value::Constant(_) => self.kernel.literals.get(&id).cloned().unwrap_or_default(),
            Value::Same(of) => self.operand(of),
            _ => self.argument(id),
        };
        self.known[id.index()].clone_from(&operand);
        operand
    }

    /// Writes the instruction that reads an argument.
    fn argument(&mut self, id: ValueId) -> String {
        let name = self.kernel.program.values.name(id);
        let arrays = self.kernel.arrays.iter();
        let mut places = arrays.filter_map(|array| {
            let element = array.elements.iter().position(|element| *element == name)?;
            Some((format!("%in_{}", array.name), element))
        });
        let (array, element) = places.next().unwrap_or_default();
        let register = self.register(name, id);
        let place = self.place(&array, element);
        let load = if self.memory == "shared" { "ld.shared" } else { "ld.global.nc" };
        let _ = writeln!(self.body, "    {load}.{} {register}, {place};", self.real);
        register
    }

    /// Writes the sine and cosine of an angle together, unless they are already known.
    fn turn(&mut self, angle: ValueId, turned: [Option<&ValueId>; 2]) {
        if turned.iter().flatten().any(|id| !self.known[id.index()].is_empty()) {
            return;
        }
        let of = self.operand(angle);
        let [sine, cosine] = [(turned[0], "sine"), (turned[1], "cosine")].map(|(id, unused)| match id {
            Some(&id) => {
                let register = self.register(self.kernel.program.values.name(id), id);
                self.known[id.index()].clone_from(&register);
                register
            }
            None => unused.to_owned(),
        });
        let block = SIN_COS[usize::from(self.kernel.precision == Precision::Double)];
        let block = block.replace("COSINE", &cosine).replace("SINE", &sine).replace("ANGLE", &of);
        self.body.push_str(&block);
    }

    fn compute(&mut self, id: ValueId, value: Value) {
        let real = self.real;
        let line = match value {
            // An alias has no instruction of its own.
            Value::Same(of) => {
                self.known[id.index()] = self.operand(of);
                return;
            }
            Value::Negative(a) => format!("neg.{real} DST, {}", self.operand(a)),
            Value::Binary(operator, a, b) => {
                let operation = match operator {
                    Operator::Sum => "add",
                    Operator::Difference => "sub",
                    Operator::Product => "mul",
                    Operator::Quotient => "div",
                };
                format!("{operation}.rn.{real} DST, {}, {}", self.operand(a), self.operand(b))
            }
            Value::Fused(Contraction { factors: [x, y], addend, negated }) => {
                let [mut x, y, mut z] = [x, y, addend].map(|id| self.operand(id));
                match negated {
                    Some(Negated::Factor) => x = self.negative(id, &x),
                    Some(Negated::Addend) => z = self.negative(id, &z),
                    None => {}
                }
                format!("fma.rn.{real} DST, {x}, {y}, {z}")
            }
            Value::BySign(operands) => {
                let zero = if real == "f64" { "0d0000000000000000" } else { "0f00000000" };
                let [x, a, b] = operands.map(|operand| self.operand(operand));
                let register = self.register(self.kernel.program.values.name(id), id);
                let _ = writeln!(
                    self.body,
                    "    setp.gt.{real} %is_above, {x}, {zero};\n    setp.lt.{real} %is_below, {x}, {zero};\n    \
                     selp.{real} {register}, {b}, {zero}, %is_below;\n    \
                     selp.{real} {register}, {a}, {register}, %is_above;"
                );
                self.known[id.index()] = register;
                return;
            }
            Value::Argument | Value::Constant(_) | Value::Sine(_) | Value::Cosine(_) => return,
        };
        let register = self.register(self.kernel.program.values.name(id), id);
        let _ = writeln!(self.body, "    {};", line.replace("DST", &register));
        self.known[id.index()] = register;
    }

    /// Writes the negative of an operand of the value `id`; the assembler merges it into the instruction that uses it.
    fn negative(&mut self, id: ValueId, operand: &str) -> String {
        let register = format!("%n{}", id.index());
        self.registers.push(register.clone());
        let _ = writeln!(self.body, "    neg.{} {register}, {operand};", self.real);
        register
    }
}
