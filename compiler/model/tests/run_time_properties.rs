//! Whatever the expressions: the formulas give the numbers of the file, and those of the file with other numbers.

use proptest::prelude::*;
use rne_model::{Reader, Robot, RunTime};

/// Arithmetic over the run-time parameters `p` and `r`, the constant `m` and numbers. Without powers: `libm::pow` may
/// round them otherwise than products.
fn expression() -> impl Strategy<Value = String> {
    let leaf =
        prop::sample::select(vec!["p", "r", "s", "m", "p", "r", "0", "1", "-1", "0.1", "3", "sqrt(2)", "deg(30)"]);
    leaf.prop_map(str::to_owned).prop_recursive(4, 24, 2, |inner| {
        (inner.clone(), prop::sample::select(vec!["+", "-", "*", "/", "neg"]), inner).prop_map(|(a, operator, b)| {
            if operator == "neg" { format!("-({a})") } else { format!("({a} {operator} {b})") }
        })
    })
}

/// A robot in which every kind of number is such an expression. Masses and the like are squares, for they are not
/// negative; the inertia is that of a large body.
fn text(e: &[String; 6], [p, r]: [f64; 2], about: &str) -> String {
    let [a, b, c, d, x, y] = e;
    format!(
        "format: 1
name: random
source: test
convention: standard
gravity: [\"{a}\", 0, \"p*9 - {b}\"]
base: {{xyz: [\"{c}\", 1, \"r\"]}}
tool: {{xyz: [0, \"{d}\", \"p\"]}}
parameters: {{p: {p:?}, r: {r:?}, m: 1.5, s: \"1 + {a}\"}}
joints:
  - type: revolute
    dh: {{theta: 0, d: \"{x}\", a: \"{y}\", alpha: pi/2}}
    link:
      mass: \"2 + p*p + r*r + ({b})*({b})\"
      com: [\"{c}\", \"{y}\", \"{x}\"]
      inertia: {{xx: \"1e12 + {d}\", yy: \"1e12 - {a}\", zz: \"1.1e12 + 3*{y}\", xy: \"{x}\", xz: 7, yz: \"{c} - {a}\"}}
      inertia_about: {about}
    motor:
      inertia: \"({x})*({x})\"
      gear_ratio: \"{c}\"
      viscous: \"{y}*({y})\"
      coulomb: [\"({d})*({d})\", \"-({a})*({a})\"]
"
    )
}

/// Every number of a robot, with the sign of its zeros.
fn numbers(robot: &Robot) -> String {
    format!("{:?}", Robot { run_time: RunTime::default(), ..robot.clone() })
}

fn read(text: &str, names: &[&str]) -> Option<Robot> {
    Reader::new("x.yaml").run_time(names).read(text).ok().map(|checked| checked.robot)
}

fn value() -> impl Strategy<Value = f64> {
    prop_oneof![-4.0..4.0, prop::sample::select(vec![1.0, -1.0, 0.5, 1e-3, 100.0])]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if std::env::var_os("RNE_EXHAUSTIVE").is_some() { 500 } else { 250 },
        max_global_rejects: 50_000,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn formulas_give_the_numbers_of_the_file(
        expressions in prop::array::uniform6(expression()),
        file in [value(), value()],
        other in [value(), value()],
        about in prop::sample::select(vec!["com", "origin"]),
    ) {
        let names = ["p", "r"];
        let original = text(&expressions, file, about);
        let robot = read(&original, &names);
        prop_assume!(robot.is_some());
        let robot = robot.unwrap();
        // At the values of the file.
        prop_assert_eq!(numbers(&robot), numbers(&read(&original, &[]).unwrap()));
        prop_assert_eq!(format!("{:?}", robot.with_parameters(&file).unwrap()), format!("{:?}", robot));
        // At others, as far as a file may have them.
        let moved = robot.with_parameters(&other).unwrap();
        let replaced = text(&expressions, other, about);
        if let Some(constant) = read(&replaced, &[]) {
            prop_assert_eq!(numbers(&moved), numbers(&constant));
        }
        if let Some(same) = read(&replaced, &names) {
            prop_assert_eq!(format!("{:?}", moved), format!("{:?}", same));
        }
    }

    #[test]
    fn powers_agree_with_themselves(
        p in value(), other in value(), n in 1..=16, sign in prop::sample::select(vec!["", "-"]),
    ) {
        let power = format!("(m + p^2)^{sign}{n} * p^{sign}{n}");
        let expressions = [&power; 6].map(Clone::clone);
        let read = |p| read(&text(&expressions, [p, 1.0], "com"), &["p", "r"]);
        if let (Some(at), Some(there)) = (read(p), read(other)) {
            prop_assert_eq!(format!("{:?}", at.with_parameters(&[other, 1.0]).unwrap()), format!("{:?}", there));
        }
    }
}
