//! `rne check`, and what every command says of a file that is at fault.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne, rne_reading};

#[test]
fn shipped_robots_are_in_order() {
    let out = fine(&["check", "robots/planar1.yaml", "robots/puma560.yaml"]);
    assert!(out.starts_with("ok robots/planar1.yaml  planar1, R, standard\n"), "{out}");
    assert!(out.contains("ok robots/puma560.yaml  puma560, RRRRRR, standard\n"), "{out}");
    assert!(out.contains("note: no body can have this inertia"), "lints are shown: {out}");
}

/// For the eye: the numbers of `rne eval` at zero, of every shipped robot with a fixed base and without loops.
#[test]
fn the_check_ends_with_the_pose_and_the_torques_at_zero() {
    let out = fine(&["check", "gantry_ppp"]);
    let end: Vec<&str> = out.lines().rev().take(2).collect();
    assert_eq!(
        end,
        [
            "  at q = 0  gravity torques [0, 0, -70.6320] N",
            "  at q = 0  tip at [0, 0, 0] m, its x axis along [1.000, 0, 0], its z axis along [0, 0, -1.000]"
        ]
    );
    let mut compared = 0;
    for rne_robots::RobotFile { name, .. } in rne_robots::all() {
        let out = fine(&["check", name]);
        let Some((_, torques)) = out.split_once("at q = 0  gravity torques [") else { continue };
        let shown: Vec<f64> = torques
            .split(']')
            .next()
            .into_iter()
            .flat_map(|list| list.split(", "))
            .map(|x| x.parse().expect("a number"))
            .collect();
        let zeros = vec!["0"; shown.len()].join(",");
        let computed = fine(&["eval", name, "--function", "gravity_torques", "--q", &zeros, "--json"]);
        let computed: serde_json::Value = serde_json::from_str(&computed).expect("JSON");
        let computed: Vec<f64> = serde_json::from_value(computed["result"].clone()).expect("numbers");
        assert_eq!(shown.len(), computed.len(), "{name}");
        for (shown, computed) in shown.iter().zip(&computed) {
            assert!((shown - computed).abs() <= 0.5001e-4 + 0.006 * computed.abs(), "{name}: {shown} {computed}");
        }
        compared += 1;
    }
    assert!(compared > 30, "{compared}");
}

#[test]
fn errors_name_file_line_and_column() {
    let folder = folder("errors");
    let good = fs::read_to_string(format!("{}/robots/planar1.yaml", crate::call::ROOT)).expect("a robot");
    let bad = folder.join("bad.yaml");
    fs::write(&bad, good.replace("mass: m,", "mass: -1,")).expect("written");
    let bad = bad.to_str().expect("UTF-8");
    let line = good.lines().position(|line| line.contains("mass: m,")).expect("a mass") + 1;
    let column = good.lines().nth(line - 1).and_then(|line| line.find("m, com")).expect("a mass") + 1;
    let place = format!("{bad}:{line}:{column}");

    let called = rne(&["check", "robots/planar2.yaml", bad, "robots/planar3.yaml"]);
    assert_eq!(called.status, 1);
    for part in ["ok robots/planar2.yaml", "ok robots/planar3.yaml", "1 of 3 files", &place, "mass", "negative"] {
        assert!(called.out.contains(part), "no `{part}` in {}", called.out);
    }
    for command in [&["show", bad][..], &["emit", bad], &["ops", bad], &["eval", bad, "--q", "1"]] {
        fails(1, command, &[&place, "negative"]);
    }
}

#[test]
fn a_file_that_is_not_there() {
    fails(1, &["show", "puma"], &["no robot file puma", "did you mean the shipped robot puma560?"]);
    fails(1, &["show", "kuka_iiwa"], &["did you mean the shipped robot iiwa14?"]);
    fails(1, &["show", "excavator"], &["no robot file excavator", "rne list"]);
    fails(1, &["ops", "robots/puma.yaml"], &["no robot file robots/puma.yaml", "puma560.yaml"]);
    fails(1, &["eval", "robots", "--q", "0"], &["folder"]);
    assert_eq!(rne(&["check", "nowhere.yaml"]).status, 1);
}

#[test]
fn standard_input() {
    let good = fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    let called = rne_reading(&["check", "-"], &good);
    assert!(called.status == 0 && called.out.starts_with("ok -  planar1, R, standard\n"), "{called:?}");
    let called = rne_reading(&["check", "-"], &good.replace("mass: m,", "mass: -1,"));
    assert!(called.status == 1 && called.out.contains("--> <standard input>:"), "{called:?}");
}

/// A plan that no build accepts is not in order, whether the plan is named or its robot.
#[test]
fn plans_are_compiled() {
    let folder = folder("plans_are_compiled");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (robot, plan) = (path("arm.yaml"), path("arm.plan.yaml"));
    fs::copy(format!("{ROOT}/robots/planar3.yaml"), &robot).expect("a copy");
    let good = fs::read_to_string(format!("{ROOT}/robots/planar3.plan.yaml")).expect("a plan");
    fs::write(&plan, &good).expect("written");
    assert!(fine(&["check", &robot]).starts_with("ok "));
    assert!(fine(&["check", &plan, &robot]).contains("plan of planar3: inverse_dynamics "));

    let first = |start: &str| good.lines().find(|line| line.trim_start().starts_with(start)).expect(start).to_owned();
    let replaced = |from: &str, to: &str| good.replacen(from, to, 1);
    let (results, operations) = (first("results "), first("operations "));
    let sum = operations.split_whitespace().find(|word| word.contains('+')).expect("a sum");
    let products = good.lines().find(|line| line.contains("mul: ")).expect("products");
    let result = results.split_whitespace().last().expect("a result");
    for (wrong, at, what) in [
        (
            replaced(&operations, &operations.replacen(sum, &sum.replace('+', "-"), 1)),
            "graph: |",
            "does not compute the same as the seven steps",
        ),
        (replaced(&results, "      results 1 1"), "results 1 1", "returns 3 numbers, but the graph has 2 results"),
        (replaced(&results, &format!("{results} {result}")), result, "returns 3 numbers, but the graph has 4 results"),
        (replaced("      constants ", "      "), "", "a graph begins with `constants` or `operations`"),
        (replaced(&results, "      results k99"), "k99", "the graph defines no value `k99` before this word"),
        (replaced(&results, "      results k+1"), "k+1", "the graph defines no value `k+1` before this word"),
        (replaced(&operations, "      operations qd1^qd2"), "qd1^qd2", "`qd1^qd2` is not an operation of a graph"),
        (replaced("length_scale: a2", "length_scale: a99"), "  plan:", "does not fit"),
        (replaced("    joints:", "    gyrostat: true\n    joints:"), "  plan:", "does not fit"),
        (replaced(products, "    mul: 1"), "  operations:", "the file states 1 products"),
        (replaced("robot: planar3", "robot: planar2"), "robot: planar2", "this plan is for `planar2`"),
        (String::new(), "", "the plan file is empty"),
    ] {
        assert_ne!(wrong, good, "{what}");
        fs::write(&plan, &wrong).expect("written");
        for file in [&robot, &plan] {
            let called = rne(&["check", file]);
            assert_eq!((called.status, called.err.as_str()), (1, ""), "{what}: {called:?}");
            assert!(called.out.contains(what), "no `{what}` in {}", called.out);
            let (_, place) = called.out.split_once("arm.plan.yaml:").expect("a place");
            let line: usize = place.split(':').next().and_then(|line| line.parse().ok()).expect("a line");
            assert!(
                wrong.lines().nth(line - 1).unwrap_or_default().contains(at),
                "no `{at}` in line {line}: {called:?}"
            );
        }
    }
    fs::remove_file(&plan).expect("it was there");
    assert!(rne(&["check", &plan]).out.contains("there is no plan"));
}

/// A device may have no end, a pipe keeps its reader waiting, and a file may be far too long.
#[test]
#[cfg(unix)]
fn files_without_an_end() {
    fails(1, &["show", "/dev/zero"], &["/dev/zero cannot be read", "not a regular file"]);
    let huge = folder("huge").join("huge.yaml");
    fs::File::create(&huge).and_then(|file| file.set_len(3 << 30)).expect("a sparse file");
    fails(1, &["show", huge.to_str().expect("UTF-8")], &["huge.yaml:1:1", "more than 1048576 bytes"]);
    fs::remove_file(&huge).expect("it is gone");
}

#[test]
fn usage() {
    for arguments in [&["check"][..], &["chek", "x"], &["show"], &["ops"], &["eval"], &["emit"]] {
        let called = rne(arguments);
        assert_eq!((called.status, called.out.as_str()), (2, ""), "{arguments:?}");
        let helps = called.err.contains("Usage") || called.err.contains("; for example rne ");
        assert!(helps, "{}", called.err);
    }
    assert_eq!(fine(&["help", "check"]), fine(&["check", "--help"]));
    let help = fine(&["--help"]);
    for command in ["check", "show", "emit", "ops", "eval"] {
        assert!(help.contains(&format!("  {command} ")), "{help}");
        let help = fine(&[command, "--help"]);
        assert!(help.contains("Example") && help.contains(&format!("rne {command} robots/")), "{help}");
    }
    assert!(fine(&["--version"]).starts_with("rne "));
}

/// Every arm obeys the laws; one whose last joint nothing resists has no inverse of its mass matrix.
#[test]
fn physics() {
    let out = fine(&["check", "--physics", "robots/planar2.yaml"]);
    assert_eq!((out.matches("  holds").count(), out.matches("  fails").count()), (5, 0), "{out}");
    let called = rne(&["check", "--physics", "cli/tests/cli/plans/singular.yaml"]);
    assert_eq!(called.status, 1);
    assert_eq!((called.out.matches("  holds").count(), called.out.matches("  fails").count()), (3, 2), "{called:?}");
}

#[test]
fn a_golden_file_with_another_name_is_told() {
    let folder = folder("misnamed_golden");
    let (robot, golden) = (folder.join("wrist.yaml"), folder.join("wirst.golden.csv"));
    fs::copy(format!("{ROOT}/robots/planar1.yaml"), &robot).expect("copied");
    fs::write(&golden, "q1,qd1,qdd1,tau1\n0,0,0,0\n").expect("written");
    let robot = robot.to_str().expect("UTF-8");
    let checked = fine(&["check", robot]);
    let told = format!(
        "warning: {} is not the golden file of {robot}; did you mean to name it {}?",
        golden.display(),
        folder.join("wrist.golden.csv").display()
    );
    assert!(checked.contains(&told), "{checked}");
    fs::rename(&golden, folder.join("wrist.golden.csv")).expect("renamed");
    assert!(!fine(&["check", robot]).contains("warning"));
}

#[test]
fn denied_warnings_are_errors() {
    let folder = folder("check_denied");
    let robot = folder.join("far.yaml");
    let robot = robot.to_str().expect("UTF-8");
    let text = std::fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    let far = text.replacen("convention: standard", "convention: standard\nbase: {xyz: [77, 0, 0], rpy: [0, 0, 0]}", 1);
    assert_ne!(far, text);
    std::fs::write(robot, far).expect("written");
    assert_eq!(rne(&["check", robot]).status, 0);
    let denied = rne(&["check", "--deny-warnings", robot]);
    assert_eq!(denied.status, 1, "{denied:?}");
    assert!(denied.out.contains("1 warning denied") && !denied.out.contains("ok "), "{denied:?}");
    assert_eq!(rne(&["check", "--deny-warnings", "robots/planar2.yaml"]).status, 0);
}
