//! Identifiers of joints: one for each joint, or an error at the line of the second name.

use rne_model::{Checked, Reader};

fn read(names: &[&str]) -> Checked {
    let joint = |name: &&str| format!("- {{name: {name:?}, type: revolute, dh: {{theta: 0, d: 0, a: 1, alpha: 0}}}}\n");
    let joints: String = names.iter().map(joint).collect();
    let text =
        format!("format: 1\nname: x\nsource: own\nconvention: standard\ngravity: [0, 0, -9.81]\njoints:\n{joints}");
    Reader::new("x.yaml").read(&text).unwrap_or_else(|report| panic!("{report}"))
}

#[test]
fn each_joint_has_an_identifier() {
    let identifiers = read(&["lf_haa_joint", "lf-hfe", "Self"]).identifiers.expect("three names");
    assert_eq!(identifiers.iter().map(|it| &*it.camel_case).collect::<Vec<_>>(), ["LfHaaJoint", "LfHfe", "JointSelf"]);
    assert_eq!(identifiers.iter().map(|it| &*it.upper_case).collect::<Vec<_>>(), ["LF_HAA_JOINT", "LF_HFE", "SELF"]);
}

/// The file stays valid; two names that give one identifier of Rust or of C are told apart by no generated name.
#[test]
fn one_identifier_of_two_names_is_an_error_at_the_second() {
    for (names, identifier) in [
        (["a-b", "a_b"], "AB"),
        // of Rust alone: LF_HAA and LFHAA are two constants of C
        (["lf_haa", "lfHaa"], "LfHaa"),
        // of C alone: LfHaa and Lfhaa are two variants of Rust
        (["lfHaa", "lfhaa"], "LFHAA"),
        (["1", "joint 1"], "Joint1"),
    ] {
        let checked = read(&names);
        assert_eq!(checked.robot.dof(), 2);
        let report = checked.identifiers.expect_err("one identifier");
        let [first, second] = names;
        let expected = format!(
            "x.yaml:8:10: error: the names `{first}` of joint 1 and `{second}` of joint 2 give the same identifier \
             `{identifier}` in generated code"
        );
        assert_eq!(report.short(), expected);
    }
}

/// Names with numbers in several places, as those of hands.
#[test]
fn numbers_stay_apart() {
    let identifiers = read(&["finger_1_1", "finger_11", "1.1", "11"]).identifiers.expect("four names");
    let camel_case: Vec<&str> = identifiers.iter().map(|it| it.camel_case.as_str()).collect();
    assert_eq!(camel_case, ["Finger1_1", "Finger11", "Joint1_1", "Joint11"]);
}
