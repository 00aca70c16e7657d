//! Writes the macro of `src/lib.rs`: the files of robots/ as they are now.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut text = String::from(
        "/// Calls a macro with what is given and, for every shipped robot by the order of names, `[name, path of its \
         file]`.\n#[macro_export]\nmacro_rules! for_each_robot {\n    ($call:ident! $($given:tt)*) => {\n        \
         $call! {\n            $($given)*\n",
    );
    for (name, file) in robots(&folder) {
        let _ = writeln!(text, "            [{name}, {file:?}]");
    }
    text.push_str("        }\n    };\n}\n");
    let out = env::var_os("OUT_DIR").expect("cargo says where");
    fs::write(Path::new(&out).join("robots.rs"), text).expect("a file of our own");
}

/// Names and files. What is `NAME.plan.yaml` is no robot.
fn robots(folder: &Path) -> Vec<(String, String)> {
    let files = fs::read_dir(folder).expect("the folder of robots").map(|entry| entry.expect("an entry").path());
    let named = files.filter_map(|file| {
        let name = file.file_name()?.to_str()?.strip_suffix(".yaml")?.to_owned();
        let file = file.to_str()?.to_owned();
        (!name.contains('.')).then_some((name, file))
    });
    let mut robots: Vec<(String, String)> = named.collect();
    robots.sort();
    robots
}
