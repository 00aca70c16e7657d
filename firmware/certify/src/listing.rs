//! Reads machine code from the output of `objdump`, and checks whether a function is straight-line code: one path from
//! its first instruction to its return.

use std::collections::BTreeMap;
use std::fmt;

/// An instruction, or data between instructions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    address: u64,
    mnemonic: String,
    operands: String,
}

/// The reason why a function is not straight-line code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It calls a function; the text is the instruction.
    Calls(String),
    /// It branches; the text is the instruction.
    Branches(String),
    /// It computes in double precision; the text is the instruction.
    Doubles(String),
    /// It traps; the text is the instruction.
    Traps(String),
    /// It returns before its end.
    ReturnsElsewhere,
}

/// The numbers of instructions and constants of a straight-line function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Number of instructions. Each is executed exactly once.
    pub instructions: u64,
    /// Bytes of constants between the instructions; padding before constants counts as code.
    pub constants: u64,
}

/// The error for a line that does not have the form of `objdump`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoListing(String);

impl fmt::Display for NoListing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "this line of objdump has no address: {}", self.0)
    }
}

impl std::error::Error for NoListing {}

/// Reads the functions of an image, by their symbols.
///
/// # Errors
/// When a line has no address.
pub fn functions(objdump: &str) -> Result<BTreeMap<String, Vec<Line>>, NoListing> {
    let mut functions: BTreeMap<String, Vec<Line>> = BTreeMap::new();
    let mut current = None;
    for line in objdump.lines() {
        if let Some(symbol) = line.strip_suffix(">:").and_then(|line| line.split_once(" <")) {
            current = Some(functions.entry(symbol.1.to_owned()).or_default());
        } else if let (Some(function), Some((address, rest))) = (current.as_mut(), line.trim_start().split_once(":\t"))
        {
            let address = u64::from_str_radix(address, 16).map_err(|_| NoListing(line.to_owned()))?;
            let (mnemonic, operands) = rest.split_once('\t').unwrap_or((rest, ""));
            let operands = operands.split(['@', ';']).next().unwrap_or_default();
            let [mnemonic, operands] = [mnemonic, operands].map(|text| text.trim().to_owned());
            function.push(Line { address, mnemonic, operands });
        }
    }
    Ok(functions)
}

/// Returns the numbers of instructions and constants of a function, and all faults because of which it is not
/// straight-line code.
#[must_use]
pub fn judge(function: &[Line]) -> (Count, Vec<Fault>) {
    let mut count = Count::default();
    let mut faults = Vec::new();
    let last = function.iter().rposition(|line| line.data() == 0 && !line.is_padding());
    let mut target = 0;
    for (index, line) in function.iter().enumerate() {
        if line.data() > 0 || Some(index) > last || line.address < target && line.is_padding() {
            count.constants += line.data();
            continue;
        }
        count.instructions += 1;
        target = line.target().unwrap_or(target);
        match line.fault(&function[index + 1..]) {
            Some(fault) => faults.push(fault),
            None if line.is_return() != (Some(index) == last) => faults.push(Fault::ReturnsElsewhere),
            None => {}
        }
    }
    (count, faults)
}

const CONDITIONS: [&str; 16] =
    ["eq", "ne", "cs", "cc", "hs", "lo", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le"];

impl Line {
    /// The mnemonic as `objdump` prints it.
    #[must_use]
    pub fn mnemonic(&self) -> &str {
        &self.mnemonic
    }

    /// The operands as `objdump` prints them.
    #[must_use]
    pub fn operands(&self) -> &str {
        &self.operands
    }

    /// The mnemonic without the width of its encoding.
    #[must_use]
    pub fn name(&self) -> &str {
        self.mnemonic.strip_suffix(".n").or_else(|| self.mnemonic.strip_suffix(".w")).unwrap_or(&self.mnemonic)
    }

    /// Returns the number of bytes of data; 0 for an instruction.
    #[must_use]
    pub fn data(&self) -> u64 {
        match self.mnemonic.as_str() {
            ".word" => 4,
            ".short" => 2,
            ".byte" => 1,
            _ => 0,
        }
    }

    /// Whether the line is padding before the next function.
    #[must_use]
    pub fn is_padding(&self) -> bool {
        self.name() == "nop" || self.mnemonic == "..." || self.mnemonic == "movs" && self.operands == "r0, r0"
    }

    fn is_return(&self) -> bool {
        match self.name() {
            "bx" => self.operands == "lr",
            "pop" | "ldmia" => self.operands.ends_with("pc}"),
            "ldr" => self.operands == "pc, [sp], #4",
            _ => false,
        }
    }

    /// Returns the fault of an instruction, if any; `next` are the lines after it.
    fn fault(&self, next: &[Self]) -> Option<Fault> {
        let name = self.name();
        let text = || format!("{} {}", self.mnemonic, self.operands);
        let is_on_condition = |stem: &str| name.strip_prefix(stem).is_some_and(|rest| CONDITIONS.contains(&rest));
        if self.mnemonic.contains(".f64") {
            return Some(Fault::Doubles(text()));
        }
        if matches!(name, "cbz" | "cbnz" | "tbb" | "tbh") || is_on_condition("b") || is_on_condition("bx") {
            return Some(Fault::Branches(text()));
        }
        if matches!(name, "bl" | "blx") || is_on_condition("bl") || is_on_condition("blx") {
            return Some(Fault::Calls(text()));
        }
        if matches!(name, "udf" | "bkpt" | "svc") {
            return Some(Fault::Traps(text()));
        }
        if name == "b" {
            return (!self.skips_data(next)).then(|| Fault::Branches(text()));
        }
        let writes_pc = name == "bx" || self.operands.starts_with("pc,") || self.operands.contains("pc}");
        (writes_pc && !self.is_return()).then(|| Fault::Branches(text()))
    }

    /// Returns the address of the line.
    #[must_use]
    pub const fn address(&self) -> u64 {
        self.address
    }

    /// Returns the target of a jump.
    #[must_use]
    pub fn target(&self) -> Option<u64> {
        let target = self.operands.split(' ').next().filter(|_| self.name() == "b")?;
        u64::from_str_radix(target, 16).ok()
    }

    /// Whether a jump only skips data and padding before the next instruction.
    fn skips_data(&self, next: &[Self]) -> bool {
        let is_skipped = |line: &Self| line.data() > 0 || line.is_padding();
        let target = self.target();
        let over = next.iter().take_while(|line| Some(line.address) != target);
        target > Some(self.address)
            && next.iter().any(|line| Some(line.address) == target)
            && over.into_iter().all(is_skipped)
    }
}

impl Fault {
    /// Returns the called function, if the fault is a call.
    #[must_use]
    pub fn callee(&self) -> Option<&str> {
        let Self::Calls(line) = self else { return None };
        line.split_once('<')?.1.strip_suffix('>')
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Calls(line) => write!(f, "a call: {line}"),
            Self::Branches(line) => write!(f, "a branch: {line}"),
            Self::Doubles(line) => write!(f, "double precision: {line}"),
            Self::Traps(line) => write!(f, "a trap: {line}"),
            Self::ReturnsElsewhere => write!(f, "a return that is not the last instruction, or none"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Count, Fault, functions, judge};

    fn judged(listing: &str) -> Result<Count, Vec<Fault>> {
        let functions = functions(&format!("00000100 <f>:\n{listing}")).expect("a listing");
        let (count, faults) = judge(&functions["f"]);
        if faults.is_empty() { Ok(count) } else { Err(faults) }
    }

    #[test]
    fn a_jump_over_constants_is_no_branch() {
        let listing = "     100:\tvldr\ts0, [pc, #4]\t@ 108 <f+0x8>\n     104:\tb.n\t10c <f+0xc>\n     106:\tnop\n     \
                       108:\t.word\t0x3f800000\n     10c:\tnop\n     10e:\tbx\tlr\n";
        // of the two `nop`, the first is skipped
        assert_eq!(judged(listing), Ok(Count { instructions: 4, constants: 4 }));
    }

    #[test]
    fn a_jump_anywhere_else_is_one() {
        for target in ["100", "106", "200"] {
            let listing = format!(
                "     100:\tvldr\ts0, [r0]\n     104:\tb.n\t{target} <f>\n     106:\tmovs\tr0, #1\n     108:\tbx\tlr\n"
            );
            let is_next = target == "106";
            assert_eq!(judged(&listing).is_ok(), is_next, "{target}");
        }
    }

    #[test]
    fn faults_are_found() {
        for (line, what) in [
            ("bl\t200 <g>", "a call"),
            ("blx\tr3", "a call"),
            ("beq.n\t100 <f>", "a branch"),
            ("ble.w\t100 <f>", "a branch"),
            ("cbz\tr0, 100 <f>", "a branch"),
            ("tbb\t[pc, r0]", "a branch"),
            ("ldr\tpc, [r0]", "a return"),
            ("mov\tpc, r0", "a branch"),
            ("bxls\tlr", "a branch"),
            ("popeq\t{r4, pc}", "a branch"),
            ("vadd.f64\td0, d0, d1", "double precision"),
            ("udf\t#254", "a trap"),
            ("bx\tlr", "a return"),
        ] {
            let found = judged(&format!("     100:\t{line}\n     104:\tbx\tlr\n")).expect_err(line);
            let told = found[0].to_string();
            let as_expected = told.starts_with(what) || what == "a return" && told.starts_with("a branch");
            assert!(as_expected, "{line}: {told}");
        }
    }

    #[test]
    fn a_return_must_come() {
        assert_eq!(judged("     100:\tmovs\tr0, #1\n"), Err(vec![Fault::ReturnsElsewhere]));
    }
}
