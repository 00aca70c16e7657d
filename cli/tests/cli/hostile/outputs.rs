//! Where commands write: standard output as `-`, and places without room.

use std::fs;
use std::path::Path;

use super::robot_files::ARM;
use super::{Case, Expected, written};

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let arm = written(folder, 0, "arm.yaml", ARM);
    let states = written(folder, 0, "states.csv", "q1,qd1,qdd1\n0.1,0.2,0.3\n");
    // a file that is there, and stays as it is
    let old = |name: &str| written(folder, 1, name, "old\n");
    let writers: [(&str, Vec<&str>, &str); 8] = [
        ("emit", vec!["emit", &arm], "x.rs"),
        ("emit C", vec!["emit", &arm, "--lang", "c"], "x.c"),
        ("report", vec!["report", &arm], "x.html"),
        ("convert", vec!["convert", &arm, "--convention", "modified"], "x.yaml"),
        ("export", vec!["export", &arm, "--urdf"], "x.urdf"),
        ("plot", vec!["plot", &arm], "x.svg"),
        ("eval", vec!["eval", &arm, "--states", &states], "x.csv"),
        ("new", vec!["new", "elbow", "--dof", "2"], "x2.yaml"),
    ];
    let mut cases = Vec::new();
    for (what, command, name) in writers {
        let with =
            |out: &str| -> Vec<String> { command.iter().copied().chain(["-o", out]).map(str::to_owned).collect() };
        if what != "emit C" {
            cases.push(Case::new(format!("{what}: standard output"), &with("-"), Expected::Taken));
        }
        let out = old(name);
        cases.push(Case::new(format!("{what}: a file of somebody"), &with(&out), Expected::Failed));
        let place = folder.join("none").join(what);
        fs::create_dir_all(&place).expect("a folder");
        let out = place.join(name);
        let out = out.to_str().expect("UTF-8");
        cases.push(Case::new(format!("{what}: no room"), &with(out), Expected::Failed).without_room());
    }
    cases
}

/// What is left where there was no room, and what became of files that were there.
pub(super) fn faults(folder: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for place in fs::read_dir(folder.join("none")).expect("a folder") {
        for left in fs::read_dir(place.expect("an entry").path()).expect("a folder") {
            faults.push(format!("left without room: {}", left.expect("an entry").path().display()));
        }
    }
    for file in fs::read_dir(folder.join("1")).expect("a folder") {
        let path = file.expect("an entry").path();
        if fs::read(&path).expect("a file") != b"old\n" {
            faults.push(format!("written: {}", path.display()));
        }
    }
    faults
}
