//! Colours for annotated code: headings, formulas, what was found, what was folded.

use std::fmt::Write as _;

use crate::terminal::{FORMULA, FOUND, QUIET, TITLE};

/// A listing of the compiler, coloured line by line: each section opens with a heading and the step's formulas, and its
/// last comment counts what was folded.
pub(crate) fn listing(text: &str) -> String {
    let mut coloured = String::new();
    let mut before = Kind::Blank;
    for line in text.lines() {
        let kind = Kind::of(line, before);
        let style = match kind {
            Kind::Heading { .. } => Some(TITLE),
            Kind::Formula { .. } => Some(FORMULA),
            Kind::Finding => Some(FOUND),
            Kind::Tally => Some(QUIET),
            Kind::Blank | Kind::Code => None,
        };
        let _ = match style {
            Some(style) => writeln!(coloured, "{style}{line}{style:#}"),
            None => writeln!(coloured, "{line}"),
        };
        before = kind;
    }
    coloured
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Blank,
    Heading {
        formulas: usize,
    },
    /// So many more follow.
    Formula {
        more: usize,
    },
    Code,
    Finding,
    Tally,
}

impl Kind {
    fn of(line: &str, before: Self) -> Self {
        let line = line.trim_start();
        let Some(comment) = line.strip_prefix("//") else {
            return if line.is_empty() { Self::Blank } else { Self::Code };
        };
        match before {
            // n_i, f_{i-1,i} and n_{i-1,i} of step 6; every other step has one formula
            Self::Blank => Self::Heading { formulas: if comment.contains(", step 6:") { 3 } else { 1 } },
            Self::Heading { formulas: left } | Self::Formula { more: left } if left > 0 => {
                Self::Formula { more: left - 1 }
            }
            Self::Tally => Self::Tally,
            _ if comment.trim_start().starts_with(|c: char| c.is_ascii_digit()) => Self::Tally,
            _ => Self::Finding,
        }
    }
}
