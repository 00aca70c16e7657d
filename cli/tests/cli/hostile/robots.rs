//! Valid robots that are as large, as small or as strange as a file allows, through every command that reads one.

use std::path::Path;

use super::robot_files::with;
use super::{Case, Expected, written};

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let joint = "  - {type: revolute, dh: {theta: 0.1, d: 0.2, a: 0.3, alpha: 0.4}, link: {mass: 1, com: [0.1, 0.2, \
                 0.3], inertia: {xx: 1, yy: 1, zz: 1, xy: 0.1, xz: 0.1, yz: 0.1}}}\n";
    let (head, _) = super::robot_files::ARM.split_once("  - name").expect("joints");
    let dense = |count: usize| head.to_owned() + &joint.repeat(count);
    let comment = "*/ \\\" */ /* // ${x} $(touch here) `touch here` %n%s \\u{1b} \u{1F4A9} ?>";
    let texts = [
        ("64 joints", dense(64), 64),
        ("masses beyond float", with("m: 1.5", "m: 1e300"), 1),
        ("masses of almost nothing", with("m: 1.5", "m: 5e-324"), 1),
        ("lengths beyond reason", with("a: 0.4", "a: 1e200"), 1),
        ("a title of code", with("an arm", &format!("'{comment}'")), 1),
        ("a title that controls", with("an arm", "\"\\e[2J\\a\\r\\u202E\\x9Bx\\u2028\""), 1),
        ("a joint that controls", with("shoulder", "\"\\e[2J\\a\\r\\u202E\\x9Bx\\u2028\""), 1),
        ("a title of 100,000 letters", with("an arm", &"x".repeat(100_000)), 1),
        ("a joint of 100,000 letters", with("shoulder", &"x".repeat(100_000)), 1),
    ];
    let mut cases = Vec::new();
    for (index, (what, text, dof)) in texts.into_iter().enumerate() {
        let path = written(folder, index, "arm.yaml", text);
        let list = |number: &str| vec![number; dof].join(",");
        let (q, qd, qdd) = (list("0.5"), list("-1"), list("2"));
        let mut commands = vec![
            vec!["check", &path],
            vec!["show", &path],
            vec!["eval", &path, "--q", &q, "--qd", &qd, "--qdd", &qdd, "--trace"],
            vec!["emit", &path],
            vec!["emit", &path, "--lang", "c", "--real", "double"],
            vec!["convert", &path, "--convention", "modified"],
            vec!["export", &path, "--urdf"],
        ];
        if dof == 1 {
            commands.extend([
                vec!["check", "--physics", &path],
                vec!["show", &path, "--base-parameters"],
                vec!["ops", &path],
                vec!["emit", &path, "--function", "all", "--form", "reduced"],
                vec!["emit", &path, "--lang", "c"],
            ]);
        }
        for command in commands {
            let case = Case::new(format!("{what}, {}", command[0]), &command, Expected::Either);
            // a state may be at fault, which stands in no file
            cases.push(if command[0] == "eval" { case } else { case.naming("arm") });
        }
    }
    cases
}
