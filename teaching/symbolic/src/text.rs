//! Writes the document as text with 80 columns.

use std::fmt::Write as _;

use unicode_width::UnicodeWidthStr as _;

use crate::ClosedForm;
use crate::document::{Item, sections};
use crate::notation::Script;
use crate::written::COLUMNS;

/// Indentation of formulas.
const INDENT: usize = 2;

/// Returns the document with `spelling` applied to letters.
pub(crate) fn text(form: &ClosedForm, spelling: impl Fn(&str) -> String) -> String {
    let mut parts = Vec::new();
    for section in sections(form, Script::Unicode) {
        let mut text = String::new();
        if !section.title.is_empty() {
            let _ = writeln!(text, "{}", spelling(&section.title.concat()));
        }
        let indent = if section.title.is_empty() { 0 } else { INDENT };
        for item in section.items {
            match item {
                Item::Formula { left, width: _, right } => {
                    let (left, right) = (spelling(&left), right.spelt(&spelling));
                    let head = indent + left.width() + 3;
                    for (at, (depth, line)) in right.lines(head, indent + 4, COLUMNS).into_iter().enumerate() {
                        let _ = match at {
                            0 => writeln!(text, "{:indent$}{left} = {line}", ""),
                            _ => writeln!(text, "{:1$}{line}", "", indent + 4 + 2 * depth),
                        };
                    }
                }
                Item::Words(words) => {
                    filled(&mut text, indent, spelling(&words.concat()).split(' ').map(str::to_owned));
                }
                Item::List(entries) => {
                    let last = entries.len().saturating_sub(1);
                    let entry = |(at, (formula, unit)): (usize, (String, String))| {
                        let comma = if at == last { "" } else { "," };
                        let space = if unit.is_empty() { "" } else { " " };
                        spelling(&format!("{formula}{space}{unit}{comma}"))
                    };
                    filled(&mut text, indent + 2, entries.into_iter().enumerate().map(entry));
                }
            }
        }
        parts.push(text);
    }
    parts.join("\n")
}

/// Fills lines with words.
fn filled(text: &mut String, indent: usize, words: impl Iterator<Item = String>) {
    let mut line = " ".repeat(indent);
    let mut is_empty = true;
    for word in words {
        if !is_empty && line.width() + 1 + word.width() > COLUMNS {
            let _ = writeln!(text, "{line}");
            line = " ".repeat(indent);
            is_empty = true;
        }
        if !is_empty {
            line.push(' ');
        }
        line.push_str(&word);
        is_empty = false;
    }
    let _ = writeln!(text, "{line}");
}
