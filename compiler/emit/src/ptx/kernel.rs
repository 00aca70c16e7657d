//! Writes one function as a kernel.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::Write as _;

use rne_codegen::fma::{self, Fusing};
use rne_codegen::{ArgumentArray, Form, Layout, Program, Value, ValueId, argument_parts};

use super::Arrangement;
use super::writing::Writing;
use crate::c::{ConstantTooLarge, comment, elements_of};
use crate::syntax::Precision;
use crate::wrap::{WIDTH, fill};

/// Number of threads of a block whose rows are copied through shared memory, then the largest number of bytes of shared
/// memory that every GPU has for a block.
const BLOCK: usize = 64;
const MOST_SHARED: usize = 48 * 1024;
/// If a state has more results than this, its rows are copied through shared memory. With this, an H200 computed mass
/// matrices of the Panda, 49 numbers each, about ten times as fast (12.4 instead of 1.2 · 10⁹ states/s in `f32`), but
/// its torques, 7 numbers each, about three times as slowly (10.2 instead of 32.7 · 10⁹ states/s).
const WIDE: usize = 32;

macro_rules! abouts {
    ($($name:ident: $argument:ident, $owner:ident [$($quantity:ident * $count:literal),*], $about:literal;)*) => {
        /// Returns the meaning of an argument array, with its unit.
        fn about(array: &str) -> &'static str {
            match array {
                $(stringify!($name) => $about,)*
                _ => "Parameters of the robot file that are given at run time, in the order of the list at the top.",
            }
        }
    };
}

argument_parts!(abouts);

/// A program in the form that its kernels compute, with its arrays.
pub(super) struct Kernel<'p> {
    pub(super) program: Cow<'p, Program>,
    pub(super) precision: Precision,
    pub(super) arrays: Vec<ArgumentArray>,
    /// The literals of the constants.
    pub(super) literals: HashMap<ValueId, String>,
}

impl<'p> Kernel<'p> {
    /// Prepares a program as the machine does: in the reduced form a product and the sum to which it is added are
    /// rounded once; in the seven steps the product is rounded by itself.
    pub(super) fn of(program: &'p Program, precision: Precision) -> Result<Self, ConstantTooLarge> {
        let arrays = program.argument_arrays();
        let program = match program.form {
            Form::Reduced => Cow::Owned(fma::fused(program, Fusing::All)),
            Form::SevenSteps => Cow::Borrowed(program),
        };
        let mut literals = HashMap::new();
        for (id, value) in program.values.iter() {
            let Value::Constant(number) = value else { continue };
            let too_large = |name| ConstantTooLarge { name, value: number, function: program.function };
            let literal = literal(precision, number);
            match (literal, program.values.name(id)) {
                (Some(literal), _) => literals.insert(id, literal),
                (None, Some(name)) => return Err(too_large(name)),
                (None, None) => None,
            };
        }
        Ok(Self { program, precision, arrays, literals })
    }

    /// Returns the number type, and the number of bytes of a number.
    pub(super) fn number(&self) -> (&'static str, usize) {
        if self.precision == Precision::Double { ("f64", 8) } else { ("f32", 4) }
    }

    /// Returns the text of the kernel with this name.
    pub(super) fn text(&self, name: &str, arrangement: Arrangement) -> String {
        let (real, bytes) = self.number();
        let arrays = self.arrays.iter().map(|array| (format!("in_{}", array.name), array.elements.len()));
        let is_used = self.arrays.iter().map(|array| array.elements.iter().any(Option::is_some));
        let arrays: Vec<_> = arrays.zip(is_used).map(|((name, length), is_used)| (name, length, is_used)).collect();
        let outputs = self.program.outputs.len();
        let staged: usize = arrays.iter().filter(|(.., is_used)| *is_used).map(|(_, length, _)| length).sum();
        let staged = (staged + outputs) * bytes * BLOCK;
        let is_staged = arrangement == Arrangement::Rows && outputs > WIDE && staged <= MOST_SHARED;
        let memory = if is_staged { "shared" } else { "global" };
        let mut writing = Writing::of(self, arrangement, memory);
        writing.values(true);
        let Writing { registers, addresses, body, .. } = writing;
        let names = arrays.iter().map(|(name, ..)| name.as_str()).chain(["out"]);
        let parameters: Vec<String> = names.map(|array| format!("    .param .u64 {array}")).collect();
        let block = if memory == "shared" { ".reqntid 64" } else { ".maxntid 256" };
        let mut text = format!(
            ".visible .entry {name}(\n{},\n    .param .u32 states)\n{block}, 1, 1\n{{\n",
            parameters.join(",\n")
        );
        let registers = fill(&registers.join(", "), WIDTH, &format!("    .reg .{real} "), "        ");
        let _ = write!(
            text,
            "{registers};\n    .reg .u32 %index, %block, %width, %states;\n    .reg .u64 %a<{}>;\n    \
             .reg .pred %is_beyond, %is_above, %is_below;\n    mov.u32 %block, %ctaid.x;\n    \
             mov.u32 %index, %tid.x;\n    ld.param.u32 %states, [states];\n",
            addresses + 1
        );
        if memory == "shared" {
            let staging = Staging { arrays, outputs, real, bytes };
            return text + &staging.before(staged) + &body + &staging.after() + "    ret;\n}\n";
        }
        text.push_str(
            "    mov.u32 %width, %ntid.x;\n    mad.lo.u32 %index, %block, %width, %index;\n    \
             setp.ge.u32 %is_beyond, %index, %states;\n    @%is_beyond ret;\n",
        );
        for (array, length, _) in arrays.into_iter().chain([("out".to_owned(), outputs, true)]) {
            let step = if arrangement == Arrangement::Columns { bytes } else { length * bytes };
            let _ = writeln!(
                text,
                "    .reg .u64 %{array};\n    ld.param.u64 %{array}, [{array}];\n    \
                 cvta.to.global.u64 %{array}, %{array};\n    mad.wide.u32 %{array}, %index, {step}, %{array};"
            );
        }
        text + &body + "    ret;\n}\n"
    }
}

/// Returns a comment with the function, its form, its operations and its arrays.
pub(crate) fn heading(program: &Program) -> String {
    let mut text = comment("//", &format!("{}: {}", program.name, program.function.summary()));
    if !program.function.details().is_empty() {
        text.push_str(&comment("//", program.function.details()));
    }
    let count = program.operations();
    let _ = writeln!(
        text,
        "//\n// Form {}: {} products, {} sums, {} divisions, {} angles; {} instructions with fused products.\n//",
        program.form,
        count.mul,
        count.add,
        count.div,
        count.sincos,
        fma::instructions(program)
    );
    for ArgumentArray { name, elements, .. } in program.argument_arrays() {
        text.push_str(&comment("//", &format!("{name}[{}]: {}", elements.len(), about(name))));
    }
    let output = program.function.entry().output;
    let layout = program.layout();
    let of = shape(if output.is_empty() { "result" } else { output }, &layout);
    let elements = if layout.len() == 1 { "1 element" } else { &format!("{} elements", layout.len()) };
    text + &comment("//", &format!("Results, {elements}: {of}."))
}

/// Returns a number as an exact literal of its type, in hexadecimal.
fn literal(precision: Precision, value: f64) -> Option<String> {
    match precision {
        Precision::Double => value.is_finite().then(|| format!("0d{:016X}", value.to_bits())),
        Precision::Single => {
            #[allow(clippy::cast_possible_truncation)] // rounded once, as the runtime's `from_f64` rounds
            let value = value as f32;
            value.is_finite().then(|| format!("0f{:08X}", value.to_bits()))
        }
    }
}

/// Returns the parts of a result in their order, with their lengths.
fn shape(name: &str, layout: &Layout) -> String {
    let (lengths, of) = elements_of(layout);
    match of {
        Layout::Record(record, parts) => {
            let parts = record.fields().iter().zip(parts).map(|(field, part)| shape(field, part));
            format!("{name}{lengths} of ({})", parts.collect::<Vec<_>>().join(", "))
        }
        _ => format!("{name}{lengths}"),
    }
}

/// Copies rows through the memory that the threads of a block share: the threads together read and write the rows of
/// the block number after number, and each thread reads its own row in shared memory.
struct Staging {
    /// The name and the length of each argument, and whether it is used.
    arrays: Vec<(String, usize, bool)>,
    outputs: usize,
    real: &'static str,
    bytes: usize,
}

impl Staging {
    /// Returns code that copies the rows of the block to shared memory, and computes the addresses of a thread's own
    /// rows. The results of threads beyond the last state are not used.
    fn before(&self, size: usize) -> String {
        let Self { arrays, outputs, real, bytes } = self;
        let mut text = format!(
            "    .shared .align 8 .b8 rows[{size}];\n    .reg .u32 %first, %count, %left, %own, %shared;\n    \
             .reg .u64 %global;\n    .reg .{real} %number;\n    shl.b32 %first, %block, 6;\n    \
             sub.s32 %count, %states, %first;\n    min.s32 %count, %count, {BLOCK};\n    mov.u32 %shared, rows;\n    \
             mad.lo.u32 %own, %index, {bytes}, %shared;\n"
        );
        let mut start = 0;
        for (array, length, _) in arrays.iter().filter(|(.., is_used)| *is_used) {
            text.push_str(&self.chunk(array, *length));
            for k in 0..*length {
                let (offset, at) = (k * BLOCK * bytes, k * BLOCK);
                let _ = writeln!(
                    text,
                    "    setp.gt.s32 %is_beyond, %left, {at};\n    \
                     @%is_beyond ld.global.nc.{real} %number, [%global+{offset}];\n    \
                     @%is_beyond st.shared.{real} [%own+{}], %number;",
                    start + offset
                );
            }
            start += length * BLOCK * bytes;
        }
        text.push_str("    bar.sync 0;\n");
        let mut start = 0;
        let results = ("out".to_owned(), *outputs, true);
        for (array, length, _) in arrays.iter().filter(|(.., is_used)| *is_used).chain([&results]) {
            let _ = writeln!(
                text,
                "    .reg .u32 %{array};\n    mad.lo.u32 %{array}, %index, {}, %shared;\n    \
                 add.u32 %{array}, %{array}, {start};",
                length * bytes
            );
            start += length * BLOCK * bytes;
        }
        text
    }

    /// Returns code that copies the results of the block from shared memory.
    fn after(&self) -> String {
        let Self { arrays, outputs, real, bytes } = self;
        let start: usize = arrays.iter().filter(|(.., is_used)| *is_used).map(|(_, length, _)| length).sum();
        let mut text = "    bar.sync 0;\n".to_owned() + &self.chunk("out", *outputs);
        for k in 0..*outputs {
            let (offset, at) = (k * BLOCK * bytes, k * BLOCK);
            let _ = writeln!(
                text,
                "    setp.gt.s32 %is_beyond, %left, {at};\n    \
                 @%is_beyond ld.shared.{real} %number, [%own+{}];\n    \
                 @%is_beyond st.global.{real} [%global+{offset}], %number;",
                start * BLOCK * bytes + offset
            );
        }
        text
    }

    /// Returns code for the address of the first number of an array that a thread copies, and for how many numbers are
    /// left from there to the end.
    fn chunk(&self, array: &str, length: usize) -> String {
        let bytes = self.bytes;
        format!(
            "    ld.param.u64 %global, [{array}];\n    cvta.to.global.u64 %global, %global;\n    \
             mad.wide.u32 %global, %first, {}, %global;\n    mad.wide.u32 %global, %index, {bytes}, %global;\n    \
             mul.lo.s32 %left, %count, {length};\n    sub.s32 %left, %left, %index;\n",
            length * bytes
        )
    }
}
