//! The palette: the styles that give the text of commands its colours.
//!
//! Commands return text with colours; the streams of `terminal` remove them if the output is no terminal, or if
//! `NO_COLOR` is set.

use std::collections::hash_map::RandomState;
use std::fmt::{self, Display};
use std::hash::BuildHasher as _;
use std::sync::LazyLock;

use anstyle::AnsiColor;
use clap::builder::Styles;

/// Style of titles.
pub(crate) const TITLE: Style = Style(anstyle::Style::new().bold());
/// Style of secondary text: units, counts, hints.
pub(crate) const QUIET: Style = Style(anstyle::Style::new().dimmed());
/// Style of formulas from the lecture.
pub(crate) const FORMULA: Style = Style(AnsiColor::Cyan.on_default());
/// Style of facts that the compiler found.
pub(crate) const FOUND: Style = Style(AnsiColor::Green.on_default());
/// Style of text to type.
pub(crate) const TYPED: Style = Style(AnsiColor::Yellow.on_default());
/// Style of messages of success.
pub(crate) const GOOD: Style = Style(AnsiColor::Green.on_default().bold());
/// Style of warnings.
pub(crate) const WARNING: Style = Style(AnsiColor::Yellow.on_default().bold());
/// Style of errors.
pub(crate) const ERROR: Style = Style(AnsiColor::Red.on_default().bold());

/// The palette for the texts of `--help`.
pub(crate) const HELP_STYLES: Styles = Styles::plain()
    .header(TITLE.0)
    .usage(TITLE.0)
    .literal(TYPED.0)
    .placeholder(anstyle::Style::new())
    .error(ERROR.0)
    .invalid(TYPED.0)
    .valid(FOUND.0);

/// A style of the palette: `{STYLE}` begins it and `{STYLE:#}` ends it. Its escape sequences contain a secret mark of
/// this process, which no file or name can contain by chance, so that the terminal gets only these sequences.
#[derive(Clone, Copy)]
pub(crate) struct Style(pub(crate) anstyle::Style);

impl Display for Style {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sequences = if f.alternate() { format!("{:#}", self.0) } else { self.0.to_string() };
        f.write_str(&marked(&sequences))
    }
}

/// How an escape sequence for a colour begins.
pub(crate) const BEGIN: &str = "\u{1B}[";

/// The first parameter of every escape sequence of this program: a random number, of the same length in every process.
pub(crate) static MARK: LazyLock<String> = LazyLock::new(|| format!("{:020};", RandomState::new().hash_one(())));

pub(crate) fn marked(sequences: &str) -> String {
    sequences.replace(BEGIN, &format!("{BEGIN}{}", *MARK))
}

/// Marks the colours of a text from a library, so that the terminal gets them. If the plain text already contains an
/// escape sequence, from a file or a name, both cannot be told apart, so the plain text is returned.
pub(crate) fn coloured(plain: &str, coloured: &str) -> String {
    if plain.contains('\u{1B}') { plain.to_owned() } else { marked(coloured) }
}
