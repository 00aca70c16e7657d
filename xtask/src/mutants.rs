//! Mutants, that is, deliberate mistakes in the source that tests must notice: their data in xtask/mutants.yaml.

use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::machine;

/// The file with the mutants.
pub(crate) const FILE: &str = "xtask/mutants.yaml";

/// One deliberate change of the source, which the tests of `check` must notice.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mutant {
    /// The mistake that the mutant makes, in words.
    pub(crate) what: String,
    /// The path of the source file, from the root of the repository.
    pub(crate) file: String,
    /// The group of tests that must notice the mutant.
    pub(crate) check: Check,
    /// The text to replace, which occurs once in the source.
    pub(crate) old: String,
    /// The text that replaces `old`.
    pub(crate) new: String,
}

/// A group of tests that must notice mutants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Check {
    /// Comparison with the runtime library and with independent torques.
    Compare,
    /// The proof that the reduced form equals the seven steps.
    Prove,
    /// Comparison of the other functions with the runtime and with independent values.
    Functions,
    /// Comparison of emitted C code with derived Rust code.
    Code,
    /// Pages for students: equations, closed forms and pictures, compared with the runtime and Lagrange's equations.
    Views,
    /// Tests of robots with branches: both forms and the runtime library are compared with projected Newton-Euler, with
    /// Pinocchio and with each other.
    Trees,
}

impl Check {
    /// All groups, in the order of the document.
    pub(crate) const ALL: [Self; 6] =
        [Self::Compare, Self::Prove, Self::Functions, Self::Code, Self::Views, Self::Trees];

    /// Returns the arguments of `cargo test` that run these tests.
    pub(crate) fn tests(self) -> &'static [&'static str] {
        match self {
            Self::Compare => &["--test", "robots", "--test", "random"],
            Self::Prove => &[
                "-p",
                "rne-codegen",
                "-p",
                "rne-search",
                "--lib",
                "--test",
                "random_plans",
                "--",
                "are_the_seven_steps",
            ],
            Self::Functions => &["--test", "functions", "--", "equality::", "golden::"],
            Self::Code => &["--test", "c_code"],
            Self::Trees => &[
                "-p",
                "rne",
                "-p",
                "rne-codegen",
                "-p",
                "rne-search",
                "-p",
                "function-tests",
                "--lib",
                "--test",
                "functions",
                "--test",
                "trees",
                "--test",
                "random_plans",
                "--",
                "tree",
            ],
            Self::Views => &[
                "-p",
                "rne-inspection",
                "-p",
                "rne-symbolic",
                "-p",
                "rne-plot",
                "--lib",
                "--tests",
                "--",
                "lagranges",
                "equation",
                "torque",
                "part",
            ],
        }
    }

    /// Returns the heading of its section in the document.
    pub(crate) fn heading(self) -> &'static str {
        match self {
            Self::Compare => "The seven steps",
            Self::Prove => "The passes of the reduced form",
            Self::Functions => "The other functions",
            Self::Code => "C",
            Self::Views => "The teaching views",
            Self::Trees => "Trees",
        }
    }

    /// Returns the text of its section before the table.
    pub(crate) fn about(self) -> &'static str {
        match self {
            Self::Compare => {
                "\
The tests compare generated code with the runtime library and with torques of another program. If a test also derives
the form `reduced`, the compiler proves that this form equals the seven steps while cargo builds the test. The mutation
makes the seven steps wrong, so the proof fails, and `cargo build` fails instead of the test."
            }
            Self::Prove => {
                "\
These mutations are errors in the form `reduced`. The proof that this form equals the seven steps must refuse them; a
test that fails for another reason does not count. A mutation must make the function wrong. Another choice of a rod, of
a shift of an origin, or of a scale of lengths or forces gives the same function, so such a change is no mutation."
            }
            Self::Functions => {
                "The tests compare each function with the runtime library and with values of another program."
            }
            Self::Views => {
                "\
The tests compare equations with the runtime library, closed forms with Lagrange's equations, and the parts of a torque
with the torque."
            }
            Self::Trees => {
                "\
A mutation confuses the parent of a joint with the joint before it, or makes the placement of a row wrong. A chain does
not show it. The tests compare random and real trees with values that are independent of rne, and the form `reduced`
with the seven steps."
            }
            Self::Code => {
                "\
With these mutations, the C code does not compile, or its results differ from the results of derived Rust code."
            }
        }
    }
}

impl Mutant {
    /// Returns the source with the mutation. If the text to replace is missing or ambiguous, the error says what to do.
    pub(crate) fn apply(&self, source: &str) -> Result<String, String> {
        let Self { what, file, old, new, .. } = self;
        let advice = "write the mutant for today's source, or take it out";
        match source.matches(old).count() {
            1 if old == new => Err(format!("{FILE}: `{what}`: `old` and `new` are the same; {advice}")),
            1 => Ok(source.replacen(old, new, 1)),
            0 => Err(format!("{FILE}: `{what}`: {file} has no `{old}` any more; {advice}")),
            times => Err(format!("{FILE}: `{what}`: {file} has `{old}` {times} times; choose a longer text")),
        }
    }

    /// Reads the source from a copy of the repository and returns it with the mutation.
    pub(crate) fn applied_in(&self, tree: &Path) -> Result<String, String> {
        let Self { what, file, .. } = self;
        let source = std::fs::read_to_string(tree.join(file));
        self.apply(&source.map_err(|error| format!("{FILE}: `{what}`: {file}: {error}"))?)
    }
}

/// Reads all mutants of the repository.
pub(crate) fn all() -> Result<Vec<Mutant>> {
    serde_yaml::from_str(&machine::read(FILE)?).context(FILE)
}

#[cfg(test)]
mod tests {
    use super::{Check, Mutant, all};

    fn mutant() -> Mutant {
        let text = "{what: sign, file: a.rs, check: prove, old: a + b, new: a - b}";
        serde_yaml::from_str(text).expect("a mutant")
    }

    #[test]
    fn a_text_that_is_not_in_the_source_is_told_with_what_to_do() {
        assert_eq!(mutant().apply("let c = a + b;").as_deref(), Ok("let c = a - b;"));
        let gone = mutant().apply("let c = b + a;").expect_err("it is not there");
        let advice = "write the mutant for today's source, or take it out";
        assert_eq!(gone, format!("xtask/mutants.yaml: `sign`: a.rs has no `a + b` any more; {advice}"));
        assert!(mutant().apply("a + b + (a + b)").expect_err("twice").contains("2 times"));
        let missing = mutant().applied_in(std::path::Path::new("no such folder")).expect_err("no file");
        assert!(missing.starts_with("xtask/mutants.yaml: `sign`: a.rs: "), "{missing}");
    }

    #[test]
    fn every_check_has_mutants_and_descriptions_are_distinct() {
        let mutants = all().expect("the data");
        for check in Check::ALL {
            assert!(mutants.iter().any(|mutant| mutant.check == check), "{check:?}");
        }
        let mut names: Vec<&str> = mutants.iter().map(|mutant| mutant.what.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), mutants.len());
    }
}
