//! Blocks of documents, and what each contains.

use crate::programs::{code, control, embedded, functions, stubs, two_hands};
use crate::tables::{headline, operations, robots, sources, trees, tricks};
use crate::{read, root};

/// The documents with blocks, and which blocks these are; what is measured or printed by a command does not count.
const DOCUMENTS: &[(&str, &[&str])] = &[
    ("docs/firmware/c-library.md", &["controller"]),
    ("doors/python/package/rne/__init__.pyi", &["stubs"]),
    ("README.md", &["headline", "example", "control", "twelve_lines"]),
    ("docs/firmware/first-firmware.md", &["torque", "config", "embedded"]),
    ("docs/reference/functions.md", &["functions", "two_hands"]),
    ("docs/measured/performance.md", &["operations", "tricks"]),
    ("docs/control/ros2.md", &["ros2_controller"]),
    (
        "docs/robot-file.md",
        &[
            "frames",
            "tree",
            "gripper",
            "palletiser",
            "four_bar",
            "wam7_motors",
            "two_hands",
            "dual_arm",
            "satellite",
            "two_bars",
            "desk_arm",
            "every_key",
        ],
    ),
    ("docs/teaching/for-teachers.md", &["code"]),
    ("robots/README.md", &["sources", "robots", "trees"]),
];

/// The text of a block of a document.
fn block(name: &str) -> String {
    match name {
        "example" => format!("```rust\n{}```\n", read(&root().join("examples/puma560.rs"))),
        "control" => control(),
        "two_hands" => two_hands(),
        "ros2_controller" => {
            format!("```cpp\n{}```\n", read(&root().join("doors/c/examples/ros2_control/gravity_controller.cpp")))
        }
        "controller" => format!("```c\n{}```\n", read(&root().join("doors/c/examples/controller.c"))),
        "torque" => format!("```rust\n{}```\n", read(&root().join("cli/src/commands/firmware/main.rs"))),
        "config" => {
            let config = read(&root().join("cli/src/commands/firmware/config.toml"));
            let lines = config.lines().filter(|line| !line.trim_start().starts_with('#'));
            lines.fold("```toml\n".to_owned(), |text, line| text + line + "\n") + "```\n"
        }
        "frames" => {
            let file = read(&root().join("docs/desk_arm_frames.yaml"));
            let list = file.lines().skip_while(|line| !line.starts_with("frames:"));
            let list: Vec<&str> = list.take_while(|line| !line.starts_with("joints:")).collect();
            format!("```yaml\n{}\n```\n", list.join("\n"))
        }
        "wam7_motors" => {
            let file = read(&root().join("robots/trees/wam7_coupled.yaml"));
            let list: Vec<&str> = file.lines().skip_while(|line| !line.starts_with("motors:")).collect();
            format!("```yaml\n{}\n```\n", list.join("\n"))
        }
        "desk_arm" | "tree" | "gripper" | "palletiser" | "four_bar" | "dual_arm" | "satellite" | "two_bars" => {
            format!("```yaml\n{}```\n", read(&root().join(format!("docs/{name}.yaml"))))
        }
        "every_key" => format!("```yaml\n{}```\n", read(&root().join("docs/every-key.yaml"))),
        "headline" => headline(),
        "twelve_lines" => code(2),
        "code" => code(5),
        "sources" => sources(),
        "robots" => robots(),
        "trees" => trees(),
        "functions" => functions(),
        "stubs" => stubs(),
        "operations" => operations(),
        "tricks" => tricks(),
        "embedded" => embedded(),
        name => panic!("no block is called `{name}`"),
    }
}

/// A document with every block as it should be, and the names of the blocks.
fn renewed(document: &str) -> (String, Vec<String>) {
    let (mut text, mut names) = (String::new(), Vec::new());
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        text.push_str(line);
        text.push('\n');
        let marker = line.trim_start_matches([' ', '#']);
        if let Some(heading) = marker.strip_prefix("<!-- begin: ") {
            let name = heading.split([',', ' ']).next().unwrap_or_default();
            let end = format!("{}<!-- end -->", line.strip_suffix(marker).unwrap_or_default());
            let written: Vec<&str> = lines.by_ref().take_while(|line| *line != end).collect();
            match name {
                "measured" | "output" => written.iter().for_each(|line| {
                    text.push_str(line);
                    text.push('\n');
                }),
                name => {
                    text.push_str(&block(name));
                    names.push(name.to_owned());
                }
            }
            text.push_str(&end);
            text.push('\n');
        }
    }
    (text, names)
}

#[test]
fn documents_say_what_the_code_prints() {
    for (name, blocks) in DOCUMENTS {
        let path = root().join(name);
        let document = read(&path);
        let (renewed, found) = renewed(&document);
        assert_eq!(found, *blocks, "the blocks of {name}");
        if std::env::var_os("RNE_WRITE_DOCUMENTS").is_some() {
            std::fs::write(&path, &renewed).expect("a writable file");
        } else {
            let help = "RNE_WRITE_DOCUMENTS=1 cargo test --test documents";
            for (at, (old, new)) in document.lines().zip(renewed.lines()).enumerate() {
                assert_eq!(old, new, "{name}:{}: {help}", at + 1);
            }
            assert_eq!(document.len(), renewed.len(), "{name}: {help}");
        }
    }
}
