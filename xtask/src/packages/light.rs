//! Measures the costs before a user's first result: crates to compile, compilers to install, bytes to load.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use serde_json::Value;
use xshell::{Cmd, Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// Counts the crates behind `cargo run` and behind a derive, looks for C among them, and weighs the binary
///
/// Nothing here asks the clock: counts and bytes are the same on every machine. The limits stand in this file; a change
/// that needs more says there why.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a limit is exceeded or a crate compiles C.

Examples:
  cargo xtask light
  cargo xtask light --crates    seconds: without the release binary")]
pub(crate) struct Light {
    /// Count crates alone: the binary takes minutes
    #[arg(long)]
    crates: bool,
}

/// Largest number of crates that `cargo run` compiles with default features, including those of this repository.
const CRATES_OF_RUN: usize = 120;
/// Largest number of crates that a derive in a user's own crate compiles, with default features, including those of
/// this repository.
const CRATES_OF_DERIVE: usize = 50;
/// Largest size of the release binary with default features, without symbols, bytes.
const BINARY_BYTES: usize = 16_000_000;

/// Crates with which build scripts compile C or find C libraries.
const COMPILERS_OF_C: [&str; 5] = ["cc", "cmake", "pkg-config", "bindgen", "vcpkg"];

/// The kinds of targets that other crates can use.
const LIBRARIES: [Option<&str>; 2] = [Some("lib"), Some("proc-macro")];

/// The whole source of a user's crate.
const DERIVE: &str = "\
/// The arm.
#[derive(rne::InverseDynamics)]
#[robot(builtin = \"puma560\")]
pub struct Puma560;
";

/// The crates that a build compiles.
#[derive(Default)]
struct Build {
    /// How often the library of each crate is compiled, by name and version. It is more than once if two parts of the
    /// build ask for different features.
    crates: BTreeMap<String, usize>,
    /// Crates that compile C or link a library that is not written in Rust.
    c: BTreeSet<String>,
    executable: Option<PathBuf>,
}

impl Light {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let run = Build::of(cmd!(shell, "cargo build --bin rne"))?;
        let derive = derive(&shell)?;
        let twice: Vec<&String> = run.crates.iter().filter(|(_, times)| **times > 1).map(|(name, _)| name).collect();
        let mut rows = vec![
            ("crates behind `cargo run`", run.crates.len(), CRATES_OF_RUN),
            ("crates of it that are compiled twice", twice.len(), 0),
            ("crates of it that compile C", run.c.len(), 0),
            ("crates behind a derive", derive.crates.len(), CRATES_OF_DERIVE),
            ("crates of it that compile C", derive.c.len(), 0),
        ];
        if !self.crates {
            let release = Build::of(cmd!(shell, "cargo build --release --bin rne"))?;
            let bytes = stripped(&shell, &release.executable.context("cargo names the binary")?)?;
            rows.push(("bytes of the release binary, stripped", usize::try_from(bytes)?, BINARY_BYTES));
        }
        for (what, count, limit) in &rows {
            println!("light: {what:<40}{count:>10}, at most {limit}");
        }
        for name in twice.into_iter().chain(&run.c).chain(&derive.c) {
            println!("light: {name}");
        }
        Ok(Verdict::from(rows.iter().all(|(_, count, limit)| count <= limit)))
    }
}

impl Build {
    /// Runs a build and reads cargo's messages about each crate, also about those that had been compiled before.
    fn of(build: Cmd<'_>) -> Result<Self> {
        let messages = machine::without_flags(build.args(["--quiet", "--message-format", "json"])).quiet().read()?;
        let mut found = Self::default();
        for line in messages.lines() {
            let message: Value = serde_json::from_str(line)?;
            let Some(package) = message["package_id"].as_str() else { continue };
            let name = name(package);
            match message["reason"].as_str() {
                Some("compiler-artifact") => {
                    let kinds = message["target"]["kind"].as_array();
                    let is_library =
                        kinds.is_some_and(|kinds| kinds.iter().any(|kind| LIBRARIES.contains(&kind.as_str())));
                    *found.crates.entry(name.clone()).or_default() += usize::from(is_library);
                    if COMPILERS_OF_C.iter().any(|compiler| name.split('@').next() == Some(compiler)) {
                        found.c.insert(name);
                    }
                    if let Some(executable) = message["executable"].as_str() {
                        found.executable = Some(executable.into());
                    }
                }
                Some("build-script-executed")
                    if message["linked_libs"].as_array().is_some_and(|libraries| !libraries.is_empty()) =>
                {
                    found.c.insert(name);
                }
                _ => {}
            }
        }
        Ok(found)
    }
}

/// Returns `name@version` of a package that cargo calls `…/index#name@version`, or `…/name#version` if it is in a local
/// folder.
fn name(package: &str) -> String {
    let (place, name) = package.rsplit_once('#').unwrap_or(("", package));
    if name.contains('@') {
        return name.to_owned();
    }
    format!("{}@{name}", place.rsplit('/').next().unwrap_or_default())
}

/// Builds a crate that depends on `rne` alone and derives a robot.
fn derive(shell: &Shell) -> Result<Build> {
    let folder = tempfile::tempdir()?;
    fs::create_dir(folder.path().join("src"))?;
    let manifest = folder.path().join("Cargo.toml");
    let package = "[package]\nname = \"user\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n";
    fs::write(&manifest, format!("{package}rne = {{ path = {:?} }}\n", machine::root().display().to_string()))?;
    fs::copy(machine::root().join("Cargo.lock"), folder.path().join("Cargo.lock"))?;
    fs::write(folder.path().join("src/lib.rs"), DERIVE)?;
    Build::of(cmd!(shell, "cargo build --manifest-path {manifest}"))
}

/// Returns the size of a binary without its symbols, bytes.
fn stripped(shell: &Shell, binary: &Path) -> Result<u64> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("stripped");
    if cmd!(shell, "strip -o {out} {binary}").quiet().ignore_stderr().run().is_err() {
        return Err(Missing::error("there is no strip (Debian's package binutils)"));
    }
    Ok(fs::metadata(out)?.len())
}

#[cfg(test)]
mod tests {
    use super::name;

    #[test]
    fn packages_have_the_names_that_people_know() {
        assert_eq!(name("registry+https://example.org/index#clap@4.6.7"), "clap@4.6.7");
        assert_eq!(name("path+file:///somewhere/rne-model#0.1.0"), "rne-model@0.1.0");
        assert_eq!(name("path+file:///somewhere/clone#rne@0.1.0"), "rne@0.1.0");
    }
}
