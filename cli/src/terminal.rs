//! The terminal: its width, and writing to a reader that may have closed the stream.

use std::env;
use std::fmt::{self, Write as _};
use std::io::{self, Write};
use std::mem;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anstream::AutoStream;
use rne_model::{is_control, one_line};

use crate::outcome::{Failure, INPUT, Outcome, USAGE};
use crate::palette::{BEGIN, ERROR, MARK, TYPED, marked};

/// Returns the number of columns for prose: that of the terminal, but at most `most`, which is also used for a pipe or
/// a file.
pub(crate) fn width(most: usize) -> usize {
    const FEWEST: usize = 40;
    let terminal = terminal_size::terminal_size_of(io::stdout()).map(|(columns, _)| usize::from(columns.0));
    terminal.map_or(most, |columns| columns.clamp(FEWEST, most))
}

/// Returns the number of columns for a table: that of the terminal, or 100 for a pipe or a file.
pub(crate) fn room() -> usize {
    const OF_A_FILE: usize = 100;
    let terminal = terminal_size::terminal_size_of(io::stdout()).map(|(columns, _)| usize::from(columns.0));
    terminal.unwrap_or(OF_A_FILE)
}

/// Prints the result of a command.
pub(crate) fn show(outcome: &Outcome) -> ExitCode {
    let remark = notes_of_files() + &outcome.remark;
    let (before, after) = if outcome.remark_last { ("", &*remark) } else { (&*remark, "") };
    let _ = write(AutoStream::auto(io::stderr().lock()), before);
    let written = write(AutoStream::auto(io::stdout().lock()), &outcome.text);
    let _ = write(AutoStream::auto(io::stderr().lock()), after);
    match written {
        // In `rne show … | head` the reader has read enough, which is no error.
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

/// Prints a note at once, before the command has a result.
pub(crate) fn remark(what: fmt::Arguments<'_>) {
    // if the note cannot be written, the result may still be
    let _ = write(AutoStream::auto(io::stderr().lock()), &what.to_string());
}

/// Notes on files that were read; they are printed with the result or the error of the command.
static OF_FILES: Mutex<String> = Mutex::new(String::new());

/// Stores a note that is printed with the result of the command or with its error, so that no command can lose it.
pub(crate) fn note_of_file(note: &str) {
    OF_FILES.lock().unwrap_or_else(PoisonError::into_inner).push_str(note);
}

fn notes_of_files() -> String {
    mem::take(&mut OF_FILES.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Prints the error of a command that could not do its work.
pub(crate) fn complain(command: &str, failure: &Failure) -> ExitCode {
    let mut text = format!("{}{}\n", notes_of_files(), failure.text.trim_end());
    if failure.status == USAGE {
        let _ = writeln!(text, "\nFor more information, try '{TYPED}{command} --help{TYPED:#}'.");
    }
    // If even the error cannot be written, only the exit status reports it.
    let _ = write(AutoStream::auto(io::stderr().lock()), &text);
    failure.status.into()
}

/// Prints a text of clap: help, or what is wrong with the command line, which it may quote.
pub(crate) fn usage(error: &clap::Error) -> ExitCode {
    let text = error.render();
    // A quoted word may contain escape sequences of its own, which could not be told from those of clap.
    let has_colours = env::args_os().any(|word| word.to_string_lossy().contains('\u{1B}'));
    let text = if has_colours { text.to_string() } else { marked(&text.ansi().to_string()) };
    if error.use_stderr() {
        // If even this cannot be written, only the exit status reports it.
        let _ = write(AutoStream::auto(io::stderr().lock()), &text);
        return USAGE.into();
    }
    show(&Outcome::text(text))
}

fn write(mut stream: impl Write, text: &str) -> io::Result<()> {
    stream.write_all(inert(text).as_bytes())?;
    stream.flush()
}

/// Makes a text harmless for a terminal: the only control characters that stay are line ends and the escape sequences
/// of this program's [`Style`](crate::palette::Style)s. So the terminal shows whatever a file or its name contains, and
/// does nothing else.
fn inert(text: &str) -> String {
    let mut inert = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c != '\n' && is_control(c)) {
        let (before, from) = rest.split_at(at);
        inert.push_str(before);
        if let Some((parameters, after)) = own_sequence(from) {
            let _ = write!(inert, "{BEGIN}{parameters}m");
            rest = after;
        } else {
            let (control, after) = from.split_at(from.chars().next().map_or(0, char::len_utf8));
            inert.push_str(&one_line(control));
            rest = after;
        }
    }
    inert + rest
}

/// If a text begins with an escape sequence of this program, returns its parameters without the mark, and the text
/// after it.
fn own_sequence(text: &str) -> Option<(&str, &str)> {
    text.strip_prefix(BEGIN)?.strip_prefix(MARK.as_str())?.split_once('m')
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::palette::{QUIET, coloured};

    #[test]
    fn commands_to_a_terminal_are_shown_and_colours_kept() {
        let text = format!("{ERROR}error{ERROR:#}: a\u{1B}]0;title\u{7}b\r\u{9B}2J\u{202E}c\td\u{2028}e\u{1B}[2J\n");
        let shown = "a\u{FFFD}]0;title\u{FFFD}b \u{FFFD}2J\u{FFFD}c d e\u{FFFD}[2J\n";
        assert_eq!(inert(&text), format!("{}error{:#}: {shown}", ERROR.0, ERROR.0));
    }

    /// Control characters in data could hide text or forge a result, so they are replaced, even those that look like
    /// colours of the palette.
    #[test]
    fn colours_of_data_are_shown_and_do_nothing() {
        for data in ["\u{1B}[8m", "\u{1B}[0m", "\u{1B}[1m\u{1B}[32m", "\u{1B}[m", "\u{1B}[00000000000000000000;8m"] {
            let text = format!("{QUIET}{data}hidden{QUIET:#}");
            let shown = data.replace('\u{1B}', "\u{FFFD}");
            assert_eq!(inert(&text), format!("{}{shown}hidden{:#}", QUIET.0, QUIET.0));
            // a message of a library that quotes the data
            let message = format!("no `{data}`");
            let styled = format!("\u{1B}[31m{message}\u{1B}[0m");
            assert_eq!(inert(&coloured(&message, &styled)), format!("no `{shown}`"));
        }
        assert_eq!(inert(&coloured("error", "\u{1B}[31merror\u{1B}[0m")), "\u{1B}[31merror\u{1B}[0m");
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
            prop_assert!(!text.chars().any(|c| c != '\n' && is_control(c)), "{text:?}");
            prop_assert_eq!(inert(&text), text, "once is enough");
        }
    }
}
