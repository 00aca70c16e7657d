//! The machine on which a task runs: the folder of the repository, installed tools, and the installation of missing
//! ones.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, anyhow, bail};
use xshell::{Cmd, Shell, cmd};

/// The error that this machine lacks a tool. Its message is printed in place of a result.
#[derive(Debug)]
pub(crate) struct Missing(String);

impl Missing {
    /// Creates such an error.
    pub(crate) fn error(why: impl Into<String>) -> anyhow::Error {
        anyhow!(Self(why.into()))
    }
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Missing {}

/// Returns the folder of the repository.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("this package is in a folder of the repository")
}

/// Returns a shell in the folder of the repository.
pub(crate) fn shell() -> Result<Shell> {
    let shell = Shell::new()?;
    shell.change_dir(root());
    Ok(shell)
}

/// Reads a file of the repository.
pub(crate) fn read(path: &str) -> Result<String> {
    fs::read_to_string(root().join(path)).with_context(|| path.to_owned())
}

/// Writes a file of the repository.
pub(crate) fn write(path: &str, text: &str) -> Result<()> {
    fs::write(root().join(path), text).with_context(|| path.to_owned())
}

/// Returns the absolute path of `CARGO_TARGET_DIR`, or of a default folder in the repository, and creates it.
pub(crate) fn target_folder(default: &str) -> Result<PathBuf> {
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join(default), PathBuf::from);
    fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    Ok(folder.canonicalize()?)
}

/// Returns the profile with which the Python package and the C library are built, and the name of its folder. It is
/// `release` unless `RNE_PROFILE` says `dev`. Tests use `dev`, which compiles faster; measurements and releases use
/// `release`.
pub(crate) fn profile() -> Result<(&'static str, &'static str)> {
    match std::env::var("RNE_PROFILE").as_deref() {
        Ok("dev") => Ok(("dev", "debug")),
        Ok("release") | Err(_) => Ok(("release", "release")),
        Ok(other) => bail!("RNE_PROFILE is `{other}`; it may be `dev` or `release`"),
    }
}

/// Removes environment variables of the caller from a command: compiler flags, which would change the code, and the
/// library path that rustup sets for its own compiler, because another compiler may be started.
pub(crate) fn without_flags(command: Cmd<'_>) -> Cmd<'_> {
    ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "LD_LIBRARY_PATH"].into_iter().fold(command, Cmd::env_remove)
}

/// Downloads the crates of a separate workspace. A lock file that does not fit its manifest is an error; crates that
/// cannot be downloaded are a missing tool.
pub(crate) fn fetch(shell: &Shell, manifest: &str) -> Result<()> {
    let fetched = cmd!(shell, "cargo fetch --quiet --locked --manifest-path {manifest}").quiet().ignore_status();
    let fetched = fetched.output()?;
    if fetched.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&fetched.stderr);
    if said.contains("lock file") {
        bail!("{}", said.trim());
    }
    Err(Missing::error("its crates cannot be downloaded"))
}

/// Whether a program can be started.
pub(crate) fn has(program: &str) -> bool {
    let started = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    started.is_ok_and(|status| status.success())
}

/// Checks that Debian packages are installed. With `install`, apt-get installs missing ones.
pub(crate) fn packages(names: &[&str], install: bool) -> Result<()> {
    let mut missing = not_installed(names);
    if missing.is_empty() {
        return Ok(());
    }
    if !install {
        let missing = missing.join(" ");
        return Err(Missing::error(format!("Debian's packages are not there: {missing} (--install gets them)")));
    }
    let complaint = apt_get(&missing);
    missing = not_installed(names);
    if missing.is_empty() {
        return Ok(());
    }
    let complaint = complaint.map_or_else(String::new, |complaint| format!(": {complaint}"));
    Err(Missing::error(format!("apt-get does not install {}{complaint}", missing.join(" "))))
}

/// Returns the packages of a list that are not installed; all of them if there is no dpkg.
fn not_installed<'a>(names: &[&'a str]) -> Vec<&'a str> {
    // a removed package also has a status, `config-files`
    let is_installed = |name: &&str| {
        let query = Command::new("dpkg-query").args(["--show", "--showformat=${db:Status-Status}", name]).output();
        query.is_ok_and(|output| output.stdout == b"installed")
    };
    names.iter().copied().filter(|name| !is_installed(name)).collect()
}

/// Installs packages with their required dependencies. Returns the first complaint of apt-get, if there is one.
fn apt_get(names: &[&str]) -> Option<String> {
    let update = ["update"].as_slice();
    let install = [["install", "--yes", "--no-install-recommends"].as_slice(), names].concat();
    for arguments in [update, &install] {
        // a package that asks a question would wait for an answer forever
        let output = Command::new("apt-get")
            .args(arguments)
            .env("DEBIAN_FRONTEND", "noninteractive")
            .env("LC_ALL", "C")
            .stdin(Stdio::null())
            .output();
        match output {
            Err(error) => return Some(error.to_string()),
            Ok(output) if !output.status.success() => {
                let messages = String::from_utf8_lossy(&output.stderr).into_owned();
                let line = messages.lines().find(|line| line.starts_with("E:")).or_else(|| messages.lines().last());
                return line.map(|line| line.trim_start_matches("E: ").to_owned());
            }
            Ok(_) => {}
        }
    }
    None
}

/// Installs a toolchain by rustup if it does not exist. Returns the reason if that fails.
pub(crate) fn toolchain(version: &str) -> Option<String> {
    let answers = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).stdin(Stdio::null()).env_remove("RUSTUP_TOOLCHAIN").output();
        output.is_ok_and(|output| output.status.success())
    };
    // `rustup run` and not `rustc +VERSION`, because `+` only works with rustup's own rustc and may install a compiler
    let has = || answers("rustup", &["run", version, "rustc", "--version"]);
    if !answers("rustup", &["--version"]) {
        return Some(format!("there is no rustup to get Rust {version}"));
    }
    if has() || (answers("rustup", &["toolchain", "install", version, "--profile", "minimal"]) && has()) {
        return None;
    }
    Some(format!("Rust {version} cannot be had (rustup toolchain install {version} says why)"))
}

/// Returns the oldest compiler version that the workspace accepts, from Cargo.toml.
pub(crate) fn oldest_compiler() -> Result<String> {
    let manifest = read("Cargo.toml")?;
    let version = manifest.lines().find_map(|line| line.strip_prefix("rust-version = \"")?.split('"').next());
    Ok(version.context("Cargo.toml has no rust-version")?.to_owned())
}

/// Returns major and minor number of the version in a text such as `rustc 1.96.0 (…)`.
pub(crate) fn version(text: &str) -> Option<(u32, u32)> {
    let word = text.split_whitespace().find(|word| word.starts_with(|letter: char| letter.is_ascii_digit()))?;
    let mut numbers = word.split('.').map(|number| number.parse().ok());
    Some((numbers.next()??, numbers.next()??))
}

#[cfg(test)]
mod tests {
    use super::{Missing, not_installed, oldest_compiler, packages, version};

    #[test]
    fn versions_are_compared_by_their_numbers() {
        assert_eq!(version("rustc 1.96.0 (ac68faa20 2026-05-25) (built from a source tarball)"), Some((1, 96)));
        assert!(version("rustc 1.9.0") < version("1.89"));
        assert_eq!(version("no version"), None);
        assert!(version(&oldest_compiler().expect("a version")) >= Some((1, 89)));
    }

    #[test]
    fn a_package_that_is_not_there_is_named_in_one_line() {
        assert_eq!(not_installed(&["no-such-package"]), ["no-such-package"]);
        let error = packages(&["no-such-package"], false).expect_err("it does not exist");
        assert!(error.is::<Missing>());
        let message = error.to_string();
        assert!(message.contains("no-such-package (--install gets them)") && !message.contains('\n'), "{message}");
        assert!(packages(&[], false).is_ok());
    }
}
