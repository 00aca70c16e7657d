//! `rne certify` of several functions of a file, and of friction and limits; the checker on such files.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::call::{ROOT, fails, fine, folder, rne};
use crate::certify::{checked, has_tools, run_checker};

/// An arm with friction in all joints, and effort limits of 40, 40 and 15 N m.
const ARM: &str = "docs/desk_arm_identified.yaml";

#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn friction_and_limits_are_certified_and_checked_again() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_joints");
    let out = folder.join("arm.cert.md");
    let out = out.to_str().expect("UTF-8");
    let more = ["--function", "gravity_torques", "--friction", "--limits", "--tests", "--states", "200"];
    let certify = [&["certify", ARM], &more[..]].concat();
    let json: Value = serde_json::from_str(&fine(&[&certify[..], &["--json"]].concat())).expect("JSON");
    let others = json["more"].as_array().expect("functions");
    let names: Vec<&str> = others.iter().map(|other| other["function"].as_str().expect("a name")).collect();
    assert_eq!(
        (&json["function"], &names[..]),
        (&"gravity_torques".into(), &["friction_torques", "friction_derivatives", "limit_torques"][..])
    );
    for certified in others.iter().chain([&json]) {
        let cost = &certified["cost"];
        assert_eq!(certified["emulation"]["instructions"], cost["instructions"], "{}", certified["function"]);
        assert_eq!(certified["emulation"]["states"], 32);
        assert_eq!(cost["stack"], cost["stack_of_listing"]);
        let kinds = cost["classes"].as_array().expect("kinds").iter();
        let sum: u64 = kinds.map(|kind| kind["instructions"].as_u64().expect("a number")).sum();
        assert_eq!(Some(sum), cost["instructions"].as_u64(), "each instruction is of one kind");
    }
    for (joint, limit) in [40.0, 40.0, 15.0].into_iter().enumerate() {
        let [friction, limited] = [0, 2].map(|other| &others[other]["accuracy"]["results"][joint]);
        // roundings of a friction of some N m; the limits are numbers of single precision, so nothing is rounded
        let bound = friction["bound"].as_f64().expect("a number");
        assert!(bound > 1e-9 && bound < 1e-6, "{friction}");
        assert_eq!((limited["largest"].as_f64(), limited["bound"].as_f64()), (Some(limit), Some(0.0)), "{limited}");
    }
    let traced = json["trace"].as_array().expect("lines");
    for name in ["friction[2]", "derivatives[2]", "limited[2]"] {
        assert_eq!(traced.iter().filter(|line| line["name"] == name).count(), 1, "{name}");
    }
    // the tests of the code are not checked for the rules, which they violate
    let rules: Vec<&String> = json["misra"].as_object().expect("rules").keys().collect();
    assert_eq!(rules, ["19.2", "2.5", "20.9"]);

    assert_eq!(rne(&[&certify[..], &["-o", out]].concat()).status, 0);
    let page = fs::read_to_string(out).expect("it was written");
    for part in [
        "## Cost of a call of `friction_torques`",
        "## Error in single precision of `friction_derivatives`",
        "## Error in single precision of `limit_torques`",
        "does not cover `friction_torques`",
        "does not cover `limit_torques`",
        "behind `RNE_TEST`, are test code",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    let check = [&certify[..], &["--check", out]].concat();
    assert_eq!(rne(&check).status, 0);
    let (before, after) = page.split_once("| `friction[2]` | ").expect("an error");
    fs::write(out, format!("{before}| `friction[2]` | 1{after}")).expect("written");
    fails(1, &check, &["1 lines differ", "Error in single precision of `friction_torques`", "friction[2]"]);
}

#[test]
fn what_has_no_friction_has_no_certificate_of_it() {
    if !has_tools() {
        return;
    }
    fails(1, &["certify", "planar2", "--friction"], &["no joint has friction", "coulomb_width"]);
    fails(1, &["certify", "planar2", "--limits"], &["no joint has an effort limit"]);
    fails(2, &["certify", ARM, "--friction", "--lang", "rust"], &["--friction", "--lang c"]);
}

#[test]
fn a_folder_of_evidence_that_cannot_be_made_is_named_plainly() {
    if !has_tools() {
        return;
    }
    let folder = folder("certify_evidence");
    let file = folder.join("file");
    fs::write(&file, "mine").expect("written");
    for path in [file.clone(), file.join("evidence")] {
        let path = path.to_str().expect("UTF-8");
        fails(2, &["certify", ARM, "--evidence", path], &["file is not a folder and is not changed"]);
    }
    assert_eq!(fs::read_to_string(&file).expect("it is there"), "mine");
    if cfg!(target_os = "linux") {
        let called = rne(&["certify", ARM, "--evidence", "/proc/foo"]);
        assert_eq!(called.status, 1);
        assert!(called.err.contains("/proc/foo cannot be written: the system does not allow a new file"), "{called:?}");
        assert!(!called.err.contains("os error"), "{called:?}");
    }
}

#[test]
#[ignore = "slow: cargo xtask verify certify"]
fn the_checker_takes_a_file_with_several_functions() {
    let has_python = std::process::Command::new("python3").arg("--version").output().is_ok();
    if !has_python || !has_tools() {
        return;
    }
    let folder = folder("checker_several");
    let functions = ["--function", "inverse_dynamics,bias_torques,gravity_torques"];
    let certify = [&["certify", ARM, "--states", "5", "--evidence", folder.to_str().expect("UTF-8")], &functions[..]];
    fine(&certify.concat());
    let trace = folder.join("desk_arm_identified.trace.json");
    let source = folder.join("mine.c");
    let robot = Path::new(ROOT).join(ARM);
    // whatever `rne emit` writes beside them
    let all = ["--function", "all", "--friction", "--limits", "--tests"];
    for more in [&[][..], &functions, &["--friction", "--limits"], &all] {
        let emit = ["emit", ARM, "--lang", "c", "--force", "-o", source.to_str().expect("UTF-8")];
        assert_eq!(rne(&[&emit[..], more].concat()).status, 0);
        let (is_accepted, said) = run_checker(&[Path::new("--partial"), &source, &trace, &robot]);
        assert!(is_accepted, "{more:?}: {said}");
        for function in ["inverse_dynamics", "bias_torques", "gravity_torques"] {
            assert!(said.contains(&format!("desk_arm_{function}: 3 torques")), "{more:?}: {said}");
        }
        let names_friction = said.lines().any(|line| line.contains("not checked") && line.contains("friction_torques"));
        assert_eq!(names_friction, more.contains(&"--friction"), "{more:?}: {said}");
        // without the option, a function of which the trace says nothing is an error
        let (is_accepted, said) = checked(&source, &trace, &robot);
        assert_eq!(is_accepted, more == functions, "{more:?}: {said}");
        assert!(is_accepted || said.contains("\nwrong: the trace does not name these functions"), "{more:?}: {said}");
    }
    let emit = ["emit", ARM, "--lang", "c", "--force", "--prefix", "kf", "-o", source.to_str().expect("UTF-8")];
    assert_eq!(rne(&emit).status, 0);
    let (is_accepted, said) = checked(&source, &trace, &robot);
    assert!(!is_accepted && said.contains("wrong: the trace is of desk_arm_, the source has kf_"), "{said}");
    let emit = ["emit", ARM, "--lang", "c", "--force", "-o", source.to_str().expect("UTF-8")];
    assert_eq!(rne(&[&emit[..], &all].concat()).status, 0);
    let text = fs::read_to_string(&source).expect("it was written");
    let gravity = text.find("void desk_arm_gravity_torques(").expect("a function");
    let bias = text.find("void desk_arm_bias_torques(").expect("a function");
    let of_gravity = |old: &str, new: &str| {
        let place = gravity + text[gravity..].find(old).expect("a place");
        format!("{}{new}{}", &text[..place], &text[place + old.len()..])
    };
    for (what, mutant, words) in [
        ("an operator", of_gravity(" + ", " - "), "desk_arm_gravity_torques: torque"),
        ("an output", of_gravity("tau[1] = ", "tau[1] = -"), "desk_arm_gravity_torques: torque 2 "),
        ("no function", text.replace("desk_arm_bias_torques(", "desk_arm_bias("), "must define desk_arm_bias_torques"),
        ("twice", format!("{}{}", &text[..bias], text[bias..].replacen("bias", "gravity", 1)), "gravity_torques once"),
        ("a macro", of_gravity("void ", "#define tau1 tau2\nvoid "), "line of the preprocessor"),
        ("a variable", of_gravity("void ", "float tau1;\nvoid "), "code outside the functions"),
        ("after the tests", text.clone() + "int more;\n", "code after the tests"),
        ("a macro in the tests", text.replace("#include <stdio.h>", "#endif\n#if 1"), "the end of the source"),
    ] {
        fs::write(&source, mutant).expect("written");
        let (is_accepted, said) = checked(&source, &trace, &robot);
        assert!(!is_accepted && said.contains("\nwrong: ") && said.contains(words), "{what}: {said}");
    }
}
