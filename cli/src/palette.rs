//! The palette: a few styles, by which the text of a command has its colours.
//!
//! Commands return text with colours in it; the streams of `terminal` take them out where there is no terminal, or
//! where `NO_COLOR` asks for it.

use std::collections::hash_map::RandomState;
use std::fmt::{self, Display};
use std::hash::BuildHasher as _;
use std::sync::LazyLock;

use anstyle::AnsiColor;
use clap::builder::Styles;

/// Titles.
pub(crate) const TITLE: Style = Style(anstyle::Style::new().bold());
/// Style of secondary text: units, counts, hints.
pub(crate) const QUIET: Style = Style(anstyle::Style::new().dimmed());
/// Formulas of the lecture.
pub(crate) const FORMULA: Style = Style(AnsiColor::Cyan.on_default());
/// Style of facts that the compiler found.
pub(crate) const FOUND: Style = Style(AnsiColor::Green.on_default());
/// Style of text to type.
pub(crate) const TYPED: Style = Style(AnsiColor::Yellow.on_default());
/// All is well.
pub(crate) const GOOD: Style = Style(AnsiColor::Green.on_default().bold());
/// Something is probably not what was meant.
pub(crate) const WARNING: Style = Style(AnsiColor::Yellow.on_default().bold());
/// Something is wrong.
pub(crate) const ERROR: Style = Style(AnsiColor::Red.on_default().bold());

/// The same palette for `--help`.
pub(crate) const HELP_STYLES: Styles = Styles::plain()
    .header(TITLE.0)
    .usage(TITLE.0)
    .literal(TYPED.0)
    .placeholder(anstyle::Style::new())
    .error(ERROR.0)
    .invalid(TYPED.0)
    .valid(FOUND.0);

/// A style of the palette: `{STYLE}` begins it and `{STYLE:#}` ends it. Its sequences carry the mark of this process,
/// which no file and no name can know, so the terminal gets these and no others.
#[derive(Clone, Copy)]
pub(crate) struct Style(pub(crate) anstyle::Style);

impl Display for Style {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sequences = if f.alternate() { format!("{:#}", self.0) } else { self.0.to_string() };
        f.write_str(&marked(&sequences))
    }
}

/// How a sequence begins that colours.
pub(crate) const BEGIN: &str = "\u{1B}[";

/// The first parameter of every sequence of ours: a random number, of the same length in every process.
pub(crate) static MARK: LazyLock<String> = LazyLock::new(|| format!("{:020};", RandomState::new().hash_one(())));

pub(crate) fn marked(sequences: &str) -> String {
    sequences.replace(BEGIN, &format!("{BEGIN}{}", *MARK))
}

/// A text in the colours of a library. Where the text without them has a sequence too, that is of a file or of a name,
/// and nobody knows which is which: it stays without colours.
pub(crate) fn coloured(plain: &str, coloured: &str) -> String {
    if plain.contains('\u{1B}') { plain.to_owned() } else { marked(coloured) }
}
