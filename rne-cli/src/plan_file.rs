//! Plan files beside robot files.

use std::cell::OnceCell;
use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::ProgressBar;
use rne_codegen::plan::{Choice, PlanFile};
use rne_codegen::{CompileError, Form, Function, Program, compile};
use rne_model::Robot;

use crate::outcome::Failure;
use crate::output_file::{self, Existing};

/// Far more than the largest plan.
const LONGEST: u64 = 16 << 20;

/// `NAME.plan.yaml` beside `NAME.yaml`.
pub(crate) fn path(robot_file: &Path) -> PathBuf {
    robot_file.with_extension("plan.yaml")
}

/// `NAME.yaml` of `NAME.plan.yaml`; `None` when a path is not that of a plan.
pub(crate) fn robot_of(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?.strip_suffix(".plan.yaml")?;
    Some(path.with_file_name(format!("{name}.yaml")))
}

/// The robot files among paths: a plan goes with its robot, and a pattern such as `robots/*.yaml` means both.
pub(crate) fn robots(paths: &[PathBuf]) -> impl Iterator<Item = &PathBuf> {
    let all_are_plans = paths.iter().all(|path| robot_of(path).is_some());
    paths.iter().filter(move |path| all_are_plans || robot_of(path).is_none())
}

/// The plan file of a robot file, if there is one.
pub(crate) fn read(robot_file: &Path, robot: &Robot) -> Result<Option<PlanFile>, Failure> {
    if robot_file == Path::new("-") {
        return Ok(None);
    }
    let path = path(robot_file);
    let shown = path.display();
    let mut text = String::new();
    match File::open(&path).and_then(|file| file.take(LONGEST).read_to_string(&mut text)) {
        Ok(_) => PlanFile::read(&shown.to_string(), &text, robot).map(Some).map_err(|report| Failure::from(&report)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Failure::input(format_args!("{shown} cannot be read: {error}"))),
    }
}

/// The plan that a fresh search starts from: one that fits, or none where it is stale or broken. What is no plan at all stays.
pub(crate) fn to_replace(robot_file: &Path, robot: &Robot) -> Result<Option<PlanFile>, Failure> {
    let path = path(robot_file);
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
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let probe = folder.join(format!(".{}.rne-search.tmp", std::process::id()));
    let failure = |error| Failure::input(format_args!("{} cannot be written: {error}", path.display()));
    if path.is_dir() {
        return Err(Failure::input(format_args!("{} is a folder; the plan cannot be written", path.display())));
    }
    File::create(&probe).map_err(failure)?;
    std::fs::remove_file(&probe).map_err(failure)
}

/// Compiles the functions of one robot, by its plan file if it has one. The choices are made once, when they are needed.
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
        let name = path(file).display().to_string();
        let plan = PlanFile::read(&name, plan, robot).map_err(|report| Failure::from(&report))?;
        Ok(Self { robot, file, choice: OnceCell::from(Choice::from(plan)) })
    }

    /// The choices of the plan file, or those that a build makes by itself.
    pub(crate) fn choice(&self) -> Result<&Choice, Failure> {
        if let Some(choice) = self.choice.get() {
            return Ok(choice);
        }
        let plan = read(self.file, self.robot)?;
        Ok(self.choice.get_or_init(|| plan.map_or_else(|| Choice::default_of(self.robot), Choice::from)))
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
