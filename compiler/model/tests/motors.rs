//! The list `motors`: what it means, and every mistake at its line and column.

use rne_model::{Reader, Robot};

const FILE: &str = "format: 2
name: hand
source: own
convention: modified
gravity: [0, 0, -9.81]
parameters: {l: 0.1}
joints:
  - {name: a, type: revolute, dh: {theta: 0, d: l, a: 0, alpha: 0}, link: {mass: 1}}
  - {name: b, type: revolute, dh: {theta: 0, d: 0, a: 0.2, alpha: 0}, link: {mass: 1}}
  - {name: c, type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}}
  - {name: d, type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 1}, motor: {inertia: 1}}
";

fn read(motors: &str) -> Result<Robot, String> {
    let reader = Reader::new("hand.yaml").trees().couplings();
    reader.read(&format!("{FILE}{motors}")).map(|checked| checked.robot).map_err(|report| report.short())
}

#[test]
fn motors_turn_with_joints_and_rotors_on_links() {
    let text = "motors:
  - {turns: {c: 20, b: -2/4}, rotor: {axis: [0, 3, -4], inertia: l/100}}
  - {name: lift, turns: {a: 50}, rotor: {axis: [0, 0.6, 0.8], on: d, inertia: 0}}
  - {turns: {b: 1}, rotor: {axis: [1, 0, 0], on: base, inertia: 2}}
  - {turns: {d: 3}}
";
    let robot = read(text).unwrap_or_else(|report| panic!("{report}"));
    let names: Vec<&str> = robot.drives.iter().map(|drive| drive.name.as_str()).collect();
    assert_eq!(names, ["motor1", "lift", "motor3", "motor4"]);
    // in the order of the rows; the rotor is on the parent of the joint that is named first
    assert_eq!(robot.drives[0].turns, [(1, -0.5), (2, 20.0)]);
    let rotors = [0, 1, 2].map(|motor: usize| robot.drives[motor].rotor.expect("a rotor"));
    assert_eq!(rotors.map(|rotor| rotor.on), [Some(1), Some(3), None]);
    assert_eq!((rotors[0].axis, rotors[0].inertia), ([0.0, 0.75 / 1.25, -1.0 / 1.25], 0.001));
    assert_eq!(rotors[1].axis, [0.0, 0.6, 0.8]);
    assert_eq!(robot.drives[3].rotor, None);
    // a rotor without inertia does not resist
    assert_eq!(robot.spinning_rotors().count(), 2);
    let matrix = robot.motor_matrix();
    assert_eq!(matrix, [[0.0, -0.5, 20.0, 0.0], [50.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 3.0]]);
    let inverse = robot.inverse_motor_matrix().expect("regular");
    assert_eq!(inverse[0], [0.0, 0.02, 0.0, 0.0]);
    let follower = read("couplings: [{joint: b, follows: {a: 2}}]\nmotors: [{turns: {a: 1, b: 10}}, {turns: {c: 1}}]");
    let follower = follower.unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(follower.motor_matrix(), [[21.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(follower.inverse_motor_matrix(), None);
    let singular = read("motors: [{turns: {a: 1}}, {turns: {b: 1}}, {turns: {c: 1}}, {turns: {a: 1, b: 2}}]");
    assert_eq!(singular.expect("a file").inverse_motor_matrix(), None);
}

#[test]
fn mistakes_are_told_at_their_place() {
    for (motors, place, said) in [
        ("motors: [{turns: {x: 1}}]", "12:19", "`turns` names `x`, which is no joint of this file"),
        ("motors: [{turns: {a: 0}}]", "12:22", "the ratio `a` is zero"),
        ("motors: [{turns: {}}]", "12:18", "a mapping from joints to ratios is needed"),
        ("motors: [{name: m}]", "12:10", "lacks the required key `turns`"),
        ("motors: [{turns: {a: 1}, ratio: 2}]", "12:26", "unknown key `ratio`"),
        ("motors: [{turns: {a: 1}, rotor: {inertia: 1}}]", "12:33", "lacks the required key `axis`"),
        ("motors: [{turns: {a: 1}, rotor: {axis: [0, 0, 1]}}]", "12:33", "lacks the required key `inertia`"),
        ("motors: [{turns: {a: 1}, rotor: {axis: [0, 0, 0], inertia: 1}}]", "12:40", "the axis [0, 0, 0] has no"),
        ("motors: [{turns: {a: 1}, rotor: {axis: [0, 1], inertia: 1}}]", "12:40", "[x, y, z]"),
        ("motors: [{turns: {a: 1}, rotor: {axis: [0, 0, 1], inertia: -1}}]", "12:60", "negative"),
        ("motors: [{turns: {a: 1}, rotor: {axis: [0, 0, 1], on: x, inertia: 1}}]", "12:55", "`on` names `x`"),
        ("motors: [{turns: {d: 1}, rotor: {axis: [0, 0, 1], inertia: 1}}]", "11:103", "has a `motor` with `inertia`"),
        ("motors: [{name: m, turns: {a: 1}}, {name: m, turns: {b: 1}}]", "12:43", "already the name of motor 1"),
        ("motors: {turns: {a: 1}}", "12:9", "a list of motors is needed"),
    ] {
        let report = read(motors).expect_err(motors);
        let line = report.lines().next().unwrap_or_default();
        let is_said = report.contains(said);
        assert!(line.starts_with(&format!("hand.yaml:{place}: ")) && is_said, "{motors}\n{report}");
    }
    let text = format!("{FILE}motors: [{{turns: {{a: 1}}, rotor: {{axis: [0, 0, 1], inertia: l}}}}]");
    // a number that varies at run time
    let varying = Reader::new("hand.yaml").trees().couplings().run_time(&["l"]).read(&text).unwrap_err().short();
    assert!(varying.contains("the rotor inertia `l` depends on the run-time parameter `l`"), "{varying}");
    // who takes no motors, and a format that has none
    let refused = Reader::new("hand.yaml").trees().read(&text).unwrap_err().short();
    assert!(refused.starts_with("hand.yaml:12:") && refused.contains("the robot has a list `motors`"), "{refused}");
    let old = text.replace("format: 2", "format: 1");
    let old = Reader::new("hand.yaml").couplings().read(&old).unwrap_err().short();
    assert!(old.contains("the key `motors` needs `format: 2`"), "{old}");
}
