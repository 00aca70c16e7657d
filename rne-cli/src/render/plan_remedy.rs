//! Remedies against errors of plans, in the words of the command line.

use std::path::Path;

use rne_codegen::{CompileError, Remedy};
use rne_model::{Report, robot_of};

/// A mistake of a plan file with what helps.
pub(crate) fn helped(report: Report, remedy: Remedy) -> Report {
    let robot = robot_of(Path::new(&report.name)).map(|path| path.display().to_string());
    let robot = robot.as_deref().unwrap_or("ROBOT.yaml");
    let words = match remedy {
        Remedy::CountAnew => "`rne search ROBOT.yaml` counts anew".to_owned(),
        _ => format!(
            "`rne search {robot} --fresh` leaves out what is wrong in it and finds the rest anew; without the file, a \
             build chooses by itself"
        ),
    };
    report.with_remedy(&words)
}

/// An error of the compiler with what helps.
pub(crate) fn sentence(error: &CompileError) -> String {
    match error.remedy() {
        Some(Remedy::RewriteAfresh) => {
            format!("{error}; `rne search ROBOT.yaml --rewrite --fresh` writes the plan anew")
        }
        Some(_) => format!("{error}; `rne search ROBOT.yaml --fresh` finds another plan"),
        None => error.to_string(),
    }
}
