//! A valid file and ways to break it.
#![allow(unreachable_pub)]

use rne_model::{Diagnostic, Reader, Report};

/// A valid file; the tests count on its lines.
pub const BASE: &str = include_str!("../robots/base.yaml");

/// So many steps of work the worst files of 1 MiB may cost.
pub const MOST_WORK: usize = 32 << 20;

/// The valid file with one passage replaced.
pub fn with(old: &str, new: &str) -> String {
    assert_eq!(BASE.matches(old).count(), 1, "`{old}` must occur once");
    BASE.replace(old, new)
}

/// Everything found in a text, be it valid or not.
pub fn found(text: &str) -> Report {
    match Reader::new("robots/x.yaml").read(text) {
        Ok(checked) => checked.lints,
        Err(report) => report,
    }
}

/// The one diagnostic of the valid file with one passage replaced.
pub fn the_one(old: &str, new: &str) -> Diagnostic {
    let report = found(&with(old, new));
    assert_eq!(report.diagnostics.len(), 1, "`{new}`:\n{report}");
    report.diagnostics[0].clone()
}
