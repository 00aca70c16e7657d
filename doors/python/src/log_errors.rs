//! Errors of logs and remarks on them, with remedies as keywords of Python.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rne_identify::{ArmLogError, ArmLogRemark, ExcitationError, Mismatch, PassError};
use rne_logs::{LogError, Mapping, Remark, Remedy, Setting, suggested};
use rne_watch::WatchError;

/// Returns the exception for an error of a log. Files that cannot be opened are an OSError, which the Python package
/// raises before.
pub(crate) fn of_log(error: &LogError, joints: &[String]) -> PyErr {
    PyValueError::new_err(sentence(error, joints))
}

/// Returns the exception for an error of the logs of an arm.
pub(crate) fn of_arm_log(error: &ArmLogError) -> PyErr {
    let text = match error {
        ArmLogError::Log { error, joints } => return of_log(error, joints),
        ArmLogError::NamedJoints { .. } => error.to_string().replacen("the list of joints", "`joints`", 1),
        ArmLogError::Unmatched { mismatch: Mismatch::More | Mismatch::Order { .. }, .. } => {
            format!("{error}; joints=[…] lists the joints of the log that belong to the robot, from base to tip")
        }
        ArmLogError::NoEfforts { logged, unread } if !unread.is_empty() => {
            format!("{error}; name the columns: {}", map(&suggested(unread, logged)))
        }
        ArmLogError::NoCutoff => format!("{error}; give a cut-off with cutoff=HZ"),
        ArmLogError::Cutoff { .. } => error.to_string().replacen("the cut-off can", "`cutoff` can", 1),
        other => other.to_string(),
    };
    PyValueError::new_err(text)
}

/// Returns the exception for an error that ended a pass over logs.
pub(crate) fn of_pass<E: std::fmt::Display>(error: PassError<E>) -> PyErr {
    match error {
        PassError::Log(error) => of_arm_log(&error),
        PassError::Motion(error) => PyValueError::new_err(error.to_string()),
    }
}

/// Returns the exception for logs that cannot be watched; `words` name the logs.
pub(crate) fn of_watch(error: &WatchError, words: &str) -> PyErr {
    match error {
        WatchError::Log(error) => of_arm_log(error),
        WatchError::TooFew { .. } => PyValueError::new_err(format!("{words} is too short to watch")),
        other => PyValueError::new_err(format!("{words}: {other}")),
    }
}

/// Returns the exception if no motion that excites an arm is found.
pub(crate) fn of_excitation(error: &ExcitationError) -> PyErr {
    PyValueError::new_err(match error {
        ExcitationError::NoPosition { .. } => format!("{error} with range=…"),
        ExcitationError::Effort { .. } => {
            format!("{error}: change `seconds`, `velocity`, `acceleration` or `range`")
        }
        _ => error.to_string(),
    })
}

/// Returns the text of a remark, with the Python keywords that help.
pub(crate) fn remark(remark: &ArmLogRemark) -> String {
    match remark {
        ArmLogRemark::Log(remark) => log_remark(remark),
        ArmLogRemark::MatchedByOrder { .. } if remark.is_warning() => {
            format!("{remark}; joints=[…] gives another order")
        }
        other => other.to_string(),
    }
}

/// Returns the text of a remark on a log, with the Python keywords that help.
pub(crate) fn log_remark(remark: &Remark) -> String {
    let keywords = match remark {
        Remark::MayBeDegrees { .. } => {
            ": use angles=\"degrees\" if they are degrees, angles=\"radians\" if they are radians or metres"
        }
        Remark::VelocitiesDisagree { .. } => "; derive_velocities=True ignores them",
        Remark::Currents(_) => ": give the factor to torques in N m/A with torque_constants=…",
        Remark::TakenForTorques => "; if they are currents, give the N m/A with torque_constants=…",
        _ => "",
    };
    format!("{remark}{keywords}")
}

fn sentence(error: &LogError, joints: &[String]) -> String {
    let remedies = error.remedies().iter().map(|remedy| match remedy {
        Remedy::Give(Setting::Map(columns)) if joints.is_empty() => {
            format!("name the columns: {}", map(&suggested(columns, &["JOINT".to_owned()])))
        }
        Remedy::Give(Setting::Map(columns)) => format!("name the columns: {}", map(&suggested(columns, joints))),
        Remedy::Give(Setting::TimeColumn(columns)) => {
            format!("{} names the column of times", map(&suggested(columns, &[])))
        }
        Remedy::Give(setting) => given(setting),
        Remedy::LeaveOut(setting) => format!("remove the keyword {}", keyword(setting)),
        Remedy::BuildWithFormats => {
            "`pip install . --config-settings=build-args=\"--features formats\"` in doors/python builds one that does"
                .to_owned()
        }
    });
    [error.to_string()].into_iter().chain(remedies).collect::<Vec<_>>().join("; ")
}

/// Writes mappings of columns as the keyword `map`.
fn map(mappings: &[Mapping]) -> String {
    let each = mappings.iter().map(|mapping| format!("{:?}: {:?}", mapping.target.to_string(), mapping.column));
    format!("map={{{}}}", each.collect::<Vec<_>>().join(", "))
}

fn given(setting: &Setting) -> String {
    match setting {
        Setting::Joints(names) if names.is_empty() => {
            "joints=[\"A\", \"B\", …] lists the joints to read, from base to tip".to_owned()
        }
        Setting::Joints(names) => format!("joints={names:?} reads these joints"),
        Setting::Topic => "topic=\"…\" reads one topic".to_owned(),
        Setting::Prefix => "topic=\"actual\" reads the columns whose names begin with actual".to_owned(),
        Setting::TorqueConstants => "torque_constants=… gives the factors in N m/A from currents to torques".to_owned(),
        Setting::Angles => {
            "angles=\"degrees\" if they are in degrees, angles=\"radians\" if they are in radians or metres".to_owned()
        }
        Setting::Gap => "gap=… sets the limit of gaps".to_owned(),
        Setting::Cutoff => "cutoff=HZ sets the cut-off".to_owned(),
        Setting::TimeUnit => "time_unit=\"s\", \"ms\", \"us\" or \"ns\" gives the unit of the times".to_owned(),
        Setting::Rate => "rate=HZ gives the sampling rate".to_owned(),
        Setting::Columns => "columns=[\"time\", \"q\", \"tau\"] gives the order of the columns".to_owned(),
        Setting::Select { column, value } => {
            format!("where={{{column:?}: {value:?}}} reads only the rows with this text")
        }
        Setting::Map(_) | Setting::TimeColumn(_) => "map={…} names a column".to_owned(),
    }
}

fn keyword(setting: &Setting) -> &'static str {
    match setting {
        Setting::Joints(_) => "joints",
        Setting::Topic | Setting::Prefix => "topic",
        Setting::TorqueConstants => "torque_constants",
        Setting::Angles => "angles",
        Setting::Gap => "gap",
        Setting::Cutoff => "cutoff",
        Setting::TimeUnit => "time_unit",
        Setting::Rate => "rate",
        Setting::Select { .. } => "where",
        Setting::Map(_) | Setting::TimeColumn(_) => "map",
        Setting::Columns => "columns",
    }
}
