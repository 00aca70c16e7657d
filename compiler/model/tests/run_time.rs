//! Run-time parameters: which numbers depend on them and how, and every error.

use std::fmt::Write as _;

use crate::common::{BASE, MOST_WORK};
use rne_model::InertiaElement::{Xx, Xy, Xz, Yy, Yz, Zz};
use rne_model::{Checked, Diagnostic, Entry, Formula, Reader, Report, Robot, RunTime};

const PAYLOAD: &str = include_str!("robots/payload.yaml");

fn read(text: &str, names: &[&str]) -> Result<Checked, Report> {
    Reader::new("robots/x.yaml").run_time(names).read(text)
}

fn robot(text: &str, names: &[&str]) -> Robot {
    read(text, names).unwrap_or_else(|report| panic!("{report}")).robot
}

fn parameter(index: usize) -> Formula {
    Formula::Parameter(index)
}

fn number(value: f64) -> Formula {
    Formula::Number(value)
}

/// Everything about a robot but its formulas; two of these are equal when every number has the same bits.
fn numbers(robot: &Robot) -> String {
    format!("{:?}", Robot { run_time: RunTime::default(), ..robot.clone() })
}

#[test]
fn without_names_nothing_stays_free() {
    for text in [BASE, PAYLOAD] {
        let robot = robot(text, &[]);
        assert!(robot.run_time.is_empty());
        assert_eq!(robot, Reader::new("robots/x.yaml").read(text).unwrap().robot);
        assert_eq!(robot.with_parameters(&[]).as_ref(), Some(&robot));
        assert_eq!(robot.with_parameters(&[1.0]), None);
    }
}

#[test]
fn the_formula_of_every_kind_of_number() {
    let robot = robot(PAYLOAD, &["h", "g", "J", "unit"]);
    let [h, g, j, unit] = [0, 1, 2, 3].map(parameter);
    assert_eq!(robot.run_time.names, ["h", "g", "J", "unit"]);
    assert_eq!(
        robot.run_time.entries,
        [
            (Entry::Gravity(2), -g),
            (Entry::BaseXyz(2), h.clone()),
            (Entry::ToolXyz(1), -h.clone()),
            (Entry::D(0), h.clone() / number(2.0)),
            (Entry::A(0), h.clone() - number(0.1)),
            (Entry::MotorInertia(0), number(2.0) * j.clone()),
            (Entry::GearRatio(0), number(-60.0) * unit.clone()),
            (Entry::Viscous(0), j.clone()),
            (Entry::CoulombPositive(0), j.clone() * number(1000.0)),
            (Entry::CoulombNegative(0), -j * number(900.0)),
            (Entry::Mass(1), unit.clone()),
            (Entry::Com(1, 2), -h),
            (Entry::Inertia(1, Xx), unit.clone() / number(12.0)),
            (Entry::Inertia(1, Xy), -unit / number(100.0)),
        ]
    );
    assert!(robot.run_time.written_inertia.is_empty() && robot.run_time.parameters.is_empty());
    assert_eq!(robot.run_time.formula(Entry::Mass(1)), Some(&parameter(3)));
    assert_eq!(robot.run_time.formula(Entry::Mass(0)), None);
}

#[test]
fn inertia_is_moved_to_the_centre_of_mass_as_a_formula() {
    let robot = robot(PAYLOAD, &["payload"]);
    let payload = || parameter(0);
    let m = || number(1.2) + payload();
    let c = || (number(1.2 * 0.1) + payload() * number(0.25)) / m();
    let moment = || number(0.1) + payload() * number(0.0625);
    assert_eq!(robot.run_time.parameters, [(5, m()), (6, c())]);
    assert_eq!(robot.run_time.written_inertia, [(0, Xx, moment()), (0, Yy, moment())]);
    let (x, xx) = (|| number(0.02), number(0.02 * 0.02));
    assert_eq!(
        robot.run_time.entries,
        [
            (Entry::Mass(0), m()),
            (Entry::Com(0, 2), c()),
            (Entry::Inertia(0, Xx), moment() - m() * (c() * c())),
            (Entry::Inertia(0, Yy), moment() - m() * (xx.clone() + c() * c())),
            (Entry::Inertia(0, Zz), number(0.02) - m() * xx),
            (Entry::Inertia(0, Xz), m() * x() * c()),
        ]
    );
    // Exact zeros stay exact zeros, and nothing else of the robot depends on it.
    assert!([Xy, Yz].iter().all(|element| robot.run_time.formula(Entry::Inertia(0, *element)).is_none()));
    assert_eq!(numbers(&robot), numbers(&Reader::new("robots/x.yaml").read(PAYLOAD).unwrap().robot));
}

#[test]
fn a_point_mass_has_no_inertia_about_itself_at_run_time_either() {
    let text = BASE.replace("{m: 1.5, r: 2*m}", "{m: 1.5, r: 2*m, p: 0.5}").replace(
        "{mass: r, inertia: {",
        "{mass: p, com: [0, 0, 0.5], inertia_about: origin, inertia: {xx: 0.5^2*p, yy: m/m*p*0.5*0.5*0 + p*0.5^2} } #",
    );
    let text = text.replace("mass: 2.5", "mass: m*r/r");
    let robot = robot(&text, &["p"]);
    assert_eq!(robot.run_time.entries, [(Entry::Mass(1), parameter(0))]);
    assert_eq!(robot.run_time.written_inertia.len(), 2);
}

#[test]
fn the_robot_at_other_values_is_that_of_the_file_with_other_numbers() {
    let names = ["payload", "h", "g", "J", "unit"];
    let original = robot(PAYLOAD, &names);
    assert_eq!(numbers(&original.with_parameters(&[0.0, 0.3, 9.81, 2e-4, 1.0]).unwrap()), numbers(&original));
    let values = [1.75, 0.45, 1.62, 7e-5, 2.5];
    let text = PAYLOAD
        .replace("payload: 0.0", "payload: 1.75")
        .replace("g: 9.81", "g: 1.62")
        .replace("h: 0.3", "h: 0.45")
        .replace("J: 2e-4", "J: 7e-5")
        .replace("unit: 1", "unit: 2.5");
    let moved = original.with_parameters(&values).unwrap();
    assert_eq!(format!("{moved:?}"), format!("{:?}", robot(&text, &names)));
    assert_eq!(numbers(&moved), numbers(&Reader::new("robots/x.yaml").read(&text).unwrap().robot));
    // A zero at run time is a zero, without a sign.
    let zero = original.with_parameters(&[0.0, 0.0, 0.0, 2e-4, 1.0]).unwrap();
    let text = PAYLOAD.replace("g: 9.81", "g: 0").replace("h: 0.3", "h: 0");
    assert_eq!(numbers(&zero), numbers(&Reader::new("robots/x.yaml").read(&text).unwrap().robot));
}

#[test]
fn powers_are_products_in_the_table_too() {
    // Here `pow` rounds otherwise than products.
    let pow =
        (1..1000).map(|i| f64::from(i) / 7.0).find(|x| libm::pow(*x, 3.0).to_bits() != (x * x * x).to_bits()).unwrap();
    let text = BASE.replace("{m: 1.5, ", &format!("{{p: {pow:?}, m: 1.5, ")).replace("d: 0.4", "d: p^3/1e6");
    let robot = robot(&text, &["p"]);
    assert_eq!(robot.joints[0].row.dh.d.to_bits(), (pow * pow * pow / 1e6).to_bits());
    assert_eq!(numbers(&robot), numbers(&robot.with_parameters(&[pow]).unwrap()));
}

#[test]
fn what_a_run_time_parameter_is_in_the_file_is_only_its_value() {
    // Defined through others, even through another run-time parameter.
    let text = BASE.replace("mass: 2.5", "mass: m*2");
    let robot = robot(&text, &["m", "r"]);
    assert_eq!(robot.run_time.parameters, []);
    assert_eq!(robot.run_time.formula(Entry::Mass(1)), Some(&parameter(1)));
    let moved = robot.with_parameters(&[2.0, 3.5]).unwrap();
    assert_eq!((moved.joints[0].row.link.mass, moved.joints[1].row.link.mass), (4.0, 3.5));
    assert_eq!(moved.parameters, [("m".to_owned(), 2.0), ("r".to_owned(), 3.5)]);
}

/// The one error of the file in which one passage is replaced.
fn the_one(old: &str, new: &str, names: &[&str]) -> (String, Diagnostic) {
    assert_eq!(PAYLOAD.matches(old).count(), 1, "`{old}` must occur once");
    let text = PAYLOAD.replace(old, new);
    let report = read(&text, names).expect_err(new);
    assert_eq!(report.diagnostics.len(), 1, "`{new}`:\n{report}");
    (text, report.diagnostics[0].clone())
}

#[test]
fn errors() {
    // name, replacement; line, column, underlined, message, help
    for (name, (old, new), (line, column, underlined), message, help) in [
        (
            "twist",
            ("unit: 1", "unit: 1"),
            (11, 47, "twist"),
            "the angle `twist` depends on the run-time parameter `twist`; only lengths (not `b` and `at`), gravity, \
             the numbers",
            "remove `twist` from the run-time parameters: rne then uses its value in the file",
        ),
        ("h", ("theta: 0,", "theta: h - pi,"), (11, 17, "h - pi"), "the angle `h - pi` depends on", "remove `h` from"),
        ("payload", ("pi/4]", "m]"), (6, 36, "m"), "the angle `m` depends on the run-time parameter `payload`", ""),
        ("h", ("[-pi, pi]", "[-pi, h]"), (17, 30, "h"), "the limit `h` depends on the run-time parameter `h`", ""),
        ("J", ("velocity: 2", "velocity: 2/J"), (17, 45, "2/J"), "the limit `2/J` depends on", "remove `J` from"),
        ("J", ("effort: 50", "effort: 50*J"), (17, 56, "50*J"), "the limit `50*J` depends on", "remove `J` from"),
        (
            "payload",
            ("d: 0, a: 0,", "d: payload, a: 0,"),
            (20, 29, "payload"),
            "`payload` = 0 depends on the run-time parameter `payload`, but such a number must not be 0 in the file",
            "give `payload` a value in the file for which this number is not zero, or remove it from the run-time \
             parameters",
        ),
        ("h", ("h - 0.1", "h - 0.3"), (11, 31, "h - 0.3"), "`h - 0.3` = 0 depends on", "give `h` a value"),
        ("h", ("0.1]}", "h-0.3]}"), (7, 21, "h-0.3"), "`h-0.3` = 0 depends on the run-time parameter `h`", ""),
        ("unit", ("mass: unit", "mass: unit - 1"), (21, 18, "unit - 1"), "`unit - 1` = 0 depends on", ""),
        ("unit", ("-60*unit", "unit - 1"), (18, 39, "unit - 1"), "`unit - 1` = 0 depends on", ""),
        ("payload", ("zz: 0.02", "yz: payload"), (15, 73, "payload"), "`payload` = 0 depends on", ""),
        (
            "unit",
            (
                "mass: unit, com: [0, 0, -h], inertia: {xx: unit/12, yy: 0.1, zz: 0.1,",
                "mass: unit, com: [1, 0, 0], inertia_about: origin, inertia: {yy: 2, zz: 1,",
            ),
            (21, 72, "{yy: 2, zz: 1, xy: -unit/100}"),
            "the element zz = 0 of the inertia about the centre of mass depends on the run-time parameter `unit`",
            "give `unit` a value",
        ),
        (
            "h",
            ("d: h/2", "d: 1 + sqrt(h)"),
            (11, 27, "sqrt(h)"),
            "`sqrt(h)` depends on the run-time parameter `h`; with run-time parameters, only + - * / and whole powers \
             are allowed, up to 16",
            "remove `h` from the run-time parameters",
        ),
        ("h", ("d: h/2", "d: sin(2*h)"), (11, 23, "sin(2*h)"), "`sin(2*h)` depends on", ""),
        ("h", ("theta: 0,", "theta: cos(h),"), (11, 17, "cos(h)"), "`cos(h)` depends on", ""),
        ("h", ("d: h/2", "d: tan(h)"), (11, 23, "tan(h)"), "`tan(h)` depends on", ""),
        ("h", ("d: h/2", "d: deg(h)"), (11, 23, "deg(h)"), "`deg(h)` depends on", ""),
        ("h", ("d: h/2", "d: h^0.5"), (11, 23, "h^0.5"), "`h^0.5` depends on", ""),
        ("h", ("d: h/2", "d: 2*h^17"), (11, 25, "h^17"), "`h^17` depends on", ""),
        ("h", ("d: h/2", "d: 2^h"), (11, 23, "2^h"), "`2^h` depends on", ""),
        ("payload", ("unit: 1}", "unit: sqrt(m)}"), (8, 121, "sqrt(m)"), "`sqrt(m)` depends on", ""),
        (
            "paylod",
            ("unit: 1", "unit: 1"),
            (8, 13, "{"),
            "the robot file has no parameter `paylod` for run time; under `parameters` there are `payload`, `g`, `h`, \
             `twist`, `J`, `m`, `c`, `unit`",
            "did you mean `payload`?",
        ),
        ("width", ("unit: 1", "unit: 1"), (8, 13, "{"), "no parameter `width`", "define `width: …` under `parameters`"),
        (
            "spare",
            ("unit: 1", "unit: 1, spare: 2"),
            (8, 124, "spare"),
            "the run-time parameter `spare` has no effect: no number of the table depends on it",
            "use `spare` in a number, or remove it from the run-time parameters",
        ),
    ] {
        let (text, error) = the_one(old, new, &[name]);
        assert_eq!((error.line, error.column), (line, column), "`{new}`: {}", error.message);
        assert!(text[error.span.clone()].starts_with(underlined), "`{new}`: {}", &text[error.span.clone()]);
        assert!(error.message.contains(message), "`{new}`: {}", error.message);
        assert!(error.help.as_deref().unwrap_or_default().contains(help), "`{new}`: {:?}", error.help);
    }
}

#[test]
fn every_unknown_name_is_listed() {
    let text = BASE
        .replace("parameters: {m: 1.5, r: 2*m}\n", "")
        .replace("mass: r", "mass: 1")
        .replace("m / 12", "1")
        .replace("m/12", "1");
    let report = read(&text, &["payload", "length"]).unwrap_err();
    assert_eq!(
        report.short(),
        "robots/x.yaml:1:1: error: the robot file has no parameter `length` for run time; under `parameters` there is \
         nothing\nrobots/x.yaml:1:1: error: the robot file has no parameter `payload` for run time; under `parameters` \
         there is nothing"
    );
    let many = (0..20).fold(String::new(), |mut many, i| {
        let _ = write!(many, "p{i:02}: {i}, ");
        many
    });
    let report = read(&BASE.replace("{m: 1.5, ", &format!("{{{many}m: 1.5, ")), &["x"]).unwrap_err();
    let message = &report.diagnostics[0].message;
    assert!(
        message.ends_with(
            "there are `p00`, `p01`, `p02`, `p03`, `p04`, `p05`, `p06`, `p07`, `p08`, `p09`, `p10`, `p11` and 10 more"
        ),
        "{message}"
    );
    // A shape that is wrong is reported once.
    let report = read(&BASE.replace("{m: 1.5, r: 2*m}", "[]"), &["x"]).unwrap_err();
    assert!(report.short().starts_with("robots/x.yaml:7:13: error: found a list of 0 where a mapping"), "{report}");
    assert!(!report.short().contains("`x`"), "{report}");
}

#[test]
fn what_is_wrong_already_is_not_said_to_have_no_effect() {
    for (old, new) in
        [("mass: 2.5", "mas: p"), ("d: 0.4", "d: sqrt(p)"), ("d: 0.4", "d: 2*(p - 1)"), ("alpha: pi/2", "alpha: p")]
    {
        let text = BASE.replace("{m: 1.5, ", "{p: 1, m: 1.5, ").replace(old, new);
        let report = read(&text, &["p"]).unwrap_err();
        assert_eq!(report.errors().count(), 1, "{report}");
        assert!(!report.short().contains("no effect"), "{report}");
    }
    // Only at zero, only in another parameter that nothing uses, only in its own value: no effect.
    for new in ["d: 0.4 + 0*p", "d: 0.4 + (p - p)", "d: 0.4"] {
        let text = BASE.replace("{m: 1.5, ", "{p: 1, m: 1.5, ").replace("d: 0.4", new);
        assert!(read(&text, &["p"]).unwrap_err().short().contains("`p` has no effect"), "{new}");
    }
}

/// Parameters that double one another, and expressions that copy the longest formula again and again, take no time.
#[test]
fn hostile_formulas() {
    let base = |parameters: &str| BASE.replace("{m: 1.5, r: 2*m}", &format!("{{p: 1, m: 1.5, r: 2*m, {parameters}}}"));
    let mut doubling = "d0: p".to_owned();
    for i in 1..1900 {
        let _ = write!(doubling, ", d{i}: d{0} + d{0}", i - 1);
    }
    let long = format!("long: \"p{}\"", "+p".repeat(124));
    let mut copies = long.clone();
    for i in 0..100 {
        let _ = write!(copies, ", c{i}: \"0{}\"", "+0*(long)-0*-long".repeat(80));
    }
    let mut differences = long;
    for i in 0..100 {
        let _ = write!(differences, ", c{i}: \"0{}\"", "+(long-long)".repeat(150));
    }
    for (what, parameters) in [("doubling", doubling), ("copies", copies), ("differences", differences)] {
        let text = base(&parameters);
        let report = read(text.get(..1 << 20).unwrap_or(&text), &["p"]).expect_err(what);
        println!("{what}: {} steps, {}", report.work(), report.diagnostics[0].message);
        assert!(report.work() <= MOST_WORK, "{what}: {} steps", report.work());
    }
    let robot = robot(&BASE.replace("d: 0.4", &format!("d: \"m{}\"", "+m".repeat(124))), &["m"]);
    assert_eq!(robot.with_parameters(&[2.0]).unwrap().joints[0].row.dh.d, 250.0);
}

/// What is set and stays free has the value that was set; of two settings the last counts.
#[test]
fn settings_and_run_time_parameters_go_together() {
    let reader = Reader::new("x.yaml").setting("payload", 9.0).setting("payload", 2.0);
    let set = reader.read(PAYLOAD).unwrap().robot;
    let free = reader.run_time(&["payload"]).read(PAYLOAD).unwrap().robot;
    assert_eq!(set.joints[0].row.link.mass, 1.2 + 2.0);
    assert_eq!(numbers(&set), numbers(&free));
    assert_eq!(free.run_time.values(&free), [2.0]);
    let other = Reader::new("x.yaml").setting("payload", 3.0).read(PAYLOAD).unwrap().robot;
    assert_eq!(numbers(&free.with_parameters(&[3.0]).unwrap()), numbers(&other));
}
