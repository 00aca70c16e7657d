//! Tests the dynamics as functions of query engines, `doors/datafusion/`, a workspace of its own.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Tests the dynamics as functions of DataFusion and of Ballista
///
/// Hundreds of crates: minutes when none of them is compiled.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask fleet              clippy, the documents' examples, the tests")]
pub(crate) struct Fleet;

impl Fleet {
    pub(crate) fn run() -> Result<Verdict> {
        let shell = machine::shell()?;
        let manifest = "doors/datafusion/Cargo.toml";
        machine::fetch(&shell, manifest)?;
        let folder = machine::target_folder("target")?.join("fleet");
        let arguments = ["--manifest-path", manifest, "--locked", "--target-dir"];
        let holds =
            cmd!(shell, "cargo clippy --workspace --all-targets {arguments...} {folder} -- -D warnings").run().is_ok()
                && cmd!(shell, "cargo test --workspace {arguments...} {folder}").run().is_ok();
        Ok(Verdict::from(holds))
    }
}
