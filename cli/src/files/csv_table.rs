//! Reads tables of comma-separated values as lines of cells, each with its place in the file, so that messages can
//! point at it.

use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

use rne_model::{Diagnostic, Report};

use crate::files::input_file;
use crate::outcome::Failure;

/// A cell without the blanks and quotes around its text.
#[derive(Clone, Debug)]
pub(crate) struct Cell<'a> {
    pub(crate) text: Cow<'a, str>,
    /// The bytes of the file that the cell has.
    pub(crate) span: Range<usize>,
}

/// A line with at least one cell that is not empty.
#[derive(Clone, Debug)]
pub(crate) struct Row<'a> {
    pub(crate) cells: Vec<Cell<'a>>,
    pub(crate) span: Range<usize>,
}

/// Content of a line that is not empty.
#[derive(Clone, Debug)]
pub(crate) enum Line<'a> {
    Row(Row<'a>),
    /// A comment without its `#`, and its place.
    Comment(&'a str, Range<usize>),
    /// A quote that opens at this place and is not closed on its line.
    OpenQuote(Range<usize>),
}

/// The mistakes found in a file, up to a largest number.
#[derive(Debug)]
pub(crate) struct Mistakes<'a> {
    name: &'a str,
    text: &'a str,
    report: Option<Report>,
    /// For each remedy, how many mistakes have it, in the order in which the remedies were first needed.
    alike: Vec<(String, usize)>,
}

/// Largest number of mistakes that are reported.
const TOLD: usize = 20;

/// Largest number of mistakes with the same remedy that are reported; others are counted. A file with another decimal
/// mark has such a mistake in each cell.
const ALIKE: usize = 3;

/// The characters of the bytes 0x80 to 0x9F in Windows-1252, from the index of the WHATWG Encoding Standard; five of
/// these bytes have none.
const WINDOWS: &str = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8D}Ž\u{8F}\u{90}‘’“”•–—˜™š›œ\u{9D}žŸ";

/// Reads a file of at most `longest` bytes and returns its name and text. Messages call the file `what`; if it is
/// longer, the message ends with `help`.
pub(crate) fn read(path: &Path, what: &str, longest: usize, help: &str) -> Result<(String, String), Failure> {
    let name = input_file::name(path);
    let bytes =
        input_file::read(path, longest).map_err(|error| input_error!("the {what} {name} cannot be read: {error}"))?;
    if bytes.len() > longest {
        return Err(input_error!("{name} has more than {longest} bytes{help}"));
    }
    let text = text_of(&name, &bytes)?.into_owned();
    Ok((name, text))
}

/// Decodes the text of a file, without a byte order mark: UTF-8, or the encodings in which spreadsheets save `CSV` and
/// `Unicode text`, which are Windows-1252 and UTF-16 with its mark.
///
/// # Errors
/// A byte, with its line and column, that has no character in UTF-8 and none in Windows-1252; half a character of
/// UTF-16.
fn text_of<'a>(name: &str, bytes: &'a [u8]) -> Result<Cow<'a, str>, Failure> {
    let utf_16 = |rest: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = rest.chunks_exact(2).filter_map(|pair| Some(unit(pair.try_into().ok()?))).collect::<Vec<_>>();
        let text = String::from_utf16(&units).ok().filter(|_| rest.len().is_multiple_of(2));
        let broken = || input_error!("{name} is not UTF-16 to its end; save the file as UTF-8");
        text.map(Cow::Owned).ok_or_else(broken)
    };
    match bytes {
        [0xFF, 0xFE, rest @ ..] => return utf_16(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => return utf_16(rest, u16::from_be_bytes),
        _ => {}
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Ok(Cow::Borrowed(text));
    }
    let character = |byte: u8| match byte {
        0x80..=0x9F => WINDOWS.chars().nth(usize::from(byte - 0x80)).filter(|c| !c.is_control()),
        _ => Some(char::from(byte)),
    };
    let text: String = bytes.iter().map(|byte| character(*byte).unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    let Some(at) = text.find(char::REPLACEMENT_CHARACTER) else { return Ok(Cow::Owned(text)) };
    let byte = bytes.iter().find(|byte| character(**byte).is_none()).copied().unwrap_or_default();
    let message = format!("byte 0x{byte:02X} is not UTF-8, and no character of Windows-1252");
    let help = "save the file with the encoding UTF-8; spreadsheets call it `CSV UTF-8`";
    Err(Failure::from(&Report::of_error(name, &text, at..at + 3, message, Some(help))))
}

impl<'a> Mistakes<'a> {
    pub(crate) const fn new(name: &'a str, text: &'a str) -> Self {
        Self { name, text, report: None, alike: Vec::new() }
    }

    pub(crate) fn push(&mut self, span: Range<usize>, message: impl Into<String>, help: Option<&str>) {
        if self.are_enough() {
            return;
        }
        let message = message.into();
        let remedy = help.unwrap_or(&message);
        match self.alike.iter_mut().find(|(other, _)| other == remedy) {
            Some((_, count)) => *count += 1,
            None => self.alike.push((remedy.to_owned(), 1)),
        }
        if self.alike.iter().any(|(other, count)| other == remedy && *count > ALIKE) {
            return;
        }
        let report = Report::of_error(self.name, self.text, span, message, help);
        match &mut self.report {
            Some(all) => all.diagnostics.extend(report.diagnostics),
            None => self.report = Some(report),
        }
    }

    /// Returns whether the largest number of mistakes is reached, so that reading can end.
    pub(crate) fn are_enough(&self) -> bool {
        self.report.as_ref().is_some_and(|report| report.diagnostics.len() >= TOLD)
    }

    pub(crate) const fn are_there(&self) -> bool {
        self.report.is_some()
    }

    /// Returns the value, or an error with the mistakes if there were any.
    pub(crate) fn finish<T>(self, value: T) -> Result<T, Failure> {
        match self.report {
            Some(mut report) => {
                report.diagnostics.sort_by_key(|found| found.span.start);
                for (remedy, count) in self.alike.iter().filter(|(_, count)| *count > ALIKE) {
                    let is_alike = |found: &&mut Diagnostic| found.help.as_ref().unwrap_or(&found.message) == remedy;
                    if let Some(last) = report.diagnostics.iter_mut().rev().find(is_alike) {
                        let more = format!("{} more lines have a mistake of this kind", count - ALIKE);
                        last.help = Some(last.help.take().map_or(more.clone(), |help| format!("{help}; {more}")));
                    }
                }
                Err(Failure::from(&report))
            }
            None => Ok(value),
        }
    }
}

/// Splits a table into lines. Cells are separated by commas, or by semicolons if the first line with cells has no
/// comma; comments begin with `#`; empty lines are left out.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut separator = None;
    let mut start = 0;
    text.split('\n').filter_map(move |line| {
        let shown = line.trim();
        let from = start + (line.len() - line.trim_start().len());
        let span = from..from + shown.len();
        start += line.len() + 1;
        if shown.is_empty() {
            return None;
        }
        // a spreadsheet puts a comment with a comma in quotes
        if let Some(comment) = shown.strip_prefix('#').or_else(|| shown.strip_prefix("\"#")) {
            return Some(Line::Comment(comment.trim(), span));
        }
        let separator = *separator.get_or_insert(if shown.contains(',') { ',' } else { ';' });
        Some(match cells(shown, from, separator) {
            Ok(cells) => Line::Row(Row { cells, span }),
            Err(at) => Line::OpenQuote(at..span.end),
        })
    })
}

/// Returns help on the separator if a header without the right columns uses another one; `None` if it has commas or
/// semicolons.
pub(crate) fn other_separator(header: &Row<'_>) -> Option<&'static str> {
    let has = |separator: char| header.cells.iter().any(|cell| cell.text.contains(separator));
    let found = [
        ('\t', "the columns are separated by tabs; separate them by commas: spreadsheets and `tr '\\t' ,` do that"),
        (';', "some columns are separated by semicolons, others by commas; use the same separator everywhere"),
        ('|', "the columns are separated by `|`; separate them by commas"),
        (' ', "the columns are separated by blanks; separate them by commas"),
    ];
    found.into_iter().find(|(separator, _)| has(*separator)).map(|(_, help)| help)
}

/// The message for a line of [`Line::OpenQuote`].
pub(crate) const OPEN_QUOTE: &str = "this quote is not closed on its line";

/// Splits a line that starts at the byte `start` into cells; the error is the place of a quote that is not closed.
fn cells(line: &str, start: usize, separator: char) -> Result<Vec<Cell<'_>>, usize> {
    let mut cells = Vec::new();
    let (mut from, mut quoted) = (0, None);
    let ends = line.char_indices().chain([(line.len(), separator)]);
    for (at, character) in ends {
        match character {
            '"' => quoted = if quoted.is_some() { None } else { Some(at) },
            _ if character == separator && (quoted.is_none() || at == line.len()) => {
                if let Some(open) = quoted {
                    return Err(start + open);
                }
                let cell = line.get(from..at).unwrap_or_default();
                let shown = cell.trim();
                let begins = start + from + (cell.len() - cell.trim_start().len());
                let inner = shown.strip_prefix('"').and_then(|inner| inner.strip_suffix('"'));
                let text = inner.map_or(Cow::Borrowed(shown), |inner| Cow::Owned(inner.replace("\"\"", "\"")));
                cells.push(Cell { text, span: begins..begins + shown.len() });
                from = at + character.len_utf8();
            }
            _ => {}
        }
    }
    Ok(cells)
}

/// Replaces a decimal comma by a point, because spreadsheets of many European countries write `0,5`; and U+2212, which
/// they write too, by a minus sign.
pub(crate) fn with_point(number: &str) -> Cow<'_, str> {
    if number.contains('\u{2212}') {
        let ascii = number.replace('\u{2212}', "-");
        return Cow::Owned(with_point(&ascii).into_owned());
    }
    let is_plain = number.chars().all(|c| c.is_ascii_digit() || "+-eE,".contains(c));
    if is_plain && number.matches(',').count() == 1 {
        return Cow::Owned(number.replace(',', "."));
    }
    Cow::Borrowed(number)
}

/// Formats a text for a message: shortened, control characters escaped, in backticks.
pub(crate) fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).collect::<String>().escape_debug().to_string();
    if text.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_their_places() {
        let text = "# a comment\r\na, \"b, \"\"c\"\"\" ,ü\r\n\r\n1,,3\n";
        let all: Vec<Line<'_>> = lines(text).collect();
        let [Line::Comment(comment, _), Line::Row(first), Line::Row(second)] = all.as_slice() else {
            panic!("{all:?}")
        };
        let texts = |row: &Row<'_>| row.cells.iter().map(|cell| cell.text.to_string()).collect::<Vec<_>>();
        assert_eq!(*comment, "a comment");
        assert_eq!(
            (texts(first), texts(second)),
            (["a", "b, \"c\"", "ü"].map(str::to_owned).to_vec(), ["1", "", "3"].map(str::to_owned).to_vec())
        );
        assert_eq!(&text[first.cells[1].span.clone()], "\"b, \"\"c\"\"\"");
        assert_eq!(&text[second.cells[2].span.clone()], "3");
    }

    #[test]
    fn other_separators_are_named() {
        for (header, named) in
            [("t\tq1", "by tabs"), ("t;q1,q2", "by semicolons"), ("t|q1", "by `|`"), ("t q1", "by blanks")]
        {
            let Some(Line::Row(row)) = lines(header).next() else { panic!("{header}") };
            assert!(other_separator(&row).is_some_and(|help| help.contains(named)), "{header}");
        }
        let Some(Line::Row(row)) = lines("t;q1").next() else { panic!("a row") };
        assert_eq!(other_separator(&row), None);
    }

    #[test]
    fn a_quote_that_stays_open_is_told() {
        let text = "a,b\n1,\"2\n";
        let Some(Line::OpenQuote(span)) = lines(text).nth(1) else { panic!("it is open") };
        assert_eq!(&text[span], "\"2");
    }

    #[test]
    fn so_many_mistakes_are_told() {
        let text = "x\n".repeat(1000);
        let mut mistakes = Mistakes::new("x.csv", &text);
        (0..1000).for_each(|at| mistakes.push(2 * at..2 * at + 1, format!("no {at}"), None));
        let failure = mistakes.finish(()).unwrap_err();
        assert_eq!(failure.text.matches("x.csv:").count(), TOLD, "{}", failure.text);
    }

    #[test]
    fn mistakes_of_one_kind_are_counted() {
        let text = "x\n".repeat(60);
        let mut mistakes = Mistakes::new("x.csv", &text);
        (0..60)
            .for_each(|at| mistakes.push(2 * at..2 * at + 1, format!("no {at}"), Some(["write y", "write z"][at % 2])));
        let failure = mistakes.finish(()).unwrap_err();
        assert_eq!(failure.text.matches("x.csv:").count(), 2 * ALIKE, "{}", failure.text);
        assert_eq!(failure.text.matches("; 27 more lines have a mistake of this kind").count(), 2, "{}", failure.text);
    }
}
