//! `rne emit --names`: the index of each joint under its name.

use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};
use crate::emit_c::{path, printed};

const ROBOT: &str = "robots/puma560.yaml";
const TREE: &str = "docs/tree.yaml";

/// The names of the joints of a file, in its order.
fn joints(file: &str) -> Vec<String> {
    let text = fs::read_to_string(format!("{ROOT}/{file}")).expect("a file");
    let names = text.lines().filter_map(|line| line.trim_start().strip_prefix("- name: "));
    names.map(|name| name.split_whitespace().next().expect("a name").to_owned()).collect()
}

#[test]
fn c_has_the_index_of_each_joint() {
    for (file, prefix, option) in [(ROBOT, "PUMA560", Some("--names")), (TREE, "TORSO", None)] {
        let folder = folder(&format!("c_names_{prefix}"));
        let out = path(&folder, "arm.c");
        let emit = ["emit", file, "--lang", "c", "-o", &out].into_iter().chain(option).collect::<Vec<_>>();
        assert_eq!(rne(&emit).status, 0, "{file}");
        let joints = joints(file);
        let indices: Vec<String> =
            joints.iter().map(|name| format!("(int){prefix}_JOINT_{}", name.to_uppercase())).collect();
        let format = vec!["%d"; joints.len()].join(" ");
        let main = format!(
            "#include <stdio.h>\n#include \"arm.h\"\nint main(void)\n{{\n    \
             printf(\"{format}\", {});\n    return 0;\n}}\n",
            indices.join(", ")
        );
        fs::write(folder.join("main.c"), main).expect("written");
        let Some(found) = printed(&folder, &["main.c", "arm.c"], &[]) else { return };
        let expected: Vec<String> = (0..joints.len()).map(|joint| joint.to_string()).collect();
        assert_eq!(found, expected.join(" "), "{file}");
    }
}

#[test]
fn code_of_a_chain_has_indices_on_request_alone() {
    let plain = fine(&["emit", ROBOT, "--lang", "c"]);
    assert!(!plain.contains("_JOINT_"), "{plain}");
    let named = fine(&["emit", ROBOT, "--lang", "c", "--names"]);
    let (before, rest) = named.split_once("\n/// Indices of the joints").expect("the constants");
    let (_, after) = rest.split_once("};\n\n").expect("their end");
    assert_eq!(before.to_owned() + after, plain, "all else is as it was");
    let plain = fine(&["emit", ROBOT]);
    assert_eq!(fine(&["emit", ROBOT, "--names"]).strip_prefix(&plain), Some(RUST_NAMES));
    assert!(fine(&["emit", TREE]).contains("pub enum Joint {\n    /// waist\n    Waist,\n"));
}

const RUST_NAMES: &str = "
/// The joints; `joint as usize` is the index of a joint in arrays.
#[allow(clippy::enum_variant_names)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Joint {
    /// j1
    J1,
    /// j2
    J2,
    /// j3
    J3,
    /// j4
    J4,
    /// j5
    J5,
    /// j6
    J6,
}

/// The names of the joints, in the order of arrays.
pub const JOINTS: [&str; 6] = [\"j1\", \"j2\", \"j3\", \"j4\", \"j5\", \"j6\"];
";

/// A chain is written without the identifiers, which it does not need then.
#[test]
fn two_names_of_one_identifier_are_an_error_where_it_is_written() {
    let folder = folder("one_identifier");
    for (file, is_tree) in [(ROBOT, false), (TREE, true)] {
        let text = fs::read_to_string(format!("{ROOT}/{file}")).expect("a file");
        let joints = joints(file);
        let (first, last) = (&joints[0], joints.last().expect("joints"));
        let robot = path(&folder, "robot.yaml");
        let clash = first.to_uppercase();
        let name = format!("- name: {last}");
        let at = text.find(&name).expect("the name") + "- name: ".len();
        let line = text[..at].matches('\n').count() + 1;
        fs::write(&robot, text.replace(&name, &format!("- name: {clash}"))).expect("written");
        let place = format!("robot.yaml:{line}:");
        let words = [&*place, "give the same identifier", first, &clash];
        for lang in ["c", "rust"] {
            fails(1, &["emit", &robot, "--lang", lang, "--names"], &words);
            if is_tree {
                fails(1, &["emit", &robot, "--lang", lang], &words);
            } else {
                fine(&["emit", &robot, "--lang", lang]);
            }
        }
        fine(&["check", &robot]);
    }
}
