//! Loops of kind `parallelogram`: their couplings, and what is refused.

use std::f64::consts::FRAC_PI_2;

use rne_model::{Reader, Robot};

const PALLETISER: &str = include_str!("../../../docs/palletiser.yaml");

fn read(text: &str) -> Result<Robot, String> {
    let reader = Reader::new("palletiser.yaml").trees().couplings();
    reader.read(text).map(|checked| checked.robot).map_err(|report| report.short())
}

fn coupling(robot: &Robot, joint: &str) -> (Vec<(String, f64)>, f64) {
    let coupling = robot.joints.iter().find(|it| it.name == joint).and_then(|it| it.coupling.clone());
    let coupling = coupling.unwrap_or_else(|| panic!("{joint} follows no joint"));
    let follows = coupling.follows.iter().map(|(other, ratio)| (robot.joints[*other].name.clone(), *ratio));
    (follows.collect(), coupling.offset)
}

/// θ3 = π/2 - θ2 + θ7 and θ8 = θ2 - θ7 of the SR400 (W. Khalil, E. Dombre, "Modeling, Identification and Control of
/// Robots", 2002, section 7.8), where the rear of link 3 is along its -y.
#[test]
fn opposite_sides_stay_parallel() {
    let robot = read(PALLETISER).unwrap_or_else(|report| panic!("{report}"));
    let of =
        |terms: [(&str, f64); 2], offset: f64| (terms.map(|(name, ratio)| (name.to_owned(), ratio)).to_vec(), offset);
    assert_eq!(coupling(&robot, "j3"), of([("j2", -1.0), ("j7", 1.0)], FRAC_PI_2));
    assert_eq!(coupling(&robot, "j8"), of([("j2", 1.0), ("j7", -1.0)], 0.0));
    assert_eq!(robot.dof(), 4);
    // any two that the others determine; with j2 and j8 dependent, those of the crank and the forearm move the arm
    let text = PALLETISER.replace("[j3, j8]", "[j2, j8]");
    let robot = read(&text).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(coupling(&robot, "j2"), of([("j3", -1.0), ("j7", 1.0)], FRAC_PI_2));
    assert_eq!(coupling(&robot, "j8"), (vec![("j3".to_owned(), -1.0)], FRAC_PI_2));
}

/// A four-bar of one freedom: the coupler keeps its direction.
#[test]
fn a_parallelogram_on_one_link_has_one_freedom() {
    let text = "{format: 2, name: bars, source: own, convention: standard, gravity: [0, -9.81, 0], tool: {on: coupler},
        joints: [
        {name: crank, type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: 1}},
        {name: coupler, type: revolute, dh: {theta: 0.25, d: 0, a: 0.7, alpha: 0}, link: {mass: 1}},
        {name: rocker, parent: base, at: {xyz: [0.7, 0, 0]}, type: revolute,
         dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: 1}}],
        loops: [{kind: parallelogram, cut: revolute, between: [{on: rocker}, {on: coupler}],
        dependent: [rocker, coupler]}]}";
    let robot = read(text).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(coupling(&robot, "rocker"), (vec![("crank".to_owned(), 1.0)], 0.0));
    let (follows, offset) = coupling(&robot, "coupler");
    assert_eq!(follows, [("crank".to_owned(), -1.0)]);
    assert!((offset + 0.25).abs() < 1e-15, "the angle of its row is taken back: {offset}");
}

#[test]
fn what_is_no_parallelogram_is_refused_with_its_numbers() {
    for (from, to, said) in [
        ("xyz: [0.8, 0, 0]}, {on: j3", "xyz: [0.81, 0, 0]}, {on: j3", "are 0.81 m and 0.8 m long; they must be equal"),
        ("{on: j3, xyz: [0, -0.3, 0]}", "{on: j3, xyz: [0, -0.3, 0.01]}", "0.01 m apart along the axis"),
        (
            "{on: j3, xyz: [0, -0.3, 0]}",
            "{on: j3, xyz: [0, -0.3, 0], rpy: [0.1, 0, 0]}",
            "is not parallel to that of the joint `j7`",
        ),
        ("{on: j8, xyz: [0.8, 0, 0]}", "{on: j7, xyz: [0.8, 0, 0]}", "opposite sides of the loop are"),
        ("{on: j8, xyz: [0.8, 0, 0]}", "{on: j4, xyz: [0.8, 0, 0]}", "joints of their own"),
        ("dependent: [j3, j8]", "dependent: [j3, j1]", "`dependent` must name two of them"),
        ("dependent: [j3, j8]", "dependent: [j3]", "a list of two joints is needed"),
        (
            "parent: j1, type: revolute, dh: {alpha: -pi/2, a: 0.2",
            "parent: j1, type: revolute, dh: {alpha: -pi/2, a: 0.25",
            "must be one line",
        ),
        ("{name: j8, type: revolute", "{name: j8, type: prismatic", "is prismatic"),
        ("kind: parallelogram", "kind: rhombus", "unknown kind"),
        ("format: 2", "format: 1", "needs `format: 2`"),
        (
            "{name: j8, type: revolute,",
            "{name: j8, type: revolute, motor: {inertia: 1},",
            "has a `motor`, but the loop moves it",
        ),
    ] {
        assert!(PALLETISER.contains(from), "{from}");
        let report = read(&PALLETISER.replace(from, to)).expect_err(said);
        assert!(report.contains(said), "{from} -> {to}\n{report}");
    }
    let refused = Reader::new("palletiser.yaml").trees().read(PALLETISER).unwrap_err().short();
    assert!(refused.contains("the robot has couplings"), "{refused}");
}
