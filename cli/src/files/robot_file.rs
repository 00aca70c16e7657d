//! Reads robot files, and makes messages for files that cannot be read.

use std::path::Path;

use rne_convert::{Account, Description, OpenError, Options, Remark, Selection};
use rne_model::{Checked, Convention, Reader, Remedy, Report, Robot, six_digits};

use crate::files::input_file;
use crate::outcome::Failure;
use crate::palette::{TITLE, TYPED};
use crate::remedy::in_options;
use crate::terminal::{note_of_file, remark};

/// The kinds of robots that a command accepts.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Shape {
    /// Serial arms. A tree is refused at its line of the file.
    Chain,
    /// Serial arms and trees. Couplings are refused at their line of the file.
    Tree,
    /// Serial arms and trees, whose joints may follow others. Closed loops are refused at their line of the file.
    Coupled,
    /// Every robot that a file can describe.
    Closed,
}

/// Reads a valid robot with its warnings and notes. The path `-` is standard input.
pub(crate) fn read(path: &Path, shape: Shape) -> Result<Checked, Failure> {
    read_with(path, &[], Frames::Dropped, shape)
}

/// Whether the links of a URDF become named frames. A robot file always has the frames of its own list.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Frames {
    /// They become named frames, for `--frame`.
    Kept,
    Dropped,
    /// They do not; and the whole robot is read if the file does not say which arm is meant.
    DroppedOfAll,
}

/// Reads a robot file, with other values of its parameters.
pub(crate) fn read_with(
    path: &Path,
    settings: &[(&str, f64)],
    frames: Frames,
    shape: Shape,
) -> Result<Checked, Failure> {
    Ok(read_by(path, (settings, &[]), frames, shape)?.0)
}

/// Reads a valid robot, some of whose parameters stay free until run time, and the bytes of its file.
pub(crate) fn read_with_run_time(
    path: &Path,
    names: &[&str],
    frames: Frames,
    shape: Shape,
) -> Result<(Checked, Vec<u8>), Failure> {
    read_by(path, (&[], names), frames, shape)
}

/// Other values of parameters; and the parameters that stay free until run time.
type Parameters<'a> = (&'a [(&'a str, f64)], &'a [&'a str]);

fn read_by(
    path: &Path,
    parameters: Parameters<'_>,
    frames: Frames,
    shape: Shape,
) -> Result<(Checked, Vec<u8>), Failure> {
    let (name, bytes) = yaml(path, frames)?;
    let checked = checked(&name, &bytes, parameters, shape)?;
    // only `rne check` reads this way, and it prints every lint itself
    if frames != Frames::DroppedOfAll {
        note_warnings(path, &checked.lints, parameters.0);
    }
    Ok((checked, bytes))
}

/// Reads a robot file, or imports a URDF as one; returns its name in messages and its bytes.
fn yaml(path: &Path, frames: Frames) -> Result<(String, Vec<u8>), Failure> {
    Ok(match open(path)? {
        Opened::RobotFile(name, bytes) => (name, bytes),
        Opened::Urdf(name, text) => (format!("{name} (imported)"), imported(&name, &text, frames)?.into_bytes()),
    })
}

/// Reads a valid robot whose parameters stay free until run time, except for those that cannot, such as angles, and
/// those that are defined through other free parameters.
pub(crate) fn read_with_free_parameters(path: &Path, shape: Shape) -> Result<Checked, Failure> {
    let (name, bytes) = yaml(path, Frames::Dropped)?;
    let constant = checked(&name, &bytes, (&[], &[]), shape)?;
    let names = constant.robot.parameters.iter().map(|(name, _)| name.as_str()).enumerate();
    let alone = |(index, parameter)| {
        let free = checked(&name, &bytes, (&[], &[parameter]), shape).ok()?.robot.run_time;
        (!free.entries.is_empty()).then_some((index, parameter, free.parameters))
    };
    let free: Vec<_> = names.filter_map(alone).collect();
    let is_defined = |index: usize| free.iter().any(|(_, _, defined)| defined.iter().any(|(other, _)| *other == index));
    let free: Vec<&str> = free.iter().filter(|(index, ..)| !is_defined(*index)).map(|(_, name, _)| *name).collect();
    note_warnings(path, &constant.lints, &[]);
    checked(&name, &bytes, (&[], &free), shape)
}

/// A description of a robot by its kind, with its name in messages.
enum Opened {
    RobotFile(String, Vec<u8>),
    Urdf(String, String),
}

fn open(path: &Path) -> Result<Opened, Failure> {
    match Description::open_by(path, input_file::open) {
        Ok(Description::Shipped(robot)) => {
            Ok(Opened::RobotFile(format!("{} (shipped)", robot.name), robot.yaml.as_bytes().to_vec()))
        }
        Ok(Description::RobotFile(bytes)) => Ok(Opened::RobotFile(input_file::name(path), bytes)),
        Ok(Description::Urdf(bytes)) => match String::from_utf8(bytes) {
            Ok(text) => Ok(Opened::Urdf(input_file::name(path), text)),
            // bytes that are not UTF-8 are refused later, by the reader of robot files
            Err(error) => Ok(Opened::RobotFile(input_file::name(path), error.into_bytes())),
        },
        Ok(_) => Err(input_error!("{} is not a robot file", path.display())),
        Err(error) => Err(not_opened(&error)),
    }
}

/// Imports the only arm of a URDF as `rne import` does. A note names the ends of the arm, because the user may mean
/// another one.
fn imported(name: &str, text: &str, frames: Frames) -> Result<String, Failure> {
    let options = Options { frames: frames == Frames::Kept, ..Options::default() };
    let mut imported = rne_convert::import(name, text, &options);
    let is_of_one_arm = |remedy: &Remedy| {
        use Remedy::{LockJoint, LockOthers, NameTip, Whole, WholeOrLock};
        matches!(remedy, LockJoint { .. } | LockOthers | NameTip | Whole | WholeOrLock { .. })
    };
    let takes_all = frames == Frames::DroppedOfAll
        && imported.as_ref().is_err_and(|report| {
            report.diagnostics.iter().filter_map(|found| found.remedy.as_deref()).any(is_of_one_arm)
        });
    if takes_all {
        let selection = Selection { whole: true, ..Selection::default() };
        let options = Options { selection, convention: Convention::Modified, ..options };
        imported = rne_convert::import(name, text, &options);
    }
    let imported = imported.map_err(|report| {
        // the help names options of `rne import`, so it must say so
        let mut failure = Failure::from(&report);
        failure.text = format!(
            "{}\n\n{name} is a URDF or an MJCF file. `{TYPED}rne import {name} -o FILE.yaml{TYPED:#}` and its options \
             write a robot file of one arm; give that file to this command",
            failure.text.trim_end()
        );
        failure
    })?;
    let Account { base, tip, remarks, .. } = &imported.account;
    let what =
        if takes_all { format!("robot is everything after {base}") } else { format!("arm is from {base} to {tip}") };
    let snapped = imported.account.snapping().map_or_else(String::new, |snapping| {
        format!("      {snapping}\n      {TYPED}rne import --no-snap{TYPED:#} keeps the angles of the file\n")
    });
    remark(format_args!(
        "{TITLE}note{TITLE:#}: {name} is a URDF or an MJCF file, and the {what}\n      \
         {TYPED}rne import {name}{TYPED:#} prints its robot file and every assumption\n      {}\n{snapped}{}",
        gravity(&imported.robot),
        notes(remarks)
    ));
    Ok(imported.text.clone())
}

/// The gravity of an imported robot, which a URDF does not have.
pub(crate) fn gravity(robot: &Robot) -> String {
    let [x, y, z] = robot.gravity.map(six_digits);
    format!("gravity in frame 0: [{x}, {y}, {z}] m/s²")
}

/// Writes a line for each remark of an import.
pub(crate) fn notes(remarks: &[Remark]) -> String {
    let line = |remark: &Remark| {
        let word = if remark.is_warning { "warning" } else { "note" };
        format!("{TITLE}{word}{TITLE:#}: {}\n", remark.worded(in_options))
    };
    remarks.iter().map(line).collect()
}

fn checked(name: &str, bytes: &[u8], (settings, run_time): Parameters<'_>, shape: Shape) -> Result<Checked, Failure> {
    let plain = || match shape {
        Shape::Chain => Reader::new(name),
        Shape::Tree => Reader::new(name).trees(),
        Shape::Coupled => Reader::new(name).trees().couplings(),
        Shape::Closed => Reader::new(name).trees().couplings().loops(),
    };
    let reader = plain().run_time(run_time);
    let reader = settings.iter().fold(reader, |reader, &(parameter, value)| reader.setting(parameter, value));
    reader.read(bytes).map_err(|report| {
        // the command line is at fault if the file alone is valid and has no such parameter, else the file is
        let names: Vec<&str> = settings.iter().map(|(parameter, _)| *parameter).chain(run_time.to_vec()).collect();
        let alone = if names.is_empty() { None } else { plain().read(bytes).ok() };
        let has = |alone: &Checked, name: &str| alone.robot.parameters.iter().any(|(known, _)| known == name);
        match alone {
            Some(alone) if !names.iter().all(|name| has(&alone, name)) => Failure::unknown_name(&report),
            _ => Failure::from(&report),
        }
    })
}

/// Makes the error for a description that cannot be opened.
pub(crate) fn not_opened(error: &OpenError) -> Failure {
    match error {
        OpenError::Plan { .. } => Failure::usage(error),
        OpenError::NotFound { hint: None, .. } => {
            input_error!("{error}; {TYPED}rne list{TYPED:#} prints the shipped robots")
        }
        _ => Failure::input(error),
    }
}

/// Notes that a robot file has warnings, because they concern the results of every command.
pub(crate) fn note_warnings(path: &Path, lints: &Report, settings: &[(&str, f64)]) {
    let count = lints.warnings().count();
    let Some(first) = lints.warnings().next() else { return };
    let warnings = if count == 1 { "1 warning".to_owned() } else { format!("{count} warnings") };
    if settings.is_empty() {
        let shows = if count == 1 { "shows it" } else { "shows them" };
        let path = shell(path);
        note_of_file(&format!(
            "{TITLE}note{TITLE:#}: {warnings} in the robot file; {TYPED}rne check {path}{TYPED:#} {shows}\n"
        ));
    } else {
        // the warnings are those with these values of parameters, which `rne check` would not show
        let settings: Vec<String> = settings.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let (settings, message) = (settings.join(", "), &first.message);
        let first = if count == 1 { "" } else { "; the first" };
        note_of_file(&format!("{TITLE}note{TITLE:#}: {warnings} with {settings}{first}: {message}\n"));
    }
}

/// Reads a valid robot. `rne check` prints its warnings and notes; all other commands only count the warnings.
pub(crate) fn robot(path: &Path, shape: Shape) -> Result<Robot, Failure> {
    Ok(read(path, shape)?.robot)
}

/// Reads a valid robot from a robot file, for commands that write a file beside it. For a URDF the error names the
/// command that imports it.
pub(crate) fn robot_in_yaml(path: &Path) -> Result<Checked, Failure> {
    let (name, bytes) = match open(path)? {
        Opened::RobotFile(name, bytes) => (name, bytes),
        Opened::Urdf(name, text) => (name, text.into_bytes()),
    };
    checked(&name, &bytes, (&[], &[]), Shape::Coupled)
}

/// Quotes a path so that a shell reads it back.
pub(crate) fn shell(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', r"'\''")) }
}
