//! Errors as Python's exceptions, with remedies in the words of Python.

use std::path::Path;

use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use rne::compiled::ArmError;
use rne_convert::OpenError;
use rne_model::{Remedy, Report};

create_exception!(
    rne,
    RobotFileError,
    PyValueError,
    "A robot file, a plan or a URDF is wrong. `line` and `column`, from 1, are those of its first mistake."
);
create_exception!(
    rne,
    RobotFileWarning,
    PyUserWarning,
    "A robot file or a URDF is valid, but its numbers are probably not those of the arm."
);
create_exception!(rne, EvaluationError, PyValueError, "A function cannot be computed for this arm or these arguments.");

/// Returns the exception for the errors in a file.
pub(crate) fn of_report(py: Python<'_>, report: &Report) -> PyErr {
    let report = &report.clone().worded(in_keywords);
    let error = RobotFileError::new_err(report.render(false));
    let first = report.errors().next();
    let value = error.value(py);
    let told = value
        .setattr("line", first.map(|first| first.line))
        .and_then(|()| value.setattr("column", first.map(|first| first.column)))
        .and_then(|()| value.setattr("file", &report.name));
    told.err().unwrap_or(error)
}

/// Returns a remedy in terms of the keywords of `rne.load`.
#[allow(clippy::unnecessary_wraps)] // a report needs a function with this type
pub(crate) fn in_keywords(remedy: &Remedy) -> Option<String> {
    Some(match remedy {
        Remedy::ImportUrdf { .. } => "rne.load(path) imports a URDF".to_owned(),
        Remedy::NameTip => "name the tip with tip=\"LINK\"; whole=True takes all of them, as a tree".to_owned(),
        Remedy::LockJoint { joint } => format!("lock={{{joint:?}: VALUE}} locks it at this value"),
        Remedy::LockOthers => {
            "lock={\"JOINT\": VALUE} locks one joint at this value, lock_others=True locks all others at 0".to_owned()
        }
        Remedy::KeepUnphysical => {
            "keep_unphysical=True keeps the inertia as it is; rne.repair(path) proposes edits".to_owned()
        }
        Remedy::Repair => "rne.repair(path) proposes edits".to_owned(),
        Remedy::Whole => "whole=True imports the whole robot".to_owned(),
        Remedy::WholeOrLock { joint } => {
            format!("whole=True imports the whole robot, lock={{{joint:?}: VALUE}} locks the joint at this value")
        }
        Remedy::Float => "whole=True, floating=True makes the base float".to_owned(),
        Remedy::Rotors => "rotors=True counts it, rotors=False leaves it out".to_owned(),
    })
}

/// Returns the exception for an arm that could not be compiled.
pub(crate) fn of_arm(py: Python<'_>, error: &ArmError) -> PyErr {
    match error {
        ArmError::Invalid(report) => of_report(py, report),
        ArmError::Unreadable { path, error: cause } => of_system(path, cause, ""),
        _ => RobotFileError::new_err(error.to_string()),
    }
}

/// Returns the exception for a description of an arm that could not be opened.
pub(crate) fn of_opening(error: OpenError) -> PyErr {
    match &error {
        OpenError::NotFound { path, hint: Some(hint), error } => of_system(path, error, &format!("; {hint}")),
        OpenError::NotFound { path, error, .. } | OpenError::Unreadable { path, error } => of_system(path, error, ""),
        _ => RobotFileError::new_err(error.to_string()),
    }
}

/// Returns an error of the system with a hint. By its number Python makes it the right subclass, such as
/// FileNotFoundError.
fn of_system(path: &Path, error: &std::io::Error, hint: &str) -> PyErr {
    let words = error.to_string();
    let words = words.split(" (os error").next().unwrap_or_default().to_owned() + hint;
    match error.raw_os_error() {
        Some(number) => PyOSError::new_err((number, words, path.display().to_string())),
        None => PyOSError::new_err(format!("cannot read {}: {words}", path.display())),
    }
}

/// Returns the exception for a function that could not be computed.
pub(crate) fn of_evaluation(error: &dyn std::fmt::Display) -> PyErr {
    EvaluationError::new_err(error.to_string())
}
