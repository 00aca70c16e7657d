//! Compares random robots with closed loops with values from the principle of virtual work.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Compares random robots with closed loops with golden values that are made for them
///
/// Planar and spatial mechanisms of one to three loops, with all kinds of cut joints. `tests/witnesses/loops.py` draws
/// them and computes their values by virtual work, beside Pinocchio. The runtime library and both forms must return
/// these to 1e-9. For each robot, one wrong choice of dependent joints must be refused.
#[derive(Args)]
#[command(after_help = "\
Needs python3 with numpy, mpmath, PyYAML and pin; 500 robots take some minutes.

Examples:
  cargo xtask loops                          500 robots
  cargo xtask loops 60                       those of tests/golden/loops/random.json
  cargo xtask loops --python venv/bin/python")]
pub(crate) struct Loops {
    /// Number of robots
    #[arg(default_value_t = 500)]
    count: u16,
    /// Python that has the packages
    #[arg(long, default_value = "python3", value_name = "PROGRAM")]
    python: String,
    /// Processes that compute values
    #[arg(long, default_value_t = 2, value_name = "N")]
    processes: u8,
}

impl Loops {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let (shell, Self { count, python, processes }) = (machine::shell()?, self);
        let [count, processes] = [count.to_string(), processes.to_string()];
        let import = "import mpmath, numpy, pinocchio, yaml";
        if cmd!(shell, "{python} -c {import}").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error(format!("{python} has no numpy, mpmath, PyYAML or pin (pip installs them)")));
        }
        let file = machine::target_folder("target")?.join("loops.json");
        let compute = cmd!(shell, "{python} tests/witnesses/loops.py random {count} {file} {processes}");
        if compute.quiet().run().is_err() {
            return Ok(Verdict::Fails);
        }
        let test =
            cmd!(shell, "cargo test --release --quiet --test functions many_mechanisms -- --ignored --nocapture");
        Ok(Verdict::from(machine::without_flags(test).env("RNE_LOOPS", file).quiet().run().is_ok()))
    }
}
