//! Remarks on logs of an arm, and errors in them, with the options of the command line that help.

use rne_identify::{ArmLogError, ArmLogRemark, Mismatch};
use rne_logs::{Mapping, Quantity, Remark, Target, suggested};
use rne_model::one_line;

use crate::palette::TYPED;
use crate::remedy;

/// Returns a remark on a log, with the options that help.
pub(crate) fn log_remark(remark: &Remark) -> String {
    let options = match remark {
        Remark::MayBeDegrees { .. } => ": use --degrees if they are degrees, --radians if they are radians or metres",
        Remark::TimeGoesBack { columns, .. } => {
            let column = columns.first().map_or("COLUMN", String::as_str);
            return format!("{remark}: `rne log` describes each with --by {}", remedy::log::quoted(column.to_owned()));
        }
        Remark::VelocitiesDisagree { .. } => "; --derive-velocities ignores them",
        Remark::Currents(_) => ": give the factor to torques in N m/A with --torque-constant",
        Remark::TakenForTorques => "; if they are currents, give the N m/A with --torque-constant",
        _ => "",
    };
    format!("{remark}{options}")
}

/// Returns a remark on logs of an arm.
pub(crate) fn remark_sentence(remark: &ArmLogRemark) -> String {
    match remark {
        ArmLogRemark::Log(remark) => log_remark(remark),
        ArmLogRemark::MatchedByOrder { .. } if remark.is_warning() => {
            format!("{remark}; --joints gives another order")
        }
        other => other.to_string(),
    }
}

/// Returns an error in the logs of an arm, with the options that help.
pub(crate) fn error_sentence(error: &ArmLogError) -> String {
    match error {
        ArmLogError::Log { error, joints } => remedy::log::sentence(error, joints),
        ArmLogError::NamedJoints { .. } => {
            error.to_string().replacen("the list of joints", &format!("{TYPED}--joints{TYPED:#}"), 1)
        }
        ArmLogError::Unmatched { mismatch: Mismatch::More | Mismatch::Order { .. }, .. } => {
            format!(
                "{error}; {TYPED}--joints{TYPED:#} lists the joints of the log that belong to the robot, from base to \
                 tip"
            )
        }
        ArmLogError::NoEfforts { logged, unread } if !unread.is_empty() => {
            let is_effort = |target: &Target| matches!(target, Target::Joint { quantity: Quantity::Effort, .. });
            let efforts = suggested(unread, logged).into_iter().filter(|mapping| is_effort(&mapping.target));
            let efforts: Vec<Mapping> = efforts.collect();
            format!("{error}; name the columns: {}", one_line(&remedy::log::map(&efforts)))
        }
        ArmLogError::NoCutoff => format!("{error}; give a cut-off with {TYPED}--cutoff HZ{TYPED:#}"),
        ArmLogError::Cutoff { .. } => {
            error.to_string().replacen("the cut-off can", &format!("{TYPED}--cutoff{TYPED:#} can"), 1)
        }
        other => other.to_string(),
    }
}
