//! The dynamics as functions of query engines: a workspace of its own, tested when something that it is made of has
//! changed.

use anyhow::{Result, bail};
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// What the fleet is made of: itself, and the crates of this repository that it compiles.
const INPUTS: [&str; 13] = [
    "fleet",
    "robots",
    "src",
    "rne-codegen",
    "rne-emit",
    "rne-convert",
    "rne-identify",
    "rne-logs",
    "rne-machine",
    "rne-macro",
    "rne-model",
    "rne-runtime",
    "Cargo.toml",
];

/// What of them no crate is compiled of.
const NOT_INPUTS: [&str; 4] = [":!fleet/passed", ":!rne-*/tests/*", ":!rne-*/README.md", ":!rne-*/LICENSE-*"];

/// The hash of the inputs that passed last.
const PASSED: &str = "fleet/passed";

/// Tests the dynamics as functions of DataFusion and of Ballista
///
/// Hundreds of crates: minutes when none of them is compiled. When all tests have passed, and everything is committed,
/// the hash of what they were made of is written to fleet/passed; that file is committed, too.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask fleet              clippy, the documents' examples, the tests
  cargo xtask fleet --changed    only when it is not what passed last (CI_FULL=1: in any case)")]
pub(crate) struct Fleet {
    /// Only when the inputs are others than those that passed last
    #[arg(long)]
    pub(crate) changed: bool,
}

impl Fleet {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let inputs = inputs(&shell)?;
        let has_passed = inputs == read_passed() && is_committed(&shell)?;
        if self.changed && has_passed && std::env::var_os("CI_FULL").is_none() {
            println!("fleet: left out, nothing of it has changed since it passed (CI_FULL=1 runs it)");
            return Ok(Verdict::Holds);
        }
        let manifest = "fleet/Cargo.toml";
        let fetched = cmd!(shell, "cargo fetch --quiet --locked --manifest-path {manifest}").quiet().ignore_status();
        let fetched = fetched.output()?;
        if !fetched.status.success() {
            let said = String::from_utf8_lossy(&fetched.stderr);
            // a lock file that is not that of its manifest is a fault
            if said.contains("lock file") {
                bail!("{}", said.trim());
            }
            return Err(Missing::error("its crates cannot be downloaded"));
        }
        let folder = machine::target_folder("target")?.join("fleet");
        let arguments = ["--manifest-path", manifest, "--locked", "--target-dir"];
        let holds =
            cmd!(shell, "cargo clippy --workspace --all-targets {arguments...} {folder} -- -D warnings").run().is_ok()
                && cmd!(shell, "cargo test --workspace {arguments...} {folder}").run().is_ok();
        if holds && !is_committed(&shell)? {
            println!("fleet: {PASSED} stays as it is, for not everything is committed");
        } else if holds && inputs != read_passed() {
            machine::write(PASSED, &format!("{inputs}\n"))?;
            println!("fleet: wrote {PASSED}; commit it");
        }
        Ok(Verdict::from(holds))
    }
}

fn read_passed() -> String {
    machine::read(PASSED).unwrap_or_default().trim().to_owned()
}

/// The hash of all inputs, as they are committed.
fn inputs(shell: &Shell) -> Result<String> {
    let files = cmd!(shell, "git ls-files --stage --").args(INPUTS).args(NOT_INPUTS).quiet().read()?;
    Ok(cmd!(shell, "git hash-object --stdin").stdin(files).quiet().read()?)
}

/// Whether the inputs in the folder are those that are committed.
fn is_committed(shell: &Shell) -> Result<bool> {
    Ok(cmd!(shell, "git status --porcelain --").args(INPUTS).args(NOT_INPUTS).quiet().read()?.is_empty())
}

#[cfg(test)]
mod tests {
    use super::INPUTS;
    use crate::machine;

    /// A package of the lock file that has no source is of this repository.
    #[test]
    fn every_crate_of_this_repository_that_it_compiles_is_an_input() {
        let lock = machine::read("fleet/Cargo.lock").unwrap();
        let packages = lock.split("[[package]]").skip(1).filter(|package| !package.contains("\nsource = "));
        let names: Vec<&str> =
            packages.filter_map(|package| package.trim().strip_prefix("name = \"")?.split('"').next()).collect();
        assert!(names.len() > 5, "{names:?}");
        for name in names {
            let folder = match name {
                "rne" => "src",
                "rne-robots" => "robots",
                "rne-ballista" | "rne-datafusion" => "fleet",
                crate_of_its_name => crate_of_its_name,
            };
            assert!(INPUTS.contains(&folder), "{folder} is no input of the fleet: name it");
        }
    }
}
