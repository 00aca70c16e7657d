//! Parses expressions, and gives help for text that it cannot read.

use std::f64::consts::PI;
use std::ops::Range;

use super::{ALLOWED, Expression, Function, Kind, Mistake, Operator, SIGN, is_name_part, is_name_start, is_reserved};
use crate::text::source::quoted;
use crate::text::unit;

/// Largest depth of parentheses, signs and powers inside one another; it bounds the recursion of the parser.
const MAX_DEPTH: usize = 64;

/// Largest number of numbers, names and operators in one expression; it bounds the recursion over its tree.
const MAX_PARTS: usize = 1000;

/// A text and the position up to which it has been read.
pub(super) struct Parser<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
    parts: usize,
}

impl<'t> Parser<'t> {
    pub(super) const fn new(text: &'t str) -> Self {
        Self { text, at: 0, depth: 0, parts: 0 }
    }

    /// Parses the whole text as one expression.
    pub(super) fn whole(mut self) -> Result<Expression, Mistake> {
        let expression = self.operand_and_operators(0)?;
        self.end()?;
        Ok(expression)
    }

    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn blanks(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn peek(&mut self) -> Option<char> {
        self.blanks();
        self.rest().chars().next()
    }

    /// Reads the characters that satisfy `part`.
    fn take(&mut self, part: impl Fn(char) -> bool) -> &'t str {
        let rest = self.rest();
        let taken = rest.find(|c| !part(c)).and_then(|end| rest.get(..end)).unwrap_or(rest);
        self.at += taken.len();
        taken
    }

    fn eat(&mut self, symbol: char) -> bool {
        let found = self.peek() == Some(symbol);
        if found {
            self.at += symbol.len_utf8();
        }
        found
    }

    /// Returns the place of the next character, or the end of the text.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.rest().chars().next().map_or(0, char::len_utf8)
    }

    fn part(&mut self) -> Result<(), Mistake> {
        self.parts += 1;
        if self.parts > MAX_PARTS {
            let message = format!("the expression has more than {MAX_PARTS} numbers, names and operators");
            return Err(Mistake::new(self.here(), message).help("define parts of the expression under `parameters`"));
        }
        Ok(())
    }

    /// Parses an operand and all operators after it that bind at least as tightly as `least`.
    fn operand_and_operators(&mut self, least: u8) -> Result<Expression, Mistake> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let message = format!("the expression is nested more than {MAX_DEPTH} levels deep");
            return Err(Mistake::new(self.here(), message).help("define parts of the expression under `parameters`"));
        }
        let mut left = self.operand()?;
        while let Some(operator) = self.peek().and_then(Operator::of) {
            let (binds_left, binds_right) = operator.binding();
            if binds_left < least {
                break;
            }
            self.part()?;
            let symbol = self.here();
            self.at = symbol.end;
            if operator == Operator::Multiply && self.rest().starts_with('*') {
                let range = symbol.start..symbol.end + 1;
                return Err(Mistake::new(range, "`**` is not an operator here").help("write a power with `^`"));
            }
            let right = self.operand_and_operators(binds_right)?;
            let range = left.range.start..right.range.end;
            left = Expression { kind: Kind::Binary(operator, Box::new(left), Box::new(right)), range };
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<Expression, Mistake> {
        self.part()?;
        let next = self.peek();
        let start = self.at;
        let kind = match next {
            Some('-' | '+') => {
                self.at += 1;
                let operand = self.operand_and_operators(SIGN)?;
                if next == Some('+') {
                    return Ok(operand);
                }
                Kind::Negate(Box::new(operand))
            }
            Some('(') => {
                let inner = self.parenthesised()?;
                return Ok(Expression { range: start..self.at, ..inner });
            }
            Some(c) if is_name_start(c) => self.name()?,
            Some(c) if c.is_ascii_digit() || c == '.' => Kind::Number(self.number()?),
            _ => return Err(self.no_operand()),
        };
        Ok(Expression { kind, range: start..self.at })
    }

    fn parenthesised(&mut self) -> Result<Expression, Mistake> {
        let open = self.here();
        self.at = open.end;
        let inner = self.operand_and_operators(0)?;
        if self.eat(')') {
            return Ok(inner);
        }
        match self.peek() {
            None => Err(Mistake::new(open, "this `(` is never closed").help("add a `)`")),
            Some(_) => Err(self.no_operator()),
        }
    }

    fn name(&mut self) -> Result<Kind, Mistake> {
        let start = self.at;
        let name = self.take(is_name_part);
        if name == "pi" {
            return Ok(Kind::Number(PI));
        }
        let called = self.peek() == Some('(');
        let range = start..start + name.len();
        match (Function::of(name), called) {
            (Some(function), true) => Ok(Kind::Call(function, Box::new(self.parenthesised()?))),
            (Some(_), false) if is_reserved(name) => {
                Err(Mistake::new(range, format!("`{name}` needs an argument in parentheses"))
                    .help(format!("write `{name}(…)`")))
            }
            (None, true) => {
                let mistake = Mistake::new(range, format!("unknown function {}", quoted(name)));
                Err(mistake.help("the functions are sqrt sin cos tan deg mm g; a product is written with `*`"))
            }
            (_, false) => Ok(Kind::Name(name.to_owned())),
        }
    }

    fn number(&mut self) -> Result<f64, Mistake> {
        let start = self.at;
        let whole = self.take(|c| c.is_ascii_digit());
        let mut fraction = "";
        if self.rest().starts_with('.') {
            self.at += 1;
            fraction = self.take(|c| c.is_ascii_digit());
        }
        let mantissa = whole.len() + fraction.len();
        let exponent = self.rest().strip_prefix(['e', 'E']).map(|rest| rest.strip_prefix(['+', '-']).unwrap_or(rest));
        if let Some(exponent) = exponent.filter(|rest| mantissa > 0 && rest.starts_with(|c: char| c.is_ascii_digit())) {
            self.at = self.text.len() - exponent.len();
            self.take(|c| c.is_ascii_digit());
        }
        let digits_end = self.at;
        let tail = self.take(|c| is_name_part(c) || c == '.');
        let range = start..self.at;
        let literal = self.text.get(start..digits_end).unwrap_or_default();
        let found = quoted(self.text.get(range.clone()).unwrap_or_default());
        let wrong = |why: &str, help: &str| {
            Mistake::new(range.clone(), format!("{found} is not a number here: {why}"))
                .help(format!("{help}; {ALLOWED}"))
        };
        if mantissa == 0 {
            return Err(no_digits(self.text.get(range.clone()).unwrap_or_default(), range));
        }
        if tail.starts_with('_') {
            return Err(wrong("digits must not be grouped", "delete the `_`"));
        }
        if whole == "0" && tail.starts_with(['x', 'X', 'o', 'O', 'b', 'B']) {
            return Err(wrong("numbers are decimal", "convert it"));
        }
        if tail.starts_with(is_name_start) {
            if let Some(mistake) = self.with_unit(digits_end) {
                return Err(mistake);
            }
            return Err(wrong(
                "an operator is missing, or the number is incomplete",
                "write a product with `*`, and write no unit",
            ));
        }
        if !tail.is_empty() {
            return Err(wrong("it has two decimal points", "delete one"));
        }
        if whole.len() > 1 && whole.starts_with('0') {
            return Err(wrong("a number with a leading zero could be octal", "delete the leading zeros"));
        }
        let value: f64 = literal.parse().map_err(|_| wrong("it cannot be read", "check the digits"))?;
        if value.is_infinite() {
            return Err(wrong("it is too large for a 64-bit float", "check the exponent"));
        }
        let nonzero = whole.chars().chain(fraction.chars()).any(|digit| digit != '0');
        if value == 0.0 && nonzero {
            return Err(wrong("it is too small for a 64-bit float", "check the exponent, or write 0"));
        }
        Ok(value)
    }

    fn end(&mut self) -> Result<(), Mistake> {
        match self.peek() {
            None => Ok(()),
            Some(')') => {
                Err(Mistake::new(self.here(), "this `)` has no matching `(`").help("delete the `)` or add a `(`"))
            }
            Some(_) => Err(self.no_operator()),
        }
    }

    fn no_operand(&mut self) -> Mistake {
        let range = self.here();
        match self.peek() {
            None => {
                let before = self.text.trim_end();
                let last = before.chars().next_back().map_or(0, char::len_utf8);
                let place = before.len() - last..before.len();
                Mistake::new(place, "the expression ends where a number or a name is needed")
            }
            Some(c) => foreign(c, range.clone()).unwrap_or_else(|| {
                Mistake::new(range, format!("found {} where a number or a name is needed", quoted(&c.to_string())))
            }),
        }
    }

    fn no_operator(&mut self) -> Mistake {
        let c = self.peek().unwrap_or(' ');
        let range = self.here();
        if let Some(mistake) = self.with_unit(self.at).or_else(|| self.decimal_comma()) {
            return mistake;
        }
        foreign(c, range.clone()).unwrap_or_else(|| {
            Mistake::new(range, format!("found {} where an operator is needed", quoted(&c.to_string())))
        })
    }

    /// Returns an error for a number with a unit, if all text from the byte `at` on is a unit.
    fn with_unit(&self, at: usize) -> Option<Mistake> {
        let (before, after) = self.text.split_at_checked(at)?;
        let (before, written) = (before.trim(), after.trim());
        let help = unit::instead(before, written)?;
        let start = at + (after.len() - after.trim_start().len());
        let message =
            format!("the number {} has the unit {}; write numbers without a unit", quoted(before), quoted(written));
        Some(Mistake::new(start..start + written.len(), message).help(help))
    }

    /// Returns an error for a number such as `1,98`, with a comma as its decimal sign.
    fn decimal_comma(&self) -> Option<Mistake> {
        let (whole, fraction) = self.text.trim().split_once(',')?;
        let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
        if !digits(whole.trim_start_matches(['-', '+'])) || !digits(fraction) || !self.rest().starts_with(',') {
            return None;
        }
        let message = format!("{} is not part of a number", quoted(","));
        let mistake = Mistake::new(self.here(), message);
        Some(mistake.help(format!("the decimal sign is a point: write `{whole}.{fraction}`")))
    }
}

/// Makes the error for `.nan`, `NaN` or `.inf`, which other readers accept as numbers.
pub(super) fn no_digits(found: &str, range: Range<usize>) -> Mistake {
    Mistake::new(range, format!("{} is not a number here: numbers are finite and written in digits", quoted(found)))
        .help(format!("if this is a limit that is unknown, delete its key; {ALLOWED}"))
}

/// Returns an error with help for characters that text copied from papers and other formats contains.
fn foreign(c: char, range: Range<usize>) -> Option<Mistake> {
    let help = match c {
        '−' | '–' => "write the minus sign of the keyboard, `-`",
        '×' | '·' | '⋅' => "write `*`",
        'π' => "write `pi`",
        '°' => "write `deg(…)`",
        '²' | '³' => "write a power with `^`",
        ',' => "the decimal sign is a point",
        '~' => "delete the key instead",
        _ => return None,
    };
    Some(Mistake::new(range, format!("{} is not part of an expression", quoted(&c.to_string()))).help(help))
}
