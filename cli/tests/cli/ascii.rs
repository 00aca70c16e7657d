//! `--ascii`: the teaching views for a terminal, a printer or a mail that knows no Greek.

use serde_json::Value;
use unicode_width::UnicodeWidthStr;

use crate::call::{fails, fine, folder};

/// The shipped arms that are tried, with their joints.
fn robots() -> Vec<(String, usize)> {
    let joints = |name: &str| {
        let json: Value = serde_json::from_str(&fine(&["show", name, "--json"])).expect("JSON");
        json["robot"]["joints"].as_array().expect("joints").len()
    };
    let one_in = if shipped::is_exhaustive() { 1 } else { 2 };
    shipped::tried().step_by(one_in).map(|robot| (robot.name.to_owned(), joints(robot.name))).collect()
}

/// The views of an arm, each as a command without `--ascii`.
fn views(robot: &str, joints: usize) -> Vec<Vec<String>> {
    let state = |value: &str| vec![value; joints].join(",");
    let (q, qd, qdd) = (state("0.3"), state("-0.5"), state("0.7"));
    let last = joints.to_string();
    let component = format!("n{}_{joints}_z", joints - 1);
    let calls: [&[&str]; 11] = [
        &["show", robot],
        &["show", robot, "--keep", "omega_dot,velocity,gravity", "--joint", &last],
        &["show", robot, "--form", "reduced"],
        &["show", robot, "--equations", "--joint", &last],
        &["show", robot, "--base-parameters"],
        &["show", robot, "--symbolic", "--first", "2"],
        &["show", robot, "--symbolic"],
        &["explain", &component, robot],
        &["eval", robot, "--q", &q, "--qd", &qd, "--qdd", &qdd, "--trace"],
        &["eval", robot, "--q", &q, "--qd", &qd, "--qdd", &qdd, "--trace", "--axes", "base"],
        &["eval", robot, "--q", &q, "--qd", &qd, "--qdd", &qdd, "--trace", "--csv"],
    ];
    let has_two = |call: &&&[&str]| joints > 1 || !call.contains(&"--first");
    calls.iter().filter(has_two).map(|call| call.iter().map(|&word| word.to_owned()).collect()).collect()
}

/// A view with `--ascii`, beside the one without it.
fn both(call: &[String]) -> [String; 2] {
    let plain: Vec<&str> = call.iter().map(String::as_str).collect();
    let ascii: Vec<&str> = plain.iter().copied().chain(["--ascii"]).collect();
    [fine(&plain), fine(&ascii)]
}

#[test]
fn views_of_every_arm_are_ascii() {
    let mut letters = 0;
    for (robot, joints) in robots() {
        for call in views(&robot, joints) {
            let [plain, ascii] = both(&call);
            let foreign: Vec<char> = ascii.chars().filter(|c| !c.is_ascii()).collect();
            assert!(foreign.is_empty(), "{call:?}: {foreign:?}");
            // a letter without a spelling would be one
            assert_eq!(plain.matches('_').count(), ascii.matches('_').count(), "{call:?}");
            let widest = |text: &str| text.lines().map(UnicodeWidthStr::width).max().unwrap_or(0);
            let most = if call[0] == "show" { 100 } else { 80 };
            assert!(widest(&ascii) <= most.max(widest(&plain)), "{call:?}: {}", widest(&ascii));
            assert!(ascii.lines().all(|line| line == line.trim_end()), "{call:?}");
            letters += plain.chars().filter(|c| !c.is_ascii()).count();
        }
    }
    assert!(letters > 5_000, "{letters} letters");
}

#[test]
fn letters_are_those_that_a_reader_types() {
    insta::assert_snapshot!(fine(&["show", "planar2", "--symbolic", "--ascii"]));
    let slide = fine(&["show", "stanford", "--symbolic", "--first", "3", "--ascii"]);
    assert!(slide.contains("h3 = c311 thetad1^2 + c322 thetad2^2"), "{slide}");
    let state = ["eval", "planar1", "--q", "0.3", "--qd", "0.5", "--qdd", "1", "--trace", "--ascii"];
    let sheet = fine(&state);
    for line in [
        "    qd1         0.500000                          rad/s   given\n",
        "  2 dw1         0           0           1.000000  rad/s^2\n      = R1^T dw0 + qdd1 e + qd1 w1 x e\n",
    ] {
        assert!(sheet.contains(line), "no {line:?} in {sheet}");
    }
}

/// The same values, whoever reads them.
#[test]
fn data_stays_the_same_data() {
    for call in [
        &["show", "stanford", "--json"][..],
        &["eval", "planar1", "--q", "0.3", "--qd", "2", "--qdd", "1", "--trace", "--json"],
    ] {
        let [plain, ascii] = both(&call.iter().map(|&word| word.to_owned()).collect::<Vec<_>>());
        let value = |text: &str| serde_json::from_str::<Value>(text).expect("JSON");
        assert!(ascii.is_ascii() && value(&plain) == value(&ascii), "{call:?}");
    }
    let state = ["eval", "planar1", "--q", "0.3", "--qd", "2", "--qdd", "1", "--trace", "--ascii"];
    let file = folder("ascii").join("mine.csv");
    std::fs::write(&file, fine(&[&state[..], &["--csv"]].concat())).expect("written");
    let mine = file.to_str().expect("UTF-8");
    assert!(
        fine(&[&state[..], &["--compare", mine]].concat()).starts_with("ok 61 values of planar1"),
        "it is read back"
    );
}

#[test]
fn latex_is_ascii_already() {
    assert!(fine(&["show", "stanford", "--first", "3", "--latex", "--ascii"]).is_ascii());
    fails(2, &["list", "--ascii"], &["--ascii"]);
}
