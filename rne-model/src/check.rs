//! From the text of a robot file to a validated robot, or to a report of everything that is wrong with it.

use crate::decode::Context;
use crate::diagnostic::{Problems, Report};
use crate::{Robot, document, schema, source, urdf};

/// A valid robot file: the robot, and what is remarkable about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// The robot.
    pub robot: Robot,
    /// Lints: warnings and notes, often none.
    pub lints: Report,
}

/// Reads and checks the text of a robot file; `name` is what the messages call it, usually its path.
///
/// # Errors
///
/// Everything that is wrong with the file, with line, column and what is allowed.
pub fn check(name: &str, text: &str) -> Result<Checked, Report> {
    check_text(name, text, &[], &[])
}

fn check_text(name: &str, text: &str, run_time: &[&str], settings: &[(&str, f64)]) -> Result<Checked, Report> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let problems = Problems::new();
    // the beginning will do: a URDF may be long
    let beginning = urdf::head(text);
    if let Some(other_format) = urdf::instead_of_a_robot_file(name, beginning) {
        problems.push(other_format);
        return Err(problems.finish(name, beginning));
    }
    if !source::size_is_fine(text.len(), &problems) {
        return Err(problems.finish(name, ""));
    }
    let robot = source::is_printable(text, &problems)
        .then(|| document::parse(text, &problems))
        .flatten()
        .and_then(|root| schema::robot(&Context::new(text, &problems, run_time).with_settings(settings), &root));
    let report = problems.finish(name, text);
    match robot {
        Some(robot) if !report.has_errors() => Ok(Checked { robot, lints: report }),
        _ => Err(report),
    }
}

/// As [`check`], for bytes that may not be text.
///
/// # Errors
///
/// As [`check`]; bytes that are not UTF-8 are an error at the first of them.
pub fn check_bytes(name: &str, bytes: &[u8]) -> Result<Checked, Report> {
    check_bytes_with_run_time(name, bytes, &[])
}

/// As [`check_bytes`], for a robot some of whose parameters stay free until run time: `run_time` are their names, each
/// once. The robot is that of the parameters' values in the file; [`Robot::run_time`] says how it depends on them.
///
/// ```
/// use rne_model::{Entry, Formula, check_bytes_with_run_time};
///
/// let text = "
/// format: 1
/// name: pendulum
/// source: a lecture
/// convention: standard
/// gravity: [0, -9.81, 0]
/// parameters: {payload: 0, m: 1.2 + payload}
/// joints:
///   - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: m, com: [-1/4, 0, 0]}}
/// ";
/// let robot = check_bytes_with_run_time("pendulum.yaml", text.as_bytes(), &["payload"]).unwrap().robot;
/// let mass = Formula::Number(1.2) + Formula::Parameter(0);
/// assert_eq!(robot.run_time.entries, [(Entry::Mass(0), mass)]);
/// assert_eq!(robot.joints[0].row.link.mass, 1.2);
/// ```
///
/// What may vary: gravity, `xyz`, `d`, `a`, masses, centres of mass, inertias and the numbers of motors, by `+ - * /`
/// and whole powers, which are products. Where `libm::pow` rounds a power otherwise, the number in the robot is the
/// product too.
///
/// # Errors
///
/// As [`check_bytes`]; a name that does not stand under `parameters`; an angle or a limit that depends on a run-time
/// parameter; a function, another power or an exponent that does; a number that depends on one and is zero in the file,
/// for zeros are folded away; a run-time parameter on which nothing depends.
pub fn check_bytes_with_run_time(name: &str, bytes: &[u8], run_time: &[&str]) -> Result<Checked, Report> {
    check_anything(name, bytes, run_time, &[])
}

/// As [`check_bytes`], for a robot some of whose parameters have other values than those in the file; what the file
/// defines through them follows.
///
/// ```
/// use rne_model::check_bytes_with_settings;
///
/// let text = "
/// format: 1
/// name: pendulum
/// source: a lecture
/// convention: standard
/// gravity: [0, -9.81, 0]
/// parameters: {payload: 0, m: 1.2 + payload}
/// joints:
///   - {type: revolute, dh: {theta: 0, d: 0, a: 0.5, alpha: 0}, link: {mass: m, com: [-1/4, 0, 0]}}
/// ";
/// let robot = check_bytes_with_settings("pendulum.yaml", text.as_bytes(), &[("payload", 2.0)]).unwrap().robot;
/// assert_eq!(robot.joints[0].row.link.mass, 1.2 + 2.0);
/// ```
///
/// # Errors
///
/// As [`check_bytes`], of the file with these values; a name that does not stand under `parameters`.
pub fn check_bytes_with_settings(name: &str, bytes: &[u8], settings: &[(&str, f64)]) -> Result<Checked, Report> {
    check_anything(name, bytes, &[], settings)
}

fn check_anything(name: &str, bytes: &[u8], run_time: &[&str], settings: &[(&str, f64)]) -> Result<Checked, Report> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return check_text(name, text, run_time, settings),
        Err(error) => error,
    };
    let problems = Problems::new();
    if !source::size_is_fine(bytes.len(), &problems) {
        return Err(problems.finish(name, ""));
    }
    source::not_utf8(bytes, error, &problems);
    Err(problems.finish(name, &String::from_utf8_lossy(bytes)))
}

impl Robot {
    /// Reads a robot file that is at hand as text; lints are not reported. [`check`] reports them.
    ///
    /// # Errors
    ///
    /// Everything that is wrong with the text.
    pub fn from_yaml(text: &str) -> Result<Self, Report> {
        check("<yaml>", text).map(|checked| checked.robot)
    }
}
