//! Plan files beside robot files.

use std::cell::OnceCell;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::ProgressBar;
use rne_codegen::plan::{Choice, PlanFile};
use rne_codegen::{CompileError, Form, Function, Program, compile};
use rne_model::{Robot, plan_of, read_file, robot_of};

use crate::outcome::Failure;
use crate::output_file::{self, Existing};

/// The robot files among paths: a plan goes with its robot, and a pattern such as `robots/*.yaml` means both.
pub(crate) fn robots(paths: &[PathBuf]) -> impl Iterator<Item = &PathBuf> {
    let all_are_plans = paths.iter().all(|path| robot_of(path).is_some());
    paths.iter().filter(move |path| all_are_plans || robot_of(path).is_none())
}

/// A plan file with what messages need of it.
#[derive(Clone, Debug)]
pub(crate) struct Read {
    /// What messages call it.
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) plan: PlanFile,
}

/// The plan file of a robot file, if there is one.
pub(crate) fn read(robot_file: &Path, robot: &Robot) -> Result<Option<Read>, Failure> {
    if robot_file == Path::new("-") {
        return Ok(None);
    }
    let path = plan_of(robot_file);
    let name = path.display().to_string();
    let bytes = match read_file(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(Failure::input(format_args!("{name} cannot be read: {error}"))),
    };
    let text = String::from_utf8(bytes).map_err(|_| Failure::input(format_args!("{name} is no text in UTF-8")))?;
    let plan = PlanFile::read(&name, &text, robot).map_err(|report| Failure::from(&report))?;
    Ok(Some(Read { name, text, plan }))
}

/// The plan that a fresh search starts from: one that fits, or none where it is stale or broken. What is no plan at all
/// stays.
pub(crate) fn to_replace(robot_file: &Path, robot: &Robot) -> Result<Option<PlanFile>, Failure> {
    let path = plan_of(robot_file);
    match output_file::existing(&path) {
        Existing::Nothing => Ok(None),
        Existing::Text(text) if text.contains("\nfingerprint: ") || text.trim().is_empty() => {
            let plan = PlanFile::read(&path.display().to_string(), &text, robot).ok();
            // a plan whose form cannot be proved is as good as none
            Ok(plan.filter(|plan| {
                let choice = Choice::from(plan.clone());
                let forms = [Some(Form::Reduced), choice.rewritten.as_ref().map(|_| Form::Rewritten)];
                forms.into_iter().flatten().all(|form| choice.compile(robot, Function::InverseDynamics, form).is_ok())
            }))
        }
        _ => Err(Failure::usage(format_args!(
            "{} is no plan that rne has written, and stays as it is; move it out of the way",
            path.display()
        ))),
    }
}

/// Whether a plan can be written there: better known before a search than after it.
pub(crate) fn is_writable(path: &Path) -> Result<(), Failure> {
    let failure = |error| Failure::input(format_args!("{} cannot be written: {error}", path.display()));
    if path.is_dir() {
        return Err(Failure::input(format_args!("{} is a folder; the plan cannot be written", path.display())));
    }
    output_file::beside(path).map(drop).map_err(failure)
}

/// Compiles the function that a plan is of in every form that it describes, and proves them; each form with its
/// operations. What a build would refuse is an error at its place in the plan file.
pub(crate) fn verify(robot: &Robot, Read { name, text, plan }: &Read) -> Result<Vec<(Form, usize)>, Failure> {
    let choice = Choice::from(plan.clone());
    let forms = [Some(Form::Reduced), plan.rewritten.as_ref().map(|_| Form::Rewritten)];
    let count = |form| {
        let program = choice.compile(robot, Function::InverseDynamics, form);
        let program = program.map_err(|error| Failure::from(&PlanFile::located(name, text, form, &error)))?;
        plan.counts(name, text, &program).map_err(|report| Failure::from(&report))?;
        Ok((form, program.operations().total()))
    };
    forms.into_iter().flatten().map(count).collect()
}

/// Compiles the functions of one robot, by its plan file if it has one. The choices are made once, when they are
/// needed.
pub(crate) struct Compiler<'a> {
    robot: &'a Robot,
    file: &'a Path,
    choice: OnceCell<Choice>,
}

impl<'a> Compiler<'a> {
    pub(crate) fn new(file: &'a Path, robot: &'a Robot) -> Self {
        Self { robot, file, choice: OnceCell::new() }
    }

    /// For a robot that is part of this program, with the text of its plan.
    pub(crate) fn built_in(file: &'a Path, robot: &'a Robot, plan: &str) -> Result<Self, Failure> {
        let name = plan_of(file).display().to_string();
        let plan = PlanFile::read(&name, plan, robot).map_err(|report| Failure::from(&report))?;
        Ok(Self { robot, file, choice: OnceCell::from(Choice::from(plan)) })
    }

    /// The choices of the plan file, or those that a build makes by itself.
    pub(crate) fn choice(&self) -> Result<&Choice, Failure> {
        if let Some(choice) = self.choice.get() {
            return Ok(choice);
        }
        let plan = read(self.file, self.robot)?.map(|read| Choice::from(read.plan));
        Ok(self.choice.get_or_init(|| plan.unwrap_or_else(|| Choice::default_of(self.robot))))
    }

    pub(crate) fn compile(&self, function: Function, form: Form) -> Result<Program, Failure> {
        self.compiled(function, form)?.map_err(|error| Failure::compile(&self.file.display().to_string(), &error))
    }

    /// The program, or why there is none.
    pub(crate) fn compiled(&self, function: Function, form: Form) -> Result<Result<Program, CompileError>, Failure> {
        let bar = self.sign_of_life(format!("{}: {function}, {form}", self.robot.name));
        let compiled = match form {
            Form::SevenSteps => compile(self.robot, function, form),
            Form::Reduced | Form::Rewritten => self.choice()?.compile(self.robot, function, form),
        };
        bar.finish_and_clear();
        Ok(compiled)
    }

    /// On a terminal, what an arm that is not done at once is at.
    fn sign_of_life(&self, what: String) -> ProgressBar {
        const SOON_DONE: usize = 8;
        if self.robot.dof() <= SOON_DONE {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::new_spinner().with_message(what);
        bar.enable_steady_tick(Duration::from_millis(100));
        bar
    }
}
