//! Reading robot files, and what to say when that fails.

use std::path::Path;

use rne_convert::{Description, OpenError};
use rne_model::{Checked, Reader, Robot};

use crate::files::input_file;
use crate::outcome::Failure;
use crate::palette::TYPED;

/// A valid robot with its lints. The path `-` is standard input.
pub(crate) fn read(path: &Path) -> Result<Checked, Failure> {
    read_with(path, &[])
}

/// Reads a robot file with other values of its parameters.
pub(crate) fn read_with(path: &Path, settings: &[(&str, f64)]) -> Result<Checked, Failure> {
    Ok(read_by(path, settings, &[])?.0)
}

/// A valid robot some of whose parameters stay free until run time, and the bytes of its file.
pub(crate) fn read_with_run_time(path: &Path, names: &[&str]) -> Result<(Checked, Vec<u8>), Failure> {
    read_by(path, &[], names)
}

fn read_by(path: &Path, settings: &[(&str, f64)], run_time: &[&str]) -> Result<(Checked, Vec<u8>), Failure> {
    let read = |name: &str, bytes: &[u8]| {
        let reader = Reader::new(name).run_time(run_time);
        let reader = settings.iter().fold(reader, |reader, &(parameter, value)| reader.setting(parameter, value));
        reader.read(bytes).map_err(|report| {
            // the file is at fault, unless it is in order by itself and has no such parameter
            let names: Vec<&str> = settings.iter().map(|(parameter, _)| *parameter).chain(run_time.to_vec()).collect();
            let alone = if names.is_empty() { None } else { Reader::new(name).read(bytes).ok() };
            let has = |alone: &Checked, name: &str| alone.robot.parameters.iter().any(|(known, _)| known == name);
            match alone {
                Some(alone) if !names.iter().all(|name| has(&alone, name)) => Failure::unknown_name(&report),
                _ => Failure::from(&report),
            }
        })
    };
    let (name, bytes) = match Description::open_by(path, input_file::open) {
        Ok(Description::Shipped(robot)) => (format!("{} (shipped)", robot.name), robot.yaml.as_bytes().to_vec()),
        // a URDF is refused with the command that imports it
        Ok(Description::RobotFile(bytes) | Description::Urdf(bytes)) => (input_file::name(path), bytes),
        Ok(_) => return Err(Failure::input(format_args!("{} is no robot file", path.display()))),
        Err(error) => return Err(not_opened(&error)),
    };
    let checked = read(&name, &bytes)?;
    Ok((checked, bytes))
}

/// Why there is no robot file.
pub(crate) fn not_opened(error: &OpenError) -> Failure {
    match error {
        OpenError::Plan { .. } => Failure::usage(error),
        OpenError::NotFound { hint: None, .. } => {
            Failure::input(format_args!("{error}; {TYPED}rne list{TYPED:#} prints the shipped robots"))
        }
        _ => Failure::input(error),
    }
}

/// A valid robot. `rne check` tells of its lints, the other commands do not.
pub(crate) fn robot(path: &Path) -> Result<Robot, Failure> {
    Ok(read(path)?.robot)
}

/// A path as a shell reads it back.
pub(crate) fn shell(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}
