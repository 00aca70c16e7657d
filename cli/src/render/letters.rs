//! Chooses the letters in which text is written: those of the lecture, or only ASCII.

use std::fmt::Write as _;

use clap::Args;

use crate::render::layout::{width, wrap};

/// The letters of what is printed.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Letters {
    /// Print ASCII only: dw1 for ω̇1, thetadd1 for θ̈1
    #[arg(long)]
    pub(crate) ascii: bool,
}

/// A blank at which no line is broken.
const TIED: char = '\u{A0}';

impl Letters {
    /// Converts a text that is wrapped afterwards; blanks at which no line may break are kept.
    pub(crate) fn of(self, text: &str) -> String {
        if !self.ascii {
            return text.to_owned();
        }
        text.split(TIED).map(rne_emit::ascii).collect::<Vec<_>>().join(TIED.encode_utf8(&mut [0; 2]))
    }

    /// Converts a text that is already arranged: where letters become longer, blanks between columns are removed, and a
    /// line that becomes wider than `most` columns is continued on the next one.
    pub(crate) fn page(self, text: &str, most: usize) -> String {
        if !self.ascii {
            return text.to_owned();
        }
        let mut page = String::with_capacity(text.len());
        for line in text.split_inclusive('\n') {
            let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\n"));
            let written = in_columns(line);
            let room = most.max(plain_width(line));
            if plain_width(&written) <= room {
                let _ = write!(page, "{written}{end}");
                continue;
            }
            let indent = written.len() - written.trim_start().len();
            let _ = write!(page, "{}{end}", wrap(&written, room, &" ".repeat(indent + 4)));
        }
        page
    }

    /// Escapes letters in JSON, which does not change its value.
    pub(crate) fn json(self, json: &str) -> String {
        if !self.ascii {
            return json.to_owned();
        }
        let mut escaped = String::with_capacity(json.len());
        for c in json.chars() {
            if c.is_ascii() {
                escaped.push(c);
            } else {
                for unit in c.encode_utf16(&mut [0; 2]) {
                    let _ = write!(escaped, "\\u{unit:04x}");
                }
            }
        }
        escaped
    }
}

/// Converts a line to ASCII. Its columns stay at their places as far as there are blanks to remove.
fn in_columns(line: &str) -> String {
    let mut written = String::new();
    let mut owed = 0;
    let mut rest = line;
    while !rest.is_empty() {
        let blanks = rest.find("  ").unwrap_or(rest.len());
        let (cell, after) = rest.split_at(blanks);
        let spelt = rne_emit::ascii(cell);
        owed += plain_width(&spelt).saturating_sub(plain_width(cell));
        written.push_str(&spelt);
        let gap = after.len() - after.trim_start_matches(' ').len();
        // at least one blank stays between two columns
        let given = if written.trim().is_empty() { 0 } else { owed.min(gap.saturating_sub(1)) };
        written.push_str(&" ".repeat(gap - given));
        owed -= given;
        rest = &after[gap..];
    }
    written
}

/// Returns the number of columns of a line, without its colours.
fn plain_width(line: &str) -> usize {
    width(&anstream::adapter::strip_str(line).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASCII: Letters = Letters { ascii: true };

    #[test]
    fn columns_stay_where_they_are() {
        assert_eq!(
            ASCII.page("  ω̇1     0   rad/s²  = q̈1 e\n  ω1     1\n", 80),
            "  dw1    0   rad/s^2 = qdd1 e\n  w1     1\n"
        );
        assert_eq!(ASCII.page("\u{1B}[1mθ\u{1B}[0m      x\n", 80), "\u{1B}[1mtheta\u{1B}[0m  x\n");
        assert_eq!(ASCII.page("  θ θ\n", 8), "  theta\n      theta\n");
    }

    #[test]
    fn letters_of_json_are_escaped() {
        assert_eq!(ASCII.json("{\"ω\": \"𝜔\"}"), r#"{"\u03c9": "\ud835\udf14"}"#);
    }

    #[test]
    fn what_is_tied_stays_tied() {
        assert_eq!(ASCII.of("ω\u{A0}e θ"), "w\u{A0}e theta");
        assert_eq!(Letters::default().of("ω"), "ω");
    }
}
