//! Translates a program to the intermediate language of Cranelift.
//!
//! Inputs and constants are loaded again at each use: each of them is then an operand in memory, and occupies no
//! register between its uses.

use std::collections::HashMap;

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{self, AbiParam, InstBuilder, MemFlags, Type};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use rne_codegen::{Contraction, Negated, Operator, Value, ValueId};
use rne_runtime::machine::{Kernel, Step};

use crate::Number;
use crate::dataflow::Dataflow;

pub(crate) mod sealed {
    use cranelift_codegen::ir::{Type, types};

    pub trait Number {
        const TYPE: Type;
        /// Integer type of the same width.
        const BITS: Type;

        fn nearest(value: f64) -> Self;

        fn of_bits(bits: u8) -> Self;
    }

    macro_rules! number {
        ($type:ident, $TYPE:ident, $BITS:ident) => {
            impl Number for $type {
                const TYPE: Type = types::$TYPE;
                const BITS: Type = types::$BITS;

                #[allow(clippy::cast_possible_truncation, trivial_numeric_casts)]
                fn nearest(value: f64) -> Self {
                    value as Self
                }

                fn of_bits(bits: u8) -> Self {
                    Self::from_bits(bits.into())
                }
            }
        };
    }
    number!(f32, F32, I32);
    number!(f64, F64, I64);
}

/// Returns of how many numbers one instruction computes sines and cosines: as many as a vector register of Cranelift
/// has, if every processor of the family has vector registers.
#[allow(clippy::cast_possible_truncation)] // at most 16
const fn lanes<T>() -> u8 {
    if cfg!(any(target_arch = "x86_64", target_arch = "aarch64")) { 16 / size_of::<T>() as u8 } else { 1 }
}

/// Writes the function, and returns the constants that it reads. The function takes pointers to the inputs, the outputs
/// and the constants. It returns 1, or 0 with nothing written if an angle is beyond the range of the kernel.
pub(crate) fn write<T: Number>(
    function: &mut ir::Function,
    target: TargetFrontendConfig,
    dataflow: &Dataflow,
    kernel: &Kernel,
) -> Vec<T> {
    let pointer = target.pointer_type();
    function.signature.params.extend([AbiParam::new(pointer); 3]);
    function.signature.returns.push(AbiParam::new(pointer));
    let mut memory = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(function, &mut memory);
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let [inputs, outputs, constants] = [0, 1, 2].map(|index| builder.block_params(entry)[index]);

    let is_live = dataflow.live();
    let mut last = vec![None; dataflow.values.len()];
    for (id, _) in dataflow.values.iter().filter(|(id, _)| is_live[id.index()]) {
        dataflow.operands(id).into_iter().for_each(|operand| last[operand.index()] = Some(id));
    }
    let mut translation = Translation {
        builder,
        pointer,
        dataflow,
        kernel,
        is_live,
        last,
        inputs,
        outputs,
        table: constants,
        constants: Vec::new(),
        places: HashMap::new(),
        computed: vec![None; dataflow.values.len()],
    };
    translation.program();
    translation.builder.seal_all_blocks();
    translation.builder.finalize();
    translation.constants
}

struct Translation<'a, T> {
    builder: FunctionBuilder<'a>,
    pointer: Type,
    dataflow: &'a Dataflow,
    kernel: &'a Kernel,
    is_live: Vec<bool>,
    /// For each value the last value that uses it.
    last: Vec<Option<ValueId>>,
    inputs: ir::Value,
    outputs: ir::Value,
    table: ir::Value,
    /// The numbers in the table of constants.
    constants: Vec<T>,
    /// For each number in the table, by its bits and its number of lanes: its place.
    places: HashMap<(u64, u8), usize>,
    computed: Vec<Option<ir::Value>>,
}

impl<T: Number> Translation<'_, T> {
    fn program(&mut self) {
        let dataflow = self.dataflow;
        let before = dataflow.before_turns;
        let mut outputs = vec![Vec::new(); dataflow.values.len()];
        for (index, output) in dataflow.outputs.iter().enumerate() {
            outputs[output.index()].push(index);
        }
        for (id, _) in dataflow.values.iter().take(before) {
            self.compute(id);
        }
        self.turns();
        // outputs are written only after the check of the angles, so that nothing is written if one is beyond the range
        for ((id, _), indices) in dataflow.values.iter().zip(&outputs) {
            if id.index() >= before {
                self.compute(id);
            }
            for index in indices {
                let result = self.operand(id);
                self.builder.ins().store(MemFlags::trusted(), result, self.outputs, place::<T>(*index));
            }
        }
        self.give_back(1);
    }

    fn give_back(&mut self, result: i64) {
        let result = self.builder.ins().iconst(self.pointer, result);
        self.builder.ins().return_(&[result]);
    }

    /// Writes the operation that computes a value, if something needs it.
    fn compute(&mut self, id: ValueId) {
        if !self.is_live[id.index()] {
            return;
        }
        let result = match self.dataflow.values.get(id) {
            Value::Argument | Value::Constant(_) | Value::Sine(_) | Value::Cosine(_) | Value::Same(_) => return,
            Value::Negative(x) => {
                let x = self.operand(x);
                self.builder.ins().fneg(x)
            }
            Value::Binary(operator, x, y) => {
                // the second operand may be read from memory, so an input or constant goes there
                let commutes = matches!(operator, Operator::Sum | Operator::Product);
                let (x, y) = if commutes && self.dataflow.is_fetched(x) { (y, x) } else { (x, y) };
                let (x, y) = (self.operand(x), self.operand(y));
                match operator {
                    Operator::Sum => self.builder.ins().fadd(x, y),
                    Operator::Difference => self.builder.ins().fsub(x, y),
                    Operator::Product => self.builder.ins().fmul(x, y),
                    Operator::Quotient => self.builder.ins().fdiv(x, y),
                }
            }
            Value::Fused(Contraction { factors: [x, y], addend: z, negated }) => {
                // the result takes the register of the first factor, so a factor that is not used again goes there
                let is_free =
                    |operand: ValueId| !self.dataflow.is_fetched(operand) && self.last[operand.index()] == Some(id);
                let (x, y) = if !is_free(x) && is_free(y) { (y, x) } else { (x, y) };
                let (z, x, y) = (self.operand(z), self.operand(x), self.operand(y));
                match negated {
                    None => self.plus_product(z, x, y),
                    Some(Negated::Factor) => self.minus_product(z, x, y),
                    Some(Negated::Addend) => {
                        let z = self.builder.ins().fneg(z);
                        self.plus_product(z, x, y)
                    }
                }
            }
            Value::BySign(operands) => {
                let [x, a, b] = operands.map(|operand| self.operand(operand));
                let zero = self.constant(T::nearest(0.0), 1);
                let is_below = self.builder.ins().fcmp(FloatCC::LessThan, x, zero);
                let otherwise = self.builder.ins().select(is_below, b, zero);
                let is_above = self.builder.ins().fcmp(FloatCC::GreaterThan, x, zero);
                self.builder.ins().select(is_above, a, otherwise)
            }
        };
        self.computed[id.index()] = Some(result);
    }

    fn operand(&mut self, id: ValueId) -> ir::Value {
        match (self.dataflow.values.get(id), self.computed[id.index()]) {
            (_, Some(result)) => result,
            (Value::Argument, None) => {
                self.builder.ins().load(T::TYPE, unchanging(), self.inputs, place::<T>(id.index()))
            }
            (Value::Constant(k), None) => self.constant(T::nearest(k), 1),
            // values are in order of evaluation, and all live values are computed
            (value, None) => unreachable!("{value:?} is used before it is computed"),
        }
    }

    /// Loads a number of the table into all lanes of a register.
    fn constant(&mut self, number: T, lanes: u8) -> ir::Value {
        let bits = number.into().to_bits();
        let index = *self.places.entry((bits, lanes)).or_insert_with(|| {
            self.constants.extend(core::iter::repeat_n(number, lanes.into()));
            self.constants.len() - usize::from(lanes)
        });
        self.builder.ins().load(of_lanes(T::TYPE, lanes), unchanging(), self.table, place::<T>(index))
    }

    fn plus_product(&mut self, z: ir::Value, x: ir::Value, y: ir::Value) -> ir::Value {
        if self.kernel.is_fused {
            return self.builder.ins().fma(x, y, z);
        }
        let product = self.builder.ins().fmul(x, y);
        self.builder.ins().fadd(z, product)
    }

    fn minus_product(&mut self, z: ir::Value, x: ir::Value, y: ir::Value) -> ir::Value {
        if self.kernel.is_fused {
            let x = self.builder.ins().fneg(x);
            return self.builder.ins().fma(x, y, z);
        }
        let product = self.builder.ins().fmul(x, y);
        self.builder.ins().fsub(z, product)
    }

    /// Writes all sines and cosines, as many at once as a register has lanes.
    fn turns(&mut self) {
        let lanes = lanes::<T>();
        let angles: Vec<ir::Value> = self.dataflow.angles.iter().map(|angle| self.operand(*angle)).collect();
        let registers: Vec<ir::Value> =
            angles.chunks(lanes.into()).map(|angles| self.register(angles, lanes)).collect();
        self.leave_beyond_range(&registers, lanes);
        let results: Vec<[ir::Value; 2]> =
            registers.into_iter().map(|angles| self.sines_and_cosines(angles, lanes)).collect();
        let dataflow = self.dataflow;
        for (id, value) in dataflow.values.iter() {
            let (angle, which) = match value {
                Value::Sine(angle) if self.is_live[id.index()] => (angle, 0),
                Value::Cosine(angle) if self.is_live[id.index()] => (angle, 1),
                _ => continue,
            };
            let Some(turn) = dataflow.angles.iter().position(|of| *of == angle) else { continue };
            let (register, lane) = (turn / usize::from(lanes), turn % usize::from(lanes));
            #[allow(clippy::cast_possible_truncation)] // a register has few lanes
            let result = self.lane(results[register][which], lane as u8, lanes);
            self.computed[id.index()] = Some(result);
        }
    }

    /// Returns a register with these numbers, and zeros in its other lanes.
    fn register(&mut self, numbers: &[ir::Value], lanes: u8) -> ir::Value {
        if lanes == 1 {
            return numbers[0];
        }
        let register = self.builder.ins().scalar_to_vector(of_lanes(T::TYPE, lanes), numbers[0]);
        (1..lanes)
            .zip(&numbers[1..])
            .fold(register, |register, (lane, number)| self.builder.ins().insertlane(register, *number, lane))
    }

    fn lane(&mut self, register: ir::Value, lane: u8, lanes: u8) -> ir::Value {
        if lanes == 1 { register } else { self.builder.ins().extractlane(register, lane) }
    }

    /// Writes a return for angles that are beyond the range of the kernel or NaN: in both cases the sum of their
    /// squares is not within the limit.
    fn leave_beyond_range(&mut self, registers: &[ir::Value], lanes: u8) {
        let Some((first, others)) = registers.split_first() else { return };
        let first = self.builder.ins().fmul(*first, *first);
        let squares = others.iter().fold(first, |sum, angles| self.plus_product(sum, *angles, *angles));
        let first = self.lane(squares, 0, lanes);
        let sum = (1..lanes).fold(first, |sum, lane| {
            let square = self.lane(squares, lane, lanes);
            self.builder.ins().fadd(sum, square)
        });
        let limit = self.constant(T::nearest(self.kernel.limit_of_squares), 1);
        let is_within = self.builder.ins().fcmp(FloatCC::LessThanOrEqual, sum, limit);
        let [within, beyond] = [(); 2].map(|()| self.builder.create_block());
        self.builder.set_cold_block(beyond);
        self.builder.ins().brif(is_within, within, &[], beyond, &[]);
        self.builder.switch_to_block(beyond);
        self.give_back(0);
        self.builder.switch_to_block(within);
    }

    /// Writes the kernel of sine and cosine, operation by operation.
    fn sines_and_cosines(&mut self, angles: ir::Value, lanes: u8) -> [ir::Value; 2] {
        let kernel = self.kernel;
        let mut results: Vec<Option<ir::Value>> = Vec::with_capacity(kernel.steps.len());
        for step in &kernel.steps {
            let mut at = |index: usize| match (results[index], kernel.steps[index]) {
                (None, Step::Constant(k)) => self.constant(T::nearest(k), lanes),
                (result, _) => result.unwrap_or(angles),
            };
            let result = match *step {
                Step::Angle => angles,
                // a constant is loaded where it is used
                Step::Constant(_) => {
                    results.push(None);
                    continue;
                }
                Step::Negative(x) => {
                    let x = at(x);
                    self.builder.ins().fneg(x)
                }
                Step::Sum(x, y) => {
                    let (x, y) = (at(x), at(y));
                    self.builder.ins().fadd(x, y)
                }
                Step::Difference(x, y) => {
                    let (x, y) = (at(x), at(y));
                    self.builder.ins().fsub(x, y)
                }
                Step::Product(x, y) => {
                    let (x, y) = (at(x), at(y));
                    self.builder.ins().fmul(x, y)
                }
                Step::Quotient(x, y) => {
                    let (x, y) = (at(x), at(y));
                    self.builder.ins().fdiv(x, y)
                }
                Step::Plus(z, x, y) => {
                    let (z, x, y) = (at(z), at(x), at(y));
                    self.plus_product(z, x, y)
                }
                Step::Minus(z, x, y) => {
                    let (z, x, y) = (at(z), at(x), at(y));
                    self.minus_product(z, x, y)
                }
                Step::SineInQuadrant(operands) => {
                    let operands = operands.map(at);
                    self.in_quadrant(operands, false, lanes)
                }
                Step::CosineInQuadrant(operands) => {
                    let operands = operands.map(at);
                    self.in_quadrant(operands, true, lanes)
                }
            };
            results.push(Some(result));
        }
        [kernel.sine, kernel.cosine].map(|step| results[step].unwrap_or(angles))
    }

    /// Selects the sine or the cosine: the lowest bit of n exchanges both; the sign is the next bit of n, or for the
    /// cosine that of n + 1.
    fn in_quadrant(&mut self, operands: [ir::Value; 3], is_cosine: bool, lanes: u8) -> ir::Value {
        let (number, bits) = (of_lanes(T::TYPE, lanes), of_lanes(T::BITS, lanes));
        let flags = MemFlags::new().with_endianness(ir::Endianness::Little);
        let [n, sine, cosine] = operands.map(|operand| self.builder.ins().bitcast(bits, flags, operand));
        let [one, two] = [1, 2].map(|k| {
            let k = self.constant(T::of_bits(k), lanes);
            self.builder.ins().bitcast(bits, flags, k)
        });
        let (own, sign) = if is_cosine { (cosine, self.builder.ins().iadd(n, one)) } else { (sine, n) };
        let other = self.builder.ins().bxor(sine, cosine);
        let is_odd = self.builder.ins().band(n, one);
        let is_odd = self.builder.ins().ineg(is_odd);
        let exchange = self.builder.ins().band(other, is_odd);
        let sign = self.builder.ins().band(sign, two);
        let sign = self.builder.ins().ishl_imm(sign, i64::from(T::TYPE.bits()) - 2);
        let result = self.builder.ins().bxor(own, exchange);
        let result = self.builder.ins().bxor(result, sign);
        self.builder.ins().bitcast(number, flags, result)
    }
}

/// Returns flags for memory that exists and does not change while the function runs. Vectors may be unaligned.
fn unchanging() -> MemFlags {
    MemFlags::new().with_notrap().with_readonly().with_can_move()
}

/// Returns the type of a register with this number of lanes, or of a single number.
fn of_lanes(number: Type, lanes: u8) -> Type {
    number.by(lanes.into()).unwrap_or(number)
}

/// Returns the position of a number in an array, in bytes.
fn place<T>(index: usize) -> i32 {
    i32::try_from(index * size_of::<T>()).expect("arrays have thousands of numbers")
}
