//! Derivatives of random robots beside dual numbers, and of imported and shipped ones beside Pinocchio.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Compares every derivative of random robots with dual numbers, and of ten robots with Pinocchio
///
/// Random arms and trees, both forms, without a compiler: the functions of the list in `tests/functions/derivatives.rs`
/// against dual numbers through the runtime library, to 1e-11. With `--python`, ten robots as URDF: M⁻¹ and the
/// derivatives of torques and accelerations beside `computeMinverse`, `computeRNEADerivatives` and
/// `computeABADerivatives`, to 1e-11.
#[derive(Args)]
#[command(after_help = "\
`--python` needs a Python with numpy and pin; 1000 robots take some minutes.

Examples:
  cargo xtask derivatives                          1000 robots, without Pinocchio
  cargo xtask derivatives 60 --python venv/bin/python")]
pub(crate) struct Derivatives {
    /// Number of random robots
    #[arg(default_value_t = 1000)]
    count: u16,
    /// Python that has Pinocchio
    #[arg(long, value_name = "PROGRAM")]
    python: Option<String>,
}

impl Derivatives {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let (shell, count) = (machine::shell()?, self.count.to_string());
        let test = cmd!(shell, "cargo test --release --quiet --test functions derivatives_are -- --nocapture");
        if machine::without_flags(test).env("RNE_DERIVATIVES", count).quiet().run().is_err() {
            return Ok(Verdict::Fails);
        }
        let Some(python) = &self.python else { return Ok(Verdict::Holds) };
        if cmd!(shell, "{python} -c").arg("import numpy, pinocchio").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error(format!("{python} has no numpy or pin (pip installs them)")));
        }
        machine::without_flags(cmd!(shell, "cargo build --release --quiet -p rne-cli")).quiet().run()?;
        let program = machine::target_folder("target")?.join("release").join("rne");
        Ok(Verdict::from(cmd!(shell, "{python} xtask/derivatives.py {program}").quiet().run().is_ok()))
    }
}
