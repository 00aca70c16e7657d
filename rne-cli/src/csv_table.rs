//! Tables of comma-separated values: lines of cells, each with its place, so that a message can point at it.

use std::borrow::Cow;
use std::ops::Range;

use rne_model::Report;

use crate::outcome::Failure;

/// A cell without the blanks and quotes around it.
#[derive(Clone, Debug)]
pub(crate) struct Cell<'a> {
    pub(crate) text: Cow<'a, str>,
    /// The bytes of the file that it stands on.
    pub(crate) span: Range<usize>,
}

/// A line with something in it.
#[derive(Clone, Debug)]
pub(crate) struct Row<'a> {
    pub(crate) cells: Vec<Cell<'a>>,
    pub(crate) span: Range<usize>,
}

/// The lines of a table, without comments, which begin with `#`, and without empty lines.
#[derive(Debug, Default)]
pub(crate) struct Table<'a> {
    pub(crate) rows: Vec<Row<'a>>,
    /// The comments, each without its `#`, and where it stands.
    pub(crate) comments: Vec<(&'a str, Range<usize>)>,
}

/// Mistakes in a file, all that are found.
#[derive(Debug)]
pub(crate) struct Mistakes<'a> {
    name: &'a str,
    text: &'a str,
    report: Option<Report>,
}

/// The text of a file, without a byte order mark.
pub(crate) fn text_of<'a>(name: &str, bytes: &'a [u8]) -> Result<&'a str, Failure> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let byte = bytes.get(at).copied().unwrap_or_default();
        let help = match bytes {
            [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => "this looks like UTF-16; save the file as UTF-8",
            _ => "save the file with the encoding UTF-8; spreadsheets call it `CSV UTF-8`",
        };
        let text = String::from_utf8_lossy(bytes);
        Failure::from(&Report::of_error(name, &text, at..at + 3, format!("byte 0x{byte:02X} is not UTF-8"), Some(help)))
    })
}

impl<'a> Mistakes<'a> {
    pub(crate) const fn new(name: &'a str, text: &'a str) -> Self {
        Self { name, text, report: None }
    }

    pub(crate) fn push(&mut self, span: Range<usize>, message: impl Into<String>, help: Option<&str>) {
        let report = Report::of_error(self.name, self.text, span, message, help);
        match &mut self.report {
            Some(all) => all.diagnostics.extend(report.diagnostics),
            None => self.report = Some(report),
        }
    }

    pub(crate) const fn are_there(&self) -> bool {
        self.report.is_some()
    }

    /// The value, unless there were mistakes.
    pub(crate) fn finish<T>(self, value: T) -> Result<T, Failure> {
        match self.report {
            Some(mut report) => {
                report.diagnostics.sort_by_key(|found| found.span.start);
                Err(Failure::from(&report))
            }
            None => Ok(value),
        }
    }
}

impl<'a> Table<'a> {
    /// Reads a text whose cells are separated by commas, or by semicolons where its first line has no comma.
    pub(crate) fn read(text: &'a str, mistakes: &mut Mistakes<'_>) -> Self {
        let mut table = Self::default();
        let mut separator = None;
        let mut start = 0;
        for line in text.split('\n') {
            let shown = line.trim();
            let from = start + (line.len() - line.trim_start().len());
            let span = from..from + shown.len();
            start += line.len() + 1;
            if let Some(comment) = shown.strip_prefix('#') {
                table.comments.push((comment.trim(), span));
            } else if !shown.is_empty() {
                let separator = *separator.get_or_insert(if shown.contains(',') { ',' } else { ';' });
                match cells(shown, from, separator) {
                    Ok(cells) => table.rows.push(Row { cells, span }),
                    Err(at) => mistakes.push(at..from + shown.len(), "this quote is not closed on its line", None),
                }
            }
        }
        table
    }
}

/// The cells of a line that starts at `start`; or where a quote opens that does not close.
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

/// A text for a message: shortened, control characters escaped, in backticks.
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
        let mut mistakes = Mistakes::new("x.csv", text);
        let table = Table::read(text, &mut mistakes);
        assert!(!mistakes.are_there());
        assert_eq!(table.comments[0].0, "a comment");
        let texts: Vec<Vec<&str>> =
            table.rows.iter().map(|row| row.cells.iter().map(|cell| cell.text.as_ref()).collect()).collect();
        assert_eq!(texts, [vec!["a", "b, \"c\"", "ü"], vec!["1", "", "3"]]);
        assert_eq!(&text[table.rows[0].cells[1].span.clone()], "\"b, \"\"c\"\"\"");
        assert_eq!(&text[table.rows[1].cells[2].span.clone()], "3");
    }

    #[test]
    fn a_quote_that_stays_open_is_told() {
        let text = "a,b\n1,\"2\n";
        let mut mistakes = Mistakes::new("x.csv", text);
        Table::read(text, &mut mistakes);
        let failure = mistakes.finish(()).unwrap_err();
        assert!(failure.text.contains("not closed") && failure.text.contains("x.csv:2:3"), "{}", failure.text);
    }
}
