//! Compares derivatives of random robots with dual numbers, and derivatives of imported and shipped robots with
//! Pinocchio.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Compares every derivative of random robots with dual numbers, and of ten robots with Pinocchio
///
/// Random arms and trees, both forms, without a compiler: the functions of the list in `tests/functions/derivatives.rs`
/// against dual numbers through the runtime library, first derivatives to 1e-11 and second ones to 1e-9. With
/// `--python`, ten robots as URDF: M⁻¹ and the derivatives of torques, accelerations and Jacobians beside
/// `computeMinverse`, `computeRNEADerivatives`, `computeABADerivatives` and `getFrameJacobianTimeVariation`, to 1e-11,
/// and the Hessian of the torques beside `ComputeRNEASecondOrderDerivatives`, to 1e-9.
#[derive(Args)]
#[command(after_help = "\
The command prints a table with the largest error of each function. A run of many
robots can be done in parts: 500 robots, then 500 robots with `--first 500`.

`--python` needs a Python with numpy, pin and cmeel-eigen, and g++.

Examples:
  cargo xtask derivatives                          1000 robots, without Pinocchio
  cargo xtask derivatives 500 --first 500          the second half of them
  cargo xtask derivatives 60 --python venv/bin/python")]
pub(crate) struct Derivatives {
    /// Number of random robots
    #[arg(default_value_t = 1000)]
    count: u16,
    /// Number of the first robot
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    first: u16,
    /// Python that has Pinocchio
    #[arg(long, value_name = "PROGRAM")]
    python: Option<String>,
}

impl Derivatives {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let (shell, count, first) = (machine::shell()?, self.count.to_string(), self.first.to_string());
        let test = cmd!(shell, "cargo test --release --quiet --test functions derivatives_are -- --nocapture");
        let test = machine::without_flags(test).env("RNE_DERIVATIVES", count).env("RNE_DERIVATIVES_FIRST", first);
        if test.quiet().run().is_err() {
            return Ok(Verdict::Fails);
        }
        let Some(python) = &self.python else { return Ok(Verdict::Holds) };
        if cmd!(shell, "{python} -c").arg("import numpy, pinocchio").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error(format!("{python} has no numpy or pin (pip installs them)")));
        }
        machine::without_flags(cmd!(shell, "cargo build --release --quiet --bin rne")).quiet().run()?;
        let program = machine::target_folder("target")?.join("release").join("rne");
        Ok(Verdict::from(cmd!(shell, "{python} tests/witnesses/derivatives.py {program}").quiet().run().is_ok()))
    }
}
