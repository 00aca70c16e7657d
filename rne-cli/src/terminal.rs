//! The terminal: a small palette, and writing to a reader that may have gone away.
//!
//! Commands return text with colours in it; the streams here take them out where there is no terminal, or where
//! `NO_COLOR` asks for it.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::process::ExitCode;

use anstream::AutoStream;
use anstyle::{AnsiColor, Style};
use clap::builder::Styles;

use crate::outcome::{Failure, INPUT, Outcome, USAGE};

/// Titles.
pub(crate) const TITLE: Style = Style::new().bold();
/// What is not the matter itself: units, tallies, hints.
pub(crate) const QUIET: Style = Style::new().dimmed();
/// Formulas of the lecture.
pub(crate) const FORMULA: Style = AnsiColor::Cyan.on_default();
/// What the compiler found out.
pub(crate) const FOUND: Style = AnsiColor::Green.on_default();
/// What can be typed.
pub(crate) const TYPED: Style = AnsiColor::Yellow.on_default();
/// All is well.
pub(crate) const GOOD: Style = AnsiColor::Green.on_default().bold();
/// Something is wrong.
pub(crate) const ERROR: Style = AnsiColor::Red.on_default().bold();

/// The same palette for `--help`.
pub(crate) const HELP_STYLES: Styles = Styles::plain()
    .header(TITLE)
    .usage(TITLE)
    .literal(TYPED)
    .placeholder(Style::new())
    .error(ERROR)
    .invalid(TYPED)
    .valid(FOUND);

/// Prints what a command returned.
pub(crate) fn show(outcome: &Outcome) -> ExitCode {
    let _ = write(AutoStream::auto(io::stderr().lock()), &outcome.remark);
    match write(AutoStream::auto(io::stdout().lock()), &outcome.text) {
        // `rne show … | head` has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {}
        Err(error) => {
            let text = format!("{ERROR}error{ERROR:#}: the output cannot be written: {error}\n");
            let _ = write(AutoStream::auto(io::stderr().lock()), &text);
            return INPUT.into();
        }
        Ok(()) => {}
    }
    if outcome.at_fault { INPUT.into() } else { ExitCode::SUCCESS }
}

/// Prints why a command could not do its work.
pub(crate) fn complain(command: &str, failure: &Failure) -> ExitCode {
    let mut text = format!("{}\n", failure.text.trim_end());
    if failure.status == USAGE {
        let _ = writeln!(text, "\nFor more information, try '{TYPED}{command} --help{TYPED:#}'.");
    }
    // Where even the complaint finds no reader, the status must do.
    let _ = write(AutoStream::auto(io::stderr().lock()), &text);
    failure.status.into()
}

fn write(mut stream: impl Write, text: &str) -> io::Result<()> {
    stream.write_all(text.as_bytes())?;
    stream.flush()
}
