//! The dynamics as functions of query engines: a workspace of ten times the crates of the rest, so it is tested when
//! something that it is made of has changed.

use std::fs;

use anyhow::{Context, Result};
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// What the fleet is made of.
const INPUTS: [&str; 9] = [
    "fleet",
    "robots",
    "src",
    "rne-codegen/src",
    "rne-identify/src",
    "rne-logs/src",
    "rne-machine/src",
    "rne-model/src",
    "rne-runtime/src",
];

/// The hash of the inputs that passed last.
const PASSED: &str = "fleet/passed";

/// Tests the dynamics as functions of DataFusion and of Ballista
///
/// A query engine is some three hundred crates: about ten minutes on two cores when none of them is compiled. When all
/// tests have passed, the hash of what they were made of is written to fleet/passed.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask fleet              clippy, the documents' examples, the tests
  cargo xtask fleet --changed    unless what passed last has not changed (CI_FULL=1: in any case)")]
pub(crate) struct Fleet {
    /// Only when the inputs are others than those that passed last
    #[arg(long)]
    changed: bool,
}

impl Fleet {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let inputs = inputs(&shell)?;
        if self.changed && std::env::var_os("CI_FULL").is_none() && read_passed() == inputs {
            println!("fleet: left out, nothing of it has changed since it passed (CI_FULL=1 runs it)");
            return Ok(Verdict::Holds);
        }
        let manifest = "fleet/Cargo.toml";
        if cmd!(shell, "cargo fetch --quiet --locked --manifest-path {manifest}").quiet().ignore_stderr().run().is_err()
        {
            return Err(Missing::error("its crates cannot be downloaded"));
        }
        let folder = machine::target_folder("target")?.join("fleet");
        let arguments = ["--manifest-path", manifest, "--locked", "--target-dir"];
        let holds =
            cmd!(shell, "cargo clippy --workspace --all-targets {arguments...} {folder} -- -D warnings").run().is_ok()
                && cmd!(shell, "cargo test --workspace {arguments...} {folder}").run().is_ok();
        let is_committed = cmd!(shell, "git status --porcelain --").args(INPUTS).quiet().read()?.is_empty();
        if holds && is_committed && inputs != read_passed() {
            fs::write(machine::root().join(PASSED), format!("{inputs}\n")).context(PASSED)?;
            println!("fleet: wrote {PASSED}");
        }
        Ok(Verdict::from(holds))
    }
}

fn read_passed() -> String {
    machine::read(PASSED).unwrap_or_default().trim().to_owned()
}

/// The hash of all inputs, as they are committed.
fn inputs(shell: &Shell) -> Result<String> {
    let but = format!(":!{PASSED}");
    let files = cmd!(shell, "git ls-files --stage --").args(INPUTS).arg(but).quiet().read()?;
    Ok(cmd!(shell, "git hash-object --stdin").stdin(files).quiet().read()?)
}
