//! The mistakes that everybody makes once, each with its whole message: what is wrong, where, what to write instead.
//! `INSTA_UPDATE=always cargo test -p rne-model --test everyday` writes the snapshots.

use std::fmt::Write as _;

use crate::common;
use crate::common::{found, with};

/// The messages of the valid file with one passage replaced.
fn messages(cases: &[(&str, &str)]) -> String {
    let mut text = String::new();
    for (old, new) in cases {
        let shown = new.replace('\n', "⏎");
        let _ = writeln!(text, "─── {shown}\n\n{}\n", found(&with(old, new)));
    }
    text
}

#[test]
fn numbers() {
    insta::assert_snapshot!(messages(&[
        ("alpha: pi/2", "alpha: 90 deg"),
        ("alpha: pi/2", "alpha: 90°"),
        ("mass: 2.5", "mass: 1.98 kg"),
        ("d: 0.4", "d: 400 mm"),
        ("d: 0.4", "d: 400mm"),
        ("mass: 2.5", "mass: 1,98"),
        ("d: 0.4", "d: 0,4"),
        ("com: [0, 0, 0.3]", "com: [0 -0.02 0]"),
        ("com: [0, 0, 0.3]", "com: 0 -0.02 0"),
        ("com: [0, 0, 0.3]", "com: [0, 0, 0,3]"),
    ]));
}

#[test]
fn keys() {
    insta::assert_snapshot!(messages(&[
        ("{theta: 0, d: 0.4", "{theta:0, d: 0.4"),
        ("{theta: 0, d: 0.4", "{theta: 0, d:0.4"),
        ("mass: 2.5", "mass:2.5"),
        ("position: [-pi, pi]", "lower: -pi, upper: pi"),
        ("position: [-pi, pi]", "upper: pi"),
    ]));
}

#[test]
fn joints() {
    let robot = |joint: &str| {
        let joint = joint.replace('…', "type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 0.5}");
        format!("format: 1\nname: x\nsource: x\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n{joint}")
    };
    let mut text = messages(&[
        ("revolute", "fixed"),
        ("prismatic", "floating"),
        // a list that begins as a mapping
        ("  - name: first", "  1:\n    name: first"),
    ]);
    for joint in ["  1: {…}", "  - 1: {…}", "  - elbow: {…}", "  - {1: , …}"] {
        let _ = writeln!(text, "─── {joint}\n\n{}\n", found(&robot(joint)));
    }
    insta::assert_snapshot!(text);
}

#[test]
fn other_formats() {
    let mut text = String::new();
    for file in [
        "<?xml version=\"1.0\"?>\n<robot name=\"arm\">\n  <link name=\"base\"/>\n</robot>\n",
        "\u{FEFF}\n<!-- from CAD -->\n<robot name=\"arm\"/>",
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n  <xacro:include filename=\"arm.xacro\"/>",
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"arm\">\n  <link name=\"${prefix}base\"/>",
        // what xacro has written
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"arm\">\n  <link name=\"base\"/>",
        "<?xml version=\"1.0\"?>\n<mujoco/>",
    ] {
        let _ = writeln!(text, "{}\n", found(file));
    }
    insta::assert_snapshot!(text);
    // what merely begins with such a character is for YAML to read
    assert!(!found("<<: {a: 1}").to_string().contains("XML"));
    assert!(!rne_model::is_urdf(common::BASE));
}
