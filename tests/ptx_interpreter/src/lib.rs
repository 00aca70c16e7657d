//! An interpreter of the part of PTX that `rne emit --lang ptx` writes: it knows nothing of programs, so that a test
//! without a graphics card tells what a kernel computes. What it does not know it refuses by a panic.

use std::collections::{BTreeMap, HashMap};

/// A kernel as it was read.
#[derive(Debug)]
pub struct Kernel {
    parameters: Vec<Parameter>,
    code: Vec<Instruction>,
    registers: usize,
    /// Bytes of the memory that a block shares.
    shared: usize,
    /// Whether blocks have 64 threads, no more and no fewer.
    is_of_64: bool,
}

/// A parameter of a kernel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// The bytes of its value: 4 or 8.
    pub bytes: usize,
}

/// The memory of the card.
pub trait Memory {
    /// The number of some bytes at an address; panics where there is no such memory.
    fn load(&self, address: u64, bytes: usize) -> u64;

    /// Writes a number of some bytes to an address; panics where there is no such memory.
    fn store(&mut self, address: u64, bytes: usize, number: u64);
}

impl Memory for Vec<u8> {
    fn load(&self, address: u64, bytes: usize) -> u64 {
        let at = usize::try_from(address).expect("an address");
        let mut word = [0; 8];
        word[..bytes].copy_from_slice(&self[at..at + bytes]);
        u64::from_le_bytes(word)
    }

    fn store(&mut self, address: u64, bytes: usize, number: u64) {
        let at = usize::try_from(address).expect("an address");
        self[at..at + bytes].copy_from_slice(&number.to_le_bytes()[..bytes]);
    }
}

/// Where a thread is.
struct Thread {
    registers: Vec<Option<u64>>,
    next: usize,
}

#[derive(Debug)]
struct Instruction {
    /// The predicate under which it is executed.
    guard: Option<usize>,
    operation: String,
    operands: Vec<Operand>,
}

#[derive(Debug)]
enum Operand {
    Register(usize),
    Bits(u64),
    /// What a register holds, and an offset.
    Address(usize, u64),
    Parameter(String),
    /// `%tid.x` and the like.
    Special(String),
    /// The low and the high half of 64 bits.
    Halves(usize, usize),
    /// The place of an instruction in the code.
    Place(usize),
}

/// Reads all kernels of a module, by their names.
///
/// # Panics
/// When the text is not what `rne emit --lang ptx` writes.
#[must_use]
pub fn read(module: &str) -> HashMap<String, Kernel> {
    let code: String =
        module.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n");
    let mut directives = code.split(".visible .entry ");
    let head: Vec<&str> = directives.next().expect("directives").split_whitespace().collect();
    assert_eq!(head, [".version", "7.0", ".target", "sm_70", ".address_size", "64"]);
    directives.map(kernel).collect()
}

fn kernel(text: &str) -> (String, Kernel) {
    let (name, rest) = text.split_once('(').expect("parameters");
    let (parameters, rest) = rest.split_once(')').expect("the end of the parameters");
    let parameters: Vec<Parameter> = parameters
        .split(',')
        .map(|parameter| match parameter.split_whitespace().collect::<Vec<_>>()[..] {
            [".param", ".u64" | ".f64", name] => Parameter { name: name.to_owned(), bytes: 8 },
            [".param", ".u32" | ".f32", name] => Parameter { name: name.to_owned(), bytes: 4 },
            ref other => panic!("{other:?}"),
        })
        .collect();
    let rest = rest.trim();
    let required = rest.strip_prefix(".reqntid 64, 1, 1");
    let rest = required.or(rest.strip_prefix(".maxntid 256, 1, 1")).expect("the size of a block").trim();
    let body = rest.strip_prefix('{').and_then(|body| body.trim_end().strip_suffix('}')).expect("a body");
    // Braces of `{low, high}` stand in an instruction; others begin and end blocks, whose registers are new each time.
    let mut reading = Reading { registers: HashMap::new(), count: 0, labels: HashMap::new() };
    let mut shared = 0;
    let mut code = Vec::new();
    // the places of labels first, for branches lead forwards, too
    let mut place = 0;
    let statements = || body.split(';').map(|statement| statement.trim_start_matches(['{', '}', '\n', ' ']).trim());
    for statement in statements() {
        let (label, statement) = labelled(statement);
        reading.labels.extend(label.map(|label| (label.to_owned(), place)));
        place += usize::from(!statement.is_empty() && !statement.starts_with('.'));
    }
    for statement in statements() {
        let (_, statement) = labelled(statement);
        if let Some(size) = statement.strip_prefix(".shared .align 8 .b8 rows[") {
            shared = size.trim_end_matches(']').parse().expect("a size");
        } else if let Some(declared) = statement.strip_prefix(".reg ") {
            reading.declare(declared);
        } else if !statement.is_empty() {
            code.push(reading.instruction(statement));
        }
    }
    (name.to_owned(), Kernel { parameters, code, registers: reading.count, shared, is_of_64: required.is_some() })
}

/// A label before a statement, and the statement.
fn labelled(statement: &str) -> (Option<&str>, &str) {
    match statement.split_once(':') {
        Some((label, rest)) => (Some(label), rest.trim_start_matches(['{', '\n', ' '])),
        None => (None, statement),
    }
}

struct Reading {
    registers: HashMap<String, usize>,
    count: usize,
    labels: HashMap<String, usize>,
}

impl Reading {
    fn declare(&mut self, declared: &str) {
        let (_, names) = declared.split_once(char::is_whitespace).expect("a type");
        for name in names.split(',').map(str::trim) {
            let names = match name.split_once('<') {
                Some((stem, count)) => {
                    let count: usize = count.trim_end_matches('>').parse().expect("a number");
                    (0..count).map(|index| format!("{stem}{index}")).collect()
                }
                None => vec![name.to_owned()],
            };
            for name in names {
                // registers of blocks have plain names, and each block has its own
                let is_of_block = !name.starts_with(['%', '$']);
                let before = self.registers.insert(name, self.count);
                assert!(is_of_block || before.is_none(), "{declared}: declared twice");
                self.count += 1;
            }
        }
    }

    fn register(&self, name: &str) -> usize {
        *self.registers.get(name).unwrap_or_else(|| panic!("{name} is not declared"))
    }

    fn instruction(&self, text: &str) -> Instruction {
        let (guard, text) = match text.strip_prefix('@').and_then(|text| text.split_once(' ')) {
            Some((guard, text)) => (Some(self.register(guard)), text),
            None => (None, text),
        };
        let (operation, rest) = text.split_once(' ').unwrap_or((text, ""));
        let mut operands = Vec::new();
        let mut rest = rest.trim();
        while !rest.is_empty() {
            let end = match rest.strip_prefix('{') {
                Some(_) => rest.find('}').expect("the end of a pair") + 1,
                None => rest.find(',').unwrap_or(rest.len()),
            };
            operands.push(self.operand(rest[..end].trim()));
            rest = rest[end..].trim_start_matches(',').trim();
        }
        Instruction { guard, operation: operation.to_owned(), operands }
    }

    fn operand(&self, text: &str) -> Operand {
        if let Some(pair) = text.strip_prefix('{').and_then(|text| text.strip_suffix('}')) {
            let (low, high) = pair.split_once(',').expect("two halves");
            return Operand::Halves(self.register(low.trim()), self.register(high.trim()));
        }
        if let Some(place) = text.strip_prefix('[').and_then(|text| text.strip_suffix(']')) {
            let (base, offset) = place.split_once('+').unwrap_or((place, "0"));
            return match self.registers.get(base) {
                Some(register) => Operand::Address(*register, offset.parse().expect("an offset")),
                None => Operand::Parameter(base.to_owned()),
            };
        }
        if let Some(bits) = text.strip_prefix("0d").or(text.strip_prefix("0f")) {
            assert_eq!(bits.len(), if text.starts_with("0d") { 16 } else { 8 }, "{text}");
            return Operand::Bits(u64::from_str_radix(bits, 16).expect("bits"));
        }
        if text == "rows" {
            return Operand::Bits(0);
        }
        if ["%ctaid.x", "%ntid.x", "%tid.x"].contains(&text) {
            return Operand::Special(text.to_owned());
        }
        match (text.parse(), self.labels.get(text)) {
            (Ok(number), _) => Operand::Bits(number),
            (Err(_), Some(&place)) => Operand::Place(place),
            (Err(_), None) => Operand::Register(self.register(text)),
        }
    }
}

/// Numbers of a type, as bits of a register.
pub trait Real: Copy {
    /// Bytes of a number.
    const BYTES: usize;
    /// The number with these bits.
    fn of_bits(bits: u64) -> Self;
    /// The bits of the number.
    fn bits(self) -> u64;
}

macro_rules! real {
    ($type:ident, $bits:ident) => {
        impl Real for $type {
            const BYTES: usize = size_of::<$type>();
            fn of_bits(bits: u64) -> Self {
                Self::from_bits($bits::try_from(bits).expect("bits of this type"))
            }
            fn bits(self) -> u64 {
                self.to_bits().into()
            }
        }
    };
}
real!(f32, u32);
real!(f64, u64);

/// Bytes between arrays, and before the first: a kernel that reads at 0 reads nothing that exists.
const BETWEEN: u64 = 256;

/// The arrays of a launch, by their addresses: a kernel reads arguments alone, and writes results alone.
struct Arrays {
    parts: BTreeMap<u64, (Vec<u8>, Access)>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Access {
    Read,
    Write,
}

impl Arrays {
    fn add(&mut self, bytes: Vec<u8>, access: Access) -> u64 {
        let end = self.parts.last_key_value().map_or(0, |(start, (bytes, _))| start + bytes.len() as u64);
        let start = (end + BETWEEN).next_multiple_of(BETWEEN);
        self.parts.insert(start, (bytes, access));
        start
    }

    /// The array with these bytes, and where they begin in it.
    fn place(&self, address: u64, bytes: usize, access: Access) -> (u64, usize) {
        let found = self.parts.range(..=address).next_back();
        let inside = found.map(|(start, part)| (*start, usize::try_from(address - start).expect("an offset"), part));
        let inside = inside.filter(|(_, at, part)| at + bytes <= part.0.len() && part.1 == access);
        inside
            .map_or_else(|| panic!("{access:?} of {bytes} bytes at {address}: no array"), |(start, at, _)| (start, at))
    }
}

impl Memory for Arrays {
    fn load(&self, address: u64, bytes: usize) -> u64 {
        let (start, at) = self.place(address, bytes, Access::Read);
        self.parts[&start].0.load(at as u64, bytes)
    }

    fn store(&mut self, address: u64, bytes: usize, number: u64) {
        let (start, at) = self.place(address, bytes, Access::Write);
        self.parts.get_mut(&start).expect("an array").0.store(at as u64, bytes, number);
    }
}

impl Kernel {
    /// Its parameters.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The threads that a block must have, if it must have a certain number.
    #[must_use]
    pub fn required_width(&self) -> Option<u32> {
        self.is_of_64.then_some(64)
    }

    /// Runs blocks of `width` threads over the arguments; returns the array of results. An argument without a number
    /// has the address 0.
    ///
    /// # Panics
    /// When a thread does what no kernel may do.
    pub fn run<T: Real>(&self, arguments: &[Vec<T>], results: usize, states: u32, width: u32) -> Vec<T> {
        self.run_with(arguments, &[results], &[states.into()], width).remove(0)
    }

    /// As [`run`](Self::run), with several arrays of results and with other parameters, the last of which is the number
    /// of states.
    ///
    /// # Panics
    /// When a thread does what no kernel may do.
    pub fn run_with<T: Real>(
        &self,
        arguments: &[Vec<T>],
        results: &[usize],
        others: &[u64],
        width: u32,
    ) -> Vec<Vec<T>> {
        let mut memory = Arrays { parts: BTreeMap::new() };
        let mut values = Vec::new();
        for array in arguments {
            let bytes = array.iter().flat_map(|number| number.bits().to_le_bytes()[..T::BYTES].to_vec()).collect();
            values.push(if array.is_empty() { 0 } else { memory.add(bytes, Access::Read) });
        }
        // a number that no kernel computes
        let rooms = results.iter().map(|results| memory.add(vec![0xA5; results * T::BYTES], Access::Write));
        let starts: Vec<u64> = rooms.collect();
        values.extend(&starts);
        values.extend(others);
        let states = u32::try_from(*others.last().expect("the number of states")).expect("few");
        let width = if self.is_of_64 { 64 } else { width };
        // a block more than there are states for
        self.launch(&mut memory, &values, states.div_ceil(width) + 1, width);
        let numbers = |start: u64| {
            let bytes = memory.parts[&start].0.chunks_exact(T::BYTES);
            bytes.map(|number| T::of_bits(number.to_vec().load(0, T::BYTES))).collect()
        };
        starts.into_iter().map(numbers).collect()
    }

    /// Runs blocks of `width` threads; `parameters` has the bits of each parameter.
    ///
    /// # Panics
    /// When a thread does what no kernel may do, or the memory refuses an address.
    pub fn launch(&self, memory: &mut impl Memory, parameters: &[u64], blocks: u32, width: u32) {
        assert_eq!(parameters.len(), self.parameters.len(), "parameters");
        let names = self.parameters.iter().map(|parameter| parameter.name.as_str());
        let values: HashMap<&str, u64> = names.zip(parameters.iter().copied()).collect();
        for block in 0..blocks {
            // what a thread finds that no thread has written
            let mut shared = vec![0x5A_u8; self.shared];
            let thread = |_| Thread { registers: vec![None; self.registers], next: 0 };
            let mut threads: Vec<Thread> = (0..width).map(thread).collect();
            while threads.iter().any(|thread| thread.next < self.code.len()) {
                for (index, thread) in threads.iter_mut().enumerate() {
                    let place = [block, width, u32::try_from(index).expect("few")];
                    self.to_barrier(thread, memory, &mut shared, &values, place);
                }
            }
        }
    }

    /// Runs a thread to the next barrier, or to its end.
    fn to_barrier(
        &self,
        thread: &mut Thread,
        memory: &mut impl Memory,
        shared: &mut Vec<u8>,
        parameters: &HashMap<&str, u64>,
        [block, width, number]: [u32; 3],
    ) {
        let Thread { registers, next } = thread;
        while let Some(Instruction { guard, operation, operands }) = self.code.get(*next) {
            *next += 1;
            if guard.is_some_and(|guard| registers[guard].expect("a predicate") == 0) {
                continue;
            }
            let value = |index: usize| -> u64 {
                match &operands[index] {
                    Operand::Register(register) => registers[*register].expect("a value before it is used"),
                    Operand::Bits(bits) => *bits,
                    Operand::Parameter(name) => parameters[name.as_str()],
                    Operand::Address(register, offset) => registers[*register].expect("an address") + offset,
                    Operand::Special(name) => match name.as_str() {
                        "%ctaid.x" => block.into(),
                        "%ntid.x" => width.into(),
                        "%tid.x" => number.into(),
                        other => panic!("{other}"),
                    },
                    Operand::Place(place) => *place as u64,
                    Operand::Halves(low, high) => {
                        registers[*low].expect("a half") | registers[*high].expect("a half") << 32
                    }
                }
            };
            let result = match operation.as_str() {
                "ret" => {
                    *next = self.code.len();
                    return;
                }
                "bar.sync" => return,
                "bra" => {
                    *next = usize::try_from(value(0)).expect("a place");
                    continue;
                }
                "ld.global.nc.f32" | "ld.global.nc.f64" | "ld.shared.f32" | "ld.shared.f64" => {
                    let bytes = if operation.ends_with("64") { 8 } else { 4 };
                    let (is_shared, at) = (operation.starts_with("ld.shared"), value(1));
                    assert!(at.is_multiple_of(bytes as u64), "{bytes} bytes at {at}: not aligned");
                    if is_shared { shared.load(at, bytes) } else { memory.load(at, bytes) }
                }
                "st.global.f32" | "st.global.f64" | "st.shared.f32" | "st.shared.f64" => {
                    let bytes = if operation.ends_with("64") { 8 } else { 4 };
                    let at = value(0);
                    assert!(at.is_multiple_of(bytes as u64), "{bytes} bytes at {at}: not aligned");
                    if operation.starts_with("st.shared") {
                        shared.store(at, bytes, value(1));
                    } else {
                        memory.store(at, bytes, value(1));
                    }
                    continue;
                }
                other => computed(other, value),
            };
            match &operands[0] {
                Operand::Register(register) => registers[*register] = Some(result),
                Operand::Halves(low, high) => {
                    registers[*low] = Some(result & 0xFFFF_FFFF);
                    registers[*high] = Some(result >> 32);
                }
                _ => panic!("{operation} writes a register"),
            }
        }
    }
}

/// The result of an instruction that reads registers and writes one.
fn computed(operation: &str, value: impl Fn(usize) -> u64) -> u64 {
    let word = |index| u32::try_from(value(index)).expect("32 bits");
    let signed = |index| word(index).cast_signed();
    let double = |index| f64::from_bits(value(index));
    let single = |index| f32::from_bits(word(index));
    let of_double = |number: f64| number.to_bits();
    let of_single = |number: f32| u64::from(number.to_bits());
    match operation {
        "mov.u32" | "mov.u64" | "mov.b32" | "mov.b64" | "mov.f32" | "mov.f64" | "ld.param.u32" | "ld.param.u64"
        | "ld.param.f32" | "ld.param.f64" | "cvta.to.global.u64" => value(1),
        "mul.wide.u32" => u64::from(word(1)) * u64::from(word(2)),
        "mad.lo.u64" => value(1).wrapping_mul(value(2)).wrapping_add(value(3)),
        "add.u64" => value(1).wrapping_add(value(2)),
        "div.u32" => (word(1) / word(2)).into(),
        "mad.lo.u32" => word(1).wrapping_mul(word(2)).wrapping_add(word(3)).into(),
        "mad.wide.u32" => u64::from(word(1)) * u64::from(word(2)) + value(3),
        "mul.lo.s32" => signed(1).wrapping_mul(signed(2)).cast_unsigned().into(),
        "sub.s32" => signed(1).wrapping_sub(signed(2)).cast_unsigned().into(),
        "min.s32" => signed(1).min(signed(2)).cast_unsigned().into(),
        "setp.gt.s32" => u64::from(signed(1) > signed(2)),
        "add.u32" => word(1).wrapping_add(word(2)).into(),
        "and.b32" => (word(1) & word(2)).into(),
        "xor.b32" => (word(1) ^ word(2)).into(),
        "shl.b32" => word(1).checked_shl(word(2)).unwrap_or(0).into(),
        "setp.ge.u32" => u64::from(word(1) >= word(2)),
        "setp.ne.u32" => u64::from(word(1) != word(2)),
        "setp.gt.f64" => u64::from(double(1) > double(2)),
        "setp.lt.f64" => u64::from(double(1) < double(2)),
        "setp.gt.f32" => u64::from(single(1) > single(2)),
        "setp.lt.f32" => u64::from(single(1) < single(2)),
        "selp.f32" | "selp.f64" => {
            if value(3) == 0 {
                value(2)
            } else {
                value(1)
            }
        }
        "neg.f64" => of_double(-double(1)),
        "add.rn.f64" => of_double(double(1) + double(2)),
        "sub.rn.f64" => of_double(double(1) - double(2)),
        "mul.rn.f64" => of_double(double(1) * double(2)),
        "div.rn.f64" => of_double(double(1) / double(2)),
        "fma.rn.f64" => of_double(double(1).mul_add(double(2), double(3))),
        "neg.f32" => of_single(-single(1)),
        "add.rn.f32" => of_single(single(1) + single(2)),
        "sub.rn.f32" => of_single(single(1) - single(2)),
        "mul.rn.f32" => of_single(single(1) * single(2)),
        "div.rn.f32" => of_single(single(1) / single(2)),
        "fma.rn.f32" => of_single(single(1).mul_add(single(2), single(3))),
        other => panic!("{other} is not an instruction of this interpreter"),
    }
}
