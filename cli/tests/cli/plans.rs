//! Plans of arms that random ones found: what a search writes is accepted, and what a file claims is not believed.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};

/// A robot of the folder `plans` in a folder of its own, with its plan if it has one.
fn arm(name: &str) -> (String, String) {
    let folder = folder(&format!("plans_{name}"));
    let path = |file: &str| folder.join(file).to_str().expect("UTF-8").to_owned();
    let shipped = format!("{ROOT}/cli/tests/cli/plans/{name}");
    fs::copy(format!("{shipped}.yaml"), path("arm.yaml")).expect("a robot");
    let _ = fs::remove_file(path("arm.plan.yaml"));
    if fs::exists(format!("{shipped}.plan.yaml")).expect("a folder") {
        fs::copy(format!("{shipped}.plan.yaml"), path("arm.plan.yaml")).expect("a plan");
    }
    (path("arm.yaml"), path("arm.plan.yaml"))
}

/// Links whose matter is all on an axis need no regrouping, so that a search could leave it out, which no file can say.
#[test]
fn what_a_search_writes_is_in_order() {
    for name in ["massless_link", "point_masses", "count", "singular"] {
        let (robot, plan) = arm(name);
        fine(&["search", &robot, "--seconds", "0.1", "--seed", "3"]);
        assert!(fine(&["check", &plan]).contains("proved"), "{name}");
        fine(&["search", &robot, "--seconds", "0.3", "--rewrite", "--function", "all", "--seed", "3"]);
        assert!(fine(&["check", &plan]).contains("proved"), "{name}");
        fine(&["emit", &robot, "--form", "reduced", "--function", "all"]);
    }
}

/// A mass matrix that is always singular has no inverse that another could be.
#[test]
fn nothing_is_rewritten_that_divides_by_zero() {
    let (robot, plan) = arm("singular");
    fine(&["search", &robot, "--seconds", "0.3", "--rewrite", "--function", "forward_dynamics"]);
    let written = fs::read_to_string(&plan).expect("a plan");
    assert!(!written.contains("forward_dynamics:"), "{written}");
    let graph = "\
rewritten:
  forward_dynamics:
    operations: {mul: 0, add: 0, sincos: 0}
    accuracy: {double: 0, single: 0, single_of_seven_steps: 0}
    graph: results tau1
";
    fs::write(&plan, written + graph).expect("written");
    let called = rne(&["check", &robot]);
    assert!(called.status == 1 && called.out.contains("`forward_dynamics` divides by zero"), "{called:?}");
}

/// A trick may be the ground on which another stands.
#[test]
fn a_trick_is_left_out_with_what_needs_it() {
    for (name, tricks) in [
        ("without_regrouping", "regrouping"),
        ("without_regrouping", "regrouping,scales"),
        ("without_carried_small", "carried-prismatics"),
        ("without_carried", "carried-prismatics"),
        ("without_targets", "regrouping-targets"),
    ] {
        let (robot, plan) = arm(name);
        if fs::exists(&plan).expect("a folder") {
            // of another version: what it chooses is found again
            let _ = rne(&["search", &robot, "--seconds", "0.3", "--fresh"]);
        }
        assert!(fine(&["ops", &robot, "--without", tricks]).contains("reduced"), "{name}");
        assert!(fine(&["ops", &robot, "--tricks"]).contains("regrouping "), "{name}");
    }
}

/// A plan is made for the torques. What it does to another function is refused, and that function then takes fewer
/// choices, as it does in a build without a plan.
#[test]
fn a_plan_takes_nothing_from_other_functions() {
    let (robot, _) = arm("extreme");
    let emit = ["emit", &robot, "--function", "forward_dynamics", "--form", "reduced"];
    // the arm loses digits in single precision, and a warning says so
    assert_eq!(rne(&emit).status, 0);
    fine(&["search", &robot, "--seconds", "0"]);
    assert_eq!(rne(&emit).status, 0);
}

/// Counts, quotients and a place: none of them is taken on trust.
#[test]
fn a_plan_is_not_believed() {
    let folder = folder("plans_not_believed");
    let path = |file: &str| folder.join(file).to_str().expect("UTF-8").to_owned();
    let (robot, plan) = (path("arm.yaml"), path("arm.plan.yaml"));
    fs::copy(format!("{ROOT}/robots/planar2.yaml"), &robot).expect("a copy");
    let good = fs::read_to_string(format!("{ROOT}/robots/planar2.plan.yaml")).expect("a plan");

    // a count that is too small, or too large for a sum
    let (before, graph) = good.split_at(good.find("  gravity_torques:").expect("its graph"));
    let line = graph.lines().find(|line| line.contains("mul: ")).expect("products");
    for count in ["0", "18446744073709551615"] {
        let wrong = format!("{before}{}", graph.replacen(line, &format!("      mul: {count}"), 1));
        fs::write(&plan, &wrong).expect("written");
        let called = rne(&["check", &plan]);
        assert!(called.status == 1 && called.out.contains(&format!("the file states {count} products")), "{called:?}");
        fine(&["search", &robot, "--seconds", "0"]);
        assert!(fine(&["check", &plan]).contains("proved"), "it has been counted anew");
    }

    // (x q̇ + y q̇) / q̇ is x + y, but at rest
    let (before, graph) = good.split_at(good.find("  bias_torques:").expect("its graph"));
    let (_, words) = graph.split_once("operations ").expect("operations");
    let first = words.split_whitespace().next().expect("an operation");
    let wrong = graph.replacen(&format!("operations {first}"), &format!("operations {first} 1*qd1 1/qd1"), 1);
    fs::write(&plan, format!("{before}{wrong}")).expect("written");
    let called = rne(&["check", &plan]);
    assert!(called.status == 1, "{called:?}");
    assert!(
        called.out.contains("`1/qd1` divides by a value by which the code of the plan never divides"),
        "{called:?}"
    );

    // what has come about while a search was running is kept
    fs::write(&plan, &good).expect("written");
    fine(&["search", &robot, "--seconds", "0.2"]);
    assert!(fs::read_to_string(&plan).expect("a plan").contains("  gravity_torques:"));

    // a base moves what kinematics return
    let text = fs::read_to_string(&robot).expect("a robot");
    fs::write(&robot, text.replacen("\njoints:", "\nbase: {xyz: [0, 0, 0.4]}\njoints:", 1)).expect("written");
    fails(1, &["emit", &robot, "--form", "reduced"], &["numbers of the robot file have changed"]);
}

/// What a build refuses is said wherever the form is told, and nothing is said of an arm without a refusal.
#[test]
fn refused_forms_are_told() {
    let words = ["Not every reduced form of forward_dynamics could be taken", "divide by zero in every state"];
    for (name, is_refused) in [("singular", true), ("count", false)] {
        let (robot, _) = arm(name);
        let reduced = ["--function", "forward_dynamics", "--form", "reduced"];
        let commands: [&[&str]; 4] =
            [&["check", &robot], &["show", &robot], &["emit", &robot], &["emit", &robot, "--lang", "c"]];
        for command in commands {
            let arguments = if command[0] == "check" { command.to_vec() } else { [command, &reduced].concat() };
            // a comment of C goes on in the next line
            let said = fine(&arguments).replace("\n//", "").split_whitespace().collect::<Vec<_>>().join(" ");
            for words in words {
                assert_eq!(said.contains(words), is_refused, "{name}, {command:?}: {said}");
            }
            assert!(!said.contains("has one form"), "{name}, {command:?}: {said}");
        }
        let json = fine(&["show", &robot, "--function", "forward_dynamics", "--form", "reduced", "--json"]);
        assert_eq!(json.contains(words[1]), is_refused, "{name}: {json}");
    }
}
