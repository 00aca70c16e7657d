//! Texts in the place of a plan.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::robot_files::lines;
use super::{Case, Expected, as_said, written};
use crate::call::ROOT;

pub(super) fn cases(folder: &Path) -> Vec<Case> {
    let read = |name: &str| fs::read_to_string(format!("{ROOT}/robots/{name}")).expect("a shipped file");
    let (robot, plan) = (read("planar2.yaml"), read("planar2.plan.yaml"));
    let with = |old: &str, new: &str| {
        assert!(plan.contains(old), "{old}");
        plan.replacen(old, new, 1).into_bytes()
    };
    let (_, graph) = plan.split_once("graph: |\n").expect("a graph");
    let first = graph.lines().next().expect("a line");
    let in_graph = |line: &str| with(first, line);
    let bomb = lines(30, |i| match i {
        0 => "a0: &a0 [x, x, x, x, x, x, x, x, x]".to_owned(),
        i => format!("a{i}: &a{i} [{}]", vec![format!("*a{}", i - 1); 9].join(", ")),
    });
    let mut cases: Vec<Case> = [
        ("the plan", plan.clone().into_bytes(), ""),
        ("empty", Vec::new(), "the plan file is empty"),
        ("a byte order mark", [b"\xEF\xBB\xBF", plan.as_bytes()].concat(), ""),
        ("lines of DOS", plan.replace('\n', "\r\n").into_bytes(), ""),
        ("zeros", vec![0; 1 << 20], "x.plan.yaml"),
        ("ones", vec![0xFF; 1 << 20], "x.plan.yaml is not text in UTF-8"),
        ("1 MiB and 1", format!("{plan}#{}", "x".repeat(1 << 20)).into_bytes(), "more than 1048576 bytes"),
        ("a word", b"plan".into(), "x.plan.yaml:1"),
        ("a list", b"[1, 2]".into(), "x.plan.yaml:1"),
        ("the robot", robot.clone().into_bytes(), "x.plan.yaml:"),
        ("a format to come", with("format: 3", "format: 1e999"), "x.plan.yaml:"),
        ("another robot", with("robot: planar2", "robot: ../planar3"), "x.plan.yaml:"),
        ("a robot with an escape", with("robot: planar2", "robot: \"\\e[2J\\u202E\""), "x.plan.yaml:"),
        ("an unknown key", with("format: 3", "format: 3\n\"\\e[2J\": 1"), "x.plan.yaml:"),
        ("a repeated key", with("format: 3", "format: 3\nformat: 3"), "x.plan.yaml:"),
        ("two documents", format!("{plan}---\n{plan}").into_bytes(), "x.plan.yaml"),
        ("billions of laughs", format!("{bomb}{plan}").into_bytes(), "x.plan.yaml:"),
        ("open lists", b"[".repeat(1 << 20), "nested more than 16 levels deep"),
        ("open mappings", b"{a: ".repeat(1 << 18), "nested more than 16 levels deep"),
        ("keys in a line", [b"{".to_vec(), b"a: 1, ".repeat(170_000), b"}".to_vec()].concat(), "x.plan.yaml:"),
        ("deep questions", b"? ".repeat(1 << 19), "x.plan.yaml:"),
        ("a tag of Python", with("mul: 13", "mul: !!python/object 13"), "tags are not allowed"),
        ("a count of 100 digits", with("mul: 13", &format!("mul: {}", "1".repeat(100))), "x.plan.yaml:"),
        ("a count below nothing", with("mul: 13", "mul: -1"), "x.plan.yaml:"),
        ("an accuracy beyond all", with("double: 6.2e-16", "double: 1e999"), "x.plan.yaml:"),
        ("no accuracy", with("double: 6.2e-16", "double: .nan"), "is no accuracy"),
        ("a joint of too many", with("    - {}\n", &"    - {}\n".repeat(100_000)), "x.plan.yaml:"),
        ("an unknown function", with("gravity_torques:", "\"\\e[2Jtorques\":"), "x.plan.yaml:"),
        ("a value of itself", in_graph("      constants k1*k1"), "x.plan.yaml:"),
        ("a value of a later one", in_graph("      constants k2*k2 9.81"), "x.plan.yaml:"),
        ("a number beyond all", in_graph("      constants 1e999"), "x.plan.yaml:"),
        ("no number", in_graph("      constants nan"), "x.plan.yaml:"),
        ("a number of 10,000 digits", in_graph(&format!("      constants {}", "9".repeat(10_000))), "x.plan.yaml:"),
        ("an exponent of 20 digits", in_graph("      constants 1e-99999999999999999999"), "x.plan.yaml:"),
        ("an index of 30 digits", in_graph(&format!("      constants /k{}", "9".repeat(30))), "x.plan.yaml:"),
        ("a distance of 30 digits", in_graph(&format!("      constants 9.81 1*{}", "9".repeat(30))), "x.plan.yaml:"),
        ("a value with an escape", in_graph("      constants \u{202E}9.81"), "x.plan.yaml:"),
        ("no value", in_graph("      = ="), "x.plan.yaml:"),
        ("a character of two bytes", in_graph("      operations é*é"), "x.plan.yaml:"),
        ("signs alone", in_graph("      operations -*-"), "x.plan.yaml:"),
        ("30,000 values more", in_graph(&format!("{first}\n{}", lines(30_000, |_| "      k1*k1".to_owned()))), ""),
        ("a value squared 2,000 times", in_graph(&format!("{first}\n{}", lines(2000, |_| "      1*1".to_owned()))), ""),
    ]
    .into_iter()
    .enumerate()
    .map(|(index, (what, bytes, words))| {
        let path = written(folder, index, "x.yaml", &robot);
        written(folder, index, "x.plan.yaml", bytes);
        Case::new(format!("plan: {what}"), &["check", &path], as_said(words)).naming("x.plan.yaml")
    })
    .collect();
    for (index, (what, words)) in [
        ("a folder", "x.plan.yaml"),
        ("a pipe", "x.plan.yaml cannot be read: it is a pipe"),
        ("a circle", "x.plan.yaml"),
    ]
    .into_iter()
    .enumerate()
    {
        let path = written(folder, 1000 + index, "x.yaml", &robot);
        let plan = Path::new(&path).with_file_name("x.plan.yaml");
        match what {
            "a folder" => fs::create_dir_all(&plan).expect("a folder"),
            "a pipe" => assert!(Command::new("mkfifo").arg(&plan).status().expect("mkfifo").success()),
            _ => std::os::unix::fs::symlink("x.plan.yaml", &plan).expect("a link"),
        }
        for command in ["check", "show", "ops", "emit"] {
            // only the reduced form reads a plan
            let form = ["--form", "reduced"];
            let arguments: Vec<&str> = [command, &path]
                .into_iter()
                .chain(form.into_iter().filter(|_| ["show", "emit"].contains(&command)))
                .collect();
            let case = Case::new(format!("plan: {what}"), &arguments, Expected::Refused(1, words));
            cases.push(case.naming("x.plan.yaml"));
        }
    }
    cases
}
