use std::f64::consts::PI;

use super::*;
use crate::Formula;
use crate::text::spelling::did_you_mean;

/// Test names: `a` is 3, `m` is 0.5, `p` is 0.7 and a run-time parameter, `later` is defined later, `faulty` has a
/// wrong expression.
struct Known;

impl Names for Known {
    fn meaning(&self, name: &str) -> Meaning {
        match name {
            "a" => Meaning::Value(Quantity::constant(3.0)),
            "m" => Meaning::Value(Quantity::constant(0.5)),
            "p" => Meaning::Value(Quantity::parameter(0, 0.7)),
            "later" => Meaning::Later,
            "faulty" => Meaning::Faulty,
            _ => Meaning::Unknown,
        }
    }

    fn similar(&self, name: &str) -> Option<String> {
        did_you_mean(name, ["length"]).map(str::to_owned)
    }

    fn run_time_parameter(&self, _: usize) -> String {
        "p".to_owned()
    }

    fn count(&self, _: usize) {}
}

fn quantity(text: &str) -> Result<Quantity, Option<Mistake>> {
    Expression::parse(text).map_err(Some)?.evaluate(text, &Known)
}

fn value(text: &str) -> Result<f64, Option<Mistake>> {
    quantity(text).map(|quantity| quantity.value)
}

/// Returns the first and the last column of a mistake, both counted from 1, its message and its help.
fn mistake(text: &str) -> (usize, usize, String, String) {
    let mistake = value(text).expect_err(text).expect("a mistake of its own");
    (mistake.range.start + 1, mistake.range.end, mistake.message, mistake.help)
}

#[test]
fn literals() {
    for (text, expected) in [
        ("0", 0.0),
        ("1", 1.0),
        ("-1", -1.0),
        ("+1", 1.0),
        ("0.25", 0.25),
        (".5", 0.5),
        ("5.", 5.0),
        ("2.0e-4", 2.0e-4),
        ("1E+3", 1000.0),
        ("1e5", 1e5),
        ("0e0", 0.0),
        ("0.1", 0.1),
        ("4.9e-324", 4.9e-324),
        ("1.7976931348623157e308", f64::MAX),
        (" 7 ", 7.0),
        ("pi", PI),
    ] {
        assert_eq!(value(text), Ok(expected), "{text}");
    }
}

#[test]
fn precedence_and_associativity() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("(1 + 2)*3", 9.0),
        ("7 - 2 - 1", 4.0),
        ("8/4/2", 1.0),
        ("8/4*2", 4.0),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^-1", 0.5),
        ("2^-1*3", 1.5),
        ("2^-2^2", 0.0625),
        ("-2*3", -6.0),
        ("2*-3", -6.0),
        ("2 - -3", 5.0),
        ("--2", 2.0),
        ("-(1+1)", -2.0),
        ("m*a^2/12", 0.5 * 9.0 / 12.0),
        ("1+2\n+3", 6.0),
    ] {
        assert_eq!(value(text), Ok(expected), "{text}");
    }
}

#[test]
fn functions() {
    for (text, expected) in [
        ("sqrt(2)", 2.0_f64.sqrt()),
        ("sqrt 2", f64::NAN),
        ("sin(1)", libm::sin(1.0)),
        ("cos(1)", libm::cos(1.0)),
        ("tan(0.5)", libm::tan(0.5)),
        ("deg(90)", PI / 2.0),
        ("deg(180)", PI),
        ("mm(77)", 0.077),
        ("g(130.2)", 0.1302),
        ("mm(4.5) * 2", 0.009),
        ("deg(-90)", -PI / 2.0),
        ("deg(270)", 1.5 * PI),
        ("-deg (45) / 2", -PI / 8.0),
        ("2*sqrt((a+1)*4)", 8.0),
    ] {
        if expected.is_finite() {
            assert_eq!(value(text), Ok(expected), "{text}");
        } else {
            assert!(value(text).is_err(), "{text}");
        }
    }
}

#[test]
fn what_is_no_number_says_why_and_where() {
    for (text, from, to, message, help) in [
        ("1_000", 1, 5, "`1_000` is not a number here: digits must not be grouped", "delete the `_`"),
        ("012", 1, 3, "leading zero", "delete the leading zeros"),
        ("-00.5", 2, 5, "leading zero", "delete the leading zeros"),
        ("0x1F", 1, 4, "numbers are decimal", "convert it"),
        ("0o17", 1, 4, "numbers are decimal", "convert it"),
        ("0b11", 1, 4, "numbers are decimal", "convert it"),
        (".inf", 1, 4, "`.inf` is not a number here: numbers are finite", "delete its key"),
        ("-.INF", 2, 5, "numbers are finite", "delete its key"),
        (".nan", 1, 4, "numbers are finite", "delete its key"),
        ("inf", 1, 3, "`inf` is not a number here: numbers are finite", "delete its key"),
        ("NaN", 1, 3, "`NaN` is not a number here: numbers are finite", "delete its key"),
        ("q1", 1, 2, "unknown name `q1`", "added by itself: write only the constant part, such as `0`"),
        ("pi/2 + theta_2", 8, 14, "unknown name `theta_2`", "write only the constant part, such as `pi/2`"),
        ("true", 1, 4, "unknown name `true`", "a finite decimal"),
        ("", 1, 0, "a number is missing", "a finite decimal"),
        ("  ", 1, 2, "a number is missing", "a finite decimal"),
        ("~", 1, 1, "`~` is not part of an expression", "delete the key"),
        ("1e999", 1, 5, "too large", "exponent"),
        ("1e-999", 1, 6, "too small", "exponent"),
        ("2m", 2, 2, "the number `2` has the unit `m`", "write `2` alone; a product is written `2*m`"),
        ("2x", 1, 2, "an operator is missing", "`*`"),
        ("90deg", 3, 5, "the number `90` has the unit `deg`", "radians: write `deg(90)`"),
        ("-90 deg", 5, 7, "the number `-90` has the unit `deg`", "write `deg(-90)`"),
        ("pi/2 rad", 6, 8, "has the unit `rad`", "write `pi/2` alone"),
        ("400 mm", 5, 6, "has the unit `mm`", "write `mm(400)`"),
        ("3 + 4 cm", 7, 8, "has the unit `cm`", "write `(3 + 4)/100`"),
        ("1.98 kg", 6, 7, "has the unit `kg`", "write `1.98` alone"),
        ("250 g", 5, 5, "has the unit `g`", "write `g(250)`"),
        ("0.1 kg*m^2", 5, 10, "has the unit `kg*m^2`", "write `0.1` alone"),
        ("250 kg mm²", 5, 11, "has the unit `kg mm²`", "write `250*1e-6`"),
        ("30 rpm", 4, 6, "has the unit `rpm`", "write `30*2*pi/60`"),
        ("1,98", 2, 2, "`,` is not part of a number", "write `1.98`"),
        ("1e", 1, 2, "incomplete", "`*`"),
        ("1.2.3", 1, 5, "two decimal points", "delete one"),
        (".", 1, 1, "written in digits", "delete its key"),
        ("0,5", 2, 2, "`,` is not part of a number", "point"),
        ("1 2", 3, 3, "found `2` where an operator is needed", "a finite decimal"),
    ] {
        let found = mistake(text);
        assert_eq!((found.0, found.1), (from, to), "{text}: {}", found.2);
        assert!(found.2.contains(message), "{text}: {}", found.2);
        assert!(found.3.contains(help), "{text}: {}", found.3);
    }
}

#[test]
fn mistakes_in_expressions_point_at_their_column() {
    for (text, from, to, message, help) in [
        ("1 + x*2", 5, 5, "unknown name `x`", "define it under `parameters`"),
        ("2*lenght", 3, 8, "unknown name `lenght`", "did you mean `length`?"),
        ("2*PI", 3, 4, "unknown name `PI`", "did you mean `pi`?"),
        ("1 + later", 5, 9, "has no value yet", "above it"),
        ("2*(m+)/3", 6, 6, "found `)` where a number or a name is needed", ""),
        ("1 +", 3, 3, "the expression ends where", ""),
        ("(1 + 2", 1, 1, "this `(` is never closed", "add a `)`"),
        ("2*(1 + 2", 3, 3, "this `(` is never closed", "add a `)`"),
        ("1 + 2)", 6, 6, "this `)` has no matching `(`", "delete the `)`"),
        ("()", 2, 2, "found `)` where", ""),
        ("sin pi", 1, 3, "`sin` needs an argument in parentheses", "`sin(…)`"),
        ("2*g", 3, 3, "`g` needs an argument", "`g(2)`"),
        ("-mm", 2, 3, "`mm` needs an argument", "`mm(2)`"),
        ("sin(1, 2)", 6, 6, "`,` is not part", ""),
        ("atan(1)", 1, 4, "unknown function `atan`", "sqrt sin cos tan deg mm g"),
        ("a(1)", 1, 1, "unknown function `a`", "`*`"),
        ("pi(2)", 3, 3, "found `(` where an operator is needed", ""),
        ("m**2", 2, 3, "`**` is not an operator", "`^`"),
        ("2 % 3", 3, 3, "found `%` where an operator is needed", ""),
        ("* 3", 1, 1, "found `*` where a number", ""),
        ("1 + 1/0", 5, 7, "`1/0` is infinite", "division by zero"),
        ("0^-1", 1, 4, "`0^-1` is infinite", "division by zero"),
        ("1 + 2^9999", 5, 10, "`2^9999` is too large for a 64-bit float", "check the exponents"),
        ("1/(1/0)", 3, 7, "is infinite", "division by zero"),
        ("2*sqrt(-1)", 3, 10, "`sqrt(-1)` is not a real number", "root"),
        ("0/0", 1, 3, "not a real number", ""),
        ("(-8)^(1/3)", 1, 10, "not a real number", ""),
        ("1e300*1e300", 1, 11, "too large", ""),
        ("10^400 - 10^400", 1, 6, "too large", ""),
        ("5e-324*0.5", 1, 10, "`5e-324*0.5` is too small for a 64-bit float", "or write 0"),
        ("1 + 1e-200*-1e-200", 5, 18, "too small", ""),
        ("1e-300/1e300", 1, 12, "too small", ""),
        ("10^-400", 1, 7, "too small", "exponents"),
        ("1e-200^2", 1, 8, "too small", ""),
        ("deg(5e-324)", 1, 11, "too small", ""),
        ("2·3", 2, 3, "`·` is not part", "write `*`"),
        ("−1", 1, 3, "`−` is not part", "minus sign of the keyboard"),
        ("π/2", 1, 2, "`π` is not part", "write `pi`"),
        ("90°", 3, 4, "has the unit `°`", "write `deg(90)`"),
        ("-22.5 °", 7, 8, "has the unit `°`", "write `deg(-22.5)`"),
        ("°", 1, 2, "`°` is not part", "`deg(…)`"),
    ] {
        let found = mistake(text);
        assert_eq!((found.0, found.1), (from, to), "{text}: {}", found.2);
        assert!(found.2.contains(message), "{text}: {}", found.2);
        assert!(found.3.contains(help), "{text}: {}", found.3);
    }
}

#[test]
fn formulas_take_the_steps_of_their_expression() {
    for text in [
        "p",
        "-p",
        "1.2 + p",
        "(p + 0.1) + 0.2",
        "2*p/3 - 1",
        "0.1*0.3*p",
        "p*0.1*0.3",
        "m*p^2/12",
        "p^3",
        "p^-2",
        "(1 + p)^16",
        "1/(a - p)",
        "2^a*p",
        "sqrt(2)*p",
        "p/p",
    ] {
        let quantity = quantity(text).unwrap();
        let formula = quantity.varying().expect(text);
        assert_eq!(formula.evaluate(&[0.7]).to_bits(), quantity.value.to_bits(), "{text}");
        let written = text.replace('p', "(11/16)");
        if !text.contains("p^") && !text.contains(")^") {
            assert_eq!(Ok(formula.evaluate(&[0.6875])), value(&written), "{text}");
        }
    }
    let square = Formula::Parameter(0) * Formula::Parameter(0);
    assert_eq!(quantity("p^2").unwrap().varying(), Some(&square));
    assert_eq!(quantity("p^1").unwrap().varying(), Some(&Formula::Parameter(0)));
}

#[test]
fn what_folds_to_a_number_varies_no_more() {
    for (text, expected) in
        [("0*p", 0.0), ("p - p", 0.0), ("0/p + 2", 2.0), ("p^0", 1.0), ("sin(0*p)", 0.0), ("2^(p-p)", 1.0)]
    {
        assert_eq!(quantity(text), Ok(Quantity::constant(expected)), "{text}");
    }
}

#[test]
fn what_cannot_vary_at_run_time() {
    for (text, from, to, message) in [
        (
            "1 + sqrt(p)",
            5,
            11,
            "`sqrt(p)` depends on the run-time parameter `p`; with run-time parameters, only + - * /",
        ),
        ("sin(2*p)", 1, 8, "`sin(2*p)` depends on"),
        ("cos(p)", 1, 6, "`cos(p)` depends on"),
        ("tan(p)", 1, 6, "`tan(p)` depends on"),
        ("deg(p)", 1, 6, "`deg(p)` depends on"),
        ("p^0.5", 1, 5, "whole powers are allowed, up to 16"),
        ("p^17", 1, 4, "whole powers are allowed, up to 16"),
        ("p^-1e300", 1, 8, "whole powers are allowed, up to 16"),
        ("3*2^p", 3, 5, "`2^p` depends on"),
        ("p^p", 1, 3, "`p^p` depends on"),
        ("0/(p - 0.7)", 1, 11, "`0/(p - 0.7)` is not a real number"),
        ("1/(p - 0.7)", 1, 11, "`1/(p - 0.7)` is infinite"),
        ("((1 + p)^16)^16", 1, 15, "more than 250 numbers, run-time parameters and operators"),
    ] {
        let found = mistake(text);
        assert_eq!((found.0, found.1), (from, to), "{text}: {}", found.2);
        assert!(found.2.contains(message), "{text}: {}", found.2);
    }
    assert_eq!(mistake("sqrt(p)").3, "remove `p` from the run-time parameters: rne then uses its value in the file");
}

#[test]
fn a_mistake_of_a_parameter_is_reported_once() {
    assert_eq!(value("2*faulty"), Err(None));
}

#[test]
fn hostile_expressions_end_in_an_error() {
    for (text, message) in [
        ("(".repeat(100_000), "too long: 100000 bytes"),
        (" ".repeat(9_999) + "11", "too long: 10001 bytes"),
        ("(".repeat(10_000), "nested more than 64 levels deep"),
        ("-".repeat(10_000), "nested more than 64 levels deep"),
        (format!("{}1", "2^".repeat(4_999)), "nested more than 64 levels deep"),
        ("sin(".repeat(2_500), "nested more than 64 levels deep"),
        (format!("1{}", "+1".repeat(4_999)), "more than 1000 numbers"),
    ] {
        let found = mistake(&text);
        assert!(found.2.contains(message), "{}", found.2);
    }
    assert_eq!(value(&format!("{}1{}", "(".repeat(60), ")".repeat(60))), Ok(1.0));
    assert_eq!(value(&format!("1{}", "+1".repeat(499))), Ok(500.0));
    assert_eq!(value(&(" ".repeat(9_999) + "1")), Ok(1.0));
}

#[test]
fn names() {
    assert!(is_identifier("a") && is_identifier("_a1") && is_identifier("J_xx"));
    assert!(!is_identifier("") && !is_identifier("1a") && !is_identifier("a b") && !is_identifier("é"));
    assert!(is_reserved("pi") && is_reserved("deg") && !is_reserved("e") && !is_reserved("g") && !is_reserved("mm"));
}
