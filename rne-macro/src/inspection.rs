//! `#[robot(inspect)]`: writes the generated code to a file that people can read, with the formulas and the meaning of
//! every name, in the folder of the compiler's output.

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rne_codegen::{Capability, Form, Program};
use rne_model::Robot;

/// Writes the annotated code of a capability to `rne/NAME.CAPABILITY.rs`, in the folder of the compiler's output. If
/// the folder is unknown, as in editors, nothing is written.
pub(crate) fn write(robot: &Robot, capability: Capability, form: Form, programs: &[Program]) -> io::Result<()> {
    let Some(out) = output_folder(std::env::args_os()) else { return Ok(()) };
    let folder = out.join("rne");
    let file = folder.join(file_name(robot, capability, form));
    let text = format!(
        "// What `#[derive({})]` makes of this robot, for reading: the compiler wrote it for `#[robot(inspect)]`.\n// \
         `rne explain NAME FILE` explains how one name is computed; FILE is the robot file.\n\n{}",
        capability.name(),
        rne_emit::rust_file(robot, programs)
    );
    if fs::read_to_string(&file).is_ok_and(|known| known == text) {
        return Ok(());
    }
    fs::create_dir_all(&folder)?;
    // crates that are compiled at the same time may derive the same robot, so each writes a file of its own and renames
    // it
    let whole = folder.join(format!(".{}.{}", file_name(robot, capability, form), std::process::id()));
    fs::write(&whole, text)?;
    fs::rename(&whole, &file)
}

fn file_name(robot: &Robot, capability: Capability, form: Form) -> String {
    format!("{}.{}.{form}.rs", robot.name, capability.name())
}

/// Returns the folder of the profile, such as `target/debug`, from the arguments of the compiler.
fn output_folder(arguments: impl Iterator<Item = OsString>) -> Option<PathBuf> {
    let mut arguments = arguments.skip_while(|argument| argument != "--out-dir").skip(1);
    let out = PathBuf::from(arguments.next()?);
    let is_deps = out.file_name().is_some_and(|name| name == "deps" || name == "examples");
    Some(if is_deps { out.parent().map_or_else(PathBuf::new, Path::to_path_buf) } else { out })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_of_the_profile_is_found() {
        let folder = |arguments: &[&str]| output_folder(arguments.iter().map(OsString::from));
        assert_eq!(folder(&["rustc", "--out-dir", "/t/debug/deps", "--cfg", "x"]), Some(PathBuf::from("/t/debug")));
        assert_eq!(folder(&["rustc", "--out-dir", "/t/debug/examples"]), Some(PathBuf::from("/t/debug")));
        assert_eq!(folder(&["rustc", "--out-dir", "/elsewhere"]), Some(PathBuf::from("/elsewhere")));
        assert_eq!(folder(&["rust-analyzer"]), None);
        assert_eq!(folder(&["rustc", "--out-dir"]), None);
    }
}
