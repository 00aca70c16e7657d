//! The compiler for a page that has it inside: the text of a robot file in, JSON out.
//!
//! [`answer`] is all of it. [`border`] is how a page calls it where the module is WebAssembly.

pub mod border;

use std::ops::Range;

use rne_model::{Checked, Diagnostic, Reader, Report, Severity};
use serde_json::{Value, json};

/// What messages call the text.
const NAME: &str = "robot.yaml";

/// What the compiler says of the text of a robot file, as JSON: `diagnostics`, and `page` when there is no error in it.
///
/// A diagnostic has `severity` (`error`, `warning` or `note`), `message`, `label` and `help` (texts or null), and its
/// place: `line` and `column` of the first character that is underlined, `end_line` and `end_column` of the first that
/// is not, all from 1, columns in characters. What has no place in the text, for numbers of several lines make it up,
/// has null for all four. `page` is that of `rne report`, with the plan that the compiler makes by itself.
#[must_use]
pub fn answer(text: &str) -> Value {
    let Checked { robot, lints, .. } = match Reader::new(NAME).trees().couplings().read(text) {
        Ok(checked) => checked,
        Err(report) => return json!({ "diagnostics": diagnostics(&report) }),
    };
    let mut found = diagnostics(&lints);
    match rne_report::page(&robot, None) {
        Ok(page) => json!({ "diagnostics": found, "page": page }),
        Err(error) => {
            found.insert(0, without_place(&error.to_string()));
            json!({ "diagnostics": found })
        }
    }
}

fn diagnostics(report: &Report) -> Vec<Value> {
    report.diagnostics.iter().map(|found| diagnostic(&report.text, found)).collect()
}

fn diagnostic(text: &str, found: &Diagnostic) -> Value {
    let (end_line, end_column) = end(text, &found.span, (found.line, found.column));
    json!({
        "severity": match found.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            _ => "note",
        },
        "line": found.line,
        "column": found.column,
        "end_line": end_line,
        "end_column": end_column,
        "message": found.message,
        "label": found.label,
        "help": found.help,
    })
}

/// An error of the whole text.
fn without_place(message: &str) -> Value {
    json!({
        "severity": "error",
        "line": null,
        "column": null,
        "end_line": null,
        "end_column": null,
        "message": message,
        "label": null,
        "help": null,
    })
}

/// Line and column behind a span that starts at `start`.
fn end(text: &str, span: &Range<usize>, start: (usize, usize)) -> (usize, usize) {
    let spanned = text.get(span.clone()).unwrap_or_default();
    spanned.chars().fold(start, |(line, column), c| if c == '\n' { (line + 1, 1) } else { (line, column + 1) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No short text is known whose torques cannot be compiled, so the answer is looked at by itself.
    #[test]
    fn what_has_no_place_is_told_as_what_has_one() {
        let keys = |told: &Value| told.as_object().expect("an object").keys().cloned().collect::<Vec<_>>();
        let said = answer("format: 3");
        let (with, without) = (&said["diagnostics"][0], without_place("a constant is too large"));
        assert_eq!(keys(with), keys(&without));
        assert!(with["line"] == 1 && without["line"].is_null() && without["message"] == "a constant is too large");
    }
}
