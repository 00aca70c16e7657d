//! Builds and reads the generated code for RISC-V, without running it.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use crate::{functions, object_file, tools};

/// Target with single-precision registers and compressed instructions.
const TARGET: &str = "riscv32imafc-unknown-none-elf";

/// The counts from the listing.
pub(crate) struct Counts {
    /// Number of functions, which all are straight-line code.
    pub(crate) functions: usize,
    /// Instructions of the PUMA 560, seven steps and reduced.
    pub(crate) puma560: [usize; 2],
}

/// Fails if a function calls, branches, or computes in double precision.
pub(crate) fn examine(workspace: &Path) -> Result<Counts> {
    let object = object_file::build(workspace, TARGET, &["-Zmerge-functions=disabled"], &[])?;
    let listing = tools::riscv_objdump(&object)?;
    let mut counts = Counts { functions: 0, puma560: [0; 2] };
    for functions::Robot { name, form, .. } in functions::robots() {
        let path = format!("robots::torques::{name}::{form}::inverse_dynamics");
        let function = lines(&listing, &path).with_context(|| format!("the object file has no {path}"))?;
        let (last, others) = function.split_last().with_context(|| format!("{path} is empty"))?;
        ensure!(last == "ret", "{path} ends with `{last}`");
        if let Some(line) = others.iter().find(|line| !is_straight(line)) {
            anyhow::bail!("{path} is not straight: {line}");
        }
        counts.functions += 1;
        if name == "puma560" {
            counts.puma560[usize::from(form == "reduced")] = function.len();
        }
    }
    Ok(counts)
}

/// Returns the instructions of a function, with mnemonics and operands.
fn lines(listing: &str, path: &str) -> Option<Vec<String>> {
    let mut lines = listing.lines().skip_while(|line| {
        let symbol = line.strip_suffix(">:").and_then(|line| line.split_once(" <"));
        symbol.is_none_or(|(_, symbol)| format!("{:#}", rustc_demangle::demangle(symbol)) != path)
    });
    lines.next()?;
    let function = lines.take_while(|line| !line.trim().is_empty());
    Some(function.filter_map(|line| Some(line.split_once(":\t")?.1.replace('\t', " "))).collect())
}

/// Whether an instruction is no jump, branch, call or trap, and does not compute in double precision.
fn is_straight(line: &str) -> bool {
    let name = line.split(' ').next().unwrap_or_default();
    let jumps = ["b", "j", "c.b", "c.j", "call", "tail", "ret", "e", "unimp"].iter().any(|stem| name.starts_with(stem));
    let is_double = name.rsplit('.').next() == Some("d");
    !jumps && !is_double
}

#[cfg(test)]
mod tests {
    use super::is_straight;

    #[test]
    fn jumps_are_told_from_the_rest() {
        for line in ["flw fa5,0(a1)", "fmul.s fa4,fa4,fa5", "addi sp,sp,-64", "lui a0,0x0", "xor a0,a0,a1"] {
            assert!(is_straight(line), "{line}");
        }
        for line in ["beqz a0,4", "bltu a0,a1,4", "j 4", "jal ra,4", "jr a5", "call 4", "ebreak", "fadd.d fa0,fa0,fa1"]
        {
            assert!(!is_straight(line), "{line}");
        }
    }
}
