//! Trees at the commands that compute with them, beside `rne eval` of single states.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::call::{ROOT, fails, fine, folder, rne};
use crate::certify::{checked, has_tools};

const TREE: &str = "docs/tree.yaml";

/// Joints of the tree.
const DOF: usize = 5;

/// Numbers of a state that are never the same.
fn numbers(seed: usize) -> Vec<f64> {
    let number =
        |joint: usize| f64::from(u32::try_from((seed * 31 + joint * 17 + 5) % 97).expect("small")) / 40.0 - 1.2;
    (0..DOF).map(number).collect()
}

fn list(numbers: &[f64]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

/// The torques of one state, by the runtime.
fn torques([q, qd, qdd]: &[Vec<f64>; 3]) -> Vec<f64> {
    let lists = [q, qd, qdd].map(|numbers| list(numbers));
    let text = fine(&["eval", TREE, "--q", &lists[0], "--qd", &lists[1], "--qdd", &lists[2], "--json"]);
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    value["result"].as_array().expect("torques").iter().map(|tau| tau.as_f64().expect("a number")).collect()
}

fn states() -> Vec<[Vec<f64>; 3]> {
    (0..4).map(|state| [3 * state, 3 * state + 1, 3 * state + 2].map(numbers)).collect()
}

/// A file of states at a distance of 10 ms.
fn written(path: &Path) {
    let columns = ["q", "qd", "qdd"].into_iter().flat_map(|name| (1..=DOF).map(move |joint| format!("{name}{joint}")));
    let mut text = format!("t,{}\n", columns.collect::<Vec<_>>().join(","));
    for (at, state) in states().iter().enumerate() {
        let _ = writeln!(text, "0.0{at},{}", list(&state.concat()));
    }
    fs::write(path, text).expect("written");
}

/// The first columns of a table, without its header.
fn rows(text: &str, skipped: usize) -> Vec<Vec<f64>> {
    let row =
        |line: &str| line.split(',').skip(skipped).take(DOF).map(|cell| cell.parse().expect("a number")).collect();
    text.lines().skip(1).map(row).collect()
}

fn near(found: &[f64], expected: &[f64]) {
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-12 * scale), "{found:?} {expected:?}");
}

#[test]
fn a_file_of_states_and_a_plot_have_the_torques_of_each_state() {
    let file = folder("trees").join("states.csv");
    written(&file);
    let file = file.to_str().expect("UTF-8");
    let many = rne(&["eval", TREE, "--states", file]).out;
    let plotted = fine(&["plot", TREE, "--trajectory", file, "--csv"]);
    for (index, state) in states().iter().enumerate() {
        let expected = torques(state);
        near(&rows(&many, 0)[index], &expected);
        near(&rows(&plotted, 1)[index], &expected);
    }
}

#[test]
fn lists_in_the_order_of_the_alphabet_are_diagnosed() {
    let state = &states()[0];
    let tau = torques(state);
    // finger_a, finger_b, left, right, waist
    let alphabet: Vec<String> = [2, 3, 1, 4, 0].map(|joint: usize| tau[joint].to_string()).into();
    let [q, qd, qdd] = [0, 1, 2].map(|of| list(&state[of]));
    let tau = alphabet.join(",");
    let said = fine(&["diagnose", TREE, "--q", &q, "--qd", &qd, "--qdd", &qdd, "--tau", &tau]);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["alphabetical order of the joints", "waist, left, finger_a, finger_b, right"] {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn a_tree_has_its_equations_and_a_page() {
    let said = fine(&["show", TREE, "--symbolic", "--first", "2"]);
    assert!(said.contains("τ2 = ") && said.contains("θ̈1"), "{said}");
    let page = folder("tree_page").join("tree.html");
    assert_eq!(rne(&["report", TREE, "-o", page.to_str().expect("UTF-8")]).status, 0);
    let text = fs::read_to_string(page).expect("a page");
    // the right arm is on the waist, as the left one is
    assert!(text.contains("finger_b") && text.matches("\"parent\":1").count() == 2, "{}", text.len());
}

#[test]
fn a_motion_that_excites_a_tree_is_found() {
    let file = "logs/identify/tests/torso.yaml";
    let few = ["--evaluations", "20", "--seconds", "10"];
    let said = fine(&[&["excite", file, "--range", "0.6", "--velocity", "1.5"][..], &few].concat());
    assert!(said.contains("left_elbow") && said.contains("right_slide"), "{said}");
}

/// The independent checker reads the tree of the robot file.
#[test]
fn the_checker_accepts_the_code_of_a_tree_and_no_other_tree() {
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !has_tools() {
        return;
    }
    let folder = folder("tree_evidence");
    rne(&["certify", TREE, "--states", "10", "--evidence", folder.to_str().expect("UTF-8")]);
    let (source, trace) = (folder.join("tree.c"), folder.join("tree.trace.json"));
    let robot = Path::new(ROOT).join(TREE);
    let (is_accepted, said) = checked(&source, &trace, &robot);
    assert!(is_accepted, "{said}");
    let text = fs::read_to_string(&robot).expect("it is there");
    let changed = folder.join("changed.yaml");
    for (old, new) in [("parent: left", "parent: waist"), ("gamma: pi/2", "gamma: -pi/2"), ("0.4, 0, 0", "0.4, 0, 0.1")]
    {
        fs::write(&changed, text.replacen(old, new, 1)).expect("written");
        let (is_accepted, said) = checked(&source, &trace, &changed);
        assert!(!is_accepted && said.contains("wrong: "), "{old}: {said}");
    }
}

/// What computes by the formulas of a chain, or writes a chain, says so.
#[test]
fn commands_for_serial_arms_refuse_a_tree_at_its_line() {
    for command in [&["worksheet", "--seed", "1", "-o", "sheets"][..], &["convert", "--convention", "standard"]] {
        let arguments = [&command[..1], &[TREE], &command[1..]].concat();
        fails(
            1,
            &arguments,
            &["docs/tree.yaml:27:13", "joint 4 (`finger_b`)", "the robot is a tree", "docs/robot-file.md"],
        );
    }
}

/// A wrench at each tip by its name, a payload at a frame, and a body that is left out.
#[test]
fn tips_frames_and_bodies_are_named() {
    const FILE: &str = "docs/dual_arm.yaml";
    let state = ["eval", FILE, "--q", "0,0.3,0.6,0.3,0.6", "--qd", "0,0,0,0,0", "--qdd", "1,0,0,0,0", "--json"];
    let torques = |more: &[&str]| -> Vec<f64> {
        let printed: serde_json::Value = serde_json::from_str(&fine(&[&state[..], more].concat())).expect("JSON");
        serde_json::from_value(printed["result"].clone()).expect("numbers")
    };
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * b.abs().max(1.0);
    let free = torques(&[]);
    let pushed = torques(&["--tip-wrench", "left_hand=0,0,0,0,0,2"]);
    // a moment about the parallel axes of the left arm
    assert!(near(pushed[1] - free[1], 2.0) && near(pushed[2] - free[2], 2.0), "{pushed:?}");
    assert_eq!(pushed[3..], free[3..]);
    let carrying = torques(&["--payload", "1,0,0,0", "--payload-on", "right_hand"]);
    assert!(near(carrying[4] - free[4], 9.81 * 0.3 * 0.9_f64.cos()), "{carrying:?}");
    assert_eq!(carrying[1..3], free[1..3]);
    let bare = torques(&["--without", "camera"]);
    assert!(near(free[0] - bare[0], 8e-4 + 0.6 * 0.12 * 0.12), "{bare:?}");
    for (options, said) in [
        (["--tip-wrench", "hand=0,0,0,0,0,2"], "dual_arm has no tip `hand`; its tips are `left_hand`, `right_hand`"),
        (["--tip-wrench", "lefthand=0,0,0,0,0,2"], "`right_hand`; did you mean `left_hand`?"),
        (["--tip-wrench", "left_hand=1,2"], "a wrench has 6 numbers, not 2"),
        (["--without", "camra"], "did you mean `camera`?"),
        (["--function", "inverse_dynamics_with_wrenches"], "needs --tip-wrench NAME=fx,fy,fz,nx,ny,nz"),
    ] {
        fails(2, &[&state[..], &options[..]].concat(), &[said]);
    }
    let fewer = fs::read_to_string(format!("{ROOT}/{FILE}")).expect("the file");
    assert!(fewer.contains("tips: [left_hand, right_hand]"), "{fewer}");
    let path = folder("trees_tips").join("one_tip.yaml");
    fs::write(&path, fewer.replace("tips: [left_hand, right_hand]", "tips: [left_hand]")).expect("written");
    let one_tip =
        [&["eval", path.to_str().expect("UTF-8")][..], &state[2..], &["--tip-wrench", "right_hand=0,0,0,0,0,2"]];
    let said = "`right_hand` is a frame of dual_arm, but not a tip; list it under `tips` of the robot file: tips: \
                [left_hand, right_hand]";
    fails(2, &one_tip.concat(), &[said]);
    let shown = fine(&["show", FILE]);
    assert!(shown.contains("tip right_hand, in the link frame of right_elbow: (0.3, 0, 0) m"), "{shown}");
    assert!(shown.contains("body camera, 0.6 kg: a part of the link of waist"), "{shown}");
}

/// Code of a robot with tips has the function that takes a wrench at each, and says on which link they are.
#[test]
fn code_of_tips_takes_a_wrench_at_each() {
    const FILE: &str = "docs/dual_arm.yaml";
    let code = fine(&["emit", FILE, "--lang", "c", "--tests"]);
    for part in [
        "/// left_hand, on the link of left_elbow\n    DUAL_ARM_TIP_LEFT_HAND = 0,",
        "void dual_arm_inverse_dynamics_with_wrenches(",
        "const float wrenches[2][6]",
    ] {
        assert!(code.contains(part), "{part}: {code}");
    }
    // compilers that know no comments of C++ read an apostrophe as an open character
    let (_, tests) = code.split_once("#ifdef RNE_TEST").expect("tests");
    let of_comments = tests.lines().filter(|line| line.trim_start().starts_with("//"));
    assert!(of_comments.clone().count() > 1 && of_comments.clone().all(|line| !line.contains('\'')), "{tests}");
    let rust = fine(&["emit", FILE]);
    assert!(rust.contains("pub fn inverse_dynamics_with_wrenches<"), "{rust}");
    assert!(!fine(&["emit", "docs/tree.yaml", "--lang", "c"]).contains("with_wrenches"));
}

/// The C code of a robot that walks: the functions that hold the base still cost what they cost on a fixed base, a plan
/// file is for the function that lets it move, and each header says what its functions take.
#[test]
fn a_floating_base_has_its_functions_in_c() {
    let folder = folder("floating_c");
    let text = fs::read_to_string(Path::new(ROOT).join("tests/functions/floating/grid_hyq.yaml")).expect("a robot");
    let (start, end) = (text.find("floating_base:").expect("a base"), text.find("tool:").expect("a tool"));
    let held = format!("{}{}", &text[..start], &text[end..]).replace("base_link_0", "base");
    let held: String =
        held.lines().filter(|line| !line.starts_with("contacts:")).flat_map(|line| [line, "\n"]).collect();
    let emit = |name: &str, text: &str, more: &[&str]| {
        let file = folder.join(name);
        fs::write(&file, text).expect("written");
        let called = rne(&[&["emit", file.to_str().expect("UTF-8"), "--lang", "c"], more].concat());
        assert_eq!(called.status, 0, "{called:?}");
        called.out
    };
    // products and sums of the code, without those of the recursion
    let counts = |code: &str| -> Vec<Vec<String>> {
        let lines = code.lines().filter(|line| line.starts_with("//   ") && line.contains(" -> "));
        let count = |part: &str| part.split_whitespace().next().unwrap_or_default().to_owned();
        lines.map(|line| line.split(" -> ").skip(1).map(count).collect()).collect()
    };
    let floating = emit("walks.yaml", &text, &[]);
    assert!(counts(&floating).len() >= 5, "{floating}");
    assert_eq!(counts(&floating), counts(&emit("stands.yaml", &held, &[])));
    assert!(!floating.contains("Not every reduced form"), "{floating}");
    assert!(floating.contains("all other functions hold it still"), "{floating}");
    // a function that refers to others
    let alone = emit("walks.yaml", &text, &["--function", "inverse_dynamics_of_floating_base"]);
    for part in ["base_omega (rad/s), base_omega_dot", "exerted BY the robot ON its environment"] {
        let comments: String = alone.lines().filter_map(|line| line.strip_prefix("/// ")).collect::<Vec<_>>().join(" ");
        assert!(comments.contains(part), "no `{part}` in {comments}");
    }
    // a plan of a search is read again, by the function that it is for and by those that it is not for
    let file = folder.join("walks.yaml");
    let search = rne(&["search", file.to_str().expect("UTF-8"), "--seconds", "1"]);
    assert_eq!(search.status, 0, "{search:?}");
    let checked = fine(&["check", folder.join("walks.plan.yaml").to_str().expect("UTF-8")]);
    assert!(checked.contains("plan of hyq: inverse_dynamics_of_floating_base"), "{checked}");
    assert_eq!(counts(&emit("walks.yaml", &text, &[])), counts(&floating));
}

/// An option that changes nothing says so.
#[test]
fn rotors_that_are_not_there_are_told() {
    let called = rne(&["emit", "planar2", "--rotors", "--function", "gravity_torques"]);
    assert!(called.status == 0 && called.err.contains("note: no joint of planar2 has a rotor inertia"), "{called:?}");
    assert!(!rne(&["emit", "puma560", "--rotors", "--function", "gravity_torques"]).err.contains("rotor inertia"));
}
