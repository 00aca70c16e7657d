//! Lists the robot files in this folder and in `trees`. To ship a robot, its file only has to be added here.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo says where"));
    println!("cargo::rerun-if-changed={}", folder.display());
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo says where"));
    for (list, folder) in [("robots.rs", folder.clone()), ("trees.rs", folder.join("trees"))] {
        fs::write(out.join(list), texts(&folder)).expect("a file of our own");
    }
}

/// Returns Rust code of a list of the robot files in a folder, with their plans.
fn texts(folder: &Path) -> String {
    let mut text = String::from("&[\n");
    for name in robots(folder) {
        let path = |extension: &str| folder.join(format!("{name}.{extension}"));
        let yaml = path("yaml").display().to_string();
        let plan = Some(path("plan.yaml")).filter(|plan| plan.is_file());
        let plan =
            plan.map_or("None".to_owned(), |plan| format!("Some(include_str!({:?}))", plan.display().to_string()));
        let _ = writeln!(text, "    RobotFile {{ name: {name:?}, yaml: include_str!({yaml:?}), plan: {plan} }},");
    }
    text + "]\n"
}

/// Returns the names of the robot files in a folder, sorted. Plan files, `NAME.plan.yaml`, are not robot files.
fn robots(folder: &Path) -> Vec<String> {
    let files = fs::read_dir(folder).expect("the folder of robots").map(|entry| entry.expect("an entry").path());
    let named = files.filter_map(|file| Some(file.file_name()?.to_str()?.strip_suffix(".yaml")?.to_owned()));
    let mut names: Vec<String> = named.filter(|name| !name.contains('.')).collect();
    names.sort();
    names
}
