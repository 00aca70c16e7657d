//! Compares emitted code with a list of hashes, because it must not change in any byte.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Compares the emitted Rust and C of all shipped robots with the committed list of SHA-256
///
/// The list is `tests/frozen.txt`: a line per robot, form and function.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a text is not the one of the list.

Examples:
  cargo xtask frozen             compare
  cargo xtask frozen --update    write the list anew; git diff tests/frozen.txt then says what changed")]
pub(crate) struct Frozen {
    /// Write the list anew instead of comparing with it
    #[arg(long)]
    update: bool,
}

impl Frozen {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let test = cmd!(shell, "cargo test --test frozen -- --nocapture").quiet();
        let mut test = machine::without_flags(test).env("RNE_EXHAUSTIVE", "1");
        if self.update {
            test = test.env("RNE_FROZEN_UPDATE", "1");
        }
        Ok(Verdict::from(test.run().is_ok()))
    }
}
