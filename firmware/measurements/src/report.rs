//! Writes the document `docs/measured/embedded.md` with the results and their meaning.

use std::fmt::Write as _;

use crate::image::Figures;
use crate::log::Agreement;
use crate::riscv;
use crate::table::{Row, Table};

/// All results.
pub(crate) struct Report {
    /// The version of QEMU.
    pub(crate) qemu: String,
    /// The tables: robots on the boards, functions of the PUMA 560, C.
    pub(crate) tables: Vec<Table>,
    /// Instructions of the loop over a table in the image, and its agreement with the seven steps.
    pub(crate) runtime: (f64, Agreement),
    /// The counts for RISC-V; `None` in a sample, for which no document is written.
    pub(crate) riscv: Option<riscv::Counts>,
    /// How many numbers WebAssembly and the host computed with equal bits; `None` if WebAssembly was left out.
    pub(crate) wasm: Option<usize>,
}

/// Heading of the first column of a table whose rows are robots.
pub(crate) const ROBOT: &str = "robot";
/// The robots that the document shows.
const SHOWN: [&str; 5] = ["panda", "puma560", "scara_cobra600", "stanford", "ur5e"];

/// The headings of tables, by which they are found.
pub(crate) const M4F: &str = "Cortex-M4F";
pub(crate) const M7F: &str = "Cortex-M7F";
pub(crate) const FUSED: &str = "Cortex-M4F with fused multiply-add";
pub(crate) const METHODS: &str = "Every function of the PUMA 560 on the Cortex-M4F";
pub(crate) const CONTROLLERS: &str = "Computed torque with an observer on the Cortex-M4F";
pub(crate) const C: &str = "C on the Cortex-M4F";

impl Report {
    /// Returns the document.
    pub(crate) fn document(&self) -> String {
        let mut text = HEAD.replace("{qemu}", &self.qemu).replace("{states}", &robots::STATES.to_string());
        for table in &self.tables {
            text.push_str(&table.markdown(|row| table.of != ROBOT || SHOWN.contains(&row.name.as_str())));
            text.push('\n');
        }
        text.push_str(&self.comparison());
        text.push_str(&self.others());
        text
    }

    /// Returns the figures of all robots and functions.
    pub(crate) fn figures_of_all(&self) -> String {
        self.tables.iter().map(|table| table.markdown(|_| true) + "\n").collect()
    }

    /// Returns the figures of the PUMA 560 in a table: seven steps and reduced.
    pub(crate) fn puma560(&self, title: &str) -> Option<[Figures; 2]> {
        let table = self.tables.iter().find(|table| table.title == title)?;
        let row = |form: &str| table.rows.iter().find(|row: &&Row| row.name == "puma560" && row.form == form);
        Some([row("seven_steps")?.figures, row("reduced")?.figures])
    }

    /// Returns the figures of a row.
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
             - `riscv32imafc-unknown-none-elf`: `cargo xtask certificate` builds {} functions. It reads their \
             instructions, but\n  does not run them. No function calls, branches or computes in double precision. \
             The torques of the PUMA 560 take\n  {seven_steps} instructions in the form `seven_steps` and {reduced} \
             in the form `reduced`.\n",
            riscv.functions
        );
        let _ = match self.wasm {
            Some(numbers) => writeln!(
                text,
                "{WASM}: in Node, {numbers} torques (all robots and forms, `f32`, `f64`) have the same bits as on a PC."
            ),
            None => writeln!(text, "{WITHOUT_NODE}"),
        };
        text
    }
}

/// Whether two documents have the same figures. A document that was written without Node has a line that says so.
pub(crate) fn is_same(committed: &str, document: &str) -> bool {
    let is_left_out = document.contains(WITHOUT_NODE);
    let lines = |text: &'_ str| -> Vec<String> {
        let lines = text.lines().filter(|line| !(is_left_out && line.starts_with(WASM)));
        lines.map(str::to_owned).collect()
    };
    lines(committed) == lines(document)
}

const WASM: &str = "- `wasm32-unknown-unknown`";
const WITHOUT_NODE: &str = "- `wasm32-unknown-unknown`: not compared, because Node.js is not installed.";

const HEAD: &str = "\
# Generated code on microcontrollers

The command `cargo xtask certificate --update` writes this page. Without `--update`, the command builds, reads and runs
the code again, and compares the result with [the figures of all robots](../../firmware/measurements/figures.txt), of
which this page shows five. It fails if the code does not have a property that this page certifies.

The generated code computes the joint torques of each [shipped robot](../../robots/README.md) and, for the PUMA 560,
also the other functions. The code uses single precision (`f32`), and it computes the sines and cosines of the joint
angles itself. The command builds a program for a board and lists its instructions with `objdump`. The command then runs
the program on the same board, emulated by QEMU ({qemu}).

Each function has two forms. The form `seven_steps` computes every intermediate vector of the recursive Newton-Euler
algorithm. The form `reduced` computes the same result with about half the operations.

| property of each function | how the command checks or measures it |
|---|---|
| no call: no panic, no allocator, no formatting, no library | No instruction is a call. The program also contains four faulty functions: one has an index that can panic, one has a loop, one uses `f64`, one calls another function. The command fails if its own check accepts one of these four functions. |
| no branch | No instruction is a branch, except jumps over the constants that lie between the instructions. |
| no double precision | The M4F has no instruction for double precision, and software arithmetic would need a call. |
| instructions | The command counts them in the listing. Without branches, each instruction runs once. For `inverse_dynamics`, the timer SysTick in QEMU must give exactly the same count; QEMU takes 1024 ns for each instruction. |
| bytes of code and constants | They are the size of the function's symbol. The constants are the literal pools in it. |
| bytes of stack | They are the size of the stack frame that the compiler records (`-Z emit-stack-sizes`). The function needs no other stack, because it calls nothing. |
| results | The command compares the results at {states} states with the results of the same code on an x86-64 host. They must be bit-identical. With fused multiply-add they may differ; the table then shows the difference in units in the last place (ulp) of the largest torque of the state. |
| growth | The command fails if the instructions, the size or the stack of a function is more than 2 % larger than in that file. It compares them only if the compiler is the same. |

## Worst case

The generated code of a function has only one execution path. So a call takes the same number of instructions for every
input, also for NaN, infinities and subnormal numbers. This number is therefore also the worst case.

The instruction counts of this page have these limits:

- The counts are not times. QEMU counts instructions and does not measure their duration. Without a cache, the processor
  waits for code and constants from flash. The M7 executes two instructions at once where it can. On the Cortex-M4,
  `vmla` and `vfma` take three cycles, and `vmul` and `vadd` take one cycle each (Arm, Cortex-M4 Technical Reference
  Manual, FPU instruction set). With `-C target-cpu=cortex-m4` the compiler uses separate `vmul` and `vadd`: the code
  has more instructions, but it may take less time. Measure the time on your board with the cycle counter of the DWT
  unit. QEMU has no such counter.
- The counts include the sine and cosine functions of `rne` in `f32`. If you use your own sine and cosine (your own
  `Scalar` type in Rust, or `RNE_SIN_COS` in C), the counts are different. The functions of `rne` are made for angles up
  to 10⁵ rad. For a larger angle they take the same time, but give a wrong result.
- The counts are for `--release` with `opt-level` 3. The code of the dev profile contains calls and checks that the
  optimizer would remove.
- The counts are for arms with at most sixteen joint angles. For more angles, the code contains a loop, which computes
  the sines and cosines of sixteen angles at a time.

";

const LOOP: &str = "\
## Compared with a loop over a constant table

The type `rne::Arm` of the runtime library computes the torques in loops, without `std`. It reads the numbers of the
robot from a constant table in `f32` in flash. The certified program contains it, too. The torques of `rne::Arm` are
{agreement} (units in the last place) of the torques of the derived code in the form `seven_steps`. The difference
comes from constants: the derive computes each constant in double precision and rounds it once, and `rne::Arm` computes
it in `f32`.

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
