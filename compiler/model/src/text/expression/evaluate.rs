//! Evaluates expressions.

use std::f64::consts::PI;
use std::ops::Range;

use super::parser::no_digits;
use super::{ALLOWED, Expression, Function, Kind, Meaning, Mistake, Names, Operator};
use crate::parts::quantity::{LARGEST_POWER, Quantity};
use crate::readers::varying::leave_out;
use crate::text::source::quoted;
use crate::text::spelling::did_you_mean;

/// Largest number of numbers, run-time parameters and operators in one formula. Without it, parameters that are defined
/// by one another could double the length each time.
const MAX_RUN_TIME_PARTS: usize = 250;

impl Operator {
    /// Applies the operator; returns `None` for a power of a run-time parameter that products cannot express.
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

impl Function {
    fn apply(self, x: f64) -> f64 {
        match self {
            Self::Sqrt => libm::sqrt(x),
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Tan => libm::tan(x),
            // In this order deg(90) equals pi/2 to the last bit.
            Self::Deg => x / 180.0 * PI,
            // Moves the decimal point in the text, because 130.2 / 1000 is not the number nearest to 0.1302.
            Self::Milli => format!("{x}e-3").parse().unwrap_or(f64::NAN),
        }
    }
}

impl Expression {
    /// Evaluates the expression, with its formula over run-time parameters. Returns `Err(None)` when it depends on a
    /// faulty parameter, whose mistake has been reported already.
    ///
    /// Everything but the recursion is in other functions, because the size of this function's stack frame limits the
    /// possible depth.
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

    /// Makes the error for a result that is zero by underflow, although exactly it is not.
    fn too_small(&self, text: &str) -> Mistake {
        let part = quoted(text.get(self.range.clone()).unwrap_or_default());
        Mistake::new(
            self.range.clone(),
            format!("{part} is too small for a 64-bit float; numbers other than 0 must be above 4.9e-324"),
        )
        .help("check the exponents and the factors, or write 0")
    }

    /// Returns the quantity, or an error if it is not finite or its formula is too long.
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

    /// Makes the error for a function or power of a run-time parameter.
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

/// Returns whether a name is one that textbooks use for a joint variable: q, q2, q_2, theta2.
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
