//! Blocks of documents, and what each contains.

use crate::programs::{code, control, embedded, functions, stubs, two_hands};
use crate::tables::{headline, robots, sources, trees, tricks};
use crate::{read, root};

/// The documents with blocks, and which blocks these are; what is measured or printed by a command does not count.
const DOCUMENTS: &[(&str, &[&str])] = &[
    ("docs/firmware/c-library.md", &["controller"]),
    ("doors/python/package/rne/__init__.pyi", &["stubs"]),
    ("README.md", &["headline", "example", "control"]),
    ("docs/firmware/first-firmware.md", &["torque", "config", "embedded"]),
    ("docs/reference/functions.md", &["functions", "two_hands"]),
    ("docs/measured/performance.md", &["tricks"]),
    (
        "docs/robot-file.md",
        &[
            "desk_arm",
            "two_bars",
            "frames",
            "tree",
            "gripper",
            "palletiser",
            "four_bar",
            "wam7_motors",
            "bodies",
            "tips",
            "satellite",
            "contacts",
        ],
    ),
    ("docs/teaching/for-teachers.md", &["code"]),
    ("robots/README.md", &["sources", "robots", "trees"]),
];

/// The lines of a robot file from the first that begins with `from` to the one before the next that begins with `to`.
fn part(file: &str, from: &str, to: Option<&str>) -> String {
    let text = read(&root().join(file));
    let lines = text.lines().skip_while(|line| !line.starts_with(from));
    let lines: Vec<&str> = lines.take_while(|line| to.is_none_or(|to| !line.starts_with(to))).collect();
    assert!(!lines.is_empty() && to.is_none_or(|to| text.contains(to)), "{file}: from {from} to {to:?}");
    format!("```yaml\n{}\n```\n", lines.join("\n"))
}

/// The text of a block of a document.
fn block(name: &str) -> String {
    match name {
        "example" => format!("```rust\n{}```\n", read(&root().join("examples/puma560.rs"))),
        "control" => control(),
        "two_hands" => two_hands(),
        "controller" => format!("```c\n{}```\n", read(&root().join("doors/c/examples/controller.c"))),
        "torque" => format!("```rust\n{}```\n", read(&root().join("cli/src/commands/firmware/main.rs"))),
        "config" => {
            let config = read(&root().join("cli/src/commands/firmware/config.toml"));
            let lines = config.lines().filter(|line| !line.trim_start().starts_with('#'));
            lines.fold("```toml\n".to_owned(), |text, line| text + line + "\n") + "```\n"
        }
        "two_bars" => part("docs/two_bars.yaml", "    link: {first_moment", None),
        "frames" => part("docs/desk_arm_frames.yaml", "frames:", Some("joints:")),
        "tree" => part("docs/tree.yaml", "  - name: left", Some("    link:")),
        "gripper" => part("docs/gripper.yaml", "couplings:", None),
        "palletiser" => part("docs/palletiser.yaml", "loops:", None),
        "four_bar" => part("docs/four_bar.yaml", "loops:", None),
        "wam7_motors" => part("robots/trees/wam7_coupled.yaml", "motors:", Some("  - {name: m4")),
        "bodies" => part("docs/dual_arm.yaml", "  - name: camera", None),
        "tips" => part("docs/dual_arm.yaml", "frames:", Some("joints:")),
        "satellite" => part("docs/satellite.yaml", "floating_base:", Some("joints:")),
        "contacts" => part("docs/standing_hyq.yaml", "tips:", Some("  - {tip: rf_foot")),
        "desk_arm" => format!("```yaml\n{}```\n", read(&root().join("docs/desk_arm.yaml"))),
        "headline" => headline(),
        "code" => code(),
        "sources" => sources(),
        "robots" => robots(),
        "trees" => trees(),
        "functions" => functions(),
        "stubs" => stubs(),
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
