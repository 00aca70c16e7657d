//! The numbers of a robot file: arithmetic over literals, `pi` and parameters.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = { "+" | "-" } power
//! power   = atom [ "^" unary ]                    so -2^2 = -4, 2^3^2 = 2^9, 2^-1 = 0.5
//! atom    = number | name | function "(" sum ")" | "(" sum ")"
//! ```

mod evaluate;
mod parser;
#[cfg(test)]
mod tests;

use std::ops::Range;

use parser::Parser;

use crate::parts::quantity::Quantity;
use crate::text::diagnostic::Diagnostic;

/// The forms that a number may have, for the help of every error.
pub(crate) const ALLOWED: &str = "a number is a finite decimal such as 0.4 or 2.0e-4, or an expression over numbers, \
     `pi`, parameters, `+ - * / ^`, parentheses and sqrt sin cos tan deg mm g";

/// An expression in which every part has its byte range within the scalar.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expression {
    kind: Kind,
    range: Range<usize>,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Number(f64),
    Name(String),
    Negate(Box<Expression>),
    Binary(Operator, Box<Expression>, Box<Expression>),
    Call(Function, Box<Expression>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl Operator {
    fn of(symbol: char) -> Option<Self> {
        Some(match symbol {
            '+' => Self::Add,
            '-' => Self::Subtract,
            '*' => Self::Multiply,
            '/' => Self::Divide,
            '^' => Self::Power,
            _ => return None,
        })
    }

    /// Returns how tightly the operator binds its left and its right operand; a sign binds with [`SIGN`].
    fn binding(self) -> (u8, u8) {
        match self {
            Self::Add | Self::Subtract => (1, 2),
            Self::Multiply | Self::Divide => (3, 4),
            Self::Power => (7, 6),
        }
    }
}

const SIGN: u8 = 5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Function {
    Sqrt,
    Sin,
    Cos,
    Tan,
    Deg,
    /// Multiplies by 1/1000, for millimetres and grams.
    Milli,
}

impl Function {
    const NAMES: [&str; 7] = ["sqrt", "sin", "cos", "tan", "deg", "mm", "g"];
    /// The functions whose names may also be names of parameters, because robot files use `g` for gravity.
    const NOT_RESERVED: [&str; 2] = ["mm", "g"];

    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "sqrt" => Self::Sqrt,
            "sin" => Self::Sin,
            "cos" => Self::Cos,
            "tan" => Self::Tan,
            "deg" => Self::Deg,
            "mm" | "g" => Self::Milli,
            _ => return None,
        })
    }
}

/// Returns whether a name has a meaning in expressions already, so that it cannot name a parameter.
pub(crate) fn is_reserved(name: &str) -> bool {
    name == "pi" || Function::of(name).is_some() && !Function::NOT_RESERVED.contains(&name)
}

/// Returns whether a text is a name: a letter or underscore, then letters, digits and underscores.
pub(crate) fn is_identifier(name: &str) -> bool {
    name.starts_with(is_name_start) && name.chars().all(is_name_part)
}

fn is_name_start(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_'
}

fn is_name_part(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// A mistake in an expression, and its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mistake {
    pub(crate) range: Range<usize>,
    pub(crate) message: String,
    pub(crate) help: String,
}

impl Mistake {
    fn new(range: Range<usize>, message: impl Into<String>) -> Self {
        Self { range, message: message.into(), help: ALLOWED.to_owned() }
    }

    fn help(self, help: impl Into<String>) -> Self {
        Self { help: help.into(), ..self }
    }
}

/// The meaning of a name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Meaning {
    /// A parameter with its value.
    Value(Quantity),
    /// A parameter that the file defines after this use.
    Later,
    /// A parameter whose own expression is wrong, which has been reported already.
    Faulty,
    /// No parameter has this name.
    Unknown,
}

/// The names that an expression may use.
pub(crate) trait Names {
    /// Looks up a name, which counts as a use of it.
    fn meaning(&self, name: &str) -> Meaning;
    /// Returns a known name that resembles `name`.
    fn similar(&self, name: &str) -> Option<String>;
    /// Returns the name of a run-time parameter.
    fn run_time_parameter(&self, index: usize) -> String;
    /// Counts steps of work.
    fn count(&self, steps: usize);
}

impl Expression {
    /// Largest number of bytes of one expression, ten for each part; it bounds the work of reading it again for every
    /// alias.
    pub(crate) const MAX_BYTES: usize = 10_000;

    /// Parses a whole text as one expression.
    pub(crate) fn parse(text: &str) -> Result<Self, Mistake> {
        if text.trim().is_empty() {
            return Err(Mistake::new(0..text.len(), "a number is missing"));
        }
        if text.len() > Self::MAX_BYTES {
            let (bytes, most) = (text.len(), Self::MAX_BYTES);
            let message = format!("the expression is too long: {bytes} bytes, at most {most} are allowed");
            return Err(Mistake::new(0..text.len(), message).help("define parts of the expression under `parameters`"));
        }
        Parser::new(text).whole()
    }
}

/// Evaluates a number as a robot file may have it: a decimal, or an expression over numbers, `pi`, `+ - * / ^`,
/// parentheses and `sqrt sin cos tan deg mm g`. Names of parameters are not allowed.
///
/// ```
/// assert_eq!(rne_model::number("-pi/2"), Ok(-std::f64::consts::FRAC_PI_2));
/// assert_eq!(rne_model::number("pi/x").unwrap_err().message, "unknown name `x`");
/// ```
///
/// # Errors
///
/// A mistake, and its place in the text.
pub fn number(text: &str) -> Result<f64, Diagnostic> {
    struct Nameless;
    impl Names for Nameless {
        fn meaning(&self, _: &str) -> Meaning {
            Meaning::Unknown
        }
        fn similar(&self, _: &str) -> Option<String> {
            None
        }
        fn run_time_parameter(&self, _: usize) -> String {
            String::new()
        }
        fn count(&self, _: usize) {}
    }
    let value = Expression::parse(text).map_err(Some).and_then(|expression| expression.evaluate(text, &Nameless));
    match value {
        // -0 is 0, as in a file.
        Ok(quantity) => Ok(quantity.without_negative_zero().value),
        Err(mistake) => {
            let Mistake { range, message, help } =
                mistake.unwrap_or_else(|| Mistake::new(0..text.len(), "this is not a number"));
            let column = text.get(..range.start).map_or(0, |before| before.chars().count()) + 1;
            // This help is dropped, because it lists the forms of a robot file, and parameters are not allowed here.
            let help = (!help.contains(ALLOWED)).then_some(help);
            Err(Diagnostic { column, ..Diagnostic::error(range, message).maybe_help(help) })
        }
    }
}
