//! The numbers of a robot file: arithmetic over literals, `pi` and parameters.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = { "+" | "-" } power
//! power   = atom [ "^" unary ]                    so -2^2 = -4, 2^3^2 = 2^9, 2^-1 = 0.5
//! atom    = number | name | function "(" sum ")" | "(" sum ")"
//! ```

use std::f64::consts::PI;
use std::ops::Range;

use crate::diagnostic::Diagnostic;
use crate::quantity::{LARGEST_POWER, Quantity};
use crate::source::quoted;
use crate::spelling::did_you_mean;
use crate::unit;
use crate::varying::leave_out;

/// Parentheses, signs and powers inside one another; bounds the recursion of the parser.
const MAX_DEPTH: usize = 64;

/// Numbers, names and operators of one expression; bounds the recursion over its tree.
const MAX_PARTS: usize = 1000;

/// Numbers, run-time parameters and operators of one formula; parameters defined by one another could double it
/// forever.
const MAX_RUN_TIME_PARTS: usize = 250;

/// The forms of a number, for the help of every mistake.
pub(crate) const ALLOWED: &str = "a number is a finite decimal such as 0.4 or 2.0e-4, or an expression over numbers, \
     `pi`, parameters, `+ - * / ^`, parentheses and sqrt sin cos tan deg mm g";

/// An expression; every part knows its bytes within the scalar.
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

    /// How tightly it binds its left and its right operand; a sign binds with [`SIGN`].
    fn binding(self) -> (u8, u8) {
        match self {
            Self::Add | Self::Subtract => (1, 2),
            Self::Multiply | Self::Divide => (3, 4),
            Self::Power => (7, 6),
        }
    }

    /// Returns the result; `None` for a power of a run-time parameter that products cannot express.
    fn apply(self, a: Quantity, b: Quantity) -> Option<Quantity> {
        Some(match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => match (a.varying(), b.varying()) {
                (None, None) => Quantity::constant(libm::pow(a.value, b.value)),
                (Some(_), None) => a.whole_power(b.value)?,
                (_, Some(_)) => return None,
            },
        })
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
    /// Millimetres and grams: a thousandth.
    Milli,
}

impl Function {
    const NAMES: [&str; 7] = ["sqrt", "sin", "cos", "tan", "deg", "mm", "g"];
    /// The functions whose names may also name a parameter, because robot files use `g` for gravity.
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

    fn apply(self, x: f64) -> f64 {
        match self {
            Self::Sqrt => libm::sqrt(x),
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Tan => libm::tan(x),
            // In this order deg(90) is pi/2 to the last bit.
            Self::Deg => x / 180.0 * PI,
            // The decimal is moved, because 130.2 / 1000 is not the number nearest to 0.1302.
            Self::Milli => format!("{x}e-3").parse().unwrap_or(f64::NAN),
        }
    }
}

/// Whether a name means something already and cannot name a parameter.
pub(crate) fn is_reserved(name: &str) -> bool {
    name == "pi" || Function::of(name).is_some() && !Function::NOT_RESERVED.contains(&name)
}

/// Whether a text is a name: a letter or underscore, then letters, digits and underscores.
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
    /// A parameter with a value.
    Value(Quantity),
    /// A parameter that stands below the place of use.
    Later,
    /// A parameter whose own expression is wrong, which is already reported.
    Faulty,
    /// Nothing.
    Unknown,
}

/// The names an expression may use.
pub(crate) trait Names {
    /// Looks a name up, which counts as a use of it.
    fn meaning(&self, name: &str) -> Meaning;
    /// A known name that resembles `name`.
    fn similar(&self, name: &str) -> Option<String>;
    /// The name of a run-time parameter.
    fn run_time_parameter(&self, index: usize) -> String;
    /// Enters steps of work.
    fn count(&self, steps: usize);
}

impl Expression {
    /// Bytes of one expression, ten for each of its parts; bounds the work of reading it again for every alias.
    pub(crate) const MAX_BYTES: usize = 10_000;

    /// Reads a whole text as one expression.
    pub(crate) fn parse(text: &str) -> Result<Self, Mistake> {
        if text.trim().is_empty() {
            return Err(Mistake::new(0..text.len(), "a number is missing"));
        }
        if text.len() > Self::MAX_BYTES {
            let (bytes, most) = (text.len(), Self::MAX_BYTES);
            let message = format!("the expression is too long: {bytes} bytes, at most {most} are allowed");
            return Err(Mistake::new(0..text.len(), message).help("define parts of the expression under `parameters`"));
        }
        let mut parser = Parser { text, at: 0, depth: 0, parts: 0 };
        let expression = parser.operand_and_operators(0)?;
        parser.end()?;
        Ok(expression)
    }

    /// The value, and how it depends on run-time parameters. `Err(None)` when it depends on a faulty parameter: that
    /// mistake is reported where it was made.
    ///
    /// Everything but the recursion is in functions of its own: the frames of this one are what bounds its depth.
    pub(crate) fn evaluate(&self, text: &str, names: &impl Names) -> Result<Quantity, Option<Mistake>> {
        match &self.kind {
            Kind::Number(value) => Ok(Quantity::constant(*value)),
            Kind::Name(name) => self.named(name, names),
            Kind::Negate(operand) => Ok(-operand.evaluate(text, names)?),
            Kind::Binary(operator, a, b) => {
                let a = a.evaluate(text, names)?;
                self.binary(*operator, a, b.evaluate(text, names)?, text, names).map_err(Some)
            }
            Kind::Call(function, argument) => {
                self.call(*function, &argument.evaluate(text, names)?, text, names).map_err(Some)
            }
        }
    }

    fn named(&self, name: &str, names: &impl Names) -> Result<Quantity, Option<Mistake>> {
        match names.meaning(name) {
            Meaning::Value(quantity) => Ok(quantity),
            Meaning::Faulty => Err(None),
            Meaning::Later => {
                let message = format!("the parameter {} has no value yet", quoted(name));
                Err(Some(
                    Mistake::new(self.range.clone(), message)
                        .help("a parameter may use only parameters that are defined above it under `parameters`"),
                ))
            }
            Meaning::Unknown => Err(Some(unknown_name(name, self.range.clone(), names))),
        }
    }

    fn binary(
        &self,
        operator: Operator,
        a: Quantity,
        b: Quantity,
        text: &str,
        names: &impl Names,
    ) -> Result<Quantity, Mistake> {
        let divides_by_zero = match operator {
            Operator::Divide => b == 0.0,
            Operator::Power => a == 0.0,
            _ => false,
        };
        let vanishes = match operator {
            Operator::Add | Operator::Subtract => false,
            Operator::Multiply => a != 0.0 && b != 0.0,
            Operator::Divide | Operator::Power => a != 0.0,
        };
        let parameter = a.first_parameter().or(b.first_parameter());
        match operator.apply(a, b) {
            Some(quantity) if vanishes && quantity == 0.0 => Err(self.too_small(text)),
            Some(quantity) => {
                names.count(quantity.parts());
                self.finite(quantity, divides_by_zero, text)
            }
            None => Err(self.only_in_the_file(text, parameter, names)),
        }
    }

    fn call(
        &self,
        function: Function,
        argument: &Quantity,
        text: &str,
        names: &impl Names,
    ) -> Result<Quantity, Mistake> {
        if argument.varying().is_some() {
            return Err(self.only_in_the_file(text, argument.first_parameter(), names));
        }
        let value = function.apply(argument.value);
        if value == 0.0 && argument.value != 0.0 {
            return Err(self.too_small(text));
        }
        self.finite(Quantity::constant(value), false, text)
    }

    /// A result that is zero in floating point and not on paper.
    fn too_small(&self, text: &str) -> Mistake {
        let part = quoted(text.get(self.range.clone()).unwrap_or_default());
        Mistake::new(
            self.range.clone(),
            format!("{part} is too small for a 64-bit float; numbers other than 0 must be above 4.9e-324"),
        )
        .help("check the exponents and the factors, or write 0")
    }

    /// Returns the result, unless it is not finite or too long.
    fn finite(&self, quantity: Quantity, divides_by_zero: bool, text: &str) -> Result<Quantity, Mistake> {
        if quantity.varying().is_some_and(|formula| formula.parts() > MAX_RUN_TIME_PARTS) {
            let message = format!(
                "when its parameters are written out, the expression has more than {MAX_RUN_TIME_PARTS} numbers, \
                 run-time parameters and operators"
            );
            let help = "shorten it, or let fewer parameters vary at run time";
            return Err(Mistake::new(self.range.clone(), message).help(help));
        }
        let value = quantity.value;
        if value.is_finite() {
            return Ok(quantity);
        }
        let part = quoted(text.get(self.range.clone()).unwrap_or_default());
        let (message, help) = if value.is_nan() {
            (
                format!("{part} is not a real number; numbers are real and finite"),
                "check for the root of a negative number and for 0/0",
            )
        } else if divides_by_zero {
            (format!("{part} is infinite; numbers are finite"), "check for a division by zero")
        } else {
            (
                format!("{part} is too large for a 64-bit float; numbers are below 1.8e308"),
                "check the exponents and the factors",
            )
        };
        Err(Mistake::new(self.range.clone(), message).help(help))
    }

    /// A function or power of a run-time parameter.
    fn only_in_the_file(&self, text: &str, parameter: Option<usize>, names: &impl Names) -> Mistake {
        let name = parameter.map(|index| names.run_time_parameter(index)).unwrap_or_default();
        let message = format!(
            "{} depends on the run-time parameter {}; with run-time parameters, only + - * / and whole powers are \
             allowed, up to {LARGEST_POWER}",
            quoted(text.get(self.range.clone()).unwrap_or_default()),
            quoted(&name)
        );
        Mistake::new(self.range.clone(), message).help(leave_out(&name))
    }
}

/// A number as a robot file has it: a decimal, or an expression over numbers, `pi`, `+ - * / ^`, parentheses and
/// `sqrt sin cos tan deg mm g`. There are no parameters.
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
            // What a file allows is more than what is allowed here.
            let help = (!help.contains(ALLOWED)).then_some(help);
            Err(Diagnostic { column, ..Diagnostic::error(range, message).maybe_help(help) })
        }
    }
}

/// Whether a name is one that textbooks give a joint variable: q, q2, q_2, theta2.
fn is_joint_variable(name: &str) -> bool {
    let index = name.strip_prefix("theta").or_else(|| name.strip_prefix('q'));
    index.is_some_and(|index| index.trim_start_matches('_').chars().all(|c| c.is_ascii_digit() || c == 'i'))
}

fn unknown_name(name: &str, range: Range<usize>, names: &impl Names) -> Mistake {
    if ["nan", "inf", "infinity"].contains(&name.to_lowercase().as_str()) {
        return no_digits(name, range);
    }
    if is_joint_variable(name) && names.similar(name).is_none() {
        return Mistake::new(range, format!("unknown name {}", quoted(name))).help(
            "if this is the joint variable, delete it: rne adds the joint variable; write only the constant part, such \
             as 0",
        );
    }
    let known = did_you_mean(name, ["pi"].into_iter().chain(Function::NAMES)).map(str::to_owned);
    let mistake = Mistake::new(range, format!("unknown name {}", quoted(name)));
    match known.or_else(|| names.similar(name)) {
        Some(known) => mistake.help(format!("did you mean `{known}`?")),
        None => mistake.help(format!("define it under `parameters`, or check the number: {ALLOWED}")),
    }
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
    parts: usize,
}

impl<'t> Parser<'t> {
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

    /// Takes the characters that satisfy `part`.
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

    /// The place of the next character, or the end of the text.
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

    /// An operand and all operators after it that bind at least as tightly as `least`.
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

    /// A number with a unit, where all that follows the byte `at` is one.
    fn with_unit(&self, at: usize) -> Option<Mistake> {
        let (before, after) = self.text.split_at_checked(at)?;
        let (before, written) = (before.trim(), after.trim());
        let help = unit::instead(before, written)?;
        let start = at + (after.len() - after.trim_start().len());
        let message =
            format!("the number {} has the unit {}; write numbers without a unit", quoted(before), quoted(written));
        Some(Mistake::new(start..start + written.len(), message).help(help))
    }

    /// `1,98`: a number with the decimal sign of other languages.
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

/// `.nan`, `NaN`, `.inf`: what other readers take for a number.
fn no_digits(found: &str, range: Range<usize>) -> Mistake {
    Mistake::new(range, format!("{} is not a number here: numbers are finite and written in digits", quoted(found)))
        .help(format!("delete a limit that is unknown; {ALLOWED}"))
}

/// Characters that come with numbers copied from papers and other formats.
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

#[cfg(test)]
#[path = "expression_tests.rs"]
mod tests;
