//! Colours annotated code: headings, formulas, what the compiler found, what it folded.

use std::fmt::Write as _;

use rne_emit::{Line, Listing};

use crate::palette::{FORMULA, FOUND, QUIET, TITLE};
use crate::render::layout::wrap;
use crate::render::letters::Letters;

/// Largest number of columns of a comment, as in emitted code.
const WIDTH: usize = 100;

/// Colours a listing of the compiler, line by line.
pub(crate) fn listing(listing: &Listing, letters: Letters) -> String {
    let mut text = String::new();
    for (index, section) in listing.sections.iter().enumerate() {
        if index > 0 {
            text.push('\n');
        }
        for line in &section.lines {
            let style = match line {
                Line::Heading(_) => TITLE,
                Line::Formula(_) => FORMULA,
                Line::SineCosine(..) | Line::Resolution { .. } => FOUND,
                Line::Folds(_) => QUIET,
                Line::Constant(_) | Line::Statement(..) | Line::Returned(_) => {
                    let _ = writeln!(text, "{line}");
                    continue;
                }
            };
            for line in comment(line, letters).lines() {
                let _ = writeln!(text, "{style}{line}{style:#}");
            }
        }
    }
    text
}

/// Writes a comment inside a function.
fn comment(line: &Line, letters: Letters) -> String {
    if !letters.ascii {
        return line.to_string();
    }
    let words = letters.of(&line.annotated().to_string());
    wrap(&format!("    // {words}"), WIDTH, "    //   ").replace('\u{A0}', " ")
}
