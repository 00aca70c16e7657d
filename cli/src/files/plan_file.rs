//! Reads, checks and uses plan files beside robot files.

use std::cell::OnceCell;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::ProgressBar;
use rne_codegen::CheckFor as _;
use rne_codegen::plan::{PlanSet, Trick};
use rne_codegen::{self as codegen, CompileError, Form, Function, Program, Remedy, Target};
use rne_machine::CompiledArm;
use rne_model::{Robot, plan_of, read_file, robot_of};
use rne_search::PlanFile;

use crate::files::input_file::is_stream;
use crate::files::output_file::{self, Existing, Replacement, unwritable};
use crate::outcome::Failure;

/// Returns the robot files among paths. Plans are skipped, because each is read with its robot, and a pattern such as
/// `robots/*.yaml` includes both.
pub(crate) fn robots(paths: &[PathBuf]) -> impl Iterator<Item = &PathBuf> {
    let all_are_plans = paths.iter().all(|path| robot_of(path).is_some());
    paths.iter().filter(move |path| all_are_plans || robot_of(path).is_none())
}

/// A plan file, with its name and text for messages.
#[derive(Clone, Debug)]
pub(crate) struct Read {
    /// The name of the file in messages.
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) plan: PlanFile,
}

impl Read {
    /// Makes a plan as reading its written file would give it.
    pub(crate) fn of(path: &Path, plan: &PlanFile) -> Self {
        Self { name: path.display().to_string(), text: plan.to_yaml(), plan: plan.clone() }
    }
}

/// Reads the plan file of a robot file, if there is one.
pub(crate) fn read(robot_file: &Path, robot: &Robot) -> Result<Option<Read>, Failure> {
    if is_stream(robot_file) {
        return Ok(None);
    }
    if let Some(shipped) = rne_convert::shipped_at(robot_file) {
        let Some(text) = shipped.plan else { return Ok(None) };
        let name = format!("the plan of {} (shipped)", shipped.name);
        let plan = PlanFile::read(&name, text, robot).map_err(|report| Failure::plan(report, Remedy::SearchAfresh))?;
        return Ok(Some(Read { name, text: text.to_owned(), plan }));
    }
    let path = plan_of(robot_file);
    let name = path.display().to_string();
    let bytes = match read_file(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(input_error!("{name} cannot be read: {error}")),
    };
    let text = String::from_utf8(bytes).map_err(|_| input_error!("{name} is not text in UTF-8"))?;
    let plan = PlanFile::read(&name, &text, robot).map_err(|report| Failure::plan(report, Remedy::SearchAfresh))?;
    Ok(Some(Read { name, text, plan }))
}

/// The plan from which a search starts.
#[derive(Debug)]
pub(crate) struct Known {
    /// The text of the plan file; `None` if there is no such file.
    pub(crate) text: Option<String>,
    /// The part of the plan that is proved.
    pub(crate) plan: Option<PlanFile>,
    /// Functions whose graphs are not proved, if this is not an error.
    pub(crate) left_out: Vec<Function>,
}

/// Reads the plan from which a search starts. The compiler proves that its programs compute the functions of the robot.
/// A program that it cannot prove is an error, except for a `fresh` search, which starts without it.
pub(crate) fn known(robot_file: &Path, robot: &Robot, fresh: bool) -> Result<Known, Failure> {
    if fresh {
        let text = match output_file::existing(&plan_of(robot_file)) {
            Existing::Text(text) => Some(text),
            _ => None,
        };
        let (plan, left_out) = to_replace(robot_file, robot)?;
        return Ok(Known { text, plan, left_out });
    }
    let Some(read) = read(robot_file, robot)? else {
        return Ok(Known { text: None, plan: None, left_out: Vec::new() });
    };
    is_proved(robot, &read)?;
    Ok(Known { text: Some(read.text), plan: Some(read.plan), left_out: Vec::new() })
}

/// Reads the plan from which a `fresh` search starts: the part of a fitting plan that can be proved, and the functions
/// whose graphs cannot. A plan that is out of date or broken is ignored. A file that is no plan is an error, so that it
/// is not overwritten.
fn to_replace(robot_file: &Path, robot: &Robot) -> Result<(Option<PlanFile>, Vec<Function>), Failure> {
    let path = plan_of(robot_file);
    match output_file::existing(&path) {
        Existing::Nothing => Ok((None, Vec::new())),
        Existing::Text(text) if text.contains("\nfingerprint: ") || text.trim().is_empty() => {
            let Ok(mut plan) = PlanFile::read(&path.display().to_string(), &text, robot) else {
                return Ok((None, Vec::new()));
            };
            let compiles = |(function, plans): &(Function, PlanSet)| compiled(robot, *function, plans.clone()).is_ok();
            let mut described = plan.described(robot).into_iter();
            // if the torques of a plan cannot be proved, nothing of it is used
            if !described.next().is_some_and(|torques| compiles(&torques)) {
                return Ok((None, plan.rewritten.into_keys().collect()));
            }
            let wrong: Vec<Function> = described.filter(|one| !compiles(one)).map(|(function, _)| function).collect();
            plan.rewritten.retain(|function, _| !wrong.contains(function));
            Ok((Some(plan), wrong))
        }
        _ => Err(usage_error!(
            "{} was not written by `rne search`, so rne does not overwrite it; move or rename this file",
            path.display()
        )),
    }
}

/// Checks that a plan can be written, before the search and not after it.
pub(crate) fn is_writable(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(input_error!("{} is a folder; the plan cannot be written", path.display()));
    }
    Replacement::begin(path).map(drop).map_err(|error| unwritable(path, &error))
}

fn compiled(robot: &Robot, function: Function, plans: PlanSet) -> Result<Program, CompileError> {
    codegen::Compiler::new(robot).with_plans(plans).compile(function, Form::Reduced)
}

/// Makes an error of the compiler at its place in the plan file, with a remedy.
fn located(name: &str, text: &str, described: (Function, &PlanSet), error: &CompileError) -> Failure {
    Failure::plan(PlanFile::located(name, text, described, error), Remedy::SearchAfresh)
}

/// Checks that all programs that a plan file describes can be proved; an error is at its place in the plan file.
pub(crate) fn is_proved(robot: &Robot, Read { name, text, plan }: &Read) -> Result<(), Failure> {
    plan.described(robot).into_iter().try_for_each(|(function, plans)| {
        let program = compiled(robot, function, plans.clone());
        program.map(drop).map_err(|error| located(name, text, (function, &plans), &error))
    })
}

/// Compiles and proves the programs that a plan file describes. Returns each function, whether it is rewritten, and its
/// number of operations. A program that a build would refuse is an error at its place in the plan file.
pub(crate) fn verify(robot: &Robot, Read { name, text, plan }: &Read) -> Result<Vec<(Function, bool, usize)>, Failure> {
    let count = |(function, plans): (Function, PlanSet)| {
        let program = compiled(robot, function, plans.clone())
            .map_err(|error| located(name, text, (function, &plans), &error))?;
        plan.counts(name, text, &program).map_err(|report| Failure::plan(report, Remedy::CountAnew))?;
        Ok((function, program.is_rewritten, program.operations().total()))
    };
    plan.described(robot).into_iter().map(count).collect()
}

/// Makes an arm whose functions run over many states, compiled with its plan file if it has one.
pub(crate) fn compiled_arm(file: &Path, robot: &Robot) -> Result<CompiledArm, Failure> {
    let arm = CompiledArm::from_robot(robot);
    Ok(match read(file, robot)? {
        Some(read) if robot.run_time.is_empty() => arm.by_plan(read.plan),
        _ => arm,
    })
}

/// Compiles the functions of one robot, with its plan file if it has one, which is read when it is first needed.
pub(crate) struct Compiler<'a> {
    robot: &'a Robot,
    file: &'a Path,
    without: &'a [Trick],
    target: Target,
    planned: OnceCell<codegen::Compiler<'a>>,
    /// The plan file, for errors that are located in it.
    read: OnceCell<Read>,
}

impl<'a> Compiler<'a> {
    pub(crate) fn new(file: &'a Path, robot: &'a Robot) -> Self {
        Self { robot, file, without: &[], target: Target::Latency, planned: OnceCell::new(), read: OnceCell::new() }
    }

    /// Makes a compiler for a robot that is part of this program, with the text of its plan.
    pub(crate) fn built_in(file: &'a Path, robot: &'a Robot, plan: &str) -> Result<Self, Failure> {
        let name = plan_of(file).display().to_string();
        let plan = PlanFile::read(&name, plan, robot).map_err(|report| Failure::plan(report, Remedy::SearchAfresh))?;
        Ok(Self { planned: OnceCell::from(codegen::Compiler::new(robot).with_plans(plan)), ..Self::new(file, robot) })
    }

    /// Makes a compiler that ignores the plan file, for a robot whose numbers differ from those of its file.
    pub(crate) fn without_file(file: &'a Path, robot: &'a Robot) -> Self {
        Self { planned: OnceCell::from(codegen::Compiler::new(robot)), ..Self::new(file, robot) }
    }

    /// Omits some tricks of the reduced form; the other choices of its plan stay.
    pub(crate) fn without(self, tricks: &'a [Trick]) -> Self {
        Self { without: tricks, ..self }
    }

    /// Arranges the programs for another target.
    pub(crate) fn for_target(self, target: Target) -> Self {
        Self { target, ..self }
    }

    /// Returns the choices of the plan file, or those that a build makes by itself.
    pub(crate) fn plans(&self) -> Result<&PlanSet, Failure> {
        Ok(self.planned()?.plans())
    }

    fn planned(&self) -> Result<&codegen::Compiler<'a>, Failure> {
        if let Some(compiler) = self.planned.get() {
            return Ok(compiler);
        }
        let compiler = codegen::Compiler::new(self.robot).for_target(self.target);
        let compiler = match read(self.file, self.robot)? {
            Some(read) => compiler.with_plans(self.read.get_or_init(|| read).plan.clone()),
            None => compiler,
        };
        let plans = (!self.without.is_empty()).then(|| rne_search::without(self.robot, compiler.plans(), self.without));
        let compiler = plans.map_or(compiler.clone(), |plans| compiler.with_plans(plans));
        Ok(self.planned.get_or_init(|| compiler))
    }

    pub(crate) fn compile(&self, function: Function, form: Form) -> Result<Program, Failure> {
        let program = self.compiled(function, form)?.map_err(|error| self.failure(function, form, &error));
        // measures lost digits, because with a badly conditioned mass matrix even code with frames near the arm loses
        // some; the matrix of a floating base without mass is always singular
        let is_measured = function.inverts_mass() && !function.is_of_floating_base();
        program.map(|program| if is_measured { codegen::measured(self.robot, program) } else { program })
    }

    /// Returns how the constants of a program in the reduced form are computed from the numbers of the robot file.
    pub(crate) fn derivation(&self, program: &Program) -> Result<Option<codegen::Derivation>, Failure> {
        let derivation = self.planned()?.derivation(program);
        derivation.map_err(|error| self.failure(program.function, program.form, &error))
    }

    /// Makes an error of the compiler; at its place in the plan file, if the plan is the cause.
    pub(crate) fn failure(&self, function: Function, form: Form, error: &CompileError) -> Failure {
        match (form, self.read.get(), self.planned.get()) {
            (Form::Reduced, Some(read), Some(compiler))
                if !matches!(error, CompileError::TooLarge { .. }) && function.check_kind(self.robot).is_ok() =>
            {
                let described = (function, compiler.plans());
                located(&read.name, &read.text, described, error)
            }
            _ => Failure::compile(&self.file.display().to_string(), error),
        }
    }

    /// Compiles a function; returns the program, or the error of its compilation.
    pub(crate) fn compiled(&self, function: Function, form: Form) -> Result<Result<Program, CompileError>, Failure> {
        let bar = self.sign_of_life(format!("{}: {function}, {form}", self.robot.name));
        let compiled = match form {
            Form::SevenSteps => codegen::Compiler::new(self.robot).compile(function, form),
            Form::Reduced => self.planned()?.compile(function, form),
        };
        bar.finish_and_clear();
        Ok(compiled)
    }

    /// Shows on a terminal which function is being compiled, for arms with which this takes long.
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
