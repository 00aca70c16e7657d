//! Breaks words into lines of a given width.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};

/// Width of a line of emitted text.
pub(super) const WIDTH: usize = 100;

/// A blank at which no line breaks.
pub(super) const TIED: &str = "\u{A0}";

/// Breaks words into lines of `width` columns; the first line begins with `first`, the others with `others`. A word
/// that is longer than a line is not broken.
pub(super) fn fill(text: &str, width: usize, first: &str, others: &str) -> String {
    let options = Options::new(width)
        .initial_indent(first)
        .subsequent_indent(others)
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .wrap_algorithm(WrapAlgorithm::FirstFit);
    let lines = textwrap::wrap(text, options);
    lines.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("\n").replace(TIED, " ")
}
