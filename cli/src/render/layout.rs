//! Arranges text in columns.

use std::fmt::Write as _;

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};
use unicode_width::UnicodeWidthStr;

use crate::palette::{QUIET, Style, TITLE, WARNING};

/// Number of columns of a page of text.
pub(crate) const PAGE: usize = 80;

/// The side of its column at which a cell is placed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Arranges cells in lines: each column is as wide as its widest cell, with two blanks between columns.
pub(crate) fn columns(alignment: &[Align], lines: &[impl AsRef<[String]>]) -> Vec<String> {
    let mut widths = vec![0; alignment.len()];
    for line in lines {
        for (column, cell) in widths.iter_mut().zip(line.as_ref()) {
            *column = width(cell).max(*column);
        }
    }
    let line = |cells: &[String]| {
        let mut line = String::new();
        for (position, ((cell, &width), align)) in cells.iter().zip(&widths).zip(alignment).enumerate() {
            let gap = if position == 0 { "" } else { "  " };
            let _ = match align {
                Align::Left => write!(line, "{gap}{}", left(cell, width)),
                Align::Right => write!(line, "{gap}{}", right(cell, width)),
            };
        }
        line.truncate(line.trim_end().len());
        line
    };
    lines.iter().map(|cells| line(cells.as_ref())).collect()
}

/// Appends a table below its title; the first line of cells is its heading.
pub(crate) fn push_table<const N: usize>(text: &mut String, title: &str, align: &[Align], cells: &[[String; N]]) {
    let lines = columns(align, cells);
    let _ = writeln!(text, "\n{TITLE}{title}{TITLE:#}\n{QUIET}{}{QUIET:#}", lines[0]);
    for line in &lines[1..] {
        let _ = writeln!(text, "{line}");
    }
}

/// Appends blanks to a text up to a width.
pub(crate) fn left(text: &str, to: usize) -> String {
    format!("{text}{}", " ".repeat(to.saturating_sub(width(text))))
}

/// Puts blanks before a text up to a width.
pub(crate) fn right(text: &str, to: usize) -> String {
    format!("{}{text}", " ".repeat(to.saturating_sub(width(text))))
}

/// Returns the number of columns that a text takes; the dots of ω̇ and c̈ take none, because they are above their
/// letters.
pub(crate) fn width(text: &str) -> usize {
    UnicodeWidthStr::width(text)
}

/// Shortens a text to `to` columns, with a mark that more follows.
pub(crate) fn shortened(text: &str, to: usize) -> String {
    if width(text) <= to {
        return text.to_owned();
    }
    let most = |end: &usize| width(&text[..*end]) < to;
    let end = text.char_indices().map(|(at, _)| at).take_while(most).last().unwrap_or(0);
    format!("{}…", text[..end].trim_end())
}

/// Returns a note for standard error.
pub(crate) fn note(what: &str) -> String {
    remark("note", TITLE, what)
}

/// Returns a warning for standard error.
pub(crate) fn warning(what: &str) -> String {
    remark("warning", WARNING, what)
}

fn remark(word: &str, style: Style, what: &str) -> String {
    let indent = " ".repeat(word.len() + 2);
    format!("{style}{word}{style:#}: {}\n", wrap(what, PAGE - indent.len(), &indent))
}

/// Wraps words into lines of a width; lines after the first begin with `indent`.
pub(crate) fn wrap(text: &str, to: usize, indent: &str) -> String {
    let options = Options::new(to).subsequent_indent(indent).break_words(false);
    let options = options.word_separator(WordSeparator::AsciiSpace).word_splitter(WordSplitter::NoHyphenation);
    textwrap::fill(text, options.wrap_algorithm(WrapAlgorithm::FirstFit))
}

/// Quotes a text as a cell of CSV, if needed.
pub(crate) fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_take_no_column() {
        assert_eq!(width("ω̇2 + q̈2"), 7);
        assert_eq!(left("c̈", 3), "c̈  ");
        assert_eq!(right("c̈", 3), "  c̈");
    }

    #[test]
    fn what_is_too_long_ends_with_a_sign() {
        assert_eq!(shortened("ω̇ is known", 10), "ω̇ is known");
        assert_eq!(shortened("ω̇ is known", 9), "ω̇ is kno…");
        assert_eq!(shortened("one two", 5), "one…");
        assert_eq!(shortened("one", 0), "…");
    }

    #[test]
    fn long_text_breaks_between_words() {
        assert_eq!(wrap("one two three", 7, "  "), "one two\n  three");
        assert_eq!(wrap("unbreakable", 3, ""), "unbreakable");
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let lines = [["a".to_owned(), "10".to_owned()], ["bcd".to_owned(), "1".to_owned()]];
        assert_eq!(columns(&[Align::Left, Align::Right], &lines), ["a    10", "bcd   1"]);
    }
}
