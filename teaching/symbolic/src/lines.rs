//! Breaks formulas into lines, outside of parentheses if possible.

use num_traits::Signed;
use unicode_width::UnicodeWidthStr as _;

use crate::collected::{Sum, Term, is_unit};
use crate::notation::{Notation, Script};

/// A piece of a formula that is not broken.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// The text in the script.
    text: String,
    /// Width in columns of a terminal; the width on a page is proportional to it.
    width: usize,
    /// Number of parentheses that are open before it.
    depth: usize,
}

/// A formula as pieces; a line may end before each, except the first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces(Vec<Piece>);

impl Pieces {
    /// Makes the pieces of a sum; 0 for an empty sum.
    pub(crate) fn of(sum: &Sum, notation: &Notation<'_>) -> Self {
        let mut writer = Writer { notation: *notation, plain: Script::Unicode, pieces: Vec::new() };
        writer.sum(sum, 0);
        Self(writer.pieces)
    }

    /// Makes the pieces of terms that are already written, in the script and as plain text: `M11 θ̈1 + h1`.
    pub(crate) fn of_terms(terms: &[(String, String)]) -> Self {
        let piece = |(at, (text, plain)): (usize, &(String, String))| {
            let sign = if at == 0 { "" } else { "+ " };
            let text = format!("{sign}{text}");
            Piece { width: sign.width() + plain.width(), text, depth: 0 }
        };
        if terms.is_empty() {
            return Self(vec![Piece { text: "0".to_owned(), width: 1, depth: 0 }]);
        }
        Self(terms.iter().enumerate().map(piece).collect())
    }

    /// Makes the pieces of the components of a vector.
    pub(crate) fn components(components: &[Sum], notation: &Notation<'_>) -> Self {
        let mut writer = Writer { notation: *notation, plain: Script::Unicode, pieces: Vec::new() };
        writer.push("(".to_owned(), 1, 0, true);
        for (at, component) in components.iter().enumerate() {
            if at > 0 {
                writer.push(",".to_owned(), 1, 1, false);
                writer.push(String::new(), 0, 1, true);
            }
            writer.sum(component, 2);
        }
        writer.push(")".to_owned(), 1, 0, false);
        Self(writer.pieces)
    }

    /// Converts the pieces to another spelling.
    pub(crate) fn spelt(self, spelling: impl Fn(&str) -> String) -> Self {
        let piece = |piece: Piece| {
            let text = spelling(&piece.text);
            Piece { width: text.width(), text, ..piece }
        };
        Self(self.0.into_iter().map(piece).collect())
    }

    /// Breaks a formula into lines of at most `most` columns; the first begins after `head` columns. Returns each line
    /// with the depth of parentheses at its beginning.
    pub(crate) fn lines(&self, head: usize, indent: usize, most: usize) -> Vec<(usize, String)> {
        self.lines_with(head, indent, most, 4)
    }

    /// Like [`Self::lines`], but a line ends outside all parentheses if possible, even if it is very short then.
    pub(crate) fn outer_lines(&self, head: usize, indent: usize, most: usize) -> Vec<(usize, String)> {
        self.lines_with(head, indent, most, usize::MAX)
    }

    /// Breaks a formula into lines. A line that ends outside all parentheses must fill at least the part 1 / `least` of
    /// what fits.
    fn lines_with(&self, head: usize, indent: usize, most: usize, least: usize) -> Vec<(usize, String)> {
        let mut lines = Vec::new();
        let mut rest = self.0.as_slice();
        let mut start = head;
        while let Some(first) = rest.first() {
            let mut column = start;
            let fitting = rest
                .iter()
                .enumerate()
                .take_while(|(at, piece)| {
                    column += piece.width + usize::from(*at > 0);
                    *at == 0 || column <= most
                })
                .count();
            let end = if fitting == rest.len() { fitting } else { Self::best_break(rest, fitting, least) };
            let (line, after) = rest.split_at(end);
            lines.push((first.depth, line.iter().map(|piece| piece.text.as_str()).collect::<Vec<_>>().join(" ")));
            start = indent + 2 * after.first().map_or(0, |piece| piece.depth);
            rest = after;
        }
        lines
    }

    /// Returns the break with the smallest depth of parentheses that does not leave most of the line empty; the last
    /// one if several are equal.
    fn best_break(pieces: &[Piece], fitting: usize, least: usize) -> usize {
        let widths: usize = pieces[..fitting].iter().map(|piece| piece.width + 1).sum();
        let mut column = 0;
        let mut best = (usize::MAX, fitting.max(1));
        for at in 1..=fitting {
            column += pieces[at - 1].width + 1;
            let depth = pieces.get(at).map_or(0, |piece| piece.depth);
            let share = if depth == 0 { least } else { 4 };
            if share.saturating_mul(column) >= widths && depth <= best.0 {
                best = (depth, at);
            }
        }
        best.1
    }
}

struct Writer<'c> {
    notation: Notation<'c>,
    /// The script by which widths are computed.
    plain: Script,
    pieces: Vec<Piece>,
}

impl Writer<'_> {
    fn sum(&mut self, sum: &Sum, depth: usize) {
        if sum.is_zero() {
            self.push("0".to_owned(), 1, depth, false);
        }
        for (at, term) in sum.0.iter().enumerate() {
            let sign = match (at, term.coefficient.is_negative()) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => "+ ",
                (_, true) => "- ",
            };
            self.push(sign.to_owned(), sign.len(), depth, at > 0);
            self.term(term, depth);
        }
    }

    /// Writes a term without its sign.
    fn term(&mut self, term: &Term, depth: usize) {
        let plain = Notation { script: self.plain, ..self.notation };
        let factors = |notation: &Notation<'_>, is_after: bool| {
            let factors = if is_after { &term.after } else { &term.before };
            let powers = factors.iter().map(|(factor, exponent)| notation.power(factor, *exponent));
            let is_bare = factors.is_empty() && term.sums.is_empty() && term.after.is_empty();
            let number =
                (!is_after && (!is_unit(&term.coefficient) || is_bare)).then(|| notation.magnitude(&term.coefficient));
            number.into_iter().chain(powers).collect::<Vec<_>>().join(notation.times())
        };
        let both = |writer: &Self, is_after: bool| (factors(&writer.notation, is_after), factors(&plain, is_after));
        let (text, wide) = both(self, false);
        self.push(text.clone(), wide.width(), depth, false);
        for (at, (sum, power)) in term.sums.iter().enumerate() {
            let space = if at == 0 && text.is_empty() { "" } else { " " };
            self.push(format!("{space}("), space.len() + 1, depth, false);
            self.sum(sum, depth + 1);
            let power = self.notation.exponent(*power);
            self.push(format!("){power}"), 1 + usize::from(!power.is_empty()), depth, false);
        }
        let (text, wide) = both(self, true);
        if !text.is_empty() {
            let is_first = term.sums.is_empty() && term.before.is_empty() && is_unit(&term.coefficient);
            let space = match (is_first, self.notation.script) {
                (true, _) => "",
                (false, Script::Unicode) => " ",
                (false, Script::Latex) => r"\,",
            };
            self.push(format!("{space}{text}"), 1 + wide.width(), depth, false);
        }
    }

    /// Adds text, as a new piece or to the last one.
    fn push(&mut self, text: String, width: usize, depth: usize, is_new: bool) {
        match self.pieces.last_mut() {
            Some(last) if !is_new => {
                last.text.push_str(&text);
                last.width += width;
            }
            _ => self.pieces.push(Piece { text, width, depth }),
        }
    }
}
