//! Checks that the packages are complete, and that a crate builds from the packages alone.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine;

/// Packages every crate as a registry would take it, and builds a crate that depends on the packages alone
///
/// A new crate derives a robot and prints its torques, and the packaged command
/// line evaluates the same state: both from the packages, in a folder that knows nothing of this repository.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when the two print other torques.

Example:
  cargo xtask package")]
pub(crate) struct Package {
    /// Keep the folder of the crate that has nothing else, and print where it is
    #[arg(long)]
    keep: bool,
}

/// The crates that are published, in the order of their dependencies.
pub(crate) const CRATES: [&str; 21] = [
    "rne-functions",
    "rne-model",
    "rne-robots",
    "rne-runtime",
    "rne-codegen",
    "rne-search",
    "rne-emit",
    "rne-macro",
    "rne-machine",
    "rne-diagnose",
    "rne-inspection",
    "rne-symbolic",
    "rne-report",
    "rne",
    "rne-convert",
    "rne-plot",
    "rne-logs",
    "rne-identify",
    "rne-watch",
    "rne-certify",
    "rne-cli",
];

const MAIN: &str = r#"use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(builtin = "puma560")]
struct Puma560;

fn main() {
    let tau: [f64; 6] = Puma560.inverse_dynamics(&[0.1; 6], &[0.5; 6], &[1.0; 6]);
    println!("{tau:?}");
}
"#;

impl Package {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let target = machine::target_folder("target")?;
        // A new folder in each run: otherwise cargo would reuse what it built and unpacked there from an older package
        // of the same version.
        let build = tempfile::Builder::new().prefix("packaged-").tempdir_in(&target)?;
        let build = build.path();
        let packaged = build.join("package");
        let licences = Licences::copied(&shell)?;
        // `--no-verify`, because the two builds below compile all packages anyway
        let published = CRATES.iter().flat_map(|name| ["--package", name]);
        machine::without_flags(cmd!(shell, "cargo package {published...} --allow-dirty --no-verify --quiet"))
            .env("CARGO_TARGET_DIR", build)
            .run()?;
        drop(licences);

        let folder = tempfile::tempdir()?;
        let version = version()?;
        let mut patch = String::from("[patch.crates-io]\n");
        for name in CRATES {
            let unpacked = unpacked(&shell, &packaged.join(format!("{name}-{version}.crate")), folder.path())?;
            let _ = writeln!(patch, "{name} = {{ path = {:?} }}", unpacked.display().to_string());
        }
        let user = folder.path().join("user");
        fs::create_dir_all(user.join("src"))?;
        fs::write(
            user.join("Cargo.toml"),
            format!(
                "[package]\nname = \"user\"\nedition = \"2024\"\n\n[dependencies]\nrne = \"{version}\"\n\n\
                 [workspace]\n\n\
                 {patch}"
            ),
        )?;
        fs::write(user.join("src/main.rs"), MAIN)?;
        let manifest = user.join("Cargo.toml");
        let derived = machine::without_flags(cmd!(shell, "cargo run --quiet --manifest-path {manifest}"))
            .env("CARGO_TARGET_DIR", build)
            .read()?;
        // a packaged crate is a workspace of its own, so it gets the patches from a separate file of configuration
        let config = folder.path().join("patch.toml");
        fs::write(&config, &patch)?;
        let command_line = folder.path().join(format!("rne-cli-{version}/Cargo.toml"));
        let (q, qd, qdd) = (["0.1"; 6].join(","), ["0.5"; 6].join(","), ["1.0"; 6].join(","));
        let call = ["eval", "puma560", "--q", &q, "--qd", &qd, "--qdd", &qdd, "--json"];
        let evaluated = machine::without_flags(cmd!(
            shell,
            "cargo run --quiet --config {config} --manifest-path {command_line} -- {call...}"
        ))
        .env("CARGO_TARGET_DIR", build)
        .read()?;
        let (derived, evaluated) = (numbers(&derived)?, numbers(&evaluated)?);
        println!("packages: {} crates; a crate of them alone prints {derived:?}", CRATES.len());
        let equal = derived.len() == 6 && derived == evaluated;
        if !equal {
            println!("packages: the packaged command line prints {evaluated:?}");
        }
        if self.keep {
            println!("packages: {}", folder.keep().display());
        }
        Ok(Verdict::from(equal))
    }
}

/// Copies of the licences beside the manifest of each package. They exist while packages are made: the repository
/// has the licences once.
pub(crate) struct Licences(Vec<PathBuf>);

impl Licences {
    pub(crate) fn copied(shell: &Shell) -> Result<Self> {
        let manifests = cmd!(shell, "git ls-files */Cargo.toml").quiet().read()?;
        let mut copies = Self(Vec::new());
        for folder in manifests.lines().filter_map(|manifest| Path::new(manifest).parent()) {
            for name in ["LICENSE-APACHE", "LICENSE-MIT"] {
                let copy = shell.current_dir().join(folder).join(name);
                fs::copy(shell.current_dir().join(name), &copy)?;
                copies.0.push(copy);
            }
        }
        Ok(copies)
    }
}

impl Drop for Licences {
    fn drop(&mut self) {
        for copy in &self.0 {
            let _ = fs::remove_file(copy);
        }
    }
}

/// Returns the version that all published crates share.
fn version() -> Result<String> {
    let manifest = machine::read("Cargo.toml")?;
    let line = manifest.lines().find_map(|line| line.strip_prefix("version = "));
    Ok(line.context("Cargo.toml has a version")?.trim_matches('"').to_owned())
}

/// Unpacks a package into a folder and returns the path of its content.
fn unpacked(shell: &Shell, package: &Path, folder: &Path) -> Result<PathBuf> {
    if !package.is_file() {
        bail!("there is no package {}", package.display());
    }
    cmd!(shell, "tar -xzf {package} -C {folder}").quiet().run()?;
    let name = package.file_stem().context("a package has a name")?;
    Ok(folder.join(name))
}

/// Returns the numbers in a text, without the words, brackets and commas around them.
fn numbers(text: &str) -> Result<Vec<f64>> {
    let words = text.split(|c: char| c.is_whitespace() || "[]{},:".contains(c));
    let numbers = words.filter(|word| word.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
    numbers.map(|word| word.parse::<f64>().with_context(|| word.to_owned())).collect()
}
