//! Writes the macros of `src/lib.rs`: the robots that `rne-robots` ships.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

use rne_robots::{ROBOTS, RobotFile};

#[path = "src/tried.rs"]
mod tried;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/tried.rs");
    println!("cargo::rerun-if-env-changed=RNE_EXHAUSTIVE");
    let is_exhaustive = env::var_os("RNE_EXHAUSTIVE").is_some();
    let all = listing("for_each_robot", "every shipped robot", &mut ROBOTS.iter());
    let tried = listing(
        "for_each_tried_robot",
        "those shipped robots that tests try",
        &mut ROBOTS.iter().filter(|robot| is_exhaustive || tried::is_tried(robot)),
    );
    let out = env::var_os("OUT_DIR").expect("cargo says where");
    fs::write(Path::new(&out).join("robots.rs"), all + &tried).expect("a file of our own");
}

/// A macro that calls another for some robots.
fn listing(name: &str, which: &str, robots: &mut dyn Iterator<Item = &RobotFile>) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let mut text = format!(
        "/// Calls a macro with what is given and, for {which} by the order of names, `[name, path of its \
         file]`.\n#[macro_export]\nmacro_rules! {name} {{\n    ($call:ident! $($given:tt)*) => {{\n        \
         $call! {{\n            $($given)*\n"
    );
    for robot in robots {
        let file = folder.join(robot.name).with_extension("yaml");
        let _ = writeln!(text, "            [{}, {:?}]", robot.name, file.display().to_string());
    }
    text.push_str("        }\n    };\n}\n");
    text
}
