//! `rne check`: checks robot files and plan files.

mod at_zero;
mod repair;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use rne_codegen::Form;
use rne_model::{Checked, Robot, golden_of, misnamed_golden_of, plan_of, robot_of};

use crate::files::plan_file;
use crate::files::plan_file::Compiler;
use crate::files::reading;
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome, rendered};
use crate::palette::{GOOD, QUIET, WARNING};
use crate::render::heading::about;
use crate::render::layout::{left, width};
use crate::render::physics;
use crate::values::choice;

/// Check robot files and plans; print errors, warnings and notes
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne check robots/*.yaml
  rne check --physics robots/planar2.yaml
  rne check --deny-warnings my_arm.yaml
  rne check --repair robots/puma560.yaml   corrects wrong inertias
  rne check robots/puma560.plan.yaml   compiles and proves a plan

`rne search` writes plan files (NAME.plan.yaml). A plan file lists the choices
that save operations in the code of a robot. rne also checks the plan file next
to a robot file. If an arm has at most 8 joints, a note names each function for
which rne refuses the reduced form, which is the code with the fewest
operations. The note gives the reason.

The exit status is 1 if a file has errors, or if an arm violates a law of
mechanics by more than rounding. Warnings and notes do not change the status 0,
except with --deny-warnings, which makes every warning count as an error.
docs/reference/robot-file-keys.md explains every key of a robot file. If a URDF
or an MJCF file does not say which arm is meant, rne checks the whole robot.")]
#[allow(clippy::struct_excessive_bools)] // options of a command
pub(crate) struct Arguments {
    /// Robot files, URDFs, names from `rne list`, or plan files of `rne search` (NAME.plan.yaml: choices that save
    /// operations in the code); - is standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Check laws of mechanics that every arm obeys, and print the deviations
    #[arg(long)]
    physics: bool,
    /// Exit with status 1 if there is a warning, for continuous integration
    #[arg(long)]
    deny_warnings: bool,
    /// Propose a repair of each link that cannot exist; exit with status 1 if there is such a link
    #[arg(long, conflicts_with_all = ["physics", "deny_warnings"])]
    repair: bool,
    /// Write the repairs into the files, if each link has only one
    #[arg(long, requires = "repair")]
    write: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if arguments.repair {
        return repair::run(&arguments.files, arguments.write);
    }
    let mut text = String::new();
    let mut bad = 0;
    let widest = arguments.files.iter().map(|path| width(&path.display().to_string())).max().unwrap_or(0);
    let bar = reading::bar("checked", false);
    for (index, path) in arguments.files.iter().enumerate() {
        #[expect(clippy::cast_precision_loss, reason = "files are few")]
        reading::show(&bar, index as f64 / arguments.files.len() as f64);
        let checked = match robot_of(path) {
            Some(robot_file) => plan(&robot_file),
            None => robot(path, arguments),
        };
        match checked {
            Ok(Good { about, lints, warnings, laws, at_zero }) => {
                let is_denied = arguments.deny_warnings && warnings > 0;
                bad += usize::from(is_denied);
                let verdict = if is_denied { denied(warnings) } else { format!("{GOOD}ok{GOOD:#}") };
                let file = left(&path.display().to_string(), widest);
                let _ = writeln!(text, "{verdict} {file}  {QUIET}{about}{QUIET:#}");
                if let Some((laws, hold)) = laws {
                    text.push_str(&laws);
                    bad += usize::from(!hold);
                }
                if let Some(lints) = lints {
                    let _ = writeln!(text, "\n{lints}\n");
                }
                // several files have one line each
                if arguments.files.len() == 1 {
                    text.push_str(&at_zero);
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
    Ok(Outcome { text: text.trim_start_matches('\n').to_owned(), at_fault: bad > 0, ..Outcome::default() })
}

/// Returns the words before the name of a file if its warnings count as errors.
fn denied(warnings: usize) -> String {
    let s = if warnings == 1 { "" } else { "s" };
    format!("{WARNING}{warnings} warning{s} denied{WARNING:#}")
}

/// The result for a file without errors.
struct Good {
    /// The robot or the plan in a few words.
    about: String,
    lints: Option<String>,
    /// The number of warnings.
    warnings: usize,
    /// The laws of physics as lines of text, and whether all hold; `None` without `--physics`.
    laws: Option<(String, bool)>,
    /// The tip and the torques of gravity with all joints at zero, as lines of text.
    at_zero: String,
}

/// Checks a robot file together with its plan; the plan is skipped if it is among the files to check itself.
fn robot(path: &Path, arguments: &Arguments) -> Result<Good, Failure> {
    // the laws are those of trees whose loops are cut
    let shape = if arguments.physics { Shape::Coupled } else { Shape::Closed };
    let Checked { robot, lints, .. } = robot_file::read_with(path, &[], Frames::DroppedOfAll, shape)?;
    if !arguments.files.contains(&plan_of(path))
        && let Some(read) = plan_file::read(path, &robot)?
    {
        plan_file::verify(&robot, &read)?;
    }
    let refusals = refusals(path, &robot)?;
    let laws = arguments.physics.then(|| physics::check(&robot)).transpose().map_err(Failure::input)?;
    let (misnamed, at_zero) = (misnamed_golden(path), at_zero::lines(&robot));
    let warnings = lints.warnings().count() + usize::from(misnamed.is_some());
    let lints = (!lints.is_empty()).then(|| rendered(&lints));
    let lints: Vec<String> = lints.into_iter().chain(misnamed).chain(refusals).collect();
    Ok(Good { about: about(&robot), lints: (!lints.is_empty()).then(|| lints.join("\n\n")), warnings, laws, at_zero })
}

/// Returns notes on functions whose reduced form a build would refuse, with the reasons.
fn refusals(path: &Path, robot: &Robot) -> Result<Vec<String>, Failure> {
    /// Number of joints above which this check is skipped, because it would take long; `rne show` can check one
    /// function.
    const MOST_JOINTS: usize = 8;
    // a file with geometry only already has a warning, which also says why accelerations cannot be computed
    let has_links = robot.joints.iter().any(|joint| !joint.row.link.is_empty());
    if robot.joints.len() > MOST_JOINTS || !has_links {
        return Ok(Vec::new());
    }
    let compiler = Compiler::new(path, robot);
    let mut programs = Vec::new();
    for function in choice::functions_of(robot) {
        // only commands that write code report code that does not compile
        let Ok(program) = compiler.compiled(function, Form::Reduced)? else { continue };
        let is_reduced = program.form == Form::Reduced;
        programs.push(program);
        if is_reduced && rne_codegen::loses_digits(robot) {
            programs.extend(compiler.compiled(function, Form::SevenSteps)?.ok());
        }
    }
    let notes = programs.iter().map(rne_emit::refusals).chain([rne_emit::losses(&programs)]);
    let notes = notes.filter(|lines| !lines.is_empty());
    Ok(notes.map(|lines| format!("{QUIET}note{QUIET:#}: {}", lines.join("\n"))).collect())
}

/// Finds a golden file whose name is wrong, so that the tests of a derive would not find it.
fn misnamed_golden(path: &Path) -> Option<String> {
    let found = if path.is_file() { misnamed_golden_of(path) } else { None }?;
    Some(format!(
        "{WARNING}warning{WARNING:#}: {} is not the golden file of {}; did you mean to name it {}?",
        found.display(),
        path.display(),
        golden_of(path).display()
    ))
}

/// Checks that a plan belongs to its robot and that its code computes the same as the seven steps; returns its cost in
/// operations.
fn plan(robot_file: &Path) -> Result<Good, Failure> {
    let robot = robot_file::robot(robot_file, Shape::Coupled)?;
    let Some(read) = plan_file::read(robot_file, &robot)? else {
        return Err(input_error!("there is no plan {}", plan_of(robot_file).display()));
    };
    let counts = plan_file::verify(&robot, &read)?;
    let planned = counts.first().map_or(0, |(.., total)| *total);
    let of_plan = rne_codegen::function_of_plan(&robot);
    let torques = counts.iter().find(|(function, is_rewritten, _)| *is_rewritten && *function == of_plan);
    let rewritten = torques.map_or_else(String::new, |(.., total)| format!(", rewritten {total}"));
    let others = counts.len() - 1 - usize::from(torques.is_some());
    let others = match others {
        0 => String::new(),
        1 => "; 1 other function rewritten".to_owned(),
        others => format!("; {others} other functions rewritten"),
    };
    let about = format!("plan of {}: {of_plan} {planned} operations{rewritten}{others}; proved", robot.name);
    Ok(Good { about, lints: None, warnings: 0, laws: None, at_zero: String::new() })
}
