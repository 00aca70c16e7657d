//! Counts the instructions in the loops of a batch, in the machine code of examples/batch_speed.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use anyhow::{Context, Result};
use clap::Args;
use regex_lite::Regex;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Counts the instructions in the loops of a batch, in the machine code of examples/batch_speed
///
/// A state's torques take two loops: sines and cosines of a register's angles, then the torques. For each: instructions
/// for one register of eight f64, how many of them compute with registers of 512 bits, load them, store them, or copy
/// one to another, and what the first take at least on a core that starts two of them per cycle, in cycles per state.
/// Needs objdump.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask batch-profile            build the example and print a table
  cargo xtask batch-profile PROGRAM    look at another program")]
pub(crate) struct BatchProfile {
    /// The program; examples/batch_speed in the release profile, unless told
    program: Option<PathBuf>,
}

const REGISTER: &str = "%zmm";
const STATES: f64 = 8.0;

impl BatchProfile {
    pub(crate) fn run(&self) -> Result<Verdict> {
        print!("{}", table(self.program.as_deref())?);
        Ok(Verdict::Holds)
    }
}

/// Returns a table of the loops.
fn table(program: Option<&Path>) -> Result<String> {
    if !machine::has("objdump") {
        return Err(Missing::error("there is no objdump (apt-get install binutils)"));
    }
    let shell = machine::shell()?;
    let program = if let Some(program) = program {
        // relative to the caller's folder, because objdump runs in that of the repository
        std::path::absolute(program)?
    } else {
        cmd!(shell, "cargo build --quiet --release --example batch_speed").quiet().run()?;
        machine::target_folder("target")?.join("release/examples/batch_speed")
    };
    let listing = cmd!(shell, "objdump -d --no-show-raw-insn --demangle {program}").quiet().read();
    let listing = listing.with_context(|| format!("{} is no program", program.display()))?;
    let mut text = "| instructions | arithmetic | loads | stores | copies | least cycles per state |\n".to_owned();
    text.push_str("|---:|---:|---:|---:|---:|---:|\n");
    for code in functions(&listing) {
        for Row { instructions, arithmetic, loads, stores, copies } in loops(&code).into_iter().filter_map(row) {
            #[allow(clippy::cast_precision_loss)] // small counts are exact
            let cycles = arithmetic as f64 / 2.0 / STATES;
            let cells = [instructions, arithmetic, loads, stores, copies].map(|count| count.to_string()).join(" | ");
            let _ = writeln!(text, "| {cells} | {cycles:.1} |");
        }
    }
    Ok(text)
}

/// The address of an instruction, and its text.
type Instruction<'a> = (&'a str, &'a str);

/// Returns the functions of a disassembly that use 512-bit registers.
fn functions(listing: &str) -> Vec<Vec<Instruction<'_>>> {
    let mut found: Vec<Vec<Instruction<'_>>> = Vec::new();
    for line in listing.lines() {
        if line.starts_with(|letter: char| letter.is_ascii_hexdigit()) && line.ends_with(">:") {
            found.push(Vec::new());
        } else if let Some((address, instruction)) = line.split_once(":\t")
            && let Some(code) = found.last_mut()
        {
            let instruction = instruction.split('#').next().unwrap_or_default().trim();
            code.push((address.trim(), instruction));
        }
    }
    found.retain(|code| code.iter().any(|(_, instruction)| instruction.contains(REGISTER)));
    found
}

/// Returns the innermost loops, each from the target of a backward jump to this jump.
fn loops<'a>(code: &'a [Instruction<'a>]) -> Vec<&'a [Instruction<'a>]> {
    let at: HashMap<&str, usize> = code.iter().enumerate().map(|(index, (address, _))| (*address, index)).collect();
    let target = |instruction: &str| {
        let mut words = instruction.split_whitespace();
        let is_jump = words.next().is_some_and(|name| name.starts_with('j'));
        words.next().filter(|_| is_jump).and_then(|address| at.get(address).copied())
    };
    let jumps = code.iter().enumerate().filter_map(|(end, (_, jump))| Some((target(jump)?, end)));
    let found: Vec<(usize, usize)> = jumps.filter(|(start, end)| start < end).collect();
    let has_inner =
        |outer: &(usize, usize)| found.iter().any(|inner| inner != outer && outer.0 <= inner.0 && inner.1 <= outer.1);
    found.iter().filter(|found| !has_inner(found)).map(|&(start, end)| &code[start..=end]).collect()
}

/// Numbers of instructions in a loop, by kind.
#[derive(Debug, PartialEq, Eq)]
struct Row {
    instructions: usize,
    arithmetic: usize,
    loads: usize,
    stores: usize,
    copies: usize,
}

/// Counts the instructions of a loop; `None` if it does not compute in double precision.
fn row(code: &[Instruction<'_>]) -> Option<Row> {
    static STORE: LazyLock<Regex> =
        LazyLock::new(|| Regex::new(r"%zmm\d+(\{%k\d\})?,[^,]*\([^()]*\)$").expect("a regular expression"));
    let vector: Vec<&str> = code.iter().map(|(_, text)| *text).filter(|text| text.contains(REGISTER)).collect();
    let is_store = |text: &str| STORE.is_match(text);
    let is_load = |text: &str| text.contains('(') && !is_store(text);
    // a load without arithmetic does not use an arithmetic unit
    let is_plain_load =
        |text: &str| is_load(text) && ["vmov", "vbroadcast", "vpbroadcast"].iter().any(|name| text.starts_with(name));
    let is_copy = |text: &str| text.starts_with("vmov") && !text.contains('(') && !text.contains("{%k");
    let count = |is: &dyn Fn(&str) -> bool| vector.iter().filter(|text| is(text)).count();
    let (loads, stores, copies) = (count(&is_load), count(&is_store), count(&is_copy));
    let arithmetic = vector.len() - stores - copies - count(&is_plain_load);
    let doubles = count(&|text| text.split_whitespace().next().is_some_and(|name| name.contains("pd")));
    let row = Row { instructions: code.len(), arithmetic, loads, stores, copies };
    (3 * doubles > vector.len() && arithmetic > 40).then_some(row)
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::{Row, functions, loops, row};

    #[test]
    fn the_innermost_loop_is_counted() {
        let mut listing = "\n0000000000001000 <rne::batch>:\n    1000:\tmov    %rsp,%rbp\n".to_owned();
        listing.push_str("    1004:\tvmovupd 0x40(%rax),%zmm1\n    1008:\tvmovapd %zmm1,%zmm2\n");
        for address in 0x2000..0x2029 {
            let _ = writeln!(listing, "    {address:x}:\tvmulpd (%rbx),%zmm1,%zmm3");
        }
        listing.push_str("    3000:\tvmovupd %zmm3,(%rcx,%rdx,8)\n    3004:\tjne    1004 <rne::batch+0x4>\n");
        listing.push_str("    3008:\tjb     1000 <rne::batch>\n");
        listing.push_str("\n0000000000004000 <main>:\n    4000:\tret\n");
        let functions = functions(&listing);
        assert_eq!(functions.len(), 1);
        let loops = loops(&functions[0]);
        assert_eq!(loops.len(), 1);
        let expected = Row { instructions: 45, arithmetic: 41, loads: 42, stores: 1, copies: 1 };
        assert_eq!(row(loops[0]), Some(expected));
        assert_eq!(row(&loops[0][..20]), None, "too short");
    }
}
