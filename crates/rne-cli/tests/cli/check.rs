//! `rne check`, and what every command says of a file that is at fault.

use std::fs;

use crate::call::{fails, fine, folder, rne};

#[test]
fn shipped_robots_are_in_order() {
    let out = fine(&["check", "robots/planar1.yaml", "robots/puma560.yaml"]);
    assert!(out.starts_with("ok robots/planar1.yaml  planar1, R, standard\n"), "{out}");
    assert!(out.contains("ok robots/puma560.yaml  puma560, RRRRRR, standard\n"), "{out}");
    assert!(out.contains("warning: no body has this inertia"), "lints are shown: {out}");
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
    fails(1, &["show", "puma560"], &["no robot file puma560", "robots/puma560.yaml"]);
    fails(1, &["ops", "robots/puma.yaml"], &["no robot file robots/puma.yaml", "puma560.yaml"]);
    fails(1, &["eval", "robots", "--q", "0"], &["folder"]);
    assert_eq!(rne(&["check", "nowhere.yaml"]).status, 1);
}

#[test]
fn usage() {
    for arguments in [&["check"][..], &["chek", "x"], &["show"], &["ops"], &["eval"], &["emit"]] {
        let called = rne(arguments);
        assert_eq!((called.status, called.out.as_str()), (2, ""), "{arguments:?}");
        assert!(called.err.contains("Usage"), "{}", called.err);
    }
    let help = fine(&["--help"]);
    for command in ["check", "show", "emit", "ops", "eval"] {
        assert!(help.contains(&format!("  {command} ")), "{help}");
        let help = fine(&[command, "--help"]);
        assert!(help.contains("Example") && help.contains(&format!("rne {command} robots/")), "{help}");
    }
    assert!(fine(&["--version"]).starts_with("rne "));
}
