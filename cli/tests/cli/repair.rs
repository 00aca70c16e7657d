//! `rne check --repair`: what it prints, and what it writes.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};

/// A URDF whose second line has MuJoCo's order of the numbers in the slots of a URDF.
const WRONG: &str = concat!(
    r#"<robot name="t"><link name="base"/><joint name="j1" type="revolute"><parent link="base"/><child link="body"/>"#,
    r#"<axis xyz="0 0 1"/></joint>"#,
    "\n",
    r#"<link name="body"><inertial><origin xyz="0 0 0.05"/><mass value="4.970684"/><inertia ixx="0.70337" "#,
    r#"ixy="0.70661" ixz="0.0091170" iyy="-0.00013900" iyz="0.0067720" izz="0.019169"/></inertial></link></robot>"#,
    "\n",
);

#[test]
fn the_repair_is_a_change_of_one_line() {
    let path = folder("repair").join("arm.urdf");
    fs::write(&path, WRONG).expect("written");
    let file = path.to_str().expect("UTF-8");
    let called = rne(&["check", "--repair", file]);
    let expected = format!(
        "{file}:2:77: warning: link `body`: a principal moment of inertia is below zero\n  the numbers are in MuJoCo's \
         order xx yy zz xy xz yz, not in that of URDF\n  - <inertia ixx=\"0.70337\" ixy=\"0.70661\" ixz=\"0.0091170\" \
         iyy=\"-0.00013900\" iyz=\"0.0067720\" izz=\"0.019169\"/>\n  + <inertia ixx=\"0.70337\" ixy=\"-0.00013900\" \
         ixz=\"0.0067720\" iyy=\"0.70661\" iyz=\"0.019169\" izz=\"0.0091170\"/>\n"
    );
    assert_eq!((called.status, called.out.as_str()), (1, expected.as_str()));
    assert_eq!(fs::read_to_string(&path).expect("a file"), WRONG);

    let said = fine(&["check", "--repair", "--write", file]);
    assert_eq!(said, format!("{expected}repaired {file}\n"));
    let (before, after) = (WRONG.lines(), fs::read_to_string(&path).expect("a file"));
    assert_eq!(after.len(), WRONG.len());
    let changed: Vec<usize> =
        before.zip(after.lines()).enumerate().filter(|(_, (a, b))| a != b).map(|(at, _)| at).collect();
    assert_eq!(changed, [1]);
    assert_eq!(
        fine(&["check", "--repair", file]),
        format!("ok {file}  1 link, no edit of a mass or an inertia to propose\n")
    );
}

#[test]
fn several_repairs_are_not_written() {
    let path = folder("several_repairs").join("arm.yaml");
    let good = fs::read_to_string(format!("{ROOT}/robots/puma560.yaml")).expect("a robot");
    let right = "inertia: {xx: 0.13, yy: 0.524, zz: 0.539}";
    assert!(good.contains(right));
    let bad = good.replace(right, "inertia: {xx: 0.1, yy: 0.1, zz: 1}");
    fs::write(&path, &bad).expect("written");
    let file = path.to_str().expect("UTF-8");
    let parts =
        ["edits are equally good", "1. xx is too small", "2. yy is too small", "- inertia: {", "is not changed"];
    let called = rne(&["check", "--repair", "--write", file]);
    assert_eq!(called.status, 1);
    for part in parts {
        assert!(called.out.contains(part), "no `{part}` in {}", called.out);
    }
    assert_eq!(fs::read_to_string(&path).expect("a file"), bad);
    assert_eq!(
        fine(&["check", "--repair", "puma560"]),
        "ok puma560  6 links, no edit of a mass or an inertia to propose\n"
    );
    fails(2, &["check", "--write", file], &["--repair"]);
    fails(1, &["check", "--repair", "nothing.yaml"], &["there is no robot file nothing.yaml"]);
}
