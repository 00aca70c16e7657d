//! Documents are true: what stands between `<!-- begin: NAME … -->` and `<!-- end -->` is what the code prints today.
//!
//! With `RNE_WRITE_DOCUMENTS` set, the blocks are written anew. What is measured (`<!-- begin: measured NAME … -->`)
//! stays as it is: `cargo xtask performance` writes it. What a command prints (`<!-- begin: output … -->`) is for
//! `cli/tests/cli/documents.rs`, which runs it. In the stubs of Python the markers are comments. And what the
//! documents lead to is there: links, files, tests.

mod blocks;
mod links;
mod pages;
mod programs;
mod repository;
mod tables;

use std::path::{Path, PathBuf};

use rne_codegen::{Compiler, Form, Function, Program};
use rne_model::{Reader, Robot};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn robot(path: &Path) -> Robot {
    let read = Reader::new("robot").trees().couplings().loops().read(&read(path));
    read.unwrap_or_else(|report| panic!("{}: {report}", path.display())).robot
}

fn inverse_dynamics(robot: &Robot) -> Program {
    Compiler::new(robot).compile(Function::InverseDynamics, Form::SevenSteps).expect("finite constants")
}

/// The robot files of a folder, by name.
fn robot_files(folder: &str) -> Vec<PathBuf> {
    let folder = std::fs::read_dir(root().join(folder)).expect("a folder of robots");
    let mut files: Vec<PathBuf> = folder.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    files.retain(|path| !path.to_string_lossy().ends_with(".plan.yaml"));
    files.sort();
    files
}

/// The files below a folder whose names end so, what is built and hidden left out.
fn files_below(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            files_below(&path, ending, found);
        } else if name.ends_with(ending) {
            found.push(path);
        }
    }
}
