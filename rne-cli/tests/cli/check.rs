//! `rne check`, and what every command says of a file that is at fault.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne, rne_reading};

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
fn standard_input() {
    let good = fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    let called = rne_reading(&["check", "-"], &good);
    assert_eq!((called.status, called.out.as_str()), (0, "ok -  planar1, R, standard\n"));
    let called = rne_reading(&["check", "-"], &good.replace("mass: m,", "mass: -1,"));
    assert!(called.status == 1 && called.out.contains("--> <standard input>:"), "{called:?}");
}

/// A device without an end, and a file far too long, are refused at once.
#[test]
#[cfg(unix)]
fn files_without_an_end() {
    fails(1, &["show", "/dev/zero"], &["/dev/zero:1:1", "more than 1048576 bytes"]);
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
        assert!(called.err.contains("Usage"), "{}", called.err);
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
