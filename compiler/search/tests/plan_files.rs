//! Plan files: what is written is read, by us and by serde, and every mistake is told at its place.

use std::path::Path;

use common::robot;
use rne_model::Reader;
use rne_search::{PlanFile, Progress, SearchOptions, fingerprint, search};

mod common;

#[test]
fn plans_survive_as_files_and_belong_to_one_robot() {
    let robot = robot("ur5");
    let mut clock = |progress: &Progress| (progress.plans < 600).then_some(0.0);
    let found = search(&robot, None, &SearchOptions::default(), &mut clock).unwrap();
    let text = found.to_yaml();
    let read = PlanFile::read("ur5.plan.yaml", &text, &robot).unwrap();
    assert_eq!(read, found);
    let again = search(&robot, Some(&read), &SearchOptions::default(), &mut |_| None).unwrap();
    assert!(again.reduced.operations.weight() <= found.reduced.operations.weight(), "never worse");

    // kinematics depend on where the arm stands
    let mut elsewhere = robot.clone();
    elsewhere.base.xyz[2] = 0.4;
    assert_ne!(fingerprint(&elsewhere), fingerprint(&robot));

    let mut other = robot.clone();
    other.joints[2].row.link.mass += 1.0;
    let report = PlanFile::read("ur5.plan.yaml", &text, &other).unwrap_err();
    let error = report.errors().next().unwrap();
    assert_eq!((error.line, error.column), (7, 14));
    assert!(error.message.contains("numbers of the robot file have changed"), "{}", error.message);
    assert_eq!(error.help, None, "what helps is said by whoever shows it");
    for (from, to, what, line) in [
        ("format: 3", "format: 1", "format: 3", "format: 1"),
        ("format: 3", "format: one", "found `one` where a whole number is needed", "format: one"),
        ("robot: ur5", "robot: ur6", "this plan is for `ur6`, not for `ur5`", "robot: ur6"),
        ("robot:", "robt:", "unknown key `robt`; a plan file has the keys format, robot", "robt: ur5"),
        ("fingerprint: ", "fingerprint: +", "is not a fingerprint", "fingerprint: +"),
        ("fingerprint: ", "fingerprint: 0", "is not a fingerprint", "fingerprint: 0"),
        ("    mul: ", "    mull: ", "unknown key `mull`; `operations` has the keys mul, add, sincos", "mull"),
        ("    mul: ", "    mul: -", "where a whole number is needed", "mul: -"),
        ("    double: ", "    double: about ", "where a number is needed", "double: about"),
        ("    double: ", "    double: inf # ", "found `inf` where a number is needed", "double: inf"),
        ("  plan:\n", "  plam:\n", "unknown key `plam`", "plam"),
        ("    joints:\n", "    jonts:\n", "unknown key `jonts`", "jonts"),
        ("    joints:\n", "    joints:\n    - {}\n", "7 joints", "    joints:"),
        ("    joints:\n", "    joints:\n    - 3\n", "found `3` where a mapping (targets", "- 3"),
        ("length_scale: ", "length_scale: zz", "is not a valid scale", "length_scale: zz"),
        ("length_scale: a", "length_scale: a+", "is not a valid scale", "length_scale: a+"),
        (
            "    joints:\n",
            "    turned_last_frame: up\n    joints:\n",
            "found `up` where `true` or `false` is needed",
            "turned_last_frame: up",
        ),
        (
            "    joints:\n",
            "    joints:\n    - origin_shift: up\n",
            "`up` is not a valid origin shift; the valid words are `none`, `minus_d`",
            "origin_shift: up",
        ),
        (
            "    joints:\n",
            "    joints:\n    - on: [light]\n",
            "`light` is not a valid choice of a joint; the valid words are `axis_column`",
            "light",
        ),
        (
            "    joints:\n",
            "    joints:\n    - inward_offset: joint\n",
            "`inward_offset` must be `link` or `parent`",
            "inward_offset",
        ),
        ("    double: ", "    double: -", "is not an accuracy; an accuracy is a number of 0 or more", "double: -"),
        ("    joints:\n", "    joints:\n    - targets: [own]\n", "a list of 1 where 3 are needed", "targets: [own]"),
    ] {
        let wrong = text.replacen(from, to, 1);
        assert_ne!(wrong, text, "{from}");
        let report = PlanFile::read("ur5.plan.yaml", &wrong, &robot).unwrap_err();
        let error = report.errors().next().unwrap();
        assert!(error.message.contains(what), "{report}");
        let shown = wrong.lines().nth(error.line - 1).unwrap();
        assert!(shown.contains(line), "`{shown}` is not at fault, `{line}` is: {report}");
    }
    for (wrong, what) in [
        ("", "the plan file is empty"),
        ("\n \n", "the plan file is empty"),
        ("# nothing\n", "the file is empty; a plan file is a YAML mapping that begins with `format: 3`"),
        ("3", "found `3` where a mapping (format, robot"),
        ("- 3", "found a list of 1 where a mapping"),
        ("reduced: {plan: [\n", "this is not YAML"),
        (&"[".repeat(1 << 20), "nested more than 16 levels deep"),
        (&"{a: ".repeat(1 << 18), "nested more than 16 levels deep"),
        ("format: 3\nformat: 3\n", "repeated key `format`; it is already in line 1"),
        (&format!("{text}---\n{text}"), "a second YAML document begins here; a plan file must have exactly one"),
        (&format!("{text}reduced: {{}}\n"), "repeated key `reduced`"),
        (&format!("{text}# {}\n", "x".repeat(1 << 20)), "more than 1048576 bytes"),
    ] {
        let report = PlanFile::read("ur5.plan.yaml", wrong, &robot).unwrap_err();
        assert!(report.errors().next().unwrap().message.contains(what), "{report}");
    }
}

/// A plan of a tree is no plan of the tree whose branch begins elsewhere.
#[test]
fn the_fingerprint_of_a_tree_knows_where_its_branches_begin() {
    let fingerprint = |parent: &str, b: &str| {
        let yaml = format!(
            "{{format: 2, name: tree, source: test, convention: modified, gravity: [0, 0, -9.81], \
             tool: {{on: c}}, joints: [\n  \
             {{name: a, type: revolute, dh: {{theta: 0, d: 0, a: 0, alpha: 0}}}},\n  \
             {{name: b, type: revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}}},\n  \
             {{name: c, parent: {parent}, type: revolute, dh: {{b: {b}, theta: 0, d: 0, a: 1, alpha: pi/2}}}}]}}"
        );
        let read = rne_model::Reader::new("tree").trees().read(&yaml);
        rne_search::fingerprint(&read.unwrap_or_else(|report| panic!("{report}")).robot)
    };
    let first = fingerprint("a", "0.1");
    assert_eq!(first, fingerprint("a", "0.1"));
    assert_ne!(first, fingerprint("a", "0.2"));
    assert_ne!(first, fingerprint("base", "0.1"));
}

#[test]
fn a_slip_in_a_plan_file_is_told() {
    let robot = robot("puma560");
    let text = include_str!("../../../robots/puma560.plan.yaml");
    for (from, to, meant) in [
        ("fingerprint:", "fingerprnt:", "fingerprint"),
        ("    mul: ", "    mull: ", "mul"),
        ("moment: diagonal", "moment: diagnal", "diagonal"),
        ("- group_omega\n", "- group_omgea\n", "group_omega"),
        ("\n  inverse_dynamics:", "\n  inverse_dynamic:", "inverse_dynamics"),
    ] {
        let wrong = text.replacen(from, to, 1);
        assert_ne!(wrong, text, "{from}");
        let report = PlanFile::read("puma560.plan.yaml", &wrong, &robot).unwrap_err();
        let error = report.errors().next().unwrap();
        assert_eq!(error.help, Some(format!("did you mean `{meant}`?")), "{report}");
        assert!(to.contains(&wrong[error.span.clone()]), "{report}");
    }
}

/// Every plan file of the repository, written again by us and by serde.
#[test]
fn shipped_plan_files_survive_byte_for_byte_and_serde_agrees() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let mut count = 0;
    for folder in ["robots", "tests/dense"] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let Some(of) = rne_model::robot_of(&path) else { continue };
            let robot = Reader::new("the robot").read(&std::fs::read(of).unwrap()).unwrap().robot;
            let text = std::fs::read_to_string(&path).unwrap();
            let file = PlanFile::read(&robot.name, &text, &robot).unwrap_or_else(|report| panic!("{report}"));
            assert_eq!(file.to_yaml(), text, "{}", robot.name);

            let value: serde_yaml::Value = serde_yaml::from_str(&text).unwrap();
            let heading: String = text.split_inclusive('\n').take_while(|line| line.starts_with('#')).collect();
            assert_eq!(heading + &serde_yaml::to_string(&value).unwrap(), text, "{}", robot.name);
            assert_eq!(value["reduced"]["operations"]["mul"].as_u64(), Some(file.reduced.operations.mul as u64));
            assert_eq!(value["reduced"]["accuracy"]["single"].as_f64(), Some(file.reduced.accuracy.single));
            for (function, rewritten) in &file.rewritten {
                let value = &value["rewritten"][function.name()];
                assert_eq!(value["graph"].as_str(), Some(rewritten.graph.as_str()), "{} {function}", robot.name);
                assert_eq!(value["operations"]["add"].as_u64(), Some(rewritten.operations.add as u64));
            }
            let number = value["rewritten"].as_mapping().map_or(0, serde_yaml::Mapping::len);
            assert_eq!(number, file.rewritten.len(), "{}", robot.name);
            count += 1;
        }
    }
    assert!(count > 30, "{count} plan files");
}
