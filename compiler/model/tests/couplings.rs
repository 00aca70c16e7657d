//! The list `couplings`: what it means, and every mistake at its line and column.

use rne_model::{Reader, Robot};

const FILE: &str = "format: 2
name: hand
source: own
convention: modified
gravity: [0, 0, -9.81]
parameters: {l: 0.1}
joints:
  - {name: a, type: revolute, dh: {theta: 0.25, d: 0, a: 0, alpha: 0}, link: {mass: 1}}
  - {name: b, type: revolute, dh: {theta: 0.25, d: 0, a: 0.2, alpha: 0}, link: {mass: 1}}
  - {name: c, type: prismatic, dh: {theta: 0, d: l, a: 0, alpha: 0}, link: {mass: 1}}
  - {name: d, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}, motor: {inertia: 1}}
couplings:
";

fn read(couplings: &str) -> Result<Robot, String> {
    let reader = Reader::new("hand.yaml").trees().couplings();
    reader.read(&format!("{FILE}{couplings}")).map(|checked| checked.robot).map_err(|report| report.short())
}

#[test]
fn followers_are_no_coordinates() {
    let robot =
        read("  - {joint: c, follows: {d: -1, a: 2}, offset: 0.05}\n  - {joint: b, follows: {a: 1/2}, offset: pi/2}\n");
    let robot = robot.unwrap_or_else(|report| panic!("{report}"));
    assert_eq!((robot.dof(), robot.joints.len(), robot.has_couplings()), (2, 4, true));
    assert_eq!(robot.coordinates().collect::<Vec<_>>(), [0, 3]);
    let follows = |joint: usize| robot.joints[joint].coupling.clone().expect("a follower");
    // in the order of the rows
    assert_eq!((follows(2).follows, follows(2).offset), (vec![(0, 2.0), (3, -1.0)], 0.05));
    assert_eq!(follows(1).follows, [(0, 0.5)]);
    let rows = [0, 1, 2].map(|joint| robot.joints[joint].row_with_offset().dh);
    assert_eq!([rows[0].theta.radians, rows[1].theta.radians], [0.25, 0.25 + std::f64::consts::FRAC_PI_2]);
    assert_eq!((rows[2].d, robot.joints[2].row.dh.d), (0.1 + 0.05, 0.1));
}

#[test]
fn mistakes_are_told_at_their_place() {
    for (couplings, place, said) in [
        ("  - {joint: x, follows: {a: 1}}", "13:13", "`joint` names `x`, which is no joint of this file"),
        ("  - {joint: b, follows: {x: 1}}", "13:26", "`follows` names `x`, which is no joint of this file"),
        ("  - {joint: b, follows: {b: 1}}", "13:25", "the joint `b` follows itself"),
        ("  - {joint: b, follows: {a: 0}}", "13:29", "the ratio `a` is zero"),
        ("  - {joint: b, follows: {a: 1e308}}", "13:29", "the ratio `a` is"),
        ("  - {joint: b, follows: {a: -1e-320}}", "13:29", "the ratio `a` is"),
        ("  - {joint: b, follows: {a: 1}, offset: 1e300}", "13:41", "the offset is 1e300"),
        ("  - {joint: b, follows: {}}", "13:25", "a mapping from joints to ratios is needed"),
        ("  - {joint: b, follows: a}", "13:25", "a mapping from joints to ratios is needed"),
        ("  - {joint: b}", "13:5", "lacks the required key `follows`"),
        ("  - {joint: b, follows: {a: 1}, ratio: 2}", "13:33", "unknown key `ratio`"),
        ("  - {joint: b, follows: {a: 1}}\n  - {joint: b, follows: {c: 1}}", "14:13", "`b` has a coupling already"),
        (
            "  - {joint: b, follows: {c: 1}}\n  - {joint: c, follows: {a: 1}}",
            "13:25",
            "which follows other joints itself",
        ),
        ("  - {joint: d, follows: {a: 1}}", "13:5", "has a `motor`, but it follows other joints"),
        ("  {joint: b, follows: {a: 1}}", "13:3", "a list of couplings is needed"),
    ] {
        let report = read(couplings).expect_err(couplings);
        let line = report.lines().next().unwrap_or_default();
        assert!(line.starts_with(&format!("hand.yaml:{place}: ")) && line.contains(said), "{couplings}\n{report}");
    }
    let text = format!("{FILE}  - {{joint: c, follows: {{a: 1}}, offset: 0.1}}");
    // a number that varies at run time
    let varying = Reader::new("hand.yaml").trees().couplings().run_time(&["l"]).read(&text).unwrap_err().short();
    assert!(varying.contains("`d` of the joint `c` varies at run time, and its coupling has an `offset`"), "{varying}");
    // the offset of a joint that turns is an angle, and `d` is a length
    let turning = text.replace("name: c, type: prismatic", "name: c, type: revolute");
    let found = Reader::new("hand.yaml").trees().couplings().run_time(&["l"]).read(&turning);
    assert!(turning != text && found.is_ok(), "{turning}");
    // who takes no couplings, and a format that has none
    let refused = Reader::new("hand.yaml").trees().read(&text).unwrap_err().short();
    assert!(refused.starts_with("hand.yaml:13:3: ") && refused.contains("the robot has couplings"), "{refused}");
    let old = text.replace("format: 2", "format: 1");
    let old = Reader::new("hand.yaml").couplings().read(&old).unwrap_err().short();
    assert!(old.contains("the key `couplings` needs `format: 2`"), "{old}");
}

/// An offset is an angle or a length as those of the table are, and degrees and millimetres are noticed as there.
#[test]
fn degrees_and_millimetres_in_an_offset_are_remarked() {
    let lints = |couplings: &str| {
        let checked = Reader::new("hand.yaml").trees().couplings().read(&format!("{FILE}{couplings}"));
        let lints = checked.unwrap_or_else(|report| panic!("{report}")).lints.diagnostics;
        let of_offset = lints.into_iter().filter(|lint| lint.line == 13);
        of_offset.map(|lint| (lint.message, lint.help.unwrap_or_default())).collect::<Vec<_>>()
    };
    let [(message, help)] = &lints("  - {joint: b, follows: {a: 1}, offset: 90}")[..] else { panic!() };
    assert!(message.contains("the angle `90` rad is more than a full turn") && help.contains("write `deg(90)`"));
    let [(message, _)] = &lints("  - {joint: b, follows: {a: 1}, offset: 1.5708}")[..] else { panic!() };
    assert!(message.contains("off the right angle `pi/2`"), "{message}");
    let [(message, _)] = &lints("  - {joint: c, follows: {a: 1}, offset: 35}")[..] else { panic!() };
    assert!(message.contains("the length `35` m is over 20 m"), "{message}");
    for meant in ["  - {joint: b, follows: {a: 1}, offset: pi/2}", "  - {joint: c, follows: {a: 1}, offset: 1.57}"] {
        assert_eq!(lints(meant), [], "{meant}");
    }
}

/// The limits of a hand whose finger `b` follows `a` by -1/2 q + 0.1, in closed form: q = (0.1 - b) / (1/2).
#[test]
fn limits_of_a_follower_limit_the_joint_that_it_follows() {
    let file = |of_a: &str, of_b: &str, follows: &str| {
        let text = format!("{FILE}  - {{joint: b, follows: {{{follows}}}, offset: 0.1}}\n")
            .replacen("link: {mass: 1}", &format!("link: {{mass: 1}}{of_a}"), 1)
            .replacen("a: 0.2, alpha: 0}, link: {mass: 1}", &format!("a: 0.2, alpha: 0}}, link: {{mass: 1}}{of_b}"), 1);
        let read = Reader::new("hand.yaml").trees().couplings().read(&text);
        read.unwrap_or_else(|report| panic!("{}", report.short()))
    };
    let of_b = ", limits: {position: [0, 0.35], velocity: 1, effort: 3}";
    let close = |found: (f64, f64), expected: (f64, f64)| {
        assert!((found.0 - expected.0).abs() + (found.1 - expected.1).abs() < 1e-15, "{found:?} {expected:?}");
    };
    for (of_a, position, velocity) in [
        ("", (-0.5, 0.2), 2.0),
        (", limits: {position: [-1, 0.15], velocity: 1.5}", (-0.5, 0.15), 1.5),
        (", limits: {position: [-0.2, 0.7], velocity: 4}", (-0.2, 0.2), 2.0),
    ] {
        let checked = file(of_a, of_b, "a: -1/2");
        let limits = checked.robot.coordinate_limits();
        assert_eq!(limits.len(), 3, "a, c, d");
        close(limits[0].position.expect("a limit"), position);
        assert_eq!((limits[0].velocity, limits[0].effort), (Some(velocity), None), "an effort is no torque of a");
        assert_eq!(limits[1..], [rne_model::Limits::default(); 2]);
        let said = checked.lints.short();
        assert!(said.contains("the effort limit of `b` limits no torque, because `b` follows `a`"), "{said}");
    }
    // a lower end of zero stays a zero without a sign
    let zero = file("", ", limits: {position: [0.1, 0.35]}", "a: -1").robot.coordinate_limits()[0].position;
    assert!(zero.is_some_and(|(_, upper)| upper == 0.0 && upper.is_sign_positive()), "{zero:?}");
    // limits without an effect have a remark
    let several = file("", of_b, "a: 1, c: 1");
    assert_eq!(several.robot.coordinate_limits(), [rne_model::Limits::default(); 3]);
    let said = several.lints.short();
    assert!(said.contains("the limits of `b` limit no other joint, because it follows several joints"), "{said}");
    let apart = file(", limits: {position: [1, 2]}", of_b, "a: -1/2");
    assert_eq!(apart.robot.coordinate_limits()[0].position, Some((1.0, 2.0)));
    let said = apart.lints.short();
    assert!(said.contains("`a` is from -0.5 to 0.2, but the limits of `a` allow no such position"), "{said}");
}
