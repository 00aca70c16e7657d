//! Writes the macro of `src/lib.rs`: the robots that `rne-robots` ships.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    println!("cargo::rerun-if-changed=build.rs");
    let mut text = String::from(
        "/// Calls a macro with what is given and, for every shipped robot by the order of names, `[name, path of its \
         file]`.\n#[macro_export]\nmacro_rules! for_each_robot {\n    ($call:ident! $($given:tt)*) => {\n        \
         $call! {\n            $($given)*\n",
    );
    for robot in rne_robots::ROBOTS {
        let file = folder.join(robot.name).with_extension("yaml");
        let _ = writeln!(text, "            [{}, {:?}]", robot.name, file.display().to_string());
    }
    text.push_str("        }\n    };\n}\n");
    let out = env::var_os("OUT_DIR").expect("cargo says where");
    fs::write(Path::new(&out).join("robots.rs"), text).expect("a file of our own");
}
