//! `rne search`: searches a reduced form with fewer operations.

use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rne_codegen::plan::{Accuracy, Cost};
use rne_codegen::{CheckFor as _, Function};
use rne_model::{Checked, Robot, plan_of};
use rne_search::{PlanFile, Progress, SearchError, SearchOptions};

use crate::files::input_file::is_stream;
use crate::files::interruption;
use crate::files::output_file::{self, Written};
use crate::files::plan_file;
use crate::files::plan_file::{Known, Read};
use crate::files::robot_file;
use crate::outcome::{Failure, INPUT, Outcome};
use crate::palette::{FOUND, GOOD, QUIET, TYPED};
use crate::values::choice;
use crate::values::choice::FunctionOrAll;

/// Search for code with fewer operations, and save it as a plan
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne search robots/puma560.yaml --seconds 60              writes a plan
  rne search robots/puma560.yaml --seconds 300 --rewrite   and shortens code
  rne search robots/puma560.yaml --seconds 600 --rewrite --function all

rne writes the plan file NAME.plan.yaml next to NAME.yaml. Every later build
uses this file without a search. A search starts from an existing plan and never
writes a worse plan, with one exception: a plan that loses much precision in f32
may be replaced by a plan with more operations. Ctrl-C ends the search and keeps
the best plan. A second Ctrl-C ends the search at once, with status 130. Before
rne writes a plan, it proves that the code computes the same as the seven steps.")]
pub(crate) struct Arguments {
    /// Robot file; the plan file is written next to it
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Duration of the search, s
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = seconds, allow_negative_numbers = true)]
    seconds: f64,
    /// Also shorten the code of the best plans by exact algebra, and keep the result if it saves operations
    #[arg(long)]
    rewrite: bool,
    /// Functions that --rewrite shortens, F,F,… or `all` [default: inverse_dynamics]; see `rne explain functions`
    #[arg(long = "function", value_name = "F", value_delimiter = ',', value_parser = choice::function_or_all(),
        hide_possible_values = true,
        requires = "rewrite")]
    functions: Vec<FunctionOrAll>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// If the plan file cannot be read or belongs to another robot, search anew and overwrite the file, in place of an
    /// error
    #[arg(long)]
    fresh: bool,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=1e6).contains(&seconds) => Ok(seconds),
        _ => Err("write a number of seconds, 0 to 1000000".to_owned()),
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if is_stream(&arguments.file) {
        return Err(Failure::usage("a search writes its plan next to the robot file, so it needs a file"));
    }
    if let Some(shipped) = rne_convert::shipped_at(&arguments.file) {
        let name = shipped.name;
        return Err(usage_error!(
            "a search writes its plan next to the robot file, so it needs a file: {TYPED}rne example {name} > \
             {name}.yaml{TYPED:#}"
        ));
    }
    let Checked { robot, lints, .. } = robot_file::robot_in_yaml(&arguments.file)?;
    robot_file::note_warnings(&arguments.file, &lints, &[]);
    let options = SearchOptions { rewrite: rewritten(arguments, &robot)?, seed: arguments.seed };
    let known = plan_file::known(&arguments.file, &robot, arguments.fresh)?;
    let path = plan_of(&arguments.file);
    interruption::expect();
    plan_file::is_writable(&path)?;
    let found = watched(&robot, known.plan.as_ref(), &options, arguments.seconds)
        .map_err(|error| input_error!("{}: {error}", arguments.file.display()))?;
    let searched = Searched { file: &arguments.file, robot: &robot, known, fresh: arguments.fresh };
    let Kept { plan, left_out, written } = searched.keep(found, || ())?;
    Ok(Outcome::text(summary(&plan, &searched, &left_out, &path, written)))
}

/// The robot and the functions for which a search runs.
struct Searched<'a> {
    file: &'a Path,
    /// The robot as it was read at the start.
    robot: &'a Robot,
    /// The plan from which the search started.
    known: Known,
    fresh: bool,
}

/// The content of the plan file after a search.
struct Kept {
    plan: PlanFile,
    /// Functions of the previous plan that are dropped, because their graphs are not proved.
    left_out: Vec<Function>,
    written: Written,
}

impl Searched<'_> {
    /// Writes the result of a search into the plan file, merged with what another search has written there meanwhile.
    /// The robot file is locked from reading to writing, so that of several searches that end together each sees the
    /// results of those before it; `between` is called while it is locked, for tests. Nothing is written if the robot
    /// has changed, or if a search could not begin from what is now at the place of the plan.
    fn keep(&self, mut found: PlanFile, between: impl FnOnce()) -> Result<Kept, Failure> {
        let path = plan_of(self.file);
        let _locked = locked(self.file);
        self.is_unchanged(&found)?;
        let now = plan_file::known(self.file, self.robot, self.fresh).map_err(|failure| meanwhile(&path, &failure))?;
        if now.text != self.known.text
            && let Some(plan) = now.plan
        {
            found.merge(plan);
            plan_file::is_proved(self.robot, &Read::of(&path, &found))?;
        }
        between();
        let written = output_file::replace(&path, &found.to_yaml())?;
        if written == Written::Anew {
            touch(self.file);
        }
        Ok(Kept { plan: found, left_out: now.left_out, written })
    }

    /// Checks that the robot file still has the robot for which the result was found; comments and names of joints may
    /// have changed.
    fn is_unchanged(&self, found: &PlanFile) -> Result<(), Failure> {
        let is_same =
            |Checked { robot, .. }| robot.name == found.robot && rne_search::fingerprint(&robot) == found.fingerprint;
        if robot_file::robot_in_yaml(self.file).is_ok_and(is_same) {
            return Ok(());
        }
        Err(input_error!(
            "{} has changed during the search: the result is for the old file, so {} is not written. Search again",
            self.file.display(),
            plan_of(self.file).display()
        ))
    }
}

/// Makes the error for a plan that has appeared or changed during the search, so that nothing is written.
fn meanwhile(path: &Path, failure: &Failure) -> Failure {
    let text = format!(
        "{}\n\n{} has changed during the search; rne does not overwrite it and does not write the result",
        failure.text.trim_end(),
        path.display()
    );
    Failure { text, status: INPUT }
}

/// Locks the robot file against other searches, until the returned file is dropped. `None` if the system cannot lock
/// it, because the result is still useful then; and on Windows, where a lock would keep every reader out.
fn locked(robot_file: &Path) -> Option<File> {
    if cfg!(windows) {
        return None;
    }
    let file = File::open(robot_file).ok()?;
    file.lock().ok()?;
    Some(file)
}

/// Returns the functions whose graphs `--rewrite` rewrites.
fn rewritten(arguments: &Arguments, robot: &Robot) -> Result<Vec<Function>, Failure> {
    let asked = &arguments.functions;
    let is_asked = |function: Function| match asked.as_slice() {
        [] => function == Function::InverseDynamics,
        _ => asked.contains(&FunctionOrAll::One(function)),
    };
    if !arguments.rewrite {
        return Ok(Vec::new());
    }
    let functions: Vec<Function> = Function::ALL.into_iter().filter(|&function| is_asked(function)).collect();
    if let Some(function) = functions.iter().find(|function| !function.can_be_rewritten()) {
        return Err(usage_error!("`{function}` has only the form seven_steps, so there is nothing to rewrite"));
    }
    // every reader would refuse a plan with a function that the robot does not have
    if let Some(error) = functions.iter().find_map(|function| function.check_for(robot).err()) {
        return Err(Failure::usage(error));
    }
    if asked.contains(&FunctionOrAll::All) {
        return Ok(choice::functions_of(robot).filter(|function| function.can_be_rewritten()).collect());
    }
    Ok(functions)
}

/// Searches with a progress bar on a terminal.
fn watched(
    robot: &Robot,
    known: Option<&PlanFile>,
    options: &SearchOptions,
    seconds: f64,
) -> Result<PlanFile, SearchError> {
    const STEPS: u64 = 1000;
    let bar = ProgressBar::new(STEPS);
    let style = ProgressStyle::with_template("{prefix:>10} [{bar:30}] {msg}").map(|style| style.progress_chars("=> "));
    if let Ok(style) = style {
        bar.set_style(style);
    }
    let start = Instant::now();
    let mut shown = start;
    let found = rne_search::search(robot, known, options, &mut |progress: &Progress| {
        if interruption::is_wished() {
            return None;
        }
        let elapsed = start.elapsed();
        let over = if seconds > 0.0 { elapsed.as_secs_f64() / seconds } else { 1.0 };
        if shown.elapsed() > Duration::from_millis(100) {
            shown = Instant::now();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
            // the position of the bar is from 0 to 1000
            bar.set_position((over.min(1.0) * STEPS as f64) as u64);
            bar.set_prefix(progress.phase);
            bar.set_message(format!("{} operations, {} plans", progress.best.total(), progress.plans));
        }
        (over < 1.0).then_some(over)
    });
    bar.finish_and_clear();
    found
}

fn summary(found: &PlanFile, searched: &Searched<'_>, left_out: &[Function], path: &Path, written: Written) -> String {
    let known = searched.known.plan.as_ref();
    let mut text = String::new();
    let count = |cost: &Cost| format!("{} products + {} sums = {}", cost.mul, cost.add, cost.total());
    let planned = format!("{}, planned", rne_codegen::function_of_plan(searched.robot));
    let names = found.rewritten.keys().map(|function| function.name().len());
    let width = names.max().map_or("reduced".len(), |longest| longest.max(planned.len()));
    let mut line = |name: &str, operations: &Cost, accuracy: &Accuracy| {
        let _ = writeln!(
            text,
            "{name:<width$}  {FOUND}{}{FOUND:#}, {} angles  {QUIET}double {:.0e}, single {:.0e} (seven steps {:.0e}) \
             of the largest number{QUIET:#}",
            count(operations),
            operations.sincos,
            accuracy.double,
            accuracy.single,
            accuracy.single_of_seven_steps,
        );
    };
    line(
        if found.rewritten.is_empty() { "reduced" } else { &planned },
        &found.reduced.operations,
        &found.reduced.accuracy,
    );
    for (function, rewritten) in &found.rewritten {
        line(function.name(), &rewritten.operations, &rewritten.accuracy);
    }
    let lost: Vec<&str> = left_out
        .iter()
        .filter(|function| !found.rewritten.contains_key(function))
        .map(|function| function.name())
        .collect();
    if !lost.is_empty() {
        let lost = lost.join(",");
        let _ = writeln!(
            text,
            "{QUIET}the rewritten code is left out, because the proof failed; `--rewrite --function {lost}` rewrites \
             it again{QUIET:#}"
        );
    }
    let state = match (written, known) {
        (Written::Unchanged, _) => "is as good as it was",
        (Written::Anew, Some(_)) => "is written anew",
        (Written::Anew, None) => "is written",
    };
    let _ = writeln!(text, "{GOOD}ok{GOOD:#} {TYPED}{}{TYPED:#} {state}", path.display());
    if written == Written::Anew {
        let _ =
            writeln!(text, "{QUIET}builds, emit and certify use this plan from now on: their code changes{QUIET:#}");
    }
    text
}

/// Updates the date of the robot file, which builds watch, so that they notice a new plan beside it.
fn touch(robot_file: &Path) {
    let touched =
        |path: &Path| -> io::Result<()> { OpenOptions::new().append(true).open(path)?.set_modified(SystemTime::now()) };
    // if this fails, builds notice the plan only when the robot file changes
    let _ = touched(robot_file);
}

#[cfg(test)]
mod tests {
    use std::fs;

    use rne_codegen::plan::Rewritten;

    use super::*;

    /// The robot and the plan of a test, in a folder of their own.
    struct Arm {
        folder: tempfile::TempDir,
        robot: Robot,
        plan: PlanFile,
    }

    impl Arm {
        fn new() -> Self {
            let folder = tempfile::tempdir().expect("a folder");
            let shipped = rne_robots::find("scara_cobra600").expect("shipped");
            let file = folder.path().join("arm.yaml");
            fs::write(&file, shipped.yaml).expect("written");
            let robot = robot_file::robot_in_yaml(&file).unwrap_or_else(|failure| panic!("{}", failure.text)).robot;
            let plan = PlanFile::read("plan", shipped.plan.expect("a plan"), &robot).expect("of the robot");
            Self { folder, robot, plan }
        }

        fn file(&self) -> PathBuf {
            self.folder.path().join("arm.yaml")
        }

        /// Returns the text of the file at the plan's path.
        fn written(&self) -> Option<String> {
            fs::read_to_string(plan_of(&self.file())).ok()
        }

        fn write(&self, plan: &str) {
            fs::write(plan_of(&self.file()), plan).expect("written");
        }

        /// Returns a plan that rewrites only one function.
        fn found(&self, function: Function) -> PlanFile {
            let mut found = self.plan.clone();
            found.rewritten.retain(|&one, _: &mut Rewritten| one == function);
            assert_eq!(found.rewritten.len(), 1, "{function} is rewritten");
            found
        }

        /// Ends a search that began without a plan.
        fn keep(&self, found: PlanFile, between: impl FnOnce()) -> Result<Kept, Failure> {
            self.keep_as(false, found, between)
        }

        fn keep_as(&self, fresh: bool, found: PlanFile, between: impl FnOnce()) -> Result<Kept, Failure> {
            let known = Known { text: None, plan: None, left_out: Vec::new() };
            Searched { file: &self.file(), robot: &self.robot, known, fresh }.keep(found, between)
        }
    }

    /// Returns the exit status and the message of a search that must not write.
    fn refused(kept: Result<Kept, Failure>) -> (u8, String) {
        let failure = kept.map(|_| ()).expect_err("nothing is written");
        let text = anstream::adapter::strip_str(&failure.text).to_string();
        (failure.status, text.split_whitespace().collect::<Vec<_>>().join(" "))
    }

    #[test]
    fn a_robot_that_changed_during_the_search_has_no_plan() {
        let arm = Arm::new();
        let text = fs::read_to_string(arm.file()).expect("a robot");
        for (from, to) in [("mass: ", "mass: 1+"), ("name: scara_cobra600", "name: another"), ("format: 1", "format")] {
            fs::write(arm.file(), text.replacen(from, to, 1)).expect("written");
            let (status, said) = refused(arm.keep(arm.plan.clone(), || ()));
            assert_eq!(status, INPUT);
            assert!(
                said.contains("arm.yaml has changed during the search") && said.contains("is not written"),
                "{said}"
            );
            assert_eq!(arm.written(), None);
        }
        fs::remove_file(arm.file()).expect("removed");
        refused(arm.keep(arm.plan.clone(), || ()));
        // a comment changes no number, so the result is still valid
        fs::write(arm.file(), format!("# a comment\n{text}")).expect("written");
        assert!(arm.keep(arm.plan.clone(), || ()).is_ok_and(|kept| kept.written == Written::Anew));
        assert_eq!(arm.written(), Some(arm.plan.to_yaml()));
    }

    #[test]
    fn what_is_no_plan_stays() {
        let arm = Arm::new();
        for notes in ["my notes\n", "format: 3\nrobot: scara_cobra600\n", "\u{0}"] {
            arm.write(notes);
            let (status, said) = refused(arm.keep(arm.plan.clone(), || ()));
            assert_eq!(status, INPUT);
            assert!(said.contains("arm.plan.yaml has changed during the search; rne does not overwrite it"), "{said}");
            assert_eq!(arm.written().as_deref(), Some(notes));
        }
        // a fresh search replaces a plan that cannot be read, but not a text that is no plan
        arm.write("my notes\n");
        refused(arm.keep_as(true, arm.plan.clone(), || ()));
        assert_eq!(arm.written().as_deref(), Some("my notes\n"));
        arm.write("format: 3\nfingerprint: 0\n");
        assert!(arm.keep_as(true, arm.plan.clone(), || ()).is_ok());
        assert_eq!(arm.written(), Some(arm.plan.to_yaml()));
    }

    /// A graph with a wrong sign claims fewer operations than all others, and must not be merged.
    #[test]
    fn a_plan_that_is_not_proved_is_not_merged() {
        let arm = Arm::new();
        let function = Function::MassMatrix;
        let right = arm.found(function).to_yaml();
        let wrong = right.replacen("results ", "results -", 1).replacen("--", "", 1);
        assert_ne!(right, wrong);
        arm.write(&wrong);
        let (_, said) = refused(arm.keep(arm.found(Function::ForwardDynamics), || ()));
        assert!(
            said.contains("does not compute the same as the seven steps") && said.contains("rne does not overwrite it"),
            "{said}"
        );
        assert_eq!(arm.written().as_deref(), Some(wrong.as_str()));
        let kept = arm.keep_as(true, arm.found(Function::ForwardDynamics), || ());
        let kept = kept.unwrap_or_else(|failure| panic!("{}", failure.text));
        assert_eq!(kept.left_out, [function]);
        assert_eq!(arm.written(), Some(arm.found(Function::ForwardDynamics).to_yaml()));
    }

    #[test]
    fn searches_that_end_together_lose_nothing() {
        let arm = Arm::new();
        let functions = [Function::MassMatrix, Function::ForwardDynamics, Function::InverseDynamics];
        let keep = |function: Function, between: &mut dyn FnMut()| {
            let kept = arm.keep(arm.found(function), between);
            kept.map_or_else(|failure| panic!("{}", failure.text), drop);
        };
        std::thread::scope(|scope| {
            // the other searches begin after the first one has read and before it writes; they wait for it
            keep(functions[0], &mut || {
                let other = File::open(arm.file()).expect("a robot");
                assert!(cfg!(windows) || matches!(other.try_lock(), Err(std::fs::TryLockError::WouldBlock)));
                for &function in &functions[1..] {
                    scope.spawn(move || keep(function, &mut || ()));
                }
            });
        });
        let written = arm.written().expect("a plan");
        let plan = PlanFile::read("plan", &written, &arm.robot).expect("a plan");
        assert!(functions.iter().all(|function| plan.rewritten.contains_key(function)), "{written}");
        let names = fs::read_dir(arm.folder.path()).expect("a folder").count();
        assert_eq!(names, 2, "neither a lock nor a temporary file is left");
    }
}
