//! The patterns that the task `prose` refuses, with advice.

use anyhow::{Context, Result};
use regex_lite::Regex;

/// A pattern that is refused.
pub(super) struct Rule {
    /// The pattern, as a regular expression.
    pub(super) pattern: &'static str,
    /// Whether the pattern only counts at the beginning of a sentence.
    pub(super) begins: bool,
    /// Advice on what to write instead.
    pub(super) instead: &'static str,
    /// A text that the rule must find, for the test.
    #[cfg_attr(not(test), expect(dead_code, reason = "the test of the rules reads it"))]
    pub(super) example: &'static str,
}

const fn anywhere(pattern: &'static str, instead: &'static str, example: &'static str) -> Rule {
    Rule { pattern, begins: false, instead, example }
}

const fn at_the_beginning(pattern: &'static str, instead: &'static str, example: &'static str) -> Rule {
    Rule { pattern, begins: true, instead, example }
}

pub(super) const RULES: &[Rule] = &[
    at_the_beginning(r"Of\b", "name the subject: \"gain of …\", \"for a … the …\"", "Of the momentum observer, Hz"),
    at_the_beginning(r"What\b", "begin with the noun or the verb", "What a motor adds to the torque of its joint."),
    at_the_beginning(
        r"(The same[.,]|The same (as|but|in|on|for|with|when|where|from|of|by)\b)",
        "say what it is or does",
        "The same in the axes of the base.",
    ),
    at_the_beginning(r"None( yet)?\.", "say what is absent", "None yet."),
    at_the_beginning(r"So many\b", "\"number of …\"", "So many states are tried."),
    at_the_beginning(r"Which\b", "begin with the noun", "Which step has the sine."),
    at_the_beginning(r"(Those|That) (of|which|that)\b", "repeat the noun", "Those of the compiled target."),
    at_the_beginning(r"Nor\b", "a sentence with \"no\" or \"not\"", "Nor is one excited that only joints feel."),
    anywhere(r"\b(take|takes|taken|taking|took) (it|them|this|that|one|all) away\b", "remove", "take it away"),
    anywhere(r"\b(is|are) none\b", "\"there is no …\", \"is not a …\"", "numbers that are none"),
    anywhere(r"\bso many\b", "number of …", "so many blocks at least"),
    anywhere(r"\b(those|that) of (those|that)\b", "repeat the noun", "those of those before"),
    anywhere(r"\b(is|are) of no\b", "\"belongs to no …\"", "a row is of no free motion"),
    anywhere(r"\b(stays|stay) as (it is|they are)\b", "is not changed", "the file stays as it is"),
    anywhere(r"\bpassed over\b", "ignored", "others are passed over"),
    anywhere(r"\b(is|are) there already\b", "exists", "out.yaml is there already"),
    anywhere(r"\b(is|are) (said|told)\b", "is reported", "which is said, with its time"),
    anywhere(r"\b(hold|holds|held) (it |them )?against\b", "compare with", "to be held against the log"),
    anywhere(
        r"\bbehind (the (filter|low-pass|last|point|name|first)|another|it\b|each other|[0-9])",
        "after",
        "both behind 1.6 Hz",
    ),
    anywhere(r"\bhalf as much again\b", "1.5 times", "half as much again as where motion ends"),
    anywhere(r"\bstands? where\b", "found … where … is needed", "`)` stands where a number is needed"),
    anywhere(r"\bheld still\b", "locked", "the joint is held still"),
    anywhere(r"\bcut short\b", "incomplete", "the number is cut short"),
    anywhere(r"\bunless given\b", "[default: …]", "the low-pass; by the spectrum, unless given"),
];

/// Compiles the rules. A sentence begins at the beginning of a text, or after the mark that ends another; emphasis may
/// come between.
pub(super) fn rules() -> Result<Vec<(Regex, &'static Rule)>> {
    let of = |rule: &'static Rule| {
        let pattern =
            if rule.begins { format!(r"(?:^|[.!?:] )[*\[]*{}", rule.pattern) } else { format!("(?i){}", rule.pattern) };
        Ok((Regex::new(&pattern).with_context(|| rule.pattern)?, rule))
    };
    RULES.iter().map(of).collect()
}
