//! `rne check`: is a robot file in order?

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_codegen::{Form, Function};
use rne_model::{Checked, Convention, JointKind, Robot};

use crate::layout::{left, width};
use crate::outcome::{Failure, Outcome};
use crate::plan_file::Compiler;
use crate::terminal::{GOOD, QUIET};
use crate::{plan_file, robot_file};

/// Check robot files and their plans: `ok` and lints, or every error with file, line and column
#[derive(Args)]
#[command(after_help = "\
Example:
  rne check robots/*.yaml

Exit status 1 when a file has errors; lints are warnings and leave it at 0.")]
pub(crate) struct Arguments {
    /// Robot files, or plans; - is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Outcome {
    let mut text = String::new();
    let mut bad = 0;
    let widest = arguments.files.iter().map(|path| width(&path.display().to_string())).max().unwrap_or(0);
    for path in &arguments.files {
        if plan_file::robot_of(path).is_some() {
            match plan(path) {
                Ok(about) => {
                    let file = left(&path.display().to_string(), widest);
                    let _ = writeln!(text, "{GOOD}ok{GOOD:#} {file}  {QUIET}{about}{QUIET:#}");
                }
                Err(failure) => {
                    bad += 1;
                    let _ = writeln!(text, "\n{}\n", failure.text);
                }
            }
            continue;
        }
        match robot_file::read(path) {
            Ok(Checked { robot, lints }) => {
                let file = left(&path.display().to_string(), widest);
                let _ = writeln!(text, "{GOOD}ok{GOOD:#} {file}  {QUIET}{}{QUIET:#}", about(&robot));
                if !lints.is_empty() {
                    let _ = writeln!(text, "\n{}\n", lints.render(true));
                }
                // its plan goes with it
                if let Err(failure) = plan_file::read(path, &robot) {
                    bad += 1;
                    let _ = writeln!(text, "\n{}\n", failure.text);
                }
            }
            Err(failure) => {
                bad += 1;
                let _ = writeln!(text, "\n{}\n", failure.text);
            }
        }
    }
    if arguments.files.len() > 1 && bad > 0 {
        let _ = writeln!(text, "{bad} of {} files have errors", arguments.files.len());
    }
    Outcome { text: text.trim_start_matches('\n').to_owned(), at_fault: bad > 0, ..Outcome::default() }
}

/// Whether a plan belongs to its robot and gives what the seven steps give; what it costs, in a few words.
fn plan(path: &Path) -> Result<String, Failure> {
    let file = plan_file::robot_of(path).unwrap_or_default();
    let robot = robot_file::robot(&file)?;
    let compiler = Compiler::new(&file, &robot);
    let count = |form: Form| -> Result<String, Failure> {
        let operations = compiler.compile(Function::InverseDynamics, form)?.operations();
        Ok(format!("{form} {}", operations.total()))
    };
    let mut words = vec![count(Form::Reduced)?];
    if compiler.choice()?.rewritten.is_some() {
        words.push(count(Form::Rewritten)?);
    }
    Ok(format!("plan of {}: {} operations, proved", robot.name, words.join(", ")))
}

/// The robot in a few words: `puma560, RRRRRR, standard`.
fn about(robot: &Robot) -> String {
    let joints: String = robot
        .rows()
        .map(|row| match row.kind {
            JointKind::Revolute => 'R',
            JointKind::Prismatic => 'P',
        })
        .collect();
    let convention = match robot.convention {
        Convention::Standard => "standard",
        Convention::Modified => "modified",
    };
    format!("{}, {joints}, {convention}", robot.name)
}
