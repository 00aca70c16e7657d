//! Reads and writes numbers on the command line and in tables.

use std::str::FromStr;

pub(crate) use rne_logs::number::rounded;

/// A comma-separated list of finite numbers, as `--q` takes it. Each number is written as in a robot file: `pi/2`,
/// `deg(30)`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct List(pub(crate) Vec<f64>);

impl FromStr for List {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.trim().is_empty() {
            return Err("the list is empty; write numbers with commas between them, such as 0.1,-0.2".to_owned());
        }
        let number = |(index, element): (usize, &str)| {
            let (element, place) = (element.trim(), index + 1);
            if element.is_empty() {
                return Err(format!("number {place} is missing; write numbers with commas between them"));
            }
            // `30deg` is accepted, too, as in the input fields of the web page
            let in_degrees = element.strip_suffix("deg").map(|number| format!("deg({number})"));
            rne_model::number(in_degrees.as_deref().unwrap_or(element)).map_err(|mistake| {
                let hint = "write numbers or expressions with commas between them, such as 0.1,-pi/2";
                let hint = mistake.help.as_deref().unwrap_or(hint);
                match refused(element, &mistake.message) {
                    Ok(reason) => format!("number {place}, `{element}`, is not a number: {reason}; {hint}"),
                    Err(message) => format!("number {place}: {message}; {hint}"),
                }
            })
        };
        text.split(',').enumerate().map(number).collect::<Result<_, _>>().map(List)
    }
}

/// Returns `Ok` with the reason why `text` is not a number; or `Err` with the message, if this already says that it is
/// no number.
fn refused<'m>(text: &str, message: &'m str) -> Result<&'m str, &'m str> {
    if message.starts_with(&format!("`{text}` is not a number")) { Err(message) } else { Ok(message) }
}

/// Returns the message about a text that is not a number.
pub(crate) fn not_a_number(text: &str, message: &str) -> String {
    refused(text, message).map_or_else(str::to_owned, |reason| format!("`{text}` is not a number: {reason}"))
}

/// Pads texts of numbers so that their decimal points are in one column.
pub(crate) fn at_the_point(texts: &[String]) -> Vec<String> {
    let places = |text: &String| text.find('.').unwrap_or_else(|| text.find('e').unwrap_or(text.len()));
    let most = texts.iter().map(places).max().unwrap_or(0);
    texts.iter().map(|text| format!("{}{text}", " ".repeat(most - places(text)))).collect()
}

/// Number of decimals in a worksheet.
const DIGITS: usize = 6;

/// Width of a number in a worksheet.
pub(crate) const WIDTH: usize = 12;

/// Writes a number for a worksheet: with fixed decimals, an exact zero as `0`, and the decimal point always in the same
/// column.
pub(crate) fn fixed(value: f64) -> String {
    if value == 0.0 {
        // puts the zero in the column before the decimal point
        return format!("{:>1$}{2}", "0", WIDTH - DIGITS - 1, " ".repeat(DIGITS + 1));
    }
    // exponent form, where fixed decimals would show fewer than four digits or be too wide, because a person computes
    // with four
    if value.abs() < 1e-3 || value.abs() >= 1e5 {
        return format!("{value:>WIDTH$.4e}");
    }
    format!("{value:>WIDTH$.DIGITS$}")
}

/// Writes a value with its deviation, with as many digits as the deviation allows: `0.454 ± 0.011`.
pub(crate) fn with_deviation(value: f64, deviation: f64) -> String {
    if !(value.is_finite() && deviation.is_finite() && deviation > 0.0) {
        return "not known".to_owned();
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it saturates
    let digits = (1.0 - deviation.log10().floor()).clamp(0.0, 12.0) as usize;
    let value = format!("{value:.digits$}");
    // removes the minus sign of a zero
    let value = if value.trim_start_matches(['-', '0', '.']).is_empty() { value.replace('-', "") } else { value };
    format!("{value} ± {deviation:.digits$}")
}

/// Makes a parser for an argument: a number for which `is_fine` is true; for others the error is `allowed`.
pub(crate) fn checked<T: FromStr>(
    is_fine: fn(&T) -> bool,
    allowed: &'static str,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| text.parse().ok().filter(is_fine).ok_or_else(|| allowed.to_owned())
}

/// Makes a parser for a finite number above 0.
pub(crate) fn above_zero(allowed: &'static str) -> impl Fn(&str) -> Result<f64, String> + Clone {
    checked(|number: &f64| number.is_finite() && *number > 0.0, allowed)
}

/// Makes a parser for the duration of a step.
pub(crate) fn duration() -> impl Fn(&str) -> Result<List, String> + Clone {
    let is_fine = |List(numbers): &List| matches!(numbers[..], [seconds] if seconds > 0.0);
    checked(is_fine, "write a number of seconds above 0, such as 0.01")
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn lists() {
        assert_eq!("-0.1, 2e-3,3".parse(), Ok(List(vec![-0.1, 2e-3, 3.0])));
        assert_eq!("90deg,-30 deg".parse(), "deg(90),-deg(30)".parse::<List>());
        assert_eq!("pi/2,-deg(90),2*(1+1)".parse(), Ok(List(vec![FRAC_PI_2, -FRAC_PI_2, 4.0])));
        for bad in ["", "1,,2", "1,", "m", "nan", "inf", "1e999", "--qd", "1/0"] {
            assert!(bad.parse::<List>().is_err(), "{bad}");
        }
        let said = "0.1,nan".parse::<List>().expect_err("no number");
        assert!(said.starts_with("number 2: `nan` is not a number here: numbers are finite"), "{said}");
        assert_eq!(said.matches("not a number").count(), 1, "{said}");
    }

    #[test]
    fn numbers_stand_at_the_point() {
        assert_eq!(fixed(-1.5), "   -1.500000");
        assert_eq!(fixed(0.0), "    0       ");
        assert_eq!(fixed(-0.0), fixed(0.0));
        assert_eq!(fixed(1.25e-17), "  1.2500e-17");
        assert_eq!((fixed(0.001_234_56), fixed(-0.000_987_65)), ("    0.001235".into(), "  -9.8765e-4".into()));
        assert_eq!([0.0, -0.0, 1.25, 1e-9].map(|x| rounded(x, 3)), ["0", "0", "1.250", "1.00e-9"]);
        assert_eq!(at_the_point(&["1.5".to_owned(), "-10".to_owned()]), ["  1.5", "-10"]);
    }
}
