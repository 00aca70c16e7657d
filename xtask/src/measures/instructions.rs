//! Compares exact counts of instructions with the committed baseline. benches/instructions.rs measures them with
//! gungraun and callgrind.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::measures::counts::Counts;

/// Instructions of one call: runs benches/instructions.rs under callgrind and prints a table beside the baseline
///
/// Another rustc than the baseline's makes other code: differences are printed then, and the exit code is 0. Needs
/// valgrind and gungraun-runner of the version in benches/Cargo.lock. CARGO_TARGET_DIR is obeyed.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a count grew by more than 2 % (same rustc), 2 when it cannot run.

Examples:
  cargo xtask instructions              judge
  cargo xtask instructions --update     write the baseline, benches/instructions.txt, anew
  cargo xtask instructions --install    get valgrind and the runner first")]
#[derive(Default)]
pub(crate) struct Instructions {
    /// Write the baseline, benches/instructions.txt, anew
    #[arg(long)]
    update: bool,
    /// Print the counts as a Markdown table, compare nothing
    #[arg(long)]
    markdown: bool,
    /// First get what is missing: the runner by cargo install into the target folder, valgrind by apt-get; where that
    /// fails, say so in one line and exit with 0
    #[arg(long)]
    pub(crate) install: bool,
}

const BASELINE: &str = "benches/instructions.txt";

impl Instructions {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let counts = self.count()?;
        if self.markdown {
            print!("{}", counts.markdown());
            return Ok(Verdict::Holds);
        }
        let rustc = compiler()?;
        if self.update {
            let head = "# Instructions of one call, written by: cargo xtask instructions --update";
            machine::write(BASELINE, &format!("{head}\n{rustc}\n{}", counts.baseline()))?;
        }
        let baseline = machine::read(BASELINE)?;
        let compared = counts.beside(&Counts::of_baseline(&baseline));
        print!("{}", compared.text);
        let of_baseline = baseline.lines().nth(1).with_context(|| format!("{BASELINE} names no compiler"))?;
        if rustc != of_baseline {
            println!("instruction counts: not judged, the baseline is of {of_baseline}, this is {rustc}");
        } else if compared.has_grown {
            println!("instruction counts: grown by more than 2 %; if that is meant, cargo xtask instructions --update");
            return Ok(Verdict::Fails);
        } else {
            println!("instruction counts: none grew by more than 2 % ({rustc})");
        }
        Ok(Verdict::Holds)
    }

    /// Runs the harness and returns the counts.
    pub(crate) fn count(&self) -> Result<Counts> {
        let target = machine::target_folder("benches/target")?; // absolute: the runner starts in another folder
        if !machine::has("valgrind") {
            if !self.install {
                return Err(Missing::error("there is no valgrind (apt-get install valgrind)"));
            }
            machine::packages(&["valgrind"], true)?;
        }
        let runner = self.runner(&target)?;
        let shell = machine::shell()?;
        shell.set_var("CARGO_TARGET_DIR", &target);
        shell.set_var("GUNGRAUN_RUNNER", runner);
        let bench = cmd!(
            shell,
            "cargo bench --manifest-path benches/Cargo.toml --no-default-features --locked --bench instructions
             -- --nosummary"
        );
        let output = machine::without_flags(bench).quiet().ignore_status().output()?;
        let (log, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        let counts = Counts::of_harness(&log);
        if !output.status.success() || counts.is_empty() {
            bail!("the harness counts nothing: {}\n{}{}", output.status, last_lines(&log), last_lines(&errors));
        }
        Ok(counts)
    }

    /// Returns the path of gungraun-runner in the target folder; installs it if that was asked for.
    fn runner(&self, target: &Path) -> Result<PathBuf> {
        let version = locked_version("gungraun-runner")?;
        let tools = target.join("tools");
        let runner = tools.join("bin/gungraun-runner");
        let output = Command::new(&runner).arg("--version").output();
        let found = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
        if found.split_whitespace().last() == Some(&version) {
            return Ok(runner);
        }
        if !self.install {
            let how = "cargo xtask instructions --install";
            return Err(Missing::error(format!("there is no gungraun-runner {version} ({how})")));
        }
        let log = target.join("gungraun-runner.log");
        let file = fs::File::create(&log).with_context(|| log.display().to_string())?;
        // The runner need not be fast, but its build should be: hence --debug, without debug information.
        let status = Command::new("cargo")
            .args(["install", "gungraun-runner", "--version", &version, "--locked", "--debug", "--root"])
            .arg(&tools)
            .env("CARGO_PROFILE_DEV_DEBUG", "0")
            .env("CARGO_TARGET_DIR", target.join("gungraun-runner"))
            .current_dir(machine::root())
            .stdout(Stdio::null())
            .stderr(file)
            .status()?;
        if !status.success() {
            let log = log.display();
            return Err(Missing::error(format!("gungraun-runner {version} cannot be installed ({log} says why)")));
        }
        Ok(runner)
    }
}

/// Returns the version of a package in benches/Cargo.lock.
fn locked_version(package: &str) -> Result<String> {
    let lock = machine::read("benches/Cargo.lock")?;
    let mut lines = lock.lines().skip_while(|line| *line != format!("name = \"{package}\"")).skip(1);
    let version = lines.next().and_then(|line| line.strip_prefix("version = \"")?.strip_suffix('"'));
    Ok(version.with_context(|| format!("benches/Cargo.lock has no {package}"))?.to_owned())
}

/// Returns the version of the compiler and the platform on which it runs.
pub(crate) fn compiler() -> Result<String> {
    let shell = machine::shell()?;
    let version = cmd!(shell, "rustc --version").quiet().read()?;
    let details = cmd!(shell, "rustc --version --verbose").quiet().read()?;
    let host = details.lines().find_map(|line| line.strip_prefix("host: ")).context("rustc names no host")?;
    Ok(format!("{version}, {host}"))
}

fn last_lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(40)..].iter().fold(String::new(), |text, line| text + line + "\n")
}

#[cfg(test)]
mod tests {
    use super::{compiler, locked_version};

    #[test]
    fn the_runner_has_the_version_of_the_harness() {
        assert_eq!(locked_version("gungraun-runner").expect("locked"), locked_version("gungraun").expect("locked"));
        assert!(locked_version("no-such-package").is_err());
    }

    #[test]
    fn the_compiler_is_named_with_its_host() {
        let compiler = compiler().expect("it is there");
        assert!(compiler.starts_with("rustc 1.") && compiler.contains("), "), "{compiler}");
    }
}
