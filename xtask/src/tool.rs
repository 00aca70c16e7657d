//! Runs tools that are not part of this repository.

use std::path::Path;

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// Runs a tool: dependencies and their licences, the public interface, the book of the lecture
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when the tool finds fault.

Examples:
  cargo xtask tool deny --install        licences, sources and duplicates of what every lock file has: .cargo/deny.toml;
                                         takes minutes to install
  cargo xtask tool semver --install      the public interface against the last tag; takes minutes to install
  cargo xtask tool book --install        docs/teaching/lecture as a book in target/book; takes minutes to install")]
pub(crate) struct Tool {
    /// Tool to get
    tool: Name,
    /// Get the tool, into target/tools
    #[arg(long)]
    pub(crate) install: bool,
}

/// The arms whose live pages are in the book.
const LIVE: [&str; 4] = ["planar1", "planar2", "stanford", "puma560"];

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Name {
    /// cargo-deny
    Deny,
    /// cargo-semver-checks
    Semver,
    /// mdBook
    #[value(alias = "mdbook")]
    Book,
}

impl Tool {
    /// The public interface against the last tag.
    pub(crate) fn semver(install: bool) -> Self {
        Self { tool: Name::Semver, install }
    }

    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let program = match self.tool {
            Name::Deny => "cargo-deny",
            Name::Semver => "cargo-semver-checks",
            Name::Book => "mdbook",
        };
        let tag = cmd!(shell, "git describe --tags --abbrev=0").quiet().ignore_stderr().read();
        if self.tool == Name::Semver && tag.is_err() {
            return Err(Missing::error("there is no tag to compare with"));
        }
        let folder = machine::target_folder("target")?.join("tools");
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders = [folder.join("bin")].into_iter().chain(std::env::split_paths(&path));
        shell.set_var("PATH", std::env::join_paths(folders).context("PATH")?);
        let is_there = || cmd!(shell, "{program} --version").quiet().ignore_stdout().ignore_stderr().run().is_ok();
        if !is_there() {
            if !self.install {
                return Err(Missing::error(format!("{program} is not there (--install gets it)")));
            }
            let install = cmd!(shell, "cargo install --quiet --locked --root {folder} {program}").quiet();
            if install.run().is_err() || !is_there() {
                return Err(Missing::error(format!("{program} cannot be had here")));
            }
        }
        let run = match self.tool {
            Name::Deny => return deny(&shell),
            Name::Book => {
                // the chapters show live pages of arms, which `rne report` writes
                let book = machine::target_folder("target")?.join("book");
                machine::without_flags(cmd!(shell, "cargo build --quiet --bin rne")).quiet().run()?;
                let rne = machine::target_folder("target")?.join("debug/rne");
                cmd!(shell, "mdbook build docs/teaching/lecture --dest-dir {book}").quiet().ignore_stderr().run()?;
                for robot in LIVE {
                    let page = book.join(robot).with_extension("html");
                    cmd!(shell, "{rne} report {robot} -o {page} --force").quiet().ignore_stdout().run()?;
                }
                println!("the book: {}", book.join("index.html").display());
                return Ok(Verdict::Holds);
            }
            Name::Semver => {
                let tag = tag?;
                cmd!(shell, "cargo semver-checks --baseline-rev {tag} --package rne --package rne-model")
            }
        };
        Ok(Verdict::from(machine::without_flags(run).run().is_ok()))
    }
}

/// Checks the dependencies in every lock file of the repository.
fn deny(shell: &Shell) -> Result<Verdict> {
    // the database of advisories is a separate repository, which may be unreachable
    let fetch = cmd!(shell, "cargo deny --workspace --log-level off fetch db");
    let has_advisories = fetch.quiet().ignore_stdout().ignore_stderr().run().is_ok();
    if !has_advisories {
        println!("advisories: skipped, their database cannot be fetched");
    }
    let advisories = has_advisories.then_some("advisories");
    let locks = cmd!(shell, "git ls-files Cargo.lock */Cargo.lock").quiet().read()?;
    let mut verdict = Verdict::Holds;
    for lock in locks.lines() {
        let manifest = Path::new(lock).with_file_name("Cargo.toml");
        let fetch = cmd!(shell, "cargo fetch --quiet --locked --manifest-path {manifest}");
        let fetched = machine::without_flags(fetch).quiet().ignore_status().output()?;
        let said = String::from_utf8_lossy(&fetched.stderr);
        if said.contains("lock file") {
            // not caused by the network, so it is an error and not skipped
            anyhow::bail!("{lock} is not that of its manifest: {}", said.trim());
        }
        if !fetched.status.success() {
            println!("{lock}: skipped, its crates cannot be downloaded");
            continue;
        }
        println!("{lock}:");
        // In the library, two versions of a crate would cost its users time to compile. Other workspaces may have them.
        let allowed = if lock == "Cargo.lock" { None } else { Some("--allow=duplicate") };
        let check = cmd!(
            shell,
            "cargo deny --manifest-path {manifest} --workspace --all-features --locked --log-level error
                check --config .cargo/deny.toml {allowed...} bans licenses sources {advisories...}"
        );
        if machine::without_flags(check).quiet().run().is_err() {
            verdict = Verdict::Fails;
        }
    }
    Ok(verdict)
}
