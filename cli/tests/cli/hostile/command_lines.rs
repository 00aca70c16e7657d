//! Names, numbers and places on the command line.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use super::robot_files::ARM;
use super::{Case, Expected, written};

/// Names that must lead nowhere.
const NAMES: [&str; 14] =
    ["", "..", "../x", "/etc/x", "a/b", "a\\b", "c:x", "x\n", "x\u{1B}[2J", "\u{202E}x", "-x", "x y", "\u{E4}", "*/"];

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let arm = written(folder, 0, "arm.yaml", ARM);
    let urdf = written(folder, 0, "arm.urdf", "<robot name=\"r\"/>");
    let usage = |what: &str, arguments: &[&str], words| Case::new(what, arguments, Expected::Refused(2, words));
    let mut cases = Vec::new();
    for name in NAMES {
        let word = if name == "-x" { "--prefix=-x" } else { "--prefix" };
        let prefix: Vec<&str> =
            ["emit", &arm, "--lang", "c", word].into_iter().chain((name != "-x").then_some(name)).collect();
        cases.extend([
            usage("new: a name", &["new", "--dof", "2", "--", name], ""),
            usage("firmware: a name", &["firmware", "--", name], ""),
            usage("emit: a prefix", &prefix, ""),
            usage("import: a name", &["import", &urdf, &format!("--name={name}")], ""),
        ]);
    }
    let long = "x".repeat(100_000);
    let numbers = vec!["1"; 30_000].join(",");
    let deep = "(".repeat(100_000);
    for (q, words) in [
        ("", ""),
        (",", ""),
        ("nan", ""),
        ("1e999", ""),
        ("inf", ""),
        ("1/0", ""),
        ("9^9^9^9", ""),
        ("\u{1B}[2J", ""),
        ("\u{202E}1", ""),
        (&long, ""),
        (&deep, ""),
        (&numbers, "30000"),
    ] {
        cases.push(usage("eval: a list", &["eval", &arm, "--qd=0", "--qdd=0", &format!("--q={q}")], words));
    }
    for set in ["", "=", "m", "m=", "m=nan", "m=1e999", "=1", "nobody=1", "\u{1B}[2J=1", "m=1=2"] {
        let arguments = ["eval", &arm, "--q=0", "--qd=0", "--qdd=0", &format!("--set={set}")];
        cases.push(Case::new("eval: a parameter", &arguments, Expected::Failed));
    }
    for lock in ["", "=", "j", "j=", "j=nan", "j=1e999", "\u{1B}[2J=1x"] {
        cases.push(usage("import: a lock", &["import", &urdf, &format!("--lock={lock}")], ""));
    }
    for dof in ["0", "65", "256", "-1", "1e9", "99999999999999999999", "nan", ""] {
        cases.push(usage("new: joints", &["new", "x", &format!("--dof={dof}"), "-o", "-"], ""));
    }
    cases.extend([
        usage("new: a joint that is not there", &["new", "x", "--dof=2", "--prismatic=200", "-o", "-"], "no joint 200"),
        usage("show: a joint", &["show", &arm, "--joint=99999999999999999999"], ""),
        usage("show: a joint of none", &["show", &arm, "--joint=0"], ""),
        usage("show: a function", &["show", &arm, "--function=\u{1B}[2J\u{202E}"], ""),
        usage("explain: a word", &["explain", "../../etc/passwd\u{1B}[2J"], ""),
        usage("a command that is none", &["\u{1B}[2J\u{202E}"], ""),
        usage("a command of 100,000 letters", &[&long], ""),
        Case::new("eval: beyond all", &["eval", &arm, "--q=1e308", "--qd=1e308", "--qdd=1e308"], Expected::Failed),
        Case::new(
            "eval: almost nothing",
            &["eval", &arm, "--q=5e-324", "--qd=5e-324", "--qdd=5e-324"],
            Expected::Taken,
        ),
    ]);

    // places to write to
    let place = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    for name in ["pipe.c", "pipe.rs", "pipe"] {
        assert!(Command::new("mkfifo").arg(folder.join(name)).status().is_ok_and(|made| made.success()), "a pipe");
    }
    for name in ["circle.rs", "circle"] {
        symlink(name, folder.join(name)).expect("a link");
    }
    fs::create_dir_all(folder.join("folder.rs")).expect("a folder");
    for out in [
        place("pipe.rs"),
        place("circle.rs"),
        place("folder.rs"),
        place("none/there.rs"),
        String::new(),
        "/dev/full".into(),
        "/dev/null/x.rs".into(),
        "/proc/x.rs".into(),
        format!("{}.rs", "x".repeat(5000)),
        arm.clone(),
    ] {
        let out = format!("--output={out}");
        cases.extend([
            Case::new("emit: a place", &["emit", &arm, &out], Expected::Failed),
            Case::new("convert: a place", &["convert", &arm, "--convention=modified", &out], Expected::Failed),
            Case::new("export: a place", &["export", &arm, "--urdf", &out], Expected::Failed),
            Case::new("new: a place", &["new", "x", "--dof=2", &out], Expected::Failed),
            Case::new("firmware: a place", &["firmware", "torque", &out], Expected::Either),
        ]);
    }
    cases
}
