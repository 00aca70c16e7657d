//! Remedies for errors, in the words of the command line.

pub(crate) mod log;

use std::path::Path;

use rne_codegen::{CompileError, Remedy};
use rne_identify::ExcitationError;
use rne_model::{Report, robot_of};

/// Adds to the errors of a robot file or a URDF the options that help.
pub(crate) fn worded(report: &Report) -> Report {
    report.clone().worded(in_options)
}

/// Returns a remedy as an option of the command line.
#[allow(clippy::unnecessary_wraps)] // what a report asks for
pub(crate) fn in_options(remedy: &rne_model::Remedy) -> Option<String> {
    use rne_model::Remedy;
    Some(match remedy {
        Remedy::ImportUrdf { file } => {
            let file = file.as_deref().unwrap_or("FILE");
            format!("`rne import {file} -o robot.yaml` converts a URDF or MJCF file to a robot file")
        }
        Remedy::NameTip => {
            "name the tip with --tip LINK; `rne import FILE --whole` takes all of them, as a tree".to_owned()
        }
        Remedy::LockJoint { joint } => format!("--lock {joint}=VALUE locks `{joint}` at this value"),
        Remedy::LockOthers => {
            "--lock JOINT=VALUE locks one joint at this value, --lock-others locks all others at zero".to_owned()
        }
        Remedy::KeepUnphysical => {
            "--keep-unphysical imports the inertia without a change; `rne check --repair FILE` proposes edits"
                .to_owned()
        }
        Remedy::Repair => "`rne check --repair FILE` proposes edits".to_owned(),
        Remedy::Whole => "`rne import FILE --whole` imports the whole robot".to_owned(),
        Remedy::WholeOrLock { joint } => {
            format!("--whole imports the whole robot, --lock {joint}=VALUE locks `{joint}` at this value")
        }
        Remedy::Float => "`rne import FILE --whole --floating` makes the base float".to_owned(),
        Remedy::Rotors => "a command counts it with --rotors".to_owned(),
    })
}

/// Returns the reason why no motion excites an arm, with the options that help.
pub(crate) fn of_excitation(error: &ExcitationError) -> String {
    match error {
        ExcitationError::Length { .. } | ExcitationError::NotPositive(_) => format!("--{error}"),
        ExcitationError::NoPosition { .. } => format!("{error} with --range"),
        ExcitationError::Effort { .. } => format!("{error}: change --seconds, --velocity, --acceleration or --range"),
        _ => error.to_string(),
    }
}

/// Adds a remedy to a mistake in a plan file.
pub(crate) fn of_plan(report: Report, remedy: Remedy) -> Report {
    let robot = robot_of(Path::new(&report.name)).map(|path| path.display().to_string());
    let robot = robot.as_deref().unwrap_or("ROBOT.yaml");
    let words = match remedy {
        Remedy::CountAnew => "`rne search ROBOT.yaml` corrects the numbers".to_owned(),
        _ => format!(
            "`rne search {robot} --fresh` ignores the wrong parts of the plan and searches again; if you delete the \
             plan file, the build chooses by itself"
        ),
    };
    report.with_help(&words)
}

/// Returns an error of the compiler with a remedy.
pub(crate) fn of_compiler(error: &CompileError) -> String {
    match error.remedy() {
        Some(Remedy::RewriteAfresh) => {
            format!("{error}; `rne search ROBOT.yaml --rewrite --fresh` writes a new plan")
        }
        Some(_) => format!("{error}; `rne search ROBOT.yaml --fresh` finds another plan"),
        None => error.to_string(),
    }
}
