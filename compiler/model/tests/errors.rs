//! Every error: where it points and what it says.

use std::fmt::Write as _;

use crate::common::{BASE, MOST_WORK, found, the_one, with};
use rne_model::{Entry, InertiaReference, Link, Reader, Remedy, Severity};

/// One replacement in the valid file, and the one error it must give: line, column, underlined text, part of message.
type Case = (&'static str, &'static str, usize, usize, &'static str, &'static str);

fn assert_cases(cases: &[Case]) {
    for (old, new, line, column, underlined, message) in cases {
        let error = the_one(old, new);
        assert_eq!(error.severity, Severity::Error, "`{new}`");
        assert_eq!((error.line, error.column), (*line, *column), "`{new}`: {}", error.message);
        assert_eq!(&with(old, new)[error.span.clone()], *underlined, "`{new}`: {}", error.message);
        assert!(error.message.contains(message), "`{new}`: {}", error.message);
    }
}

#[test]
fn the_valid_file_is_valid() {
    assert_eq!(found(BASE).to_string(), "");
}

#[test]
fn keys() {
    assert_cases(&[
        (
            "source: test",
            "source: test\ncolour: red",
            4,
            1,
            "colour",
            "unknown key `colour`; a robot file has the keys",
        ),
        ("name: first", "name: first\n    offset: 1", 10, 5, "offset", "unknown key `offset`; a joint has the keys"),
        ("{theta: 0, d: 0.4", "{theta: 0, d: 0.4, c: 1", 11, 28, "c", "`dh` has the keys theta, d, a, alpha"),
        ("mass: 2.5", "mass: 2.5\n      masse: 1", 14, 7, "masse", "a link has the keys mass, com, first_moment"),
        ("zz: 0.02}", "zz: 0.02, zx: 1}", 15, 46, "zx", "an inertia has the keys"),
        ("velocity: 2.0", "torque: 2.0", 17, 35, "torque", "`limits` has the keys position, velocity, effort"),
        ("viscous: 1.5e-3", "stiction: 1", 18, 49, "stiction", "`motor` has the keys"),
        ("base: {xyz", "base: {quaternion: 1, xyz", 6, 8, "quaternion", "a placement has the keys xyz, rpy"),
        ("source: test", "source: test\n<<: {a: 1}", 4, 1, "<<", "unknown key `<<`"),
        ("source: test", "source: test\nname: again", 4, 1, "name", "repeated key `name`; it is already in line 2"),
        (
            "{theta: 0, d: 0.4",
            "{theta: 0, theta: 1, d: 0.4",
            11,
            20,
            "theta",
            "repeated key `theta`; it is already in line 11",
        ),
        ("{m: 1.5, ", "{m: 1.5, m: 2, ", 7, 22, "m", "repeated key `m`; it is already in line 7"),
        ("gravity: [0", "? [1, 2]\n: 3\ngravity: [0", 5, 3, "[", "a key must be a plain word"),
    ]);
}

#[test]
fn near_misses_are_recognised() {
    for (old, new, help) in [
        ("source: test", "sorce: test", "did you mean `source`?"),
        ("link: {mass: r", "link: {mas: 0*r", "did you mean `mass`?"),
        ("convention: standard", "conventions: standard", "did you mean `convention`?"),
        ("inertia_about: com", "inertia-about: com", "did you mean `inertia_about`?"),
        ("standard", "Standard", "did you mean `standard`?"),
        ("revolute", "revolut", "did you mean `revolute`?"),
        ("revolute", "R", "did you mean `revolute`?"),
        ("prismatic", "P", "did you mean `prismatic`?"),
        ("standard", "distal", "did you mean `standard`?"),
        ("name: first", "name: first\n    mass: 1", "`mass` belongs under `link`"),
        (
            "name: first",
            "name: first\n    offset: 1",
            "write the offset of the joint as the constant in `theta` or `d`",
        ),
        ("source: test", "source: test\n<<: {a: 1}", "YAML merge keys are not part of the format; write the keys out"),
    ] {
        assert_eq!(the_one(old, new).help.as_deref(), Some(help), "{new}");
    }
}

#[test]
fn missing_fields_point_at_the_mapping_that_lacks_them() {
    assert_cases(&[
        ("format: 1\n", "", 1, 1, "name", "a robot file lacks the required key `format`"),
        ("name: base\n", "", 1, 1, "format", "lacks the required key `name`"),
        ("source: test\n", "", 1, 1, "format", "lacks the required key `source`"),
        ("convention: standard\n", "", 1, 1, "format", "lacks the required key `convention`"),
        ("gravity: [0, 0, -9.81]\n", "", 1, 1, "format", "lacks the required key `gravity`"),
        ("    type: revolute\n", "", 9, 5, "name", "a joint lacks the required key `type`"),
        ("    dh: {theta: 0, d: 0.4, a: 0, alpha: pi/2}\n", "", 9, 5, "name", "a joint lacks the required key `dh`"),
        ("theta: 0, d: 0.4", "d: 0.4", 11, 9, "{d: 0.4, a: 0, alpha: pi/2}", "`dh` lacks the required key `theta`"),
        (", alpha: pi/2", "", 11, 9, "{theta: 0, d: 0.4, a: 0}", "`dh` lacks the required key `alpha`"),
    ]);
    let report = found("format: 1\nname: x\n");
    assert_eq!(report.errors().count(), 4, "{report}");
}

/// Trees: what is wrong has its place, and a reader that does not take trees says so at the first branch.
#[test]
fn trees() {
    let file = |convention: &str, tool: &str, rows: &str| {
        format!(
            "format: 2\nname: x\nsource: own\nconvention: {convention}\ngravity: [0, 0, -9.81]\n{tool}\njoints:\n\
             - {{name: a, type: revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}, link: {{mass: 1}}}}\n{rows}"
        )
    };
    let row = |keys: &str, dh: &str| {
        format!("- {{{keys}, type: revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0{dh}}}, link: {{mass: 1}}}}\n")
    };
    let two = row("name: b, parent: a", "") + &row("name: c, parent: a", "");
    let first = |text: &str| Reader::new("x").trees().read(text).unwrap_err().short();
    for (text, expected) in [
        (file("modified", "", &row("name: b, parent: c", "")), "x:9:21: error: `parent` names `c`, which is no joint"),
        (
            file("modified", "", &(row("name: b, parent: c", "") + &row("name: c", ""))),
            "x:9:21: error: the parent `c` stands below",
        ),
        (file("modified", "", &row("name: b, parent: b", "")), "x:9:21: error: joint 2 names itself as its parent"),
        (file("standard", "", &row("name: b", ", gamma: 1")), "x:9:73: error: a standard row has no `gamma`"),
        (
            file("modified", "", &row("name: b, at: {xyz: [0, 0, 1]}", ", b: 1")),
            "error: the joint has both `at` and `b`",
        ),
        (file("modified", "", &two), "error: the robot has 2 ends (`b`, `c`)"),
        (file("modified", "tool: {on: base}", &two), "x:6:12: error: the tip cannot be on `base`"),
        (
            file("modified", "tool: {on: c}", &two).replace("format: 2", "format: 1"),
            "the key `parent` needs `format: 2`",
        ),
    ] {
        let found = first(&text);
        assert!(found.contains(expected), "{found}\n{expected}");
    }
    let tree = file("modified", "tool: {on: b}", &two);
    let robot = Reader::new("x").trees().read(&tree).unwrap().robot;
    assert_eq!([0, 1, 2].map(|joint| robot.parent(joint)), [None, Some(0), Some(0)]);
    assert_eq!((robot.tip().on, robot.is_serial()), (Some(1), false));
    let refused = Reader::new("x").read(&tree).unwrap_err().short();
    assert!(refused.starts_with("x:10:21: error: joint 3 (`c`) is not on the link of the row before"), "{refused}");
    // the row that branches off, and not an earlier one that begins at a place of its own
    let refused = |text: &str| Reader::new("x").read(text).unwrap_err().short();
    let placed = tree.replace("alpha: 0}", "alpha: 0, b: 1}");
    assert_eq!(refused(&placed).lines().next(), refused(&tree).lines().next());
    let only_placed = file("modified", "", &row("name: b", ", b: 1"));
    let found = refused(&only_placed);
    assert!(found.starts_with("x:9:69: error: joint 2 (`b`) begins at `b`, which only rows of trees have"), "{found}");
    let found = refused(&file("modified", "tool: {on: a}", &row("name: b", "")));
    assert!(found.starts_with("x:6:12: error: the tip is not on the last link: the robot is a tree"), "{found}");
    // a chain in the words of a tree is that chain
    let chain = file("modified", "tool: {on: b}", &row("name: b, parent: a", ""));
    assert!(Reader::new("x").read(&chain).unwrap().robot.is_serial());
}

#[test]
fn shapes() {
    assert_cases(&[
        ("[0, 0, -9.81]", "[0, -9.81]", 5, 10, "[0, -9.81]", "a list of 2 where 3 numbers [x, y, z] (m/s²)"),
        ("[0, 0, -9.81]", "-9.81", 5, 10, "-9.81", "found `-9.81` where a list of 3 numbers"),
        ("[0, 0, -9.81]", "[0, 0, [1]]", 5, 17, "[1]", "found a list of 1 where a number is needed"),
        ("com: [0, 0, 0.3]", "com: {x: 1}", 14, 12, "{x: 1}", "found a mapping where a list of 3 numbers"),
        ("[-pi, pi]", "[pi]", 17, 24, "[pi]", "a list of 1 where 2 numbers [lower, upper]"),
        ("[0.395, -0.435]", "0.4", 18, 75, "0.4", "a list of 2 numbers [Tc⁺, Tc⁻]"),
        ("d: 0.4", "d: {x: 1}", 11, 23, "{x: 1}", "found a mapping where a number is needed"),
        (
            "{theta: 0, d: 0.4, a: 0, alpha: pi/2}",
            "[0, 1, 2, 3]",
            11,
            9,
            "[0, 1, 2, 3]",
            "found a list of 4 where a mapping (theta, d, a, alpha, gamma, b)",
        ),
        ("{xx: 0.1, yy: 0.12, zz: 0.02}", "[1, 2, 3]", 15, 16, "[1, 2, 3]", "a mapping (xx, yy, zz, xy, xz, yz)"),
        ("source: test", "source: [a, b]", 3, 9, "[a, b]", "found a list of 2 where a text is needed"),
        ("source: test", "source:", 3, 1, "source", "found nothing where a text is needed"),
        ("source: test", "source: ~", 3, 9, "~", "found `~` where a text is needed"),
        ("source: test", "source: ''", 3, 9, "''", "found nothing where a text is needed"),
        ("convention: standard", "convention: [standard]", 4, 13, "[standard]", "`standard` or `modified` is needed"),
        ("mass: 2.5", "mass:", 13, 7, "mass", "a number is missing"),
        ("theta: 0, d: 0.4", "theta, d: 0.4", 11, 10, "theta", "a number is missing"),
        (
            "- name: second",
            "- 5\n  - name: second",
            19,
            5,
            "5",
            "found `5` where a mapping (name, parent, at, type, dh",
        ),
    ]);
    for (text, message) in [
        ("format: 1\njoints: {}\n", "where a list of joints is needed"),
        ("[1, 2]", "found a list of 2 where a mapping (format, name"),
        ("---\n", "found nothing where a mapping (format, name"),
        ("format: 1\nparameters: [1]\n", "where a mapping from names to numbers is needed"),
    ] {
        let report = found(text);
        assert!(report.errors().any(|error| error.message.contains(message)), "{report}");
    }
}

#[test]
fn values() {
    assert_cases(&[
        ("format: 1", "format: 3", 1, 9, "3", "unknown format `3`; it must be `1` or `2`"),
        ("format: 1", "format: 1.0", 1, 9, "1.0", "unknown format `1.0`"),
        ("name: base", "name: Base", 2, 7, "Base", "the name `Base` is not an identifier"),
        ("name: base", "name: 7dof", 2, 7, "7dof", "the name `7dof` is not an identifier"),
        ("name: base", "name: my-arm", 2, 7, "my-arm", "the name `my-arm` is not an identifier"),
        ("standard", "distal", 4, 13, "distal", "unknown convention `distal`; it must be `standard` or `modified`"),
        ("revolute", "rotary", 10, 11, "rotary", "unknown joint type `rotary`; it must be `revolute` or `prismatic`"),
        ("inertia_about: com", "inertia_about: link", 16, 22, "link", "must be `com` or `origin`"),
        ("mass: 2.5", "mass: -2.5", 13, 13, "-2.5", "the mass `-2.5` is negative; it must be zero or positive"),
        ("mass: 2.5", "mass: m - 2", 13, 13, "m - 2", "the mass `m - 2` = -0.5 is negative"),
        ("mass: 2.5", "mass: .inf", 13, 13, ".inf", "`.inf` is not a number here: numbers are finite"),
        ("mass: 2.5", "mass: .nan", 13, 13, ".nan", "numbers are finite"),
        ("mass: 2.5", "mass: 1/0", 13, 13, "1/0", "is infinite"),
        (
            "[-pi, pi]",
            "[pi, -pi]",
            17,
            24,
            "[pi, -pi]",
            "the lower position limit 3.14159 lies above the upper one, -3.14159",
        ),
        ("velocity: 2.0", "velocity: -1", 17, 45, "-1", "the velocity limit `-1` is negative"),
        ("effort: 50", "effort: -1", 17, 58, "-1", "the effort limit `-1` is negative"),
        ("inertia: 2.0e-4", "inertia: -1e-4", 18, 22, "-1e-4", "the rotor inertia `-1e-4` is negative"),
        ("viscous: 1.5e-3", "viscous: -1", 18, 58, "-1", "the viscous friction `-1` is negative"),
        ("gear_ratio: -62.6", "gear_ratio: 0", 18, 42, "0", "the gear ratio `0` is zero"),
        ("[0.395, -0.435]", "[-0.395, -0.435]", 18, 76, "-0.395", "`-0.395` for positive speed has the wrong sign"),
        ("[0.395, -0.435]", "[0.395, 0.435]", 18, 83, "0.435", "`0.435` for negative speed has the wrong sign"),
        ("name: second", "name: first", 19, 11, "first", "the name `first` of joint 2 is already the name of joint 1"),
        ("name: second", "name: \"a\\nb\"", 19, 11, "\"a\\nb\"", "has a line break; a joint name is one line"),
        ("name: second", "name: \"a\\tb\"", 19, 11, "\"a\\tb\"", "joint name `a\\tb` has the control character U+0009"),
        ("{m: 1.5,", "{m: 1.5, pi: 3, ", 7, 22, "pi", "the parameter name `pi` already has a meaning"),
        ("{m: 1.5,", "{m: 1.5, sin: 3, ", 7, 22, "sin", "the parameter name `sin` already has a meaning"),
        ("{m: 1.5,", "{m: 1.5, 2x: 3, ", 7, 22, "2x", "the parameter name `2x` is not an identifier"),
    ]);
}

/// From 2^23 rad on neighbouring numbers are more than 1e-9 rad apart; beyond 1e16 rad every angle was a right one.
#[test]
fn angles_are_so_small_that_their_digits_count() {
    for (old, at) in [("theta: 0, d: 0.4", "theta: "), ("alpha: pi/2", "alpha: ")] {
        for angle in ["8388608", "-1e15", "1e16", "1e300", "2^23"] {
            let value = old.split_once(at).and_then(|(_, rest)| rest.split(',').next()).expect("a value");
            let new = old.replacen(value, angle, 1);
            let error = the_one(old, &new);
            assert!(error.message.contains("rad is too large; angles must be below 8388608 rad"), "{}", error.message);
            assert_eq!(&with(old, &new)[error.span.clone()], angle);
        }
    }
    for (old, new) in [("rpy: [0, 0, pi]", "rpy: [0, 0, 1e15]"), ("rpy: [0, 0, pi]", "rpy: [-1e300, 0, pi]")] {
        assert!(the_one(old, new).message.contains("angles must be below 8388608 rad"), "{new}");
    }
    let largest = the_one("alpha: pi/2", "alpha: 8388607.9");
    assert_eq!(largest.severity, Severity::Warning, "{}", largest.message);
}

#[test]
fn a_default_joint_name_can_be_taken_as_well() {
    let text = with("name: first", "name: joint2").replace("  - name: second\n    type", "  - type");
    let report = found(&text);
    assert_eq!(
        report.short(),
        "robots/x.yaml:19:5: error: the name `joint2` of joint 2 is already the name of joint 1; joint names must \
         differ"
    );
}

#[test]
fn inertia_that_no_mass_distribution_has() {
    assert_cases(&[
        (
            "xx: 0.1",
            "xx: -0.1",
            15,
            16,
            "{xx: -0.1, yy: 0.12, zz: 0.02}",
            "smallest principal moment about the centre of mass is -0.1 kg m²",
        ),
        (
            "zz: 0.02}",
            "zz: 0.02, xy: 0.2}",
            15,
            16,
            "{xx: 0.1, yy: 0.12, zz: 0.02, xy: 0.2}",
            "smallest principal moment about the centre of mass is -0.09",
        ),
        // 2.5 · 0.3² = 0.225 is more than 0.1 and 0.12.
        (
            "inertia_about: com",
            "inertia_about: origin",
            15,
            16,
            "{xx: 0.1, yy: 0.12, zz: 0.02}",
            "smallest principal moment about the centre of mass is -0.125",
        ),
        (
            "xx: 0.1",
            "xx: 1e308, yz: 1e308, xy: 1e308",
            15,
            16,
            "{xx: 1e308, yz: 1e308, xy: 1e308, yy: 0.12, zz: 0.02}",
            "no body can have this inertia",
        ),
    ]);
    let text = with("com: [0, 0, 0.3]", "com: [0, 0, 1e200]").replace("inertia_about: com", "inertia_about: origin");
    let report = found(&text);
    assert!(report.errors().any(|error| error.message.contains("not finite")), "{report}");
}

#[test]
fn expressions_point_into_the_scalar() {
    assert_cases(&[
        ("alpha: pi/2", "alpha: pi/x", 11, 44, "x", "unknown name `x`"),
        ("\"m / 12\"", "\"m / x\"", 22, 40, "x", "unknown name `x`"),
        ("\"m / 12\"", "'m / (1'", 22, 40, "(", "this `(` is never closed"),
        // Escapes and folded lines: the whole scalar.
        ("\"m / 12\"", "\"m \\x2f x\"", 22, 35, "\"m \\x2f x\"", "unknown name `x`"),
        ("\"m / 12\"", "1 +\n     x", 22, 35, "1 +\n     x", "unknown name `x`"),
        ("d: 0.4", "d: 1_000", 11, 23, "1_000", "digits must not be grouped"),
        ("d: 0.4", "d: 012", 11, 23, "012", "leading zero"),
        ("d: 0.4", "d: true", 11, 23, "true", "unknown name `true`"),
        ("d: 0.4", "d: 2 +* 3", 11, 26, "*", "found `*` where a number or a name is needed"),
        ("{m: 1.5, r: 2*m}", "{r: 2*m, m: 1.5}", 7, 19, "m", "the parameter `m` has no value yet"),
        ("{m: 1.5, r: 2*m}", "{m: 1.5, r: 2*r}", 7, 27, "r", "the parameter `r` has no value yet"),
        // A faulty parameter is reported once, not at every use.
        ("{m: 1.5, ", "{m: 1.5*, ", 7, 20, "*", "the expression ends where"),
    ]);
}

#[test]
fn yaml_itself() {
    for (text, line, column, message) in [
        ("", 1, 1, "the file is empty"),
        ("# nothing\n", 1, 1, "the file is empty"),
        ("\u{FEFF}", 1, 1, "the file is empty"),
        ("format: 1\nname: [1, 2\nsource: x\n", 3, 7, "this is not YAML"),
        ("format: 1\njoints:\n\t- a: 1\n", 3, 1, "line 3 is indented with a tab; use spaces"),
        // the parser reads the tab as a part of the line before
        ("format: 1\njoints:\n  - type: a\n\n\tdh: {}\n", 5, 1, "line 5 is indented with a tab; use spaces"),
        ("format: 1\njoints:\n  - dh:\n  \t  a: 1\n", 4, 3, "line 4 is indented with a tab; use spaces"),
        ("source: a: b\n", 1, 10, "this is not YAML: mapping values"),
        ("format: 1\n---\nformat: 1\n", 2, 1, "a second YAML document begins"),
        ("format: !!int 1\n", 1, 9, "YAML tag in `!!int 1`; tags are not allowed"),
        ("!robot {format: 1}\n", 1, 1, "tags are not allowed"),
        ("format: *one\n", 1, 9, "unknown anchor"),
        ("a: &x [*x]\n", 1, 8, "does not name a complete value"),
        ("*x : 1\n", 1, 1, "unknown anchor"),
        ("a: &x 1\n*x : 1\n", 2, 1, "a key must be a plain word"),
        ("a: 1\u{0}b: 2\n", 1, 5, "control character U+0000"),
        ("é: \u{7}\n", 1, 4, "control character U+0007"),
        ("é: \u{9B}\n", 1, 4, "control character U+009B"),
    ] {
        let report = found(text);
        let error = report.diagnostics.last().unwrap();
        assert_eq!((error.line, error.column), (line, column), "{text:?}: {}", error.message);
        assert!(error.message.contains(message), "{text:?}: {}", error.message);
        assert!(report.to_string().contains(message) && report.short().contains(message), "{text:?}");
    }
}

#[test]
fn bytes_that_are_no_text() {
    let report = Reader::new("x.yaml").read(b"format: 1\nname: caf\xE9\n").unwrap_err();
    let error = &report.diagnostics[0];
    assert_eq!((error.line, error.column), (2, 10));
    assert_eq!(error.message, "byte 0xE9 is not UTF-8; a robot file is UTF-8 text");
    assert!(report.to_string().contains("name: caf\u{FFFD}"), "{report}");

    let report = Reader::new("x.yaml").read(b"\xFF\xFEf\0o\0").unwrap_err();
    assert_eq!((report.diagnostics[0].line, report.diagnostics[0].column), (1, 1));
    assert!(report.to_string().contains("this looks like UTF-16"), "{report}");

    let mut marked = b"\xEF\xBB\xBF".to_vec();
    marked.extend_from_slice(BASE.as_bytes());
    assert_eq!(Reader::new("x.yaml").read(&marked).unwrap().robot, Reader::new("x.yaml").read(BASE).unwrap().robot);
    marked.push(0xFF);
    let report = Reader::new("x.yaml").read(&marked).unwrap_err();
    assert_eq!((report.diagnostics[0].line, report.diagnostics[0].column), (BASE.lines().count() + 1, 1));
}

/// Titles and names stand in headings and in comments of generated code; texts may have lines, and nothing that a
/// terminal takes for a command.
#[test]
fn texts() {
    let title = |title: &str| with("source: test", &format!("source: test\ntitle: {title}"));
    for (text, place, message) in [
        ("\"a\\nb\"", (4, 8), "the title `a\\nb` has a line break; a title is one line"),
        ("|\n  a\n  b", (5, 3), "has a line break"),
        ("\"a\\u2028b\"", (4, 8), "has a line break"),
        ("\"a\\rb\"", (4, 8), "has a line break"),
        ("\"a\\tb\"", (4, 8), "the title `a\\tb` has the control character U+0009; it must be readable text"),
        ("\"\\e[2J\"", (4, 8), "has the control character U+001B"),
        ("\"\\x9b2J\"", (4, 8), "has the control character U+009B"),
        ("\"\\u202Earm\"", (4, 8), "has the control character U+202E"),
    ] {
        let report = found(&title(text));
        let [error] = report.diagnostics.as_slice() else { panic!("{text}: {report}") };
        assert_eq!((error.line, error.column), place, "{text}");
        assert!(error.message.contains(message), "{text}: {}", error.message);
    }
    let block = Reader::new("x.yaml").read(&title("|\n  An arm\n")).expect("one line").robot;
    assert_eq!(block.title.as_deref(), Some("An arm"), "the end of a block is no line break");

    let lines = with("source: test", "source: \"a\\n\\tb\"\nnotes: |\n  one\n  two\n");
    let robot = Reader::new("x.yaml").read(&lines).expect("texts of several lines").robot;
    assert_eq!((robot.source.as_str(), robot.notes.as_deref()), ("a\n\tb", Some("one\ntwo")));
    for key in ["source", "notes"] {
        let text = with("source: test", "").replace("name: base\n", "name: base\nsource: a\n");
        let text = text.replace(
            if key == "source" { "source: a" } else { "joints:" },
            &match key {
                "source" => "source: \"\\e]0;x\"".to_owned(),
                _ => "notes: \"\\e]0;x\"\njoints:".to_owned(),
            },
        );
        let report = found(&text);
        assert!(report.to_string().contains("has the control character U+001B"), "{key}: {report}");
    }
}

/// What has no end, or is far too long, is not read to the end.
#[test]
fn a_reader_without_an_end() {
    let bytes = rne_model::read_limited(std::io::repeat(b'#')).expect("it reads");
    assert_eq!(bytes.len(), (1 << 20) + 1);
    let report = Reader::new("x.yaml").read(&bytes).unwrap_err();
    assert!(report.short().contains("more than 1048576 bytes"), "{report}");
    assert_eq!(rne_model::read_limited(BASE.as_bytes()).expect("it reads"), BASE.as_bytes());
}

#[test]
fn size() {
    let padded = |length: usize| format!("{BASE}#{}", " ".repeat(length - BASE.len() - 1));
    assert!(Reader::new("x.yaml").read(&padded(1 << 20)).is_ok());
    for report in [
        Reader::new("x.yaml").read(&padded((1 << 20) + 1)),
        Reader::new("x.yaml").read(padded((1 << 20) + 1).as_bytes()),
    ] {
        let report = report.unwrap_err();
        assert!(report.short().starts_with("x.yaml:1:1: error: the file has more than 1048576 bytes (1 MiB)"));
        assert!(report.to_string().contains("--> x.yaml:1:1"), "{report}");
    }
}

#[test]
fn number_of_joints() {
    let arm = |joints: usize| {
        let mut text = BASE[..BASE.find("  - name: first").unwrap()].replace("parameters: {m: 1.5, r: 2*m}\n", "");
        for _ in 0..joints {
            text += "  - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}}\n";
        }
        text
    };
    let robot = Reader::new("x.yaml").read(&arm(64)).unwrap().robot;
    assert_eq!((robot.dof(), robot.joints[63].name.as_str()), (64, "joint64"));
    let report = found(&arm(65));
    assert_eq!(report.short(), "robots/x.yaml:72:5: error: 65 joints; 1 to 64 joints are allowed");
    let report = found(&arm(0).replace("joints:", "joints: []"));
    assert_eq!(report.short(), "robots/x.yaml:7:9: error: the robot has no joints; 1 to 64 joints are allowed");
}

#[test]
fn all_mistakes_of_a_file_are_found_and_shown_up_to_twenty() {
    let text = with("mass: 2.5", "mass: -1").replace("standard", "distal").replace("alpha: 0", "alpha: x");
    let lines: Vec<usize> = found(&text).diagnostics.iter().map(|found| found.line).collect();
    assert_eq!(lines, [4, 13, 21]);

    let mut text = BASE.to_owned();
    for i in 0..30 {
        let _ = writeln!(text, "nonsense{i}: 1");
    }
    let report = found(&text);
    assert_eq!(report.diagnostics.len(), 30);
    assert_eq!(report.to_string().matches("error:").count(), 20);
    assert!(report.to_string().ends_with("\n\nand 10 more errors"), "{report}");
    assert!(report.short().ends_with("\nand 10 more errors"), "{report}");
}

/// Files made to take long or much memory end in an error soon.
#[test]
fn a_urdf_is_told_about_import() {
    let tag = "<robot name=\"arm\">";
    for text in
        [format!("<?xml version=\"1.0\"?>\n{tag}"), tag.to_owned(), format!("\n {tag}"), format!("<!-- a -->{tag}")]
    {
        let report = Reader::new("arm.urdf").read(&text).unwrap_err();
        let [error] = &report.diagnostics[..] else { panic!("{report}") };
        assert!(error.message.starts_with("this is URDF"), "{}", error.message);
        assert_eq!(error.remedy.as_deref(), Some(&Remedy::ImportUrdf { file: Some("arm.urdf".to_owned()) }));
    }
    let long = format!("<robot>{}", " ".repeat(2 << 20));
    assert!(Reader::new("long.urdf").read(&long).unwrap_err().short().contains("this is URDF"), "however long it is");
}

#[test]
fn a_first_moment_is_a_centre_of_mass() {
    let file = |link: &str| {
        format!("{BASE}  - {{type: revolute, dh: {{theta: 0, d: 0, a: 0, alpha: 0}}, link: {{{link}}}}}\n")
    };
    let com = |link: &str| Reader::new("x").read(&file(link)).unwrap().robot.joints.last().unwrap().row.link.com;
    assert_eq!(com("mass: 4, first_moment: [1, m, 0]"), [0.25, 0.375, 0.0]);
    assert_eq!(com("mass: 0, first_moment: [0, 0, 0]"), [0.0; 3]);
    for (link, part) in [
        ("mass: 4, com: [0, 0, 0], first_moment: [1, 0, 0]", "both `first_moment` and `com`"),
        ("mass: 0, first_moment: [1, 0, 0]", "a first moment but no mass"),
        ("first_moment: [1, 0, 0]", "a first moment but no mass"),
        ("mass: 1, first_moment: [1, 0]", "a list of 2 where 3 numbers"),
    ] {
        let report = Reader::new("x").read(&file(link)).unwrap_err();
        assert!(report.short().contains(part), "{report}");
    }
    // a first moment but no mass is no body: the file has to know it
    let checked =
        Reader::new("x").read(&file("first_moment: [1, 0, -m], inertia: {xx: -0.5, zz: 0.1}, physical: false"));
    let checked = checked.unwrap_or_else(|report| panic!("{report}"));
    let joint = checked.robot.joints.last().unwrap();
    let Link { mass, com, first_moment, inertia } = joint.row.link;
    assert_eq!((mass, com, first_moment, inertia.xx), (0.0, [0.0; 3], [1.0, 0.0, -1.5], -0.5));
    assert_eq!(joint.written_inertia, (inertia, InertiaReference::Origin), "there is no other point");
    assert!(!joint.is_physical());
    assert_eq!(checked.lints.warnings().count(), 0, "{}", checked.lints);
    let [note] = &checked.lints.diagnostics[..] else { panic!("{}", checked.lints) };
    assert!(
        note.message.starts_with("the link has a first moment but no mass, as `physical: false` allows"),
        "{}",
        note.message
    );
    let report = Reader::new("x").read(&file("first_moment: [1, 0, 0], inertia_about: com, physical: false"));
    assert!(report.unwrap_err().short().contains("a link with a first moment and no mass has no centre of mass"));
    assert!(Reader::new("x").read(&file("first_moment: [1, 0, 0], inertia_about: origin, physical: false")).is_ok());
    // What depends on a parameter does so through the mass, too.
    let text = file("mass: 1 + r, first_moment: [1, 0, 0]");
    let robot = Reader::new("x").run_time(&["r"]).read(&text).unwrap().robot;
    let heavier = robot.with_parameters(&[7.0]).unwrap();
    assert_eq!(heavier.joints.last().unwrap().row.link.com, [1.0 / 8.0, 0.0, 0.0]);
    // without mass it is a number of the table as any other
    let text = file("first_moment: [1, 3*r, 0], inertia: {zz: r}, physical: false");
    let robot = Reader::new("x").run_time(&["r"]).read(&text).unwrap_or_else(|report| panic!("{report}")).robot;
    let (last, other) = (robot.dof() - 1, robot.with_parameters(&[7.0]).unwrap());
    assert!(robot.run_time.formula(Entry::FirstMoment(last, 1)).is_some());
    let link = other.joints[last].row.link;
    assert_eq!((link.first_moment, link.inertia.zz), ([1.0, 21.0, 0.0], 7.0));
    assert_eq!(other.joints[last].written_inertia.0.zz, 7.0);
    let report = Reader::new("x").run_time(&["r"]).read(&text.replace("3*r", "r - 3")).unwrap_err();
    assert!(report.short().contains("rne removes operations with zeros"), "{report}");
}

#[test]
fn an_inertia_that_no_body_has_is_kept_where_the_file_says_so() {
    let file = |link: &str| {
        format!("{BASE}  - {{type: revolute, dh: {{theta: 0, d: 0, a: 0, alpha: 0}}, link: {{{link}}}}}\n")
    };
    let report = Reader::new("x").read(&file("mass: 1, inertia: {xx: -0.1, yy: 1, zz: 1}")).unwrap_err();
    assert!(report.short().contains("no body can have this inertia"), "{report}");
    let checked = Reader::new("x").read(&file("mass: 1, inertia: {xx: -0.1, yy: 1, zz: 1}, physical: false")).unwrap();
    assert!(checked.lints.to_string().contains("as `physical: false` allows"), "{}", checked.lints);
    assert!(!checked.robot.joints.last().unwrap().is_physical());
}

/// What everybody writes once, and what to write instead.
#[test]
fn a_mistake_is_answered_with_what_to_write() {
    for (old, new, help) in [
        ("{theta: 0, d: 0.4", "{theta: pi/2 d: 0.4", "write a comma before `d`"),
        ("{theta: 0, d: 0.4", "{theta: 0, d: 0.4 + 1 a: 0", "write a comma before `a`"),
        ("mass: 2.5", "weight: 2.5", "did you mean `mass`?"),
        ("gear_ratio: -62.6", "ratio: -62.6", "did you mean `gear_ratio`?"),
        ("com: [0, 0, 0.3]", "cog: [0, 0, 0.3]", "did you mean `com`?"),
        ("inertia: {xx: 0.1", "tensor: {xx: 0.1", "did you mean `inertia`?"),
        ("{mass: r,", "{mass r,", "write `mass: r`"),
        ("{theta: 0, d: 0.4", "{theta: q2 + pi/2, d: 0.4", "such as `pi/2`"),
        ("{theta: 0, d: 0.4", "{theta: q_1, d: 0.4", "such as `0`"),
        ("{theta: 0, d: 0.4", "{theta: pi - q1, d: 0.4", "write only the constant part"),
    ] {
        let report = found(&with(old, new));
        let said = report.errors().filter_map(|found| found.help.as_deref()).any(|said| said.contains(help));
        assert!(said, "{new}:\n{report}");
    }
    // also beside a parameter with nearly the same name
    let report = found(&with("m: 1.5,", "m: 1.5, a2: 0.4,").replace("{theta: 0, d: 0.4", "{theta: q2 + pi/2, d: a2"));
    assert!(report.to_string().contains("the joint variable is added by itself"), "{report}");
}

#[test]
fn hostile_files() {
    let fill = |unit: &str| unit.repeat((1 << 20) / unit.len());
    let mut bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n".to_owned();
    for i in 1..12 {
        let _ = writeln!(bomb, "a{i}: &a{i} [{}]", vec![format!("*a{}", i - 1); 10].join(", "));
    }
    let mut tower = "a0: &a0 [x]\n".to_owned();
    for i in 1..10_000 {
        let _ = writeln!(tower, "a{i}: &a{i} [*a{}]", i - 1);
    }
    let mut keys = String::new();
    for i in 0..60_000 {
        let _ = writeln!(keys, "k{i}: 1");
    }
    let unknown = (0..40_000).fold(String::new(), |mut line, i| {
        let _ = write!(line, "k{i}: é, ");
        line
    });
    let mut parameters = format!("{BASE}\n").replace("parameters: {m: 1.5, r: 2*m}", "parameters:\n  m: 1\n  r: 1");
    let at = parameters.find("joints:").unwrap();
    let lines = (0..1900).fold(String::new(), |lines, i| format!("{lines}  p{i:031}: q{i:031}\n"));
    parameters.insert_str(at, &lines);
    // Long names to compare with, and as many unknown ones.
    let mut long_names = format!("{BASE}\n").replace("parameters: {m: 1.5, r: 2*m}", "parameters:\n  m: 1\n  r: 1");
    let lines = (0..100).fold(String::new(), |lines, i| format!("{lines}  n{i}{}: 1\n", "n".repeat(900)));
    let unknown_names = (0..1800).fold(String::new(), |lines, i| format!("{lines}  p{i}: unknown{i}\n"));
    long_names.insert_str(at, &(lines + &unknown_names));
    // One long number that many parameters share.
    let mut shared = format!("parameters:\n  p: &p {}\n", "1".repeat(10_000));
    for i in 0..1900 {
        let _ = writeln!(shared, "  p{i}: *p");
    }
    let shared = BASE.replace("parameters: {m: 1.5, r: 2*m}\n", &shared);
    for (what, text, message) in [
        ("long names", long_names, "unknown name"),
        ("shared number", shared, "too large"),
        ("alias bomb", bomb, "more than 50000 values when aliases (`*name`) are written out"),
        ("tower of aliases", tower, "nested more than 16 levels deep"),
        ("lists", fill("["), "nested more than 16 levels deep"),
        ("mappings", fill("{a: "), "nested more than 16 levels deep"),
        ("blocks", fill("- "), "nested more than 16 levels deep"),
        ("complex keys", fill("? "), ""),
        ("items", fill("- 1\n"), "more than 50000 values"),
        ("entries", keys, "more than 50000 values"),
        ("same key", fill("a: 1\n"), ""),
        ("long line of keys", format!("{{{}}}", fill("a: 1, ")), ""),
        ("long line of unknown keys", format!("{{{unknown}}}"), "unknown key"),
        ("long word", fill("a"), ""),
        ("longer number", with("d: 0.4", &format!("d: {}", "1".repeat(1 << 19))), "too long: 524288 bytes"),
        ("longer expression", with("d: 0.4", &format!("d: {}", "1+".repeat(1 << 18))), "too long"),
        ("deeper expression", with("d: 0.4", &format!("d: \"{}\"", "(".repeat(1 << 18))), "too long"),
        ("long number", with("d: 0.4", &format!("d: {}", "1".repeat(10_000))), "too large"),
        ("long expression", with("d: 0.4", &format!("d: {}", "1+".repeat(5000))), "more than 1000 numbers"),
        (
            "deep expression",
            with("d: 0.4", &format!("d: \"{}\"", "(".repeat(10_000))),
            "nested more than 64 levels deep",
        ),
        ("quotes", fill("'"), ""),
        ("escapes", format!("\"{}", fill("\\x41")), ""),
        ("anchors", fill("&a "), ""),
        ("colons", fill(":"), ""),
        ("tabs", fill("\t"), ""),
        ("lines", fill("\n"), "the file is empty"),
        ("carriage returns", fill("a\r"), ""),
        ("comments", fill("#\n"), "the file is empty"),
        ("unknown names", parameters, "unknown name"),
        ("folded text", format!("a: {}", fill("b\n  ")), ""),
    ] {
        let text = text.get(..1 << 20).unwrap_or(&text);
        let report = Reader::new("x.yaml").read(text).expect_err(what);
        assert!(report.to_string().contains(message), "{what}: {report}");
        println!("{what}: {} bytes, {} steps", text.len(), report.work());
        assert!(report.work() <= MOST_WORK, "{what}: {} steps", report.work());
    }
}

/// So many joints that reading ends before all are read: the limit that is told is that of joints.
#[test]
fn thousands_of_joints() {
    let joint = "  - {type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}}\n";
    let head = "format: 1\nname: x\nsource: s\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n";
    for (count, message) in
        [(65, "65 joints; 1 to 64 joints"), (10_000, "more than 64 joints; 1 to 64 joints are allowed")]
    {
        let report = Reader::new("x.yaml").read(&format!("{head}{}", joint.repeat(count))).unwrap_err();
        assert!(report.errors().next().unwrap().message.contains(message), "{report}");
    }
}

/// A value in too many brackets: none of them is open at its end, so the help does not ask for one.
#[test]
fn too_many_brackets_are_not_said_to_be_open() {
    // deeper than the parser's own limit, too
    for depth in [16, 20, 300] {
        let text = format!("format: 1\nname: {}0{}\n", "[".repeat(depth), "]".repeat(depth));
        let report = found(&text);
        let [error] = &report.diagnostics[..] else { panic!("{report}") };
        assert!(error.message.contains("nested more than 16 levels deep"), "{report}");
        assert!(error.help.as_deref().is_some_and(|help| help.starts_with("delete brackets")), "{report}");
    }
}

/// A key of one mapping in another one: the help names the place where it belongs, in whole words.
#[test]
fn keys_in_another_mapping_are_told_where_they_belong() {
    for (key, place) in [
        ("follows: {a: 1}", "`follows` belongs under an entry of `couplings`"),
        ("turns: {a: 1}", "`turns` belongs under an entry of `motors`"),
        ("xyz: [0, 0, 0]", "`xyz` belongs under `base`, `tool`, `at` or an entry of `frames`"),
        ("between: []", "`between` belongs under an entry of `loops`"),
    ] {
        let report = found(&with("name: first", &format!("name: first\n    {key}")));
        let has = report.diagnostics.iter().any(|found| found.help.as_deref() == Some(place));
        assert!(has, "{place}\n{report}");
    }
}
