//! Checks that take longer than `cargo test`: more samples, more targets, more compilers.

use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;
use serde_json::{Value, json};
use xshell::cmd;

use crate::Verdict;
use crate::{certificate, machine};

/// Verifies what `cargo test` only samples
///
/// Each step is a command that a person can type; `--list` prints them. A step that this machine cannot do is skipped
/// with one line. `.ci/run` runs them all.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a step fails.

Examples:
  cargo xtask verify             all steps
  cargo xtask verify --install   all steps, with the tools that they need
  cargo xtask verify msrv        one of them
  cargo xtask verify --list      the steps and their commands")]
pub(crate) struct Verify {
    /// The steps; all, unless some are named
    #[arg(value_name = "STEP")]
    names: Vec<String>,
    /// Print the steps instead
    #[arg(long)]
    list: bool,
    /// First get what a step needs by apt-get (Debian)
    #[arg(long)]
    pub(crate) install: bool,
}

/// A check: a command, and what it needs.
struct Step {
    name: &'static str,
    about: &'static str,
    /// Environment variables of the command.
    variables: &'static [(&'static str, &'static str)],
    command: &'static [&'static str],
    /// Requirements of the step; it is skipped if they are not met.
    needs: Needs,
}

/// A placeholder in a command, replaced by `--test NAME` for every test of the packages that `cargo test` does not
/// select by default.
const TESTS_OF_REST: &str = "TESTS_OF_REST";

/// A requirement of a step.
enum Needs {
    Nothing,
    /// The oldest compiler that Cargo.toml allows, which rustup installs.
    OldestCompiler,
    /// Packages of Debian, which must be installed.
    Packages(&'static [&'static str]),
    /// A program on PATH or in `target/tools`.
    Program(&'static str),
    /// Time: the step only runs if `CI_FULL` is set.
    Time,
    /// Time, and another requirement.
    TimeAnd(&'static Needs),
    /// A tag of this repository, with which the step compares.
    Tag,
}

/// The steps. Each uses a target folder that earlier steps have filled as far as possible. Steps do not select packages
/// if they can avoid it, because cargo would then drop the features that other packages ask of shared crates and
/// compile all of them again. The four steps that test all formats of logs select all packages and share the compiled
/// code.
const STEPS: &[Step] = &[
    Step {
        name: "intervals",
        about: "torques enclosed by intervals, where this processor rounds as told",
        variables: &[("RUSTFLAGS", "-C target-cpu=native"), ("CARGO_TARGET_DIR", "target/native")],
        command: &["cargo", "test", "--package", "rne", "--test", "scalars"],
        needs: Needs::Time,
    },
    Step {
        name: "users",
        about: "what a user sees who builds rne: messages, warnings, rebuilds, an editor, the cost of a derive",
        variables: &[],
        command: &[
            "cargo",
            "test",
            "--test",
            "ui",
            "--test",
            "hygiene",
            "--test",
            "rebuild",
            "--test",
            "editor",
            "--test",
            "compile_time",
            "--test",
            "no_std",
        ],
        needs: Needs::Nothing,
    },
    Step {
        name: "rest",
        about: "tests of the packages that `cargo test` leaves out, with all formats of logs",
        variables: &[],
        command: &["cargo", "test", "--workspace", "--features", "rne-cli/full", "--lib", "--bins", TESTS_OF_REST],
        needs: Needs::Nothing,
    },
    Step {
        name: "examples",
        about: "examples in the reference of all packages",
        variables: &[],
        command: &["cargo", "test", "--workspace", "--features", "rne-cli/full", "--doc"],
        needs: Needs::Nothing,
    },
    Step {
        name: "formats",
        about: "the command line with logs in bags and Parquet, which a build without their features leaves out",
        variables: &[],
        command: &[
            "cargo",
            "test",
            "--workspace",
            "--features",
            "rne-cli/full",
            "--test",
            "cli",
            "--",
            "bags",
            "bounds",
            "corrupt",
            "formats",
            "labels",
            "tables",
            "log::",
            "log_tables",
        ],
        needs: Needs::Nothing,
    },
    Step {
        name: "hostile",
        about: "hundreds of hostile inputs within 200 MB and 2 s each",
        variables: &[("RNE_EXHAUSTIVE", "1")],
        command: &["cargo", "test", "--release", "--test", "cli", "--", "hostile"],
        needs: Needs::Time,
    },
    Step {
        name: "certify",
        about: "certificates of three arms, thirty mutations of C code before the checker, a firmware that builds",
        variables: &[("RNE_EXHAUSTIVE", "1")],
        command: &[
            "cargo",
            "test",
            "--workspace",
            "--features",
            "rne-cli/full",
            "--test",
            "cli",
            "--",
            "--include-ignored",
            "certify",
            "documents",
            "examples_of_helps",
            "what_is_written_builds",
        ],
        needs: Needs::Packages(&certificate::OF_COMMAND_LINE),
    },
    Step {
        name: "exhaustive",
        about: "all shipped arms, thousands of random ones and of random trees, where `cargo test` tries some",
        variables: &[("RNE_EXHAUSTIVE", "1")],
        command: &["cargo", "test", "--workspace", "--release"],
        needs: Needs::Time,
    },
    Step {
        name: "c_code",
        about: "every shipped robot: derived code beside its C, the machine and the interpreter at a million states",
        variables: &[("RNE_EXHAUSTIVE", "1")],
        command: &["cargo", "test", "--package", "rne", "--test", "c_code_of_every_robot"],
        needs: Needs::Time,
    },
    Step {
        name: "native",
        about: "single calls of an arm at run time as instructions of the processor",
        variables: &[],
        command: &["cargo", "test", "--features", "rne-machine/native", "--test", "native"],
        needs: Needs::Time,
    },
    Step {
        name: "python",
        about: "the wheel in a clean environment, against numpy",
        variables: &[],
        command: &["cargo", "xtask", "python", "--install"],
        needs: Needs::Nothing,
    },
    Step {
        name: "python_peers",
        about: "the wheel against Pinocchio and with CasADi, and the notebooks",
        variables: &[],
        command: &["cargo", "xtask", "python", "--install", "--peers", "--casadi", "--notebooks"],
        needs: Needs::Time,
    },
    Step {
        name: "fmu",
        about: "FMUs validated and simulated by FMPy, which is fetched",
        variables: &[],
        command: &["cargo", "xtask", "fmu", "--install"],
        needs: Needs::Time,
    },
    Step {
        name: "playground",
        about: "the compiler as WebAssembly in a page, in headless Chromium",
        variables: &[],
        command: &["cargo", "xtask", "playground", "--install", "--no-serve", "--test"],
        needs: Needs::Time,
    },
    Step {
        name: "site",
        about: "the documents, the playground, reports and the reference as a site, in headless Chromium",
        variables: &[],
        command: &["cargo", "xtask", "site", "--install", "--test"],
        needs: Needs::Time,
    },
    Step {
        name: "book",
        about: "the lecture as a book",
        variables: &[],
        command: &["cargo", "xtask", "tool", "book"],
        needs: Needs::Program("mdbook"),
    },
    Step {
        name: "urdf",
        about: "real arms imported from URDF beside Pinocchio, which is fetched",
        variables: &[],
        command: &["cargo", "xtask", "urdf", "--install"],
        needs: Needs::Time,
    },
    Step {
        name: "corpora",
        about: "whole robots of packages through every door of the Python wheel, beside Pinocchio and MuJoCo",
        variables: &[],
        command: &["cargo", "xtask", "urdf", "--install", "--corpora"],
        needs: Needs::Time,
    },
    Step {
        name: "no_std",
        about: "the facade, the runtime and the plain types of the table without `std`",
        variables: &[],
        command: &["cargo", "check", "--package", "rne", "--package", "rne-model", "--no-default-features"],
        needs: Needs::Nothing,
    },
    Step {
        name: "features",
        about: "no feature, each by itself, all",
        variables: &[],
        command: &["cargo", "xtask", "features"],
        needs: Needs::Nothing,
    },
    Step {
        name: "feature_pairs",
        about: "every pair of features by itself",
        variables: &[],
        command: &["cargo", "xtask", "features", "--pairs"],
        needs: Needs::Time,
    },
    Step {
        name: "floats",
        about: "`f32` and `f64` without simba have the bits that they have with it",
        variables: &[],
        command: &[
            "cargo",
            "test",
            "--package",
            "rne-runtime",
            "--no-default-features",
            "--features",
            "std",
            "--test",
            "floats",
        ],
        needs: Needs::Nothing,
    },
    Step {
        name: "mpc",
        about: "optimal control of the example, whose solver CMake builds",
        variables: &[],
        command: &["cargo", "test", "--manifest-path", "examples/mpc/Cargo.toml", "--locked"],
        needs: Needs::TimeAnd(&Needs::Packages(&["cmake", "g++"])),
    },
    Step {
        name: "deny",
        about: "licences, sources and duplicates of dependencies",
        variables: &[],
        command: &["cargo", "xtask", "tool", "deny"],
        needs: Needs::Program("cargo-deny"),
    },
    Step {
        name: "semver",
        about: "the public interface against the last tag",
        variables: &[],
        command: &["cargo", "xtask", "tool", "semver"],
        needs: Needs::Tag,
    },
    Step {
        name: "package",
        about: "packages as a registry takes them, and a crate that has nothing else",
        variables: &[],
        command: &["cargo", "xtask", "package"],
        needs: Needs::Nothing,
    },
    Step {
        name: "release",
        about: "wheels and binaries, each tried where nothing else of rne is",
        variables: &[],
        command: &["cargo", "xtask", "release", "--dry-run"],
        needs: Needs::Time,
    },
    Step {
        name: "msrv",
        about: "the oldest compiler that Cargo.toml allows builds what users build",
        variables: &[("CARGO_TARGET_DIR", "target/msrv")],
        command: &["cargo", "+OLDEST", "check", "--locked"],
        needs: Needs::TimeAnd(&Needs::OldestCompiler),
    },
];

impl Verify {
    pub(crate) fn run(&self) -> Result<Verdict> {
        if let Some(unknown) = self.names.iter().find(|name| !STEPS.iter().any(|step| step.name == **name)) {
            let names: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
            bail!("there is no step `{unknown}`; there are {}", names.join(", "));
        }
        let oldest = machine::oldest_compiler()?;
        let mut failed = Vec::new();
        for step in STEPS.iter().filter(|step| self.names.is_empty() || self.names.iter().any(|name| name == step.name))
        {
            let words = step.words(&oldest);
            if self.list {
                println!("{:<12}{}\n            {words}", step.name, step.about);
            } else if let Some(lack) = step.needs.lack(&oldest, self.install) {
                println!("verify {}: skipped, {lack}", step.name);
            } else {
                println!("verify {}: {words}", step.name);
                let start = Instant::now();
                if !step.holds(&oldest)? {
                    failed.push(step.name);
                }
                println!("verify {}: {:.0} s", step.name, start.elapsed().as_secs_f64());
            }
        }
        if !failed.is_empty() {
            println!("verify: failed: {}", failed.join(", "));
        }
        Ok(Verdict::from(failed.is_empty()))
    }
}

impl Step {
    /// Returns the command as a person types it.
    fn words(&self, oldest: &str) -> String {
        let quoted = |value: &str| if value.contains(' ') { format!("'{value}'") } else { value.to_owned() };
        let variables = self.variables.iter().map(|(name, value)| format!("{name}={}", quoted(value)));
        let command = self.command.iter().map(|word| {
            if *word == TESTS_OF_REST { "--test NAME of each".to_owned() } else { word.replace("OLDEST", oldest) }
        });
        variables.chain(command).collect::<Vec<_>>().join(" ")
    }

    fn holds(&self, oldest: &str) -> Result<bool> {
        let shell = machine::shell()?;
        let mut command = Vec::new();
        for word in self.command {
            if *word == TESTS_OF_REST {
                command.extend(tests_of_rest()?.into_iter().flat_map(|name| ["--test".to_owned(), name]));
            } else {
                command.push(word.replace("OLDEST", oldest));
            }
        }
        let (program, arguments) = command.split_first().expect("a command has a program");
        let command = machine::without_flags(cmd!(shell, "{program} {arguments...}")).quiet();
        // the command chooses its own toolchain, not the one in which this program was started
        let command = command.env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO").envs(self.variables.iter().copied());
        Ok(command.run().is_ok())
    }
}

/// Returns the names of the tests of all packages that are not default members of the workspace, from cargo's metadata.
fn tests_of_rest() -> Result<Vec<String>> {
    let shell = machine::shell()?;
    let metadata = cmd!(shell, "cargo metadata --no-deps --format-version 1").quiet().read()?;
    let metadata: Value = serde_json::from_str(&metadata)?;
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let by_default = list(&metadata["workspace_default_members"]);
    let packages = list(&metadata["packages"]).into_iter().filter(|package| !by_default.contains(&package["id"]));
    let targets = packages.flat_map(|package| list(&package["targets"]));
    let tests = targets.filter(|target| target["kind"] == json!(["test"]) && target["test"] == json!(true));
    Ok(tests.filter_map(|target| Some(target["name"].as_str()?.to_owned())).collect())
}

impl Needs {
    /// Returns why the requirement is not met; `None` if it is met.
    fn lack(&self, oldest: &str, install: bool) -> Option<String> {
        match self {
            Self::Nothing => None,
            Self::Packages(names) => machine::packages(names, install).err().map(|error| error.to_string()),
            Self::OldestCompiler => machine::toolchain(oldest),
            Self::Program(name) => {
                let here = machine::root().join("target/tools/bin").join(name).is_file() || machine::has(name);
                let task = name.trim_start_matches("cargo-");
                (!here).then(|| format!("there is no {name} (cargo xtask tool {task} --install)"))
            }
            Self::TimeAnd(other) => Self::Time.lack(oldest, install).or_else(|| other.lack(oldest, install)),
            Self::Time => std::env::var_os("CI_FULL").is_none().then(|| "it takes long (CI_FULL=1)".to_owned()),
            Self::Tag => {
                let tag = machine::shell()
                    .ok()
                    .map(|shell| cmd!(shell, "git describe --tags").quiet().ignore_stderr().read());
                tag.is_none_or(|tag| tag.is_err()).then(|| "there is no tag to compare with".to_owned())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::STEPS;

    #[test]
    fn steps_are_told_apart_and_can_be_typed() {
        for step in STEPS {
            assert_eq!(STEPS.iter().filter(|other| other.name == step.name).count(), 1, "{}", step.name);
        }
        let intervals = STEPS.iter().find(|step| step.name == "intervals").expect("it is there");
        let typed = intervals.words("1.89");
        assert!(typed.starts_with("RUSTFLAGS='-C target-cpu=native' CARGO_TARGET_DIR=target/native cargo "), "{typed}");
        assert!(STEPS.iter().any(|step| step.words("1.89").contains("cargo +1.89 check")));
    }
}
