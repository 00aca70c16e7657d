//! Compares numbers of operations for robots with branches with those of Khalil's algorithm.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::measures::performance;

/// Robots whose operations are counted: shipped ones, and those of benches/trees.
const ROBOTS: [&str; 15] = [
    "robots/trees/hyq.yaml",
    "benches/trees/anymal_c.yaml",
    "benches/trees/go2.yaml",
    "benches/trees/solo12.yaml",
    "benches/trees/atlas.yaml",
    "benches/trees/g1.yaml",
    "benches/trees/sr400.yaml",
    "robots/trees/mini_cheetah.yaml",
    "benches/trees/hyq_floating.yaml",
    "benches/trees/anymal_c_floating.yaml",
    "benches/trees/go2_floating.yaml",
    "benches/trees/solo12_floating.yaml",
    "benches/trees/atlas_floating.yaml",
    "benches/trees/g1_floating.yaml",
    "benches/trees/mini_cheetah_floating.yaml",
];

/// Robots with closed loops whose operations are counted.
const LOOPS: [&str; 3] = ["docs/four_bar.yaml", "benches/trees/loops/g1_ankle.yaml", "benches/trees/loops/delta.yaml"];

/// The document with the table of robots with closed loops.
const PAGE: &str = "docs/control/closed-loops.md";

/// Counts the operations of robots with branches beside Khalil's algorithm
///
/// Inverse dynamics in the form reduced, on fixed and on floating bases, by the plan files, and the customised
/// Newton-Euler algorithm with base parameters, from the same robot files. `tests/witnesses/tree_counts.py` has the
/// rules of both counts. With --loops: robots with closed loops beside their spanning trees with a dense projection, by
/// the rules of `tests/witnesses/loop_counts.py`; the table is written to docs/control/closed-loops.md.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a robot needs more operations than its bar. Needs python3 with PyYAML.

Examples:
  cargo xtask tree-counts                          all of them
  cargo xtask tree-counts robots/trees/hyq.yaml    one robot file; a table with modified rows
  cargo xtask tree-counts --loops                  closed loops")]
pub(crate) struct TreeCounts {
    /// Robot files to count instead
    #[arg(value_name = "FILE")]
    files: Vec<String>,
    /// Count robots with closed loops
    #[arg(long, conflicts_with = "files")]
    loops: bool,
}

impl TreeCounts {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        if cmd!(shell, "python3 -c 'import yaml'").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error("there is no python3 with PyYAML"));
        }
        machine::without_flags(cmd!(shell, "cargo build --quiet --bin rne")).quiet().run()?;
        let rne = machine::target_folder("target")?.join("debug/rne");
        if self.loops {
            let counted =
                cmd!(shell, "python3 tests/witnesses/loop_counts.py {rne} {LOOPS...}").quiet().ignore_status();
            let output = counted.output()?;
            let table = String::from_utf8(output.stdout)?;
            print!("{table}");
            eprint!("{}", String::from_utf8_lossy(&output.stderr));
            if output.status.success() {
                machine::write(PAGE, &performance::replaced(&machine::read(PAGE)?, "loops", &table)?)?;
            }
            return Ok(Verdict::from(output.status.success()));
        }
        let files = if self.files.is_empty() { ROBOTS.map(str::to_owned).to_vec() } else { self.files.clone() };
        Ok(Verdict::from(cmd!(shell, "python3 tests/witnesses/tree_counts.py {rne} {files...}").quiet().run().is_ok()))
    }
}
