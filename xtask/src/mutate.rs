//! Checks whether the tests notice mistakes: breaks the compiler in one place at a time, in a copy of this repository,
//! and runs the tests.
//!
//! `mutants.yaml` has mistakes that need knowledge of dynamics, such as a missing term or a wrong sign. Changes that
//! need none (an operator, a comparison, a returned value) are made by cargo-mutants, which `.cargo/mutants.toml`
//! configures:
//!
//! ```sh
//! cargo install cargo-mutants --locked
//! cargo mutants --file compiler/codegen/src/ir/graph.rs        # one file, with the tests that compare and prove
//! cargo mutants --in-diff <(git diff main)                # what a change has touched
//! cargo mutants --list --file 'compiler/codegen/src/**/*.rs'   # which there are
//! ```

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use regex_lite::Regex;
use tempfile::TempDir;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine;
use crate::mutants::{self, Check, Mutant};

/// Breaks the compiler in one place at a time, in a copy of this tree, and runs the tests that must notice
///
/// The mutants are those of xtask/mutants.yaml; docs/measured/mutations.md is what this prints. A mutant of the reduced
/// form takes some ten to thirty seconds, another one some minutes. Plain mutants (an operator, a comparison) are the
/// business of cargo-mutants: `cargo mutants --file compiler/codegen/src/ir/graph.rs`, set up in .cargo/mutants.toml.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a mutant survives, 2 when a mutant's text is not in the source any more.

Examples:
  cargo xtask mutate             all mutants
  cargo xtask mutate Coriolis    those whose file and description match a regular expression
  cargo xtask mutate --look      whether all texts are in the source; runs no test
  cargo xtask mutate --update    write docs/measured/mutations.md anew")]
pub(crate) struct Mutate {
    /// Those whose file and description match
    #[arg(default_value = "", hide_default_value = true)]
    regex: Regex,
    /// Only look whether each mutant's text is in the source
    #[arg(long)]
    look: bool,
    /// Write docs/measured/mutations.md anew
    #[arg(long, conflicts_with_all = ["regex", "look"])]
    update: bool,
}

const PAGE: &str = "docs/measured/mutations.md";

const HEAD: &str = "\
# Mutations

A mutation is a change that makes one term of the source code wrong. This page lists mutations, and the tests that fail
because of them. `cargo xtask mutate --update` writes the page: it makes each mutation in a copy of the repository and
runs the tests that the section names. If no test fails, its exit status is 1.
[xtask/mutants.yaml](../../xtask/mutants.yaml) contains the old and the new text of each mutation. All mutations of this
page need knowledge of dynamics or of the compiler. `cargo mutants` makes the other kind: it exchanges operators and
comparisons.
";

impl Mutate {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let is_meant = |mutant: &Mutant| self.regex.is_match(&format!("{} {}", mutant.file, mutant.what));
        let mutants: Vec<Mutant> = mutants::all()?.into_iter().filter(is_meant).collect();
        let lost: Vec<String> = mutants.iter().filter_map(|it| it.applied_in(machine::root()).err()).collect();
        if !lost.is_empty() {
            bail!("{} of {} mutants cannot be made\n  {}", lost.len(), mutants.len(), lost.join("\n  "));
        }
        if self.look {
            println!("mutate: the texts of {} mutants are in the source", mutants.len());
            return Ok(Verdict::Holds);
        }
        if mutants.is_empty() {
            bail!("no file and description matches `{}`", self.regex);
        }
        let laboratory = Laboratory::new()?;
        let mut page = HEAD.to_owned();
        print!("{HEAD}");
        let mut survivors = 0;
        for check in Check::ALL {
            let mutants: Vec<&Mutant> = mutants.iter().filter(|mutant| mutant.check == check).collect();
            if mutants.is_empty() {
                continue;
            }
            if let Some(tests) = laboratory.failing(check)?.words() {
                bail!("without any mutation these fail: {tests}");
            }
            let head = section(check);
            print!("{head}");
            page.push_str(&head);
            for mutant in mutants {
                let caught = laboratory.caught(mutant)?;
                survivors += usize::from(!caught.is_a_catch());
                let line = format!("| {} | {} |\n", mutant.what, caught.words().as_deref().unwrap_or("**none**"));
                print!("{line}");
                page.push_str(&line);
            }
        }
        if self.update {
            machine::write(PAGE, &page)?;
        }
        if survivors > 0 {
            eprintln!("mutate: {survivors} survived");
        }
        Ok(Verdict::from(survivors == 0))
    }
}

/// Returns the heading of a section and of its table.
fn section(check: Check) -> String {
    let head = if check == Check::Prove { "refused by the proof in" } else { "caught by" };
    let (heading, about, tests) = (check.heading(), check.about(), check.tests().join(" "));
    format!("\n## {heading}\n\n{about}\n\n    cargo test {tests}\n\n| mutation | {head} |\n|---|---|\n")
}

/// The result of the tests with a mutant.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Caught {
    Nothing,
    /// These tests failed.
    By(BTreeSet<String>),
    /// The build of the tests failed, because the proof in a derive refused the mutant.
    Build,
    /// Tests failed, but not because the proof refused the mutant.
    SomethingElse,
}

impl Caught {
    fn is_a_catch(&self) -> bool {
        matches!(self, Self::By(_) | Self::Build)
    }

    fn words(&self) -> Option<String> {
        match self {
            Self::Nothing => None,
            Self::By(names) => {
                let more =
                    names.len().checked_sub(2).map(|after| format!(" and {} more", after + 1)).unwrap_or_default();
                names.first().map(|name| format!("`{name}`{more}"))
            }
            Self::Build => Some("`cargo build`: the proof refuses in `derive(InverseDynamics)`".to_owned()),
            Self::SomethingElse => Some("**something else**".to_owned()),
        }
    }

    /// Finds the failed tests in the output of a test run. `None` if the output shows no failure of a test.
    fn of(check: Check, log: &str) -> Option<Self> {
        let names = if check == Check::Prove { refused(log) } else { failed(log) };
        if !names.is_empty() {
            return Some(Self::By(names));
        }
        let is_refused =
            log.lines().any(|line| line.starts_with("error: ") && line.contains(" is not the seven steps"));
        if is_refused {
            return Some(Self::Build);
        }
        log.lines().any(|line| line.starts_with("test result: FAILED")).then_some(Self::SomethingElse)
    }
}

/// Returns the tests whose output says that the proof refuses.
fn refused(log: &str) -> BTreeSet<String> {
    let mut name = None;
    let mut names = BTreeSet::new();
    for line in log.lines() {
        if let Some(test) = line.strip_prefix("---- ").and_then(|line| line.strip_suffix(" stdout ----")) {
            name = Some(test);
        } else if line.starts_with("the proof refuses ") {
            names.extend(name.map(str::to_owned));
        }
    }
    names
}

/// Returns the tests in the list of failures.
fn failed(log: &str) -> BTreeSet<String> {
    let names = log.lines().filter_map(|line| line.strip_prefix("    "));
    let is_name = |name: &&str| {
        name.starts_with(|letter: char| letter.is_ascii_lowercase())
            && name
                .chars()
                .all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || "_:".contains(letter))
    };
    names.filter(is_name).map(str::to_owned).collect()
}

/// A copy of the repository, in which one source is broken at a time.
struct Laboratory {
    tree: TempDir,
    shell: Shell,
}

impl Laboratory {
    fn new() -> Result<Self> {
        let tree = tempfile::tempdir()?;
        copy(machine::root(), tree.path())?;
        let shell = Shell::new()?;
        shell.change_dir(tree.path());
        let target = std::env::var_os("MUTATE_TARGET_DIR").map_or_else(|| tree.path().join("target"), PathBuf::from);
        shell.set_var("CARGO_TARGET_DIR", target);
        // One random robot that fails is enough; the search for the smallest one takes long.
        shell.set_var("PROPTEST_MAX_SHRINK_ITERS", "0");
        shell.set_var("RUST_BACKTRACE", "0");
        Ok(Self { tree, shell })
    }

    /// Applies a mutant, finds the tests that notice it, and restores the source.
    fn caught(&self, mutant: &Mutant) -> Result<Caught> {
        let file = self.tree.path().join(&mutant.file);
        let original = fs::read_to_string(&file).with_context(|| file.display().to_string())?;
        fs::write(&file, mutant.apply(&original).map_err(anyhow::Error::msg)?)?;
        let caught = self.failing(mutant.check);
        fs::write(&file, original)?;
        caught.with_context(|| mutant.what.clone())
    }

    /// Runs the tests on the tree as it is now, and returns those that fail.
    fn failing(&self, check: Check) -> Result<Caught> {
        let tests = check.tests();
        let output =
            cmd!(self.shell, "cargo test --quiet --no-fail-fast {tests...}").quiet().ignore_status().output()?;
        if output.status.success() {
            return Ok(Caught::Nothing);
        }
        let log = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        Caught::of(check, &log).with_context(|| format!("the tests do not run\n{log}"))
    }
}

/// Copies a folder without the folders `.git` and `target`.
fn copy(from: &Path, to: &Path) -> Result<()> {
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            if !["target", ".git"].iter().any(|name| entry.file_name() == *name) {
                fs::create_dir_all(&target)?;
                copy(&entry.path(), &target)?;
            }
        } else {
            fs::copy(entry.path(), &target).with_context(|| entry.path().display().to_string())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Caught, section};
    use crate::machine;
    use crate::mutants::{self, Check};

    const LOG: &str = "\
---- reduced::tests::random_plans_are_the_seven_steps stdout ----
the proof refuses torque 3
---- reduced::tests::others stdout ----
assertion failed

failures:
    reduced::tests::others
    reduced::tests::random_plans_are_the_seven_steps

test result: FAILED. 0 passed; 2 failed
";

    #[test]
    fn of_a_proof_only_a_refusal_counts() {
        let words = |check, log| Caught::of(check, log).expect("something").words().expect("something");
        assert_eq!(words(Check::Prove, LOG), "`reduced::tests::random_plans_are_the_seven_steps`");
        assert_eq!(words(Check::Compare, LOG), "`reduced::tests::others` and 1 more");
        let both = ["reduced::tests::others", "reduced::tests::random_plans_are_the_seven_steps"];
        assert_eq!(Caught::of(Check::Compare, LOG), Some(Caught::By(both.map(str::to_owned).into())));
        assert_eq!(
            Caught::of(Check::Prove, &LOG.replace("the proof refuses", "it refuses")),
            Some(Caught::SomethingElse)
        );
        let build = "error: the reduced form of `arm` is not the seven steps: torque 1\n";
        assert_eq!(Caught::of(Check::Compare, build), Some(Caught::Build));
        assert_eq!(Caught::of(Check::Compare, "error: unresolved import\n"), None);
    }

    /// The page lists these mutants in this order, and each was noticed.
    #[test]
    fn the_page_is_what_is_printed() {
        let page = machine::read(super::PAGE).expect("the page");
        let mut rest = page.strip_prefix(super::HEAD).expect("its head");
        for check in Check::ALL {
            rest = rest.strip_prefix(&section(check)).unwrap_or_else(|| panic!("no section of {check:?}: {rest:.200}"));
            for mutant in mutants::all().expect("the data").iter().filter(|mutant| mutant.check == check) {
                let line;
                (line, rest) = rest.split_once('\n').expect("a line");
                assert!(line.starts_with(&format!("| {} | `", mutant.what)), "{}: {line}", mutant.what);
            }
        }
        assert_eq!(rest, "");
    }
}
