//! Reading robot files, and what to say when that fails.

use std::fmt::Write as _;
use std::fs;
use std::io::ErrorKind;
use std::iter;
use std::path::{Path, PathBuf};

use rne_model::{Checked, MAX_BYTES, Reader, Robot, did_you_mean, robot_of};
use rne_robots::RobotFile;

use crate::files::input_file::{self, is_standard_input};
use crate::outcome::Failure;
use crate::palette::TYPED;

/// So many files of a folder are named where one is missing.
const NAMED: usize = 16;

/// The shipped robot that a path stands for: a bare name, where there is no file of this name.
pub(crate) fn of_a_name(path: &Path) -> Option<&'static RobotFile> {
    let name = path.to_str()?;
    rne_robots::find(name).filter(|_| !path.exists())
}

/// The shipped robot of a name.
pub(crate) fn shipped(name: &str) -> Result<&'static RobotFile, Failure> {
    rne_robots::find(name).ok_or_else(|| {
        let names: Vec<&str> = rne_robots::ROBOTS.iter().map(|robot| robot.name).collect();
        let meant = near(name).map_or_else(String::new, |near| format!("; did you mean {TYPED}{near}{TYPED:#}?"));
        Failure::input(format_args!("there is no shipped robot {name}{meant}; there are {}", names.join(", ")))
    })
}

/// The shipped robot whose name is meant by another, which may have its maker's name before it.
fn near(name: &str) -> Option<&'static str> {
    let names = rne_robots::ROBOTS.iter().map(|robot| robot.name);
    let separators = name.match_indices(['_', '-', ' ']).map(|(at, _)| &name[at + 1..]);
    iter::once(name).chain(separators).filter(|name| !name.is_empty()).find_map(|name| {
        did_you_mean(name, names.clone()).or_else(|| names.clone().find(|known| known.starts_with(name)))
    })
}

/// A valid robot with its lints. The path `-` is standard input.
pub(crate) fn read(path: &Path) -> Result<Checked, Failure> {
    read_with(path, &[])
}

/// The same with other values of the file's parameters.
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
    if let Some(robot) = robot_of(path) {
        return Err(Failure::usage(format_args!(
            "{} is a plan; its robot is {TYPED}{}{TYPED:#}",
            path.display(),
            robot.display()
        )));
    }
    if let Some(robot) = of_a_name(path) {
        let name = format!("{} (shipped)", robot.name);
        let bytes = robot.yaml.as_bytes();
        let checked = read(&name, bytes)?;
        return Ok((checked, bytes.to_vec()));
    }
    let name = if is_standard_input(path) { "<standard input>".to_owned() } else { path.display().to_string() };
    let bytes = input_file::read(path, MAX_BYTES).map_err(|error| match error.kind() {
        ErrorKind::NotFound => Failure::input(missing(path)),
        ErrorKind::IsADirectory => Failure::input(format_args!(
            "{0} is a folder; name the robot files in it, such as {TYPED}{1}{TYPED:#}",
            path.display(),
            path.join("*.yaml").display()
        )),
        _ => Failure::input(format_args!("{name} cannot be read: {error}")),
    })?;
    let checked = read(&name, &bytes)?;
    Ok((checked, bytes))
}

/// A valid robot. `rne check` tells of its lints, the other commands do not.
pub(crate) fn robot(path: &Path) -> Result<Robot, Failure> {
    Ok(read(path)?.robot)
}

fn missing(path: &Path) -> String {
    let mut text = format!("there is no robot file {}", path.display());
    let folder = path.parent().filter(|folder| folder.is_dir() && !folder.as_os_str().is_empty());
    let probably = candidates(path).into_iter().find(|candidate| candidate.is_file());
    if let Some(probably) = probably {
        let _ = write!(text, "; did you mean {TYPED}{}{TYPED:#}?", probably.display());
    } else if let Some(near) = path.to_str().and_then(near) {
        let _ = write!(text, "; did you mean the shipped robot {TYPED}{near}{TYPED:#}?");
    } else if let Some(names) = folder.map(robots_in).filter(|names| !names.is_empty()) {
        let more = if names.len() > NAMED { ", …" } else { "" };
        let shown = names.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
        let _ = write!(text, "; {} has {shown}{more}", path.with_file_name("").display());
    } else {
        let _ = write!(text, "; {TYPED}rne list{TYPED:#} prints the shipped robots");
    }
    text
}

/// Where the file may be instead: with its extension, or in `robots/`.
fn candidates(path: &Path) -> Vec<PathBuf> {
    let Some(name) = path.file_name() else { return Vec::new() };
    let shipped = Path::new("robots").join(name);
    vec![path.with_extension("yaml"), shipped.with_extension("yaml")]
}

/// The names of the robot files of a folder, sorted; a plan, `NAME.plan.yaml`, is none.
fn robots_in(folder: &Path) -> Vec<String> {
    let paths = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_robot =
        |path: &PathBuf| path.extension().is_some_and(|extension| extension == "yaml") && robot_of(path).is_none();
    let name = |path: PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let mut names: Vec<String> = paths.filter(is_robot).filter_map(name).collect();
    names.sort();
    names
}

/// A path as a shell reads it back.
pub(crate) fn shell(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}
