//! Computes the worst case of straight-line code in cycles of a processor.
//!
//! A table gives the cycles of each instruction, and a rule adds a cycle if the next instruction waits for a result.
//! Straight-line code executes each instruction once, so the sum is the worst case for a processor for which the table
//! is correct.

use serde::Serialize;

use std::collections::BTreeMap;

use crate::listing::Line;

/// A processor with a floating-point unit for single precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// Cortex-M4F.
    M4,
    /// Cortex-M7F.
    M7,
}

/// A kind of instruction with its cycles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Sum,
    Product,
    Accumulation,
    Quotient,
    Move,
    Transfer,
    Load,
    Store,
    Several,
    Integer,
    Call,
    Return,
    Branch,
}

/// Instructions of one kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Class {
    /// The kind in words.
    pub what: &'static str,
    /// The mnemonics of this kind that occur.
    pub mnemonics: Vec<String>,
    /// Number of instructions.
    pub instructions: u64,
    /// The cycles of all of them.
    pub cycles: u64,
}

/// The cycles of a call.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cycles {
    /// The sum of the cycles.
    pub total: u64,
    /// Number of these cycles in which the next instruction waits for a result.
    pub waits: u64,
    /// The kinds of instructions.
    pub classes: Vec<Class>,
    /// Mnemonics that are not in the table; they count as the slowest instruction.
    pub unknown: Vec<String>,
}

/// Adds the cycles of several straight-line functions.
#[derive(Clone, Debug, Default)]
pub struct Counter {
    waits: u64,
    kinds: BTreeMap<Kind, (BTreeMap<String, u64>, u64)>,
    unknown: BTreeMap<String, u64>,
    unknown_cycles: u64,
}

/// The cycles of an instruction that is not in the table.
const SLOWEST: u64 = 16;

impl Core {
    /// Returns the name of the core for `-mcpu`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::M4 => "cortex-m4",
            Self::M7 => "cortex-m7",
        }
    }

    /// Returns the core with this name for `-mcpu`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [Self::M4, Self::M7].into_iter().find(|core| core.name() == name)
    }

    /// Returns the options of a C compiler for the core.
    #[must_use]
    pub const fn flags(self) -> [&'static str; 4] {
        match self {
            Self::M4 => ["-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"],
            Self::M7 => ["-mcpu=cortex-m7", "-mthumb", "-mfpu=fpv5-sp-d16", "-mfloat-abi=hard"],
        }
    }

    /// Returns QEMU's name of a board with the core.
    #[must_use]
    pub const fn machine(self) -> &'static str {
        match self {
            Self::M4 => "mps2-an386",
            Self::M7 => "mps2-an500",
        }
    }

    /// Returns the meaning of the cycles in words: a worst case, or an estimate of it.
    #[must_use]
    pub const fn bound(self) -> &'static str {
        match self {
            Self::M4 => "worst case by the assumptions below",
            Self::M7 => "an estimate above the worst case: Arm publishes no table",
        }
    }

    /// Returns the assumptions under which the cycles are correct, a sentence each.
    #[must_use]
    pub fn assumptions(self) -> Vec<&'static str> {
        let mut assumptions = vec![
            "Flash and RAM have no wait states, and no cache misses: code and constants are in zero-wait memory.",
            "No interrupt comes during the call.",
        ];
        assumptions.extend(match self {
            Self::M4 => [
                "Cycles are those of the Cortex-M4 Technical Reference Manual (Arm 100166, instruction set summary and \
                 FPU instruction set): vadd, vsub, vmul, vneg, vabs, vmov 1; vmov between the core and the FPU 2; \
                 vmla, vmls, vfma 3; vdiv, vsqrt 14; load and store of a word 2; of N words 1 + N; branch 1 + P with \
                 P = 3, the largest refill of the pipeline.",
                "An arithmetic instruction of the FPU takes one cycle more if the next instruction uses its result.",
                "Loads and stores in a row may overlap on the processor; the count does not use this.",
            ],
            Self::M7 => [
                "Arm publishes no table of cycles for the Cortex-M7. The count takes each instruction alone, with its \
                 whole latency, as if no two instructions overlapped. Latencies of the FPU are those of LLVM's model \
                 of this core (ARMScheduleM7.td): vadd, vsub, vmul, vneg 3; vmla, vfma 6; vdiv, vsqrt 16. Estimates \
                 are: vmov between the core and the FPU 3; load 3; store 1; of N words 2 + N; integer 1; branch 1 + P \
                 with P = 8.",
                "The processor executes up to two instructions per cycle, so a measured time is shorter.",
                "Measure this core with the cycle counter DWT_CYCCNT before you rely on the count.",
            ],
        });
        assumptions
    }

    #[allow(clippy::match_same_arms)] // a table: a line for a core and a kind
    const fn cycles(self, kind: Kind, registers: u64) -> u64 {
        match (self, kind) {
            (Self::M4, Kind::Sum | Kind::Product | Kind::Move | Kind::Integer) => 1,
            (Self::M4, Kind::Transfer) => 2,
            (Self::M4, Kind::Accumulation) => 3,
            (Self::M4, Kind::Quotient) => 14,
            (Self::M4, Kind::Load | Kind::Store) => 2,
            (Self::M4, Kind::Several) => 1 + registers,
            (Self::M4, Kind::Call | Kind::Branch) => 4,
            (Self::M4, Kind::Return) => 4 + registers,
            (Self::M7, Kind::Sum | Kind::Product | Kind::Load | Kind::Transfer) => 3,
            (Self::M7, Kind::Accumulation) => 6,
            (Self::M7, Kind::Quotient) => 16,
            (Self::M7, Kind::Move | Kind::Store | Kind::Integer) => 1,
            (Self::M7, Kind::Several) => 2 + registers,
            (Self::M7, Kind::Call | Kind::Branch) => 9,
            (Self::M7, Kind::Return) => 9 + registers,
        }
    }
}

impl Kind {
    const fn what(self) -> &'static str {
        match self {
            Self::Sum => "sum, difference, sign, conversion",
            Self::Product => "product",
            Self::Accumulation => "product and sum",
            Self::Quotient => "quotient, square root",
            Self::Move => "move between registers, constant",
            Self::Transfer => "move between the core and the FPU",
            Self::Load => "load of a word",
            Self::Store => "store of a word",
            Self::Several => "load or store of several words",
            Self::Integer => "integer instruction",
            Self::Call => "call",
            Self::Return => "return",
            Self::Branch => "branch over constants",
        }
    }

    /// Returns the kind of an instruction, and how many registers it moves.
    fn of(line: &Line) -> Option<(Self, u64)> {
        let name = line.name();
        // removes suffixes, as of vmul.f32 and vmul.f32.n
        let stem = name.split('.').next().unwrap_or(name);
        let registers = registers(line.operands());
        Some(match stem {
            "vadd" | "vsub" | "vneg" | "vabs" | "vcmp" | "vcmpe" | "vcvt" | "vmrs" | "vsel" => (Self::Sum, 1),
            "vmul" | "vnmul" => (Self::Product, 1),
            "vmla" | "vmls" | "vnmla" | "vnmls" | "vfma" | "vfms" | "vfnma" | "vfnms" => (Self::Accumulation, 1),
            "vdiv" | "vsqrt" => (Self::Quotient, 1),
            "vmov" if line.operands().split(',').any(is_core_register) => (Self::Transfer, 1),
            "vmov" => (Self::Move, 1),
            "vldr" | "ldr" | "ldrb" | "ldrh" | "ldrd" if line.operands() == "pc, [sp], #4" => (Self::Return, 1),
            "ldrd" | "strd" => (Self::Several, 2),
            "vldr" | "vstr" if line.operands().starts_with('d') => (Self::Several, 2),
            "vldr" | "ldr" | "ldrb" | "ldrh" => (Self::Load, 1),
            "vstr" | "str" | "strb" | "strh" => (Self::Store, 1),
            "pop" | "ldmia" if line.operands().contains("pc}") => (Self::Return, registers),
            "vpush" | "vpop" | "vldmia" | "vstmia" | "vldmdb" | "vstmdb" | "push" | "pop" | "ldmia" | "stmia"
            | "ldmdb" | "stmdb" => (Self::Several, registers),
            "bx" => (Self::Return, 0),
            "bl" | "blx" => (Self::Call, 0),
            "b" => (Self::Branch, 0),
            "mov" | "movs" | "movw" | "movt" | "mvn" | "add" | "adds" | "addw" | "sub" | "subs" | "subw" | "rsb"
            | "rsbs" | "and" | "ands" | "orr" | "orrs" | "eor" | "eors" | "bic" | "bics" | "lsl" | "lsls" | "lsr"
            | "lsrs" | "asr" | "asrs" | "ror" | "ubfx" | "sbfx" | "bfi" | "uxtb" | "uxth" | "sxtb" | "sxth" | "adr"
            | "cmp" | "tst" | "it" | "nop" | "negs" | "mvns" | "mul" | "sbfiz" | "orn" => (Self::Integer, 1),
            _ => return None,
        })
    }

    /// Whether the next instruction waits a cycle for the result.
    const fn is_arithmetic(self) -> bool {
        matches!(self, Self::Sum | Self::Product | Self::Accumulation | Self::Quotient)
    }
}

impl Counter {
    /// Adds the instructions of a straight-line function.
    pub fn add(&mut self, core: Core, lines: &[Line]) {
        let last = lines.iter().rposition(|line| line.data() == 0 && !line.is_padding());
        let mut code = lines.iter().take(last.map_or(0, |last| last + 1)).filter(|line| line.data() == 0).peekable();
        let mut skipped_to = 0;
        while let Some(line) = code.next() {
            if line.address() < skipped_to {
                continue; // what a branch over constants leaps is not executed
            }
            skipped_to = line.target().unwrap_or(skipped_to);
            let Some((kind, registers)) = Kind::of(line) else {
                *self.unknown.entry(line.mnemonic().to_owned()).or_default() += 1;
                self.unknown_cycles += SLOWEST;
                continue;
            };
            let (mnemonics, cycles) = self.kinds.entry(kind).or_default();
            *mnemonics.entry(line.mnemonic().to_owned()).or_default() += 1;
            *cycles += core.cycles(kind, registers);
            if core == Core::M4 && kind.is_arithmetic() && code.peek().is_some_and(|next| is_read(line, next)) {
                self.waits += 1;
            }
        }
    }

    /// Returns the sum of all functions.
    #[must_use]
    pub fn cycles(&self) -> Cycles {
        let classes: Vec<Class> = self
            .kinds
            .iter()
            .map(|(kind, (mnemonics, cycles))| Class {
                what: kind.what(),
                mnemonics: mnemonics.keys().cloned().collect(),
                instructions: mnemonics.values().sum(),
                cycles: *cycles,
            })
            .collect();
        let total = classes.iter().map(|class| class.cycles).sum::<u64>() + self.waits + self.unknown_cycles;
        Cycles { total, waits: self.waits, classes, unknown: self.unknown.keys().cloned().collect() }
    }
}

/// Whether the next instruction reads the result, which is the first operand, of an instruction. An instruction that
/// accumulates also reads its destination.
fn is_read(line: &Line, next: &Line) -> bool {
    let result = line.operands().split(',').next().unwrap_or_default().trim();
    let mut operands = next.operands().split([',', '{', '}', '-', ' ']).map(str::trim).filter(|word| !word.is_empty());
    let writes_only = matches!(
        Kind::of(next),
        Some((
            Kind::Sum | Kind::Product | Kind::Quotient | Kind::Move | Kind::Transfer | Kind::Load | Kind::Integer,
            _
        ))
    ) && !next.name().starts_with("vcmp");
    if writes_only {
        operands.next();
    }
    let in_range = || {
        // a range of registers, as in vpush {s16-s31}
        let number = |word: &str| word.trim().strip_prefix('s')?.parse::<u32>().ok();
        let range = next.operands().split(['{', '}']).nth(1).and_then(|list| list.split_once('-'));
        range.is_some_and(|(low, high)| {
            matches!((number(low), number(result), number(high)), (Some(a), Some(x), Some(b)) if (a..=b).contains(&x))
        })
    };
    operands.any(|word| word == result) || in_range()
}

/// Whether an operand of `vmov` is a register of the core: neither a register of the FPU, such as `s0` and `d8`, nor a
/// constant.
fn is_core_register(operand: &str) -> bool {
    let operand = operand.trim();
    let is_of_fpu = operand.strip_prefix(['s', 'd']).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    !is_of_fpu && !operand.starts_with('#')
}

/// Returns the number of registers in a list such as `{r4, r5, pc}` or `{s16-s31}`.
fn registers(operands: &str) -> u64 {
    let Some(list) = operands.split(['{', '}']).nth(1) else { return 1 };
    let number = |word: &str| word.trim().get(1..).and_then(|digits| digits.parse::<u64>().ok());
    // a register of two words counts as two
    let words = if list.trim().starts_with('d') { 2 } else { 1 };
    list.split(',')
        .map(|part| match part.split_once('-') {
            Some((low, high)) => match (number(low), number(high)) {
                (Some(low), Some(high)) => words * (high + 1).saturating_sub(low),
                _ => words,
            },
            None => words,
        })
        .sum()
}

/// Returns the bytes of stack of a straight-line function from its instructions: the registers that it pushes, and what
/// it subtracts from the stack pointer.
#[must_use]
pub fn stack(lines: &[Line]) -> u64 {
    let bytes = |text: &str| text.trim().trim_start_matches('#').parse::<u64>().unwrap_or(0);
    lines
        .iter()
        .map(|line| match line.name() {
            "push" | "vpush" => 4 * registers(line.operands()),
            "stmdb" if line.operands().starts_with("sp!") => 4 * registers(line.operands()),
            "sub" | "subs" | "subw" if line.operands().starts_with("sp,") => {
                bytes(line.operands().rsplit(',').next().unwrap_or_default())
            }
            "str" => line
                .operands()
                .split_once("[sp, #-")
                .map_or(0, |(_, rest)| rest.split_once("]!").map_or(0, |(number, _)| bytes(number))),
            _ => 0,
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::{Core, Counter, stack};
    use crate::listing::{Line, functions};

    fn lines(listing: &str) -> Vec<Line> {
        functions(&format!("00000100 <f>:\n{listing}")).expect("a listing").remove("f").expect("the function")
    }

    fn cycles(core: Core, listing: &str) -> u64 {
        let mut counter = Counter::default();
        counter.add(core, &lines(listing));
        counter.cycles().total
    }

    #[test]
    fn cycles_are_those_of_the_manual() {
        // 2 + 1 + 1 + 3 + 14 + 2 + 4 cycles; vdiv waits for vmla, and vstr for vdiv
        let listing = "     100:\tvldr\ts0, [r0]\n     104:\tvmul.f32\ts1, s0, s0\n     108:\tvadd.f32\ts2, s0, s0\n   \
                         10c:\tvmla.f32\ts3, s0, s0\n     110:\tvdiv.f32\ts4, s3, s1\n     114:\tvstr\ts4, [r1]\n     \
                       118:\tbx\tlr\n";
        assert_eq!(cycles(Core::M4, listing), 27 + 2);
        assert_eq!(cycles(Core::M7, listing), 3 + 3 + 3 + 6 + 16 + 1 + 9);
    }

    /// By the manual, moving a float between the core and the FPU takes two cycles, and loading a double takes three.
    #[test]
    fn moves_between_the_core_and_the_fpu_take_two_cycles() {
        for (instruction, [m4, m7]) in [
            ("vmov.f32\ts0, s1", [1, 1]),
            ("vmov.f32\ts0, #112\t@ 0x3f800000", [1, 1]),
            ("vmov\ts0, r0", [2, 3]),
            ("vmov\tlr, s15", [2, 3]),
            ("vldr\ts0, [r0]", [2, 3]),
            ("vldr\td8, [r0]", [3, 4]),
        ] {
            let listing = format!("     100:\t{instruction}\n     104:\tbx\tlr\n");
            let found = [Core::M4, Core::M7].map(|core| cycles(core, &listing) - cycles(core, "     104:\tbx\tlr\n"));
            assert_eq!(found, [m4, m7], "{instruction}");
        }
    }

    #[test]
    fn what_a_branch_leaps_takes_no_time() {
        let listing = "     100:\tb.n\t10c <f+0xc>\n     102:\tnop\n     104:\t.word\t0x3f800000\n     \
                       108:\t.word\t0\n     10c:\tbx\tlr\n";
        assert_eq!(cycles(Core::M4, listing), 8);
    }

    #[test]
    fn what_no_table_knows_is_told_and_slow() {
        let mut counter = Counter::default();
        counter.add(Core::M4, &lines("     100:\tsmlal\tr0, r1, r2, r3\n     104:\tbx\tlr\n"));
        let cycles = counter.cycles();
        assert_eq!((cycles.total, cycles.unknown), (20, vec!["smlal".to_owned()]));
    }

    #[test]
    fn the_stack_is_what_is_pushed_and_subtracted() {
        let listing = "     100:\tpush\t{r4, r5, lr}\n     104:\tvpush\t{d8-d15}\n     108:\tvpush\t{s16-s17}\n     \
                       10c:\tsub\tsp, #36\t@ 0x24\n     10e:\tstr.w\tr4, [sp, #-8]!\n     110:\tbx\tlr\n";
        assert_eq!(stack(&lines(listing)), 12 + 64 + 8 + 36 + 8);
    }
}
