//! Plan files beside robot files.

use std::cell::OnceCell;
use std::fs::File;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use rne_codegen::reduced::{Choice, PlanFile};
use rne_codegen::{Form, Function, Program, compile};
use rne_model::Robot;

use crate::outcome::Failure;

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
        let compiled = match form {
            Form::SevenSteps => compile(self.robot, function, form),
            Form::Reduced | Form::Rewritten => self.choice()?.compile(self.robot, function, form),
        };
        compiled.map_err(|error| Failure::compile(&self.file.display().to_string(), &error))
    }
}
