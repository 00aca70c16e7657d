//! What an editor sees: rust-analyzer expands the derives by itself, and may not tell them their source file.

mod build;

use std::fs;
use std::path::Path;
use std::process::Command;

const ROBOT: &str = "
format: 1
name: slide
source: own numbers
convention: standard
gravity: [0, 0, -10]
joints: [{type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {mass: 2}}]
";

fn source(path: &str) -> String {
    format!(
        "use rne::InverseDynamics;\n\n#[derive(InverseDynamics)]\n#[robot(path = \"{path}\")]\npub struct Slide;\n\n\
         pub fn force() -> f64 {{\n    let [force] = Slide.gravity_torques(&[0.0_f64]);\n    force\n}}\n"
    )
}

/// The lines that rust-analyzer has to say of this package.
fn diagnostics(folder: &Path) -> Option<Vec<String>> {
    let there = Command::new("rust-analyzer").arg("--version").output();
    if !there.is_ok_and(|output| output.status.success()) {
        println!("skipped: there is no rust-analyzer (`rustup component add rust-analyzer`)");
        return None;
    }
    let output = Command::new("rust-analyzer").arg("diagnostics").arg(folder).env("CARGO_NET_OFFLINE", "true").output();
    let output = output.expect("rust-analyzer runs");
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("diagnostic scan complete"), "{said}");
    Some(said.split(['\r', '\n']).filter(|line| line.contains("crate editor,")).map(str::to_owned).collect())
}

#[test]
fn rust_analyzer_finds_the_robot_file() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("editor");
    let write = |path: &str, text: &str| {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    };
    write("Cargo.toml", &build::manifest("editor"));
    fs::copy(build::root().join("Cargo.lock"), folder.join("Cargo.lock")).expect("the workspace's lock file");
    write("robots/slide.yaml", ROBOT);
    write("src/arms/small/slide.yaml", ROBOT);
    write("src/lib.rs", &format!("{}\npub mod arms;\n", source("../robots/slide.yaml")));
    write("src/arms/mod.rs", &format!("{}\npub mod small;\npub mod wrong;\n", source("../../robots/slide.yaml")));
    write("src/arms/small/mod.rs", &source("slide.yaml"));
    write("src/arms/wrong.rs", &source("nowhere.yaml"));
    let Some(said) = diagnostics(&folder) else { return };
    let (wrong, others): (Vec<_>, Vec<_>) = said.into_iter().partition(|line| line.contains("wrong.rs"));
    assert!(others.is_empty(), "{others:#?}");
    assert!(wrong.iter().any(|line| line.contains("Error")), "the derives are not expanded: {wrong:#?}");
}
