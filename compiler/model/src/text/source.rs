//! Turns bytes into text, and checks the text before YAML is parsed.

use std::ops::Range;

use crate::text::data_file::MAX_BYTES;
use crate::text::diagnostic::{Diagnostic, Problems};

/// Returns whether a file of `length` bytes is short enough to be read, or reports an error; `what` is its kind in
/// words.
pub(crate) fn size_is_fine(length: usize, what: &str, problems: &Problems) -> bool {
    if length > MAX_BYTES {
        problems.push(
            Diagnostic::error(
                0..0,
                format!("the file has more than {MAX_BYTES} bytes (1 MiB), the most that {what} may have"),
            )
            .help("one file describes one robot of at most 64 joints; is this the right file?"),
        );
    }
    length <= MAX_BYTES
}

/// Reports the first byte of `bytes` that is not UTF-8.
pub(crate) fn not_utf8(bytes: &[u8], error: std::str::Utf8Error, what: &str, problems: &Problems) {
    let at = error.valid_up_to();
    let byte = bytes.get(at).copied().unwrap_or_default();
    // The replacement character U+FFFD has three bytes in the text that is shown.
    problems.push(
        Diagnostic::error(at..at + 3, format!("byte 0x{byte:02X} is not UTF-8; {what} is UTF-8 text"))
            .label("not UTF-8")
            .help(match bytes {
                [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => "this looks like UTF-16; save the file as UTF-8",
                _ => "save the file with the encoding UTF-8",
            }),
    );
}

/// Reports the first control character: YAML forbids them, the parser takes U+0000 for the end of the file, and a
/// terminal may execute some as commands. Returns whether the text has no control character.
pub(crate) fn is_printable(text: &str, problems: &Problems) -> bool {
    let forbidden = |c: &(usize, char)| c.1.is_control() && !matches!(c.1, '\t' | '\n' | '\r' | '\u{85}');
    let Some((at, character)) = text.char_indices().find(forbidden) else { return true };
    problems.push(
        Diagnostic::error(
            at..at + character.len_utf8(),
            format!("control character U+{:04X}; only tab and line breaks are allowed", u32::from(character)),
        )
        .help("delete the character, and check that this is a text file"),
    );
    false
}

/// Returns whether a character is a line break, at least for some programs.
pub(crate) fn is_line_break(c: char) -> bool {
    matches!(c, '\n' | '\r' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

/// Returns whether a character acts instead of showing something: it controls terminals, or changes the direction of
/// text, which compilers refuse in source code, or breaks the line for some programs.
#[must_use]
pub fn is_control(c: char) -> bool {
    let turns_direction =
        matches!(c, '\u{61C}' | '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}');
    c.is_control() || is_line_break(c) || turns_direction
}

/// Returns whether a character is invisible and has no width, such as those in text from web pages and PDFs; those that
/// join letters of some scripts (U+200C, U+200D) are not included.
pub(crate) fn is_invisible(c: char) -> bool {
    matches!(
        c,
        '\u{AD}' | '\u{34F}' | '\u{115F}' | '\u{1160}' | '\u{180E}' | '\u{200B}' | '\u{2060}'
            ..='\u{2064}' | '\u{3164}' | '\u{FEFF}' | '\u{FFA0}'
    )
}

/// Returns a text as one line of harmless characters: a line break or a tab becomes a blank, any other [control
/// character](is_control) becomes U+FFFD.
#[must_use]
pub fn one_line(text: &str) -> String {
    let shown = |c: char| match c {
        '\t' => ' ',
        c if is_line_break(c) => ' ',
        c if is_control(c) => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    text.chars().map(shown).collect()
}

/// Formats a value for a message: shortened, control characters escaped, in backticks.
pub(crate) fn quoted(value: &str) -> String {
    const LONGEST: usize = 40;
    let shown = |text: &str| text.escape_debug().to_string().replace("\\\"", "\"").replace("\\'", "'");
    match value.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("`{}…`", shown(value.get(..end).unwrap_or_default())),
        None => format!("`{}`", shown(value)),
    }
}

/// Formats a number with all digits that are needed to read it back exactly; zero gets no sign.
#[must_use]
pub fn exact_digits(value: f64) -> String {
    // the sum of -0.0 and 0.0 is 0.0
    let shown = format!("{:?}", value + 0.0);
    shown.strip_suffix(".0").unwrap_or(&shown).to_owned()
}

/// Returns half of the last digit of a decimal number; zero for an expression, which is exact.
///
/// ```
/// assert_eq!(["14.5", "1e3", "0.10"].map(rne_model::half_of_last_digit), [0.05, 500.0, 0.005]);
/// ```
#[must_use]
pub fn half_of_last_digit(number: &str) -> f64 {
    let (mantissa, exponent) = number.trim().split_once(['e', 'E']).unwrap_or((number.trim(), "0"));
    let plain = mantissa.chars().all(|c| c.is_ascii_digit() || "+-.".contains(c));
    let (true, Ok(exponent)) = (plain, exponent.parse::<i32>()) else { return 0.0 };
    // `behind` is the number of decimals; a whole number has none, so its last digit is at the units
    let behind = mantissa.split_once('.').map_or(0, |(_, digits)| i32::try_from(digits.len()).unwrap_or(i32::MAX));
    0.5 * 10_f64.powi(exponent.saturating_sub(behind))
}

/// Formats a number with six significant digits, for a message.
#[must_use]
pub fn six_digits(value: f64) -> String {
    exact_digits(format!("{value:.5e}").parse().unwrap_or(value))
}

/// Returns the bytes `range` of a value that has the bytes `span`, but never beyond the end of the span.
pub(crate) fn inside(span: &Range<usize>, range: &Range<usize>) -> Range<usize> {
    let at = |offset: usize| (span.start + offset).min(span.end);
    at(range.start)..at(range.end)
}
