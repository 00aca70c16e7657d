//! Writes the table of the PUMA 560 as a Rust constant, which firmware with the generic recursion includes in its
//! image.

use std::path::Path;
use std::{env, fs};

use rne_model::Robot;

fn main() {
    let file = "../../robots/puma560.yaml";
    println!("cargo::rerun-if-changed={file}");
    let text = fs::read_to_string(file).expect("the robot file");
    let robot = Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"));
    let model = robot.model::<6>().expect("six joints").to_f32();
    // The `Debug` output of plain data is valid Rust code.
    let constant = format!("/// The table of `{file}`.\npub const PUMA560: Model<6, f32> = {model:?};\n");
    let folder = env::var_os("OUT_DIR").expect("cargo says where");
    fs::write(Path::new(&folder).join("puma560.rs"), constant).expect("a file of our own");
}
