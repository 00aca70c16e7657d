//! `rne firmware`: writes a folder with a firmware that computes a robot's torques.
//!
//! The written files are those of the folder `firmware/` beside this source file. They are the same as
//! `firmware/example`, a firmware for the PUMA 560; for another robot, [`files`] replaces a few lines.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_codegen::{Form, Function};
use rne_model::{Robot, did_you_mean, plan_of};

use crate::files::output_file::unwritable;
use crate::files::output_folder;
use crate::files::plan_file::{self, Compiler};
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TYPED};

/// Write a folder with a firmware for Cortex-M that computes torques
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne firmware torque                      the folder torque, for the PUMA 560
  rne firmware ur5                         for the shipped robot ur5
  rne firmware desk --robot my_arm.yaml -o desk_firmware

Until rne is published, add --rne-path with the folder of its repository.

Commands that run the firmware, in its folder:
  rustup target add thumbv7em-none-eabihf
  sudo apt-get install --yes qemu-system-arm
  cargo run --release

The folder of -o must be empty or must not exist: rne overwrites nothing.")]
pub(crate) struct Arguments {
    /// Name of the firmware crate: letters, digits, - and _
    #[arg(value_name = "NAME", value_parser = name)]
    name: String,
    /// Robot file, or name of a shipped robot [default: the shipped robot NAME, else puma560]
    #[arg(long, value_name = "FILE")]
    robot: Option<PathBuf>,
    /// Folder to create for the firmware [default: NAME]
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Take rne from this folder, a clone of its repository, instead of the registry of crates
    #[arg(long, value_name = "PATH")]
    rne_path: Option<PathBuf>,
}

/// Names that the crate cannot have: those of its dependencies, of crates that Rust always has, and of folders that
/// cargo makes.
const TAKEN: [&str; 15] = [
    "rne",
    "cortex-m",
    "cortex-m-rt",
    "cortex-m-semihosting",
    "panic-semihosting",
    "core",
    "std",
    "alloc",
    "test",
    "proc-macro",
    "build",
    "deps",
    "examples",
    "incremental",
    "self",
];

fn name(text: &str) -> Result<String, String> {
    let starts_well = text.starts_with(|c: char| c.is_ascii_alphabetic());
    if !starts_well || !text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') || text.len() > 64 {
        return Err("a crate's name has letters, digits, - and _, 64 at most, and starts with a letter".to_owned());
    }
    if TAKEN.contains(&text.replace('_', "-").as_str()) {
        return Err("this name is reserved; choose another, such as torque".to_owned());
    }
    Ok(text.to_owned())
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let folder = arguments.output.clone().unwrap_or_else(|| PathBuf::from(&arguments.name));
    output_folder::is_free(&folder, "a firmware")?;
    let dependency = dependency(arguments.rne_path.as_deref())?;
    let robot_file = robot_of(arguments)?;
    let (checked, bytes) = robot_file::read_with_run_time(&robot_file, &[], Frames::Dropped, Shape::Coupled)?;
    let robot = checked.robot;
    let yaml = String::from_utf8(bytes).map_err(|error| Failure::input(error.utf8_error()))?;
    let plan = plan_file::read(&robot_file, &robot)?.map(|read| read.text);
    // Compiles now what the build of the firmware would refuse later.
    Compiler::new(&robot_file, &robot).compile(Function::InverseDynamics, Form::Reduced)?;

    let mut files = files(&arguments.name, &robot, &dependency);
    files.push((ROBOT.into(), yaml));
    files.extend(plan.map(|plan| (plan_of(Path::new(ROBOT)), plan)));
    output_folder::write(&folder, &files).map_err(|(path, error)| unwritable(&path, &error))?;
    Ok(Outcome::remark(next(&folder, &files, &robot_file)))
}

/// The robot of a firmware if its name is not that of a shipped robot.
const DEFAULT: &str = "puma560";

/// Returns the robot file or name that the command line gives; else the shipped robot with the name of the firmware, or
/// the default robot. A name that is nearly that of a shipped robot is an error.
fn robot_of(arguments: &Arguments) -> Result<PathBuf, Failure> {
    if let Some(robot) = &arguments.robot {
        return Ok(robot.clone());
    }
    let name = &arguments.name;
    if let Some(robot) = rne_robots::find(name) {
        return Ok(robot.name.into());
    }
    let names: Vec<&str> = rne_robots::all().map(|robot| robot.name).collect();
    let begun = || names.iter().copied().find(|known| name.len() > 2 && known.starts_with(name.as_str()));
    match did_you_mean(name, names.iter().copied()).or_else(begun) {
        None => Ok(DEFAULT.into()),
        Some(near) => Err(usage_error!(
            "there is no shipped robot {name}; did you mean {TYPED}--robot {near}{TYPED:#}? {name} is then the name of \
             the crate; for the PUMA 560, write {TYPED}--robot {DEFAULT}{TYPED:#}"
        )),
    }
}

/// The line for `rne` in the manifest of the template.
const PUBLISHED: &str = "rne = { version = \"0.1\", default-features = false }";

/// Returns the line for `rne` in the manifest: a path to a clone of its repository, or a version from the registry.
fn dependency(clone: Option<&Path>) -> Result<String, Failure> {
    let Some(clone) = clone else { return Ok(PUBLISHED.to_owned()) };
    let is_rne = fs::read_to_string(clone.join("Cargo.toml")).is_ok_and(|text| text.contains("\nname = \"rne\"\n"));
    let path = std::path::absolute(clone).ok().filter(|_| is_rne);
    let path = path.as_deref().and_then(Path::to_str).ok_or_else(|| {
        usage_error!(
            "{} is not a clone of the rne repository, whose Cargo.toml contains the package rne; name the \
             folder of a clone",
            clone.display()
        )
    })?;
    // TOML reads a JSON string as the same string
    let path = serde_json::Value::from(path);
    Ok(format!("rne = {{ path = {path}, default-features = false }}"))
}

/// The name of the robot file in the folder.
const ROBOT: &str = "robot.yaml";

/// Makes the files from the template. They differ in the name of the crate, the place of `rne`, the number of joints
/// and the title of the robot.
fn files(name: &str, robot: &Robot, dependency: &str) -> Vec<(PathBuf, String)> {
    let manifest = include_str!("firmware/manifest.toml")
        .replacen("name = \"firmware\"", &format!("name = \"{name}\""), 1)
        .replacen(PUBLISHED, dependency, 1);
    let main = include_str!("firmware/main.rs").replacen(
        "const JOINTS: usize = 6;",
        &format!("const JOINTS: usize = {};", robot.dof()),
        1,
    );
    let readme = include_str!("firmware/README.md").replacen("# firmware", &format!("# {name}"), 1).replacen(
        "TITLE",
        &rne_emit::markdown(&rne_emit::title(robot)),
        1,
    );
    let files = [
        ("README.md", readme),
        ("Cargo.toml", manifest),
        (".cargo/config.toml", include_str!("firmware/config.toml").to_owned()),
        ("memory.x", include_str!("firmware/memory.x").to_owned()),
        ("build.rs", include_str!("firmware/build.rs").to_owned()),
        ("src/main.rs", main),
    ];
    files.map(|(file, text)| (file.into(), text)).into()
}

/// Returns text that lists the robot, the files, and the commands to type next.
fn next(folder: &Path, files: &[(PathBuf, String)], robot: &Path) -> String {
    let mut text = format!("robot: {}\n", robot.display());
    for (file, _) in files {
        let _ = writeln!(text, "{GOOD}wrote{GOOD:#} {}", folder.join(file).display());
    }
    text.push_str("\nnext:\n\n");
    let _ = writeln!(text, "  {TYPED}cd {}{TYPED:#}", robot_file::shell(folder));
    for command in commands() {
        let _ = writeln!(text, "  {TYPED}{command}{TYPED:#}");
    }
    text
}

/// Returns the commands that the README of the template contains.
fn commands() -> impl Iterator<Item = &'static str> {
    let (_, below) = include_str!("firmware/README.md").split_once("```sh\n").unwrap_or_default();
    let lines = below.lines().take_while(|line| *line != "```");
    lines.filter_map(|line| line.split(" #").next()).map(str::trim)
}
