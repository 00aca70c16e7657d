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
use rne_model::{is_control, one_line};

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
/// Something is probably not what was meant.
pub(crate) const WARNING: Style = AnsiColor::Yellow.on_default().bold();
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

/// Columns of prose: those of the terminal, and no more than `most`, which a pipe or a file has.
pub(crate) fn width(most: usize) -> usize {
    const FEWEST: usize = 40;
    let terminal = terminal_size::terminal_size_of(io::stdout()).map(|(columns, _)| usize::from(columns.0));
    terminal.map_or(most, |columns| columns.clamp(FEWEST, most))
}

/// Columns of a table: those of the terminal, and 100 of a pipe or a file.
pub(crate) fn room() -> usize {
    const OF_A_FILE: usize = 100;
    let terminal = terminal_size::terminal_size_of(io::stdout()).map(|(columns, _)| usize::from(columns.0));
    terminal.unwrap_or(OF_A_FILE)
}

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

/// Prints what clap says: help, or what is wrong with the command line, which may be quoted.
pub(crate) fn usage(error: &clap::Error) -> ExitCode {
    let text = error.render().ansi().to_string();
    // A reader that has gone away needs no help.
    if error.use_stderr() {
        let _ = write(AutoStream::auto(io::stderr().lock()), &text);
        return USAGE.into();
    }
    let _ = write(AutoStream::auto(io::stdout().lock()), &text);
    ExitCode::SUCCESS
}

fn write(mut stream: impl Write, text: &str) -> io::Result<()> {
    stream.write_all(inert(text).as_bytes())?;
    stream.flush()
}

/// Text for a terminal: of all control characters it keeps the ends of lines, and the sequences that colour. Whatever a
/// file or its name holds, a terminal shows it and does nothing else.
fn inert(text: &str) -> String {
    let mut inert = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c != '\n' && is_control(c)) {
        let (before, from) = rest.split_at(at);
        inert.push_str(before);
        let coloured = colour(from);
        let taken = if coloured > 0 { coloured } else { from.chars().next().map_or(0, char::len_utf8) };
        let (control, after) = from.split_at(taken);
        inert.push_str(&if coloured > 0 { control.to_owned() } else { one_line(control) });
        rest = after;
    }
    inert + rest
}

/// The length of the sequence that chooses a colour with which a text starts, such as `ESC [ 1 ; 31 m`; 0 where there
/// is none.
fn colour(text: &str) -> usize {
    let parameters = text.strip_prefix("\u{1B}[").unwrap_or_default();
    let end = parameters.find(|c: char| !c.is_ascii_digit() && c != ';');
    end.filter(|&end| parameters[end..].starts_with('m')).map_or(0, |end| "\u{1B}[".len() + end + "m".len())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn commands_to_a_terminal_are_shown_and_colours_kept() {
        let text = format!("{ERROR}error{ERROR:#}: a\u{1B}]0;title\u{7}b\r\u{9B}2J\u{202E}c\td\u{2028}e\u{1B}[2J\n");
        let shown = "a\u{FFFD}]0;title\u{FFFD}b \u{FFFD}2J\u{FFFD}c d e\u{FFFD}[2J\n";
        assert_eq!(inert(&text), format!("{ERROR}error{ERROR:#}: {shown}"));
    }

    fn piece() -> impl Strategy<Value = String> {
        let nasty = [
            "\u{1B}",
            "\u{1B}[",
            "\u{1B}[1;31m",
            "1",
            ";",
            "m",
            "\u{9B}",
            "\u{7}",
            "\u{202E}",
            "\u{2028}",
            "\r",
            "\t",
            "\n",
        ];
        prop_oneof![any::<char>().prop_map(String::from), prop::sample::select(nasty.to_vec()).prop_map(str::to_owned)]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_text_controls_the_terminal(pieces in prop::collection::vec(piece(), 0..20)) {
            let text = inert(&pieces.concat());
            let plain = anstream::adapter::strip_str(&text).to_string();
            prop_assert!(!plain.chars().any(|c| c != '\n' && is_control(c)), "{text:?}");
            prop_assert_eq!(inert(&text), text, "once is enough");
        }
    }
}
