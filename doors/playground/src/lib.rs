//! The compiler of robot files for a web page that contains it: takes the text of a robot file, returns JSON.
//!
//! [`answer`] does all of it. [`border`] lets a page call it when it is compiled to WebAssembly.

pub mod border;

use std::ops::Range;

use rne_model::{Checked, Diagnostic, Reader, Report, Severity};
use serde_json::{Value, json};

/// The name of the text in messages.
const NAME: &str = "robot.yaml";

/// Returns what the compiler finds in the text of a robot file, as JSON: `diagnostics`, and `page` if there is no
/// error.
///
/// A diagnostic has `severity` (`error`, `warning` or `note`), `message`, `label` and `help` (texts or null), and its
/// place: `line` and `column` of the first character that is underlined, `end_line` and `end_column` of the first
/// character after it, all from 1, columns in characters. If numbers on several lines cause it together, it has no
/// place, and all four are null. `page` is that of `rne report`, with the plan that the compiler makes by itself.
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

/// Returns a diagnostic about the whole text.
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

/// Returns the line and the column after a span of the text that starts at `start`.
fn end(text: &str, span: &Range<usize>, start: (usize, usize)) -> (usize, usize) {
    let spanned = text.get(span.clone()).unwrap_or_default();
    spanned.chars().fold(start, |(line, column), c| if c == '\n' { (line + 1, 1) } else { (line, column + 1) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No short text is known whose torques cannot be compiled, so the JSON of such an error is tested on its own.
    #[test]
    fn what_has_no_place_is_told_as_what_has_one() {
        let keys = |told: &Value| told.as_object().expect("an object").keys().cloned().collect::<Vec<_>>();
        let said = answer("format: 3");
        let (with, without) = (&said["diagnostics"][0], without_place("a constant is too large"));
        assert_eq!(keys(with), keys(&without));
        assert!(with["line"] == 1 && without["line"].is_null() && without["message"] == "a constant is too large");
    }
}
