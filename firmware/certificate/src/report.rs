//! `docs/embedded.md`: what was found out, and what it means.

use std::fmt::Write as _;

use crate::image::Figures;
use crate::log::Agreement;
use crate::riscv;
use crate::table::{Row, Table};

/// Everything that was found out.
pub(crate) struct Report {
    /// The version of QEMU.
    pub(crate) qemu: String,
    /// The tables: robots on the boards, functions of the PUMA 560, C.
    pub(crate) tables: Vec<Table>,
    /// Instructions of the loop over a baked-in table, and its agreement.
    pub(crate) runtime: (f64, Agreement),
    /// What was counted for RISC-V; `None` in a sample, of which no document is made.
    pub(crate) riscv: Option<riscv::Counts>,
    /// Numbers that WebAssembly and the host computed alike; `None` where it was left out.
    pub(crate) wasm: Option<usize>,
}

/// The headings of the tables, by which they are found again.
pub(crate) const M4F: &str = "Cortex-M4F";
pub(crate) const M7F: &str = "Cortex-M7F";
pub(crate) const FUSED: &str = "Cortex-M4F with fused multiply-add";
pub(crate) const METHODS: &str = "Every function of the PUMA 560 on the Cortex-M4F";
pub(crate) const C: &str = "C on the Cortex-M4F";

impl Report {
    /// The document.
    pub(crate) fn document(&self) -> String {
        let mut text = HEAD.replace("{qemu}", &self.qemu).replace("{states}", &robots::STATES.to_string());
        for table in &self.tables {
            text.push_str(&table.markdown());
            text.push('\n');
        }
        text.push_str(&self.comparison());
        text.push_str(&self.others());
        text
    }

    /// The rows of the PUMA 560, seven steps and reduced.
    pub(crate) fn puma560(&self, title: &str) -> Option<[Figures; 2]> {
        let table = self.tables.iter().find(|table| table.title == title)?;
        let row = |form: &str| table.rows.iter().find(|row: &&Row| row.name == "puma560" && row.form == form);
        Some([row("seven_steps")?.figures, row("reduced")?.figures])
    }

    /// The figures of a row.
    pub(crate) fn figures(&self, title: &str, name: &str, form: &str) -> Option<Figures> {
        let table = self.tables.iter().find(|table| table.title == title)?;
        table.rows.iter().find(|row| row.name == name && row.form == form).map(|row| row.figures)
    }

    fn comparison(&self) -> String {
        let (instructions, agreement) = self.runtime;
        let mut text = LOOP.replace("{agreement}", &agreement.to_string());
        text.push_str("| PUMA 560, one call | instructions | factor |\n|---|---:|---:|\n");
        let _ = writeln!(text, "| `rne::Arm`, a loop over a table in flash | {instructions:.0} | 1 |");
        for (form, figures) in ["seven_steps", "reduced"].iter().zip(self.puma560(M4F).into_iter().flatten()) {
            #[allow(clippy::cast_precision_loss)]
            let factor = instructions / figures.instructions as f64;
            let _ = writeln!(text, "| derived, `{form}` | {} | {factor:.1} |", figures.instructions);
        }
        text
    }

    fn others(&self) -> String {
        let Some(riscv) = &self.riscv else { return String::new() };
        let [seven_steps, reduced] = riscv.puma560;
        let mut text = format!(
            "\n## RISC-V and WebAssembly\n\n\
             - `riscv32imafc-unknown-none-elf`: {} functions are built, and none calls, branches or computes in double \
             precision.\n  PUMA 560: {seven_steps} instructions in `seven_steps`, {reduced} in `reduced`. \
             The code is read, but not run.\n",
            riscv.functions
        );
        let _ = match self.wasm {
            Some(numbers) => writeln!(
                text,
                "{WASM}, in Node: {numbers} torques (all robots, both forms, `f32` and `f64`) have the host's bits."
            ),
            None => writeln!(text, "{WITHOUT_NODE}"),
        };
        text
    }
}

/// Whether two documents have the same figures. One that was written without Node says so in a line.
pub(crate) fn is_same(committed: &str, document: &str) -> bool {
    let is_left_out = document.contains(WITHOUT_NODE);
    let lines = |text: &'_ str| -> Vec<String> {
        let lines = text.lines().filter(|line| !(is_left_out && line.starts_with(WASM)));
        lines.map(str::to_owned).collect()
    };
    lines(committed) == lines(document)
}

const WASM: &str = "- `wasm32-unknown-unknown`";
const WITHOUT_NODE: &str = "- `wasm32-unknown-unknown`: not compared, because there is no Node.";

const HEAD: &str = "\
# Generated code on microcontrollers

`cargo xtask certificate --update` writes this page. `cargo xtask certificate` builds, reads and runs everything again,
and fails if a certified property no longer holds.

The page covers every shipped robot, in `f32`, with sines and cosines. The image is built for a board, and `objdump`
lists its instructions. The image then runs on that board in QEMU
({qemu}).

| certified of each function | how |
|---|---|
| no call: no panic, no allocator, no formatting, no library | no instruction is a call. The image also contains four functions that are faulty on purpose (an index that can panic, a loop, an `f64`, a call); the check must refuse them |
| no branch | no instruction is a branch, except jumps over the constants that lie between the instructions |
| no double precision | the M4F has no instruction for double precision, and software arithmetic would need a call |
| instructions | counted in the listing; without branches, each instruction runs once. For `inverse_dynamics`, the timer SysTick in QEMU must give exactly the same count, with 1024 ns per instruction |
| bytes of code and constants | size of the function's symbol; the constants are the literal pools in it |
| bytes of stack | size of the stack frame that the compiler records (`-Z emit-stack-sizes`); it is the whole stack use because the function calls nothing |
| results | compared at {states} states with the same code on an x86-64 host. They must be bit-identical. With fused multiply-add they may differ; the difference is given in units in the last place (ulp) of the largest torque of the state |
| growth | the check fails if instructions, size or stack grow by more than 2 % over this page, for the same compiler |

## Worst case

Each function has only one path. So the count is also the worst case, for every input: NaN, infinities, subnormal
numbers. The count does not apply to the following:

- time: QEMU counts instructions and does not measure their duration. Without a cache, the processor waits for code and
  constants from flash. The M7 executes two instructions at once where it can. On the Cortex-M4, `vmla` and `vfma` take
  three cycles, and `vmul` and `vadd` take one cycle each (Arm, Cortex-M4 Technical Reference Manual, FPU instruction
  set). With `-C target-cpu=cortex-m4` the compiler uses separate `vmul` and `vadd`: more instructions, but possibly
  less time. Measure the time on your board with the cycle counter of the DWT unit; QEMU has no such counter.
- your own sine and cosine: a `Scalar` of your own, or `RNE_SIN_COS` in C. The counts here include the sine and cosine
  of the crate, in `f32` only, for angles up to 10⁵ rad. Larger angles take the same time, but give wrong results.
- the dev profile: its code contains the calls and checks that an optimiser removes. The counts here are for `--release`
  with `opt-level` 3.
- more than sixteen angles: a loop computes their sines and cosines, sixteen at a time.

";

const LOOP: &str = "\
## Compared with a loop over a baked-in table

`rne::Arm` without `std` computes the same recursion in the same image. Its table is a constant in `f32` in flash. Its
torques are {agreement} of the torques of the seven steps. The difference comes from constants: the compiler computes
them from the table in double precision and rounds once, and the loop computes them in `f32`.

";

#[cfg(test)]
mod tests {
    use super::{WASM, WITHOUT_NODE, is_same};

    #[test]
    fn a_machine_without_node_finds_the_same_figures() {
        let committed = format!("| a | 1 |\n{WASM}, in Node: 5 torques.\n");
        assert!(is_same(&committed, &committed));
        assert!(is_same(&committed, &format!("| a | 1 |\n{WITHOUT_NODE}\n")));
        assert!(!is_same(&committed, &format!("| a | 2 |\n{WITHOUT_NODE}\n")));
        assert!(!is_same(&committed, &format!("| a | 1 |\n{WASM}, in Node: 6 torques.\n")), "with Node it is compared");
    }
}
