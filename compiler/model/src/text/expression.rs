//! The numbers of a robot file: arithmetic over literals, `pi` and parameters.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = { "+" | "-" } power
//! power   = atom [ "^" unary ]                    so -2^2 = -4, 2^3^2 = 2^9, 2^-1 = 0.5
//! atom    = number | name | function "(" sum ")" | "(" sum ")"
//! ```

mod parser;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;
use std::ops::Range;

use parser::{Parser, no_digits};

use crate::parts::quantity::{LARGEST_POWER, Quantity};
use crate::parts::varying::leave_out;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::quoted;
use crate::text::spelling::did_you_mean;

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
        Parser::new(text).whole()
    }

    /// The value, and how it depends on run-time parameters. `Err(None)` when it depends on a faulty parameter: that
    /// mistake is reported where it was made.
    ///
    /// Everything but the recursion is in functions of its own: the frames of this one are what bounds its depth.
    pub(crate) fn evaluate(&self, text: &str, names: &impl Names) -> Result<Quantity, Option<Mistake>> {
        match &self.kind {
            Kind::Number(value) => Ok(Quantity::constant(*value)),
            Kind::Name(name) => self.named(name, text, names),
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

    fn named(&self, name: &str, text: &str, names: &impl Names) -> Result<Quantity, Option<Mistake>> {
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
            Meaning::Unknown => Err(Some(unknown_name(name, self.range.clone(), text, names))),
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

fn unknown_name(name: &str, range: Range<usize>, text: &str, names: &impl Names) -> Mistake {
    if ["nan", "inf", "infinity"].contains(&name.to_lowercase().as_str()) {
        return no_digits(name, range);
    }
    if is_joint_variable(name) {
        let constant = text.replace(name, "");
        let constant = constant.trim_matches(|c: char| c == '+' || c.is_whitespace());
        let constant = if Expression::parse(constant).is_ok() { constant } else { "0" };
        let help = format!("the joint variable is added by itself: write only the constant part, such as `{constant}`");
        return Mistake::new(range, format!("unknown name {}", quoted(name))).help(help);
    }
    if Function::NAMES.contains(&name) {
        let help = format!("`{name}` is a function: write its argument in parentheses, as in `{name}(2)`");
        return Mistake::new(range, format!("{} needs an argument", quoted(name))).help(help);
    }
    let known = did_you_mean(name, ["pi"].into_iter().chain(Function::NAMES)).map(str::to_owned);
    let mistake = Mistake::new(range, format!("unknown name {}", quoted(name)));
    match known.or_else(|| names.similar(name)) {
        Some(known) => mistake.help(format!("did you mean `{known}`?")),
        None => mistake.help(format!("define it under `parameters`, or check the number: {ALLOWED}")),
    }
}
