//! Robots by name, and files to start from: `rne list`, `rne example`, `rne new`.

use std::fs;

use crate::call::{ROOT, command, fails, fine, folder, rne};

#[test]
fn every_robot_of_the_folder_is_listed() {
    let list = fine(&["list"]);
    let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let robots = |folder: &str| {
        let mut files: Vec<String> = fs::read_dir(format!("{ROOT}/{folder}"))
            .expect("a folder of robots")
            .filter_map(|entry| Some(entry.expect("an entry").file_name().to_str()?.strip_suffix(".yaml")?.to_owned()))
            .filter(|name| !name.contains('.'))
            .collect();
        files.sort();
        files
    };
    assert_eq!(names, [robots("robots"), robots("robots/trees")].concat());
    assert!(list.contains("puma560") && list.contains("RRRRRR, standard"), "{list}");
    assert!(list.contains("RRRRRRRPP, modified") && list.contains("Panda with its hand"), "{list}");
}

#[test]
fn an_example_is_the_file() {
    let file = |name: &str| fs::read_to_string(format!("{ROOT}/robots/{name}")).expect("a file");
    assert_eq!(fine(&["example", "puma560"]), file("puma560.yaml"));
    assert_eq!(fine(&["example", "puma560", "--plan"]), file("puma560.plan.yaml"));
    fails(1, &["example", "puma"], &["no shipped robot `puma`", "puma560"]);
}

#[test]
fn a_name_is_a_robot_with_its_plan() {
    for arguments in [&["ops"][..], &["show", "--joint", "3"], &["emit", "--form", "reduced"]] {
        let [command, rest @ ..] = arguments else { unreachable!() };
        let of = |robot| fine(&[&[*command, robot], rest].concat());
        let (file, name) = (of("robots/puma560.yaml"), of("puma560"));
        assert_eq!(file.replace("robots/puma560.yaml", "puma560"), name);
    }
    let eval = |robot| fine(&["eval", robot, "--q", "0.1,0.2", "--qd", "0,0", "--qdd", "0,0", "--json"]);
    assert_eq!(eval("planar2"), eval("robots/planar2.yaml"));
}

#[test]
fn a_file_comes_before_a_name() {
    let folder = folder("a_file_of_a_name");
    let planar1 = fs::read_to_string(format!("{ROOT}/robots/planar1.yaml")).expect("a robot");
    fs::write(folder.join("puma560"), planar1).expect("written");
    let out = command(&["check", "puma560"]).current_dir(&folder).output().expect("rne starts");
    assert!(String::from_utf8_lossy(&out.stdout).contains("planar1, R, standard"), "{out:?}");
}

#[test]
fn nothing_is_searched_for_a_name() {
    fails(2, &["search", "planar2", "--seconds", "0"], &["needs a file", "rne example planar2"]);
}

#[test]
fn a_new_file_is_written_once() {
    let folder = folder("new");
    let new = |arguments: &[&str]| {
        let out = command(&[&["new", "my_arm", "--dof", "3"], arguments].concat())
            .current_dir(&folder)
            .output()
            .expect("rne starts");
        (out.status.code(), String::from_utf8(out.stderr).expect("UTF-8"))
    };
    let (status, said) = new(&["--prismatic", "3"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("rne check my_arm.yaml"), "{said}");
    let text = fs::read_to_string(folder.join("my_arm.yaml")).expect("it is there");
    assert!(text.contains("type: prismatic") && text.lines().all(|line| line.chars().count() <= 120), "{text}");
    let (status, said) = new(&[]);
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("is not changed"), "{said}");
    assert_eq!(fs::read_to_string(folder.join("my_arm.yaml")).expect("it is there"), text);
    let file = folder.join("my_arm.yaml");
    let out = fine(&["check", file.to_str().expect("UTF-8")]);
    assert!(out.contains("my_arm, RRP, standard") && !out.contains("warning"), "{out}");
}

#[test]
fn wrong_requests_for_a_new_file() {
    for (arguments, said) in [
        (&["My-Arm", "--dof", "3"][..], "small letters"),
        (&["arm", "--dof", "0"], "0 is not in 1..=64"),
        (&["arm", "--dof", "65"], "65 is not in 1..=64"),
        (&["arm", "--dof", "2", "--prismatic", "3"], "there is no joint 3"),
        (&["arm"], "--dof"),
    ] {
        let called = rne(&[&["new"], arguments].concat());
        assert_eq!(called.status, 2, "{called:?}");
        assert!(called.err.contains(said), "{called:?}");
    }
}
