//! `rne certify`: measures what the code of an arm costs on a microcontroller, and how accurate it is.

mod certificate_file;
mod code;
mod command;
mod measurement;
mod options;
mod subject;
mod tools;
mod trace;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_certify::board::Call;
use rne_certify::certificate::{Certificate, Certified, Traced, trace};
use rne_certify::cycles::Core;
use rne_certify::joint_functions::JointFunction;
use rne_certify::observer::LowPass;
use rne_certify::{misra, sha256};
use rne_codegen::CheckFor as _;
use rne_codegen::{Form, Function, Order, Program};
use rne_emit::{CCode, Precision, Prefix};
use rne_model::Robot;

use crate::commands::certify::code::{Code, build};
use crate::commands::certify::command::file_name;
use crate::commands::certify::measurement::Measurement;
use crate::commands::certify::subject::Subject;
use crate::commands::certify::tools::Tool;
use crate::commands::emit::c::{self, Request};
use crate::commands::emit::{Real, functions};
use crate::commands::toolchain;
use crate::files::chosen_arm::Rotors;
use crate::files::input_file::is_stream;
use crate::files::plan_file::{self, Compiler};
use crate::files::reading;
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::TITLE;
use crate::values::choice;

/// Certify code for a microcontroller: cycles, stack, error
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne certify docs/desk_arm.yaml --cpu cortex-m4 -o desk_arm.cert.md
  rne certify docs/desk_arm.yaml --check desk_arm.cert.md
  rne certify docs/desk_arm.yaml --observer --gain 20 --period 0.001
  rne certify docs/desk_arm_identified.yaml --friction --limits

The command compiles the code of `rne emit --lang c`, reads its instructions by
objdump, runs it in QEMU, compares the results with those of this computer, and
bounds their error. It fails if the code branches, uses doubles, or calls other
functions than its sine. Needed: arm-none-eabi-gcc; used if installed:
qemu-system-arm, cppcheck. To certify a file of `rne emit`, give the same
options as there. See docs/firmware/assurance.md.")]
#[allow(clippy::struct_excessive_bools)] // options of a command
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,
    #[command(flatten)]
    pub(super) rotors: Rotors,
    /// Language of the code: c or rust
    #[arg(long, value_enum, default_value_t = Language::C, hide_possible_values = true)]
    pub(super) lang: Language,
    /// Compiler [default: arm-none-eabi-gcc or rustc]
    #[arg(long, value_name = "PROGRAM")]
    pub(super) cc: Option<String>,
    /// More options for the compiler, in one argument
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true, allow_hyphen_values = true)]
    pub(super) cc_options: String,
    /// cortex-m4 or cortex-m7, with FPU
    #[arg(long, value_name = "CORE", default_value = "cortex-m4", value_parser = core)]
    pub(super) cpu: Core,
    /// Functions to certify, F,F,…; see `rne explain functions`
    #[arg(long = "function", value_name = "F", value_delimiter = ',', value_parser = choice::function(),
        default_value = "inverse_dynamics", hide_possible_values = true)]
    functions: Vec<Function>,
    /// Certify an update of the momentum observer, too
    #[arg(long)]
    pub(super) observer: bool,
    /// Gain of the observer's low-pass, Hz
    #[arg(long, value_name = "HZ", default_value_t = 20.0, requires = "observer", allow_negative_numbers = true)]
    pub(super) gain: f64,
    /// Period of the observer's updates, s
    #[arg(long, value_name = "S", default_value_t = 0.001, requires = "observer", allow_negative_numbers = true)]
    pub(super) period: f64,
    /// Form: reduced or seven_steps
    #[arg(long, value_name = "F", value_parser = choice::form(), default_value = Form::Reduced.name(),
        hide_possible_values = true)]
    pub(super) form: Form,
    /// Order: formulas or registers
    #[arg(long, value_name = "O", default_value_t = Order::Formulas, value_parser = choice::order(),
        hide_possible_values = true)]
    order: Order,
    /// Prefix of names in C [default: the robot's name]
    #[arg(long, value_name = "P")]
    pub(super) prefix: Option<Prefix>,
    /// Name of the code's file; not read [default: as FILE]
    #[arg(long, value_name = "SOURCE")]
    pub(super) source: Option<PathBuf>,
    /// Certify friction and its derivatives, too
    #[arg(long)]
    friction: bool,
    /// Certify limit_torques, too
    #[arg(long)]
    limits: bool,
    /// Certify code with the indices of `rne emit --names`
    #[arg(long)]
    names: bool,
    /// Certify code with the tests of `rne emit --tests`
    #[arg(long)]
    tests: bool,
    /// Certify code with ASCII comments
    #[arg(long)]
    ascii: bool,
    /// Fail without these tools: qemu, cppcheck, or both
    #[arg(long, value_enum, value_name = "TOOLS", value_delimiter = ',', hide_possible_values = true)]
    pub(super) require: Vec<Tool>,
    /// Number of random states, at least 1
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = states,
        allow_negative_numbers = true)]
    pub(super) states: usize,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Also write C code, header and trace to this folder
    #[arg(long, value_name = "FOLDER")]
    pub(super) evidence: Option<PathBuf>,
    /// Number type of C in FOLDER: float (default), double
    #[arg(long, value_enum, value_name = "TYPE", hide_possible_values = true, requires = "evidence")]
    pub(super) real: Option<Real>,
    /// Print JSON: certificate and a trace of all lines
    #[arg(long)]
    pub(super) json: bool,
    /// Output file; - is standard output [default: -]
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// Overwrite OUT even if it is no certificate
    #[arg(long, requires = "output")]
    pub(super) force: bool,
    /// Check OUT, and the code beside it
    #[arg(long, value_name = "OUT", conflicts_with_all = ["output", "evidence", "force", "real"])]
    pub(super) check: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Language {
    C,
    Rust,
}

impl Language {
    fn name(self) -> &'static str {
        match self {
            Self::C => "c",
            Self::Rust => "rust",
        }
    }

    /// Returns the compiler that is used if the command line names none.
    const fn compiler(self) -> &'static str {
        match self {
            Self::C => "arm-none-eabi-gcc",
            Self::Rust => "rustc",
        }
    }
}

impl Arguments {
    /// Returns the functions whose programs are compiled, each once, in the order of `rne emit`.
    fn programs(&self) -> Vec<Function> {
        let of_observer = self.observer.then_some(Function::MomentumAndRate);
        let is_asked = |function: &Function| self.functions.contains(function) || of_observer == Some(*function);
        Function::ALL.into_iter().filter(is_asked).collect()
    }

    /// Returns the options that `rne emit` has, too, each with whether the command line gives it.
    fn flags(&self) -> [(&'static str, bool); 6] {
        [
            ("--rotors", self.rotors.rotors),
            ("--friction", self.friction),
            ("--limits", self.limits),
            ("--names", self.names),
            ("--tests", self.tests),
            ("--ascii", self.ascii),
        ]
    }

    /// Returns the functions to certify: programs and the observer, then friction and limits.
    fn subjects<'a>(&self, robot: &Robot, programs: &'a [Program]) -> Result<Vec<Subject<'a>>, Failure> {
        let low_pass = LowPass { gain: self.gain, period: self.period };
        let subject = |program: &'a Program| match program.function {
            Function::MomentumAndRate if self.observer => Subject::Observer(program, low_pass),
            _ => Subject::Program(program),
        };
        let mut subjects: Vec<Subject> = programs.iter().map(subject).collect();
        if self.friction {
            let friction = c::friction(&self.file, robot)?;
            subjects.push(Subject::Joints(JointFunction::Friction(friction.clone())));
            subjects.push(Subject::Joints(JointFunction::FrictionDerivatives(friction)));
        }
        if self.limits {
            subjects.push(Subject::Joints(JointFunction::limits(robot)));
        }
        Ok(subjects)
    }

    /// Returns the C code, the same that `rne emit` writes.
    pub(super) fn c_code(
        &self,
        robot: &Robot,
        programs: &[Program],
        bytes: &[u8],
        precision: Precision,
    ) -> Result<CCode, Failure> {
        let request = Request {
            rollout: false,
            casadi: false,
            acados: false,
            runge_kutta: false,
            file: &self.file,
            bytes,
            prefix: self.prefix.as_ref(),
            precision,
            friction: self.friction,
            limits: self.limits,
            names: self.names || !robot.is_serial(),
            tests: self.tests,
            ascii: self.ascii,
        };
        c::c_code(&request, robot, programs)
    }
}

fn core(text: &str) -> Result<Core, String> {
    Core::named(text).ok_or_else(|| "the processors are cortex-m4 and cortex-m7".to_owned())
}

fn states(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("without a state there is no bound of the error; give 1 or more".to_owned()),
        Ok(states) => Ok(states),
        Err(_) => Err("it is no number of states; give a whole number, such as 10000".to_owned()),
    }
}

/// Number of states below which a note says that the measured error is of little value.
const FEW_STATES: usize = 100;

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    options::fit_together(arguments)?;
    let (certificate, remarks) = certificate(arguments)?;
    let mut outcome = certificate_file::written(arguments, &certificate)?;
    outcome.remark += &remarks;
    Ok(outcome)
}

/// Makes the certificate, and remarks on missing tools, on the checker and on warnings of the robot file.
fn certificate(arguments: &Arguments) -> Result<(Certificate, String), Failure> {
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &[], Frames::Dropped, Shape::Closed)?;
    let robot = arguments.rotors.of(checked.robot);
    if arguments.lang == Language::C && (arguments.names || !robot.is_serial()) {
        checked.identifiers.map_err(|report| Failure::from(&report))?;
    }
    let programs = programs(arguments, &robot)?;
    let subjects = arguments.subjects(&robot, &programs)?;
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(&robot));
    let call = |subject: &Subject| subject.call(prefix.as_str(), &robot);
    let calls: Vec<Call> = subjects.iter().map(call).collect::<Result<_, _>>()?;
    let (compiler, objdump, mut tools) = tools::compiler(arguments)?;
    let ([qemu, cppcheck], mut remarks) = tools::versions(arguments.lang, &arguments.require)?;
    remarks += &notes(arguments, &robot);
    let folder = tempfile::tempdir().map_err(Failure::input)?;
    let folder = folder.path();
    if let Some(evidence) = &arguments.evidence {
        remarks += &trace::write(arguments, evidence, &robot, &programs, &bytes)?;
    }
    let mut code = build(arguments, &robot, &programs, &compiler, &calls, &bytes, folder)?;
    let (objdump, has_qemu) = (objdump.as_str(), qemu.is_some());
    let measurement = Measurement { arguments, robot: &robot, prefix: &prefix, objdump, folder, has_qemu };
    let bar = reading::bar("certified", false);
    let certified =
        subjects.iter().zip(&calls).zip(&code.images).enumerate().map(|(index, ((subject, call), image))| {
            #[expect(clippy::cast_precision_loss, reason = "functions are few")]
            reading::show(&bar, index as f64 / subjects.len() as f64);
            measurement.of(subject, call, image)
        });
    let mut certified = certified.collect::<Result<Vec<Certified>, Failure>>()?.into_iter();
    let first = certified.next().ok_or_else(|| Failure::usage("no function is named"))?;
    let misra = cppcheck.is_some().then(|| violations(folder, &code)).transpose()?;
    let used = [("qemu-system-arm", qemu), ("cppcheck", cppcheck)];
    tools.extend(used.into_iter().filter_map(|(tool, version)| Some((tool.to_owned(), version?))));
    code.hashes.extend(hashes(arguments, &robot, &bytes, &compiler)?);
    let certificate = Certificate {
        command: command::of_certificate(arguments),
        emit: command::of_code(arguments, &code.source),
        robot: robot.name.clone(),
        language: arguments.lang.name(),
        form: arguments.form.to_string(),
        core: arguments.cpu.name().to_owned(),
        tools,
        first,
        more: certified.collect(),
        tests: arguments.tests,
        misra,
        trace: lines(arguments, &robot, &prefix, &subjects, &calls, &code.text),
        options: code.options,
        hashes: code.hashes,
    };
    Ok((certificate, remarks))
}

/// Compiles the programs of the functions, with their statements in the order that the command line asks for.
fn programs(arguments: &Arguments, robot: &Robot) -> Result<Vec<Program>, Failure> {
    let compiler = Compiler::new(&arguments.file, robot);
    let functions = arguments.programs();
    functions.iter().try_for_each(|function| function.check_base(robot)).map_err(Failure::usage)?;
    let programs = functions.into_iter().map(|function| compiler.compile(function, arguments.form));
    functions::in_order(arguments.order, arguments.form, programs.collect::<Result<_, _>>()?)
}

/// Returns the SHA-256 of the robot file, of its plan and of the compiler, by their names.
fn hashes(
    arguments: &Arguments,
    robot: &Robot,
    bytes: &[u8],
    compiler: &str,
) -> Result<BTreeMap<String, String>, Failure> {
    let name = if is_stream(&arguments.file) { "robot file".into() } else { file_name(&arguments.file) };
    let mut hashes = BTreeMap::from([(name, sha256(bytes))]);
    if let Some(plan) = plan_file::read(&arguments.file, robot)? {
        hashes.insert(file_name(Path::new(&plan.name)), sha256(plan.text.as_bytes()));
    }
    hashes.extend(toolchain::hash(compiler).map(|hash| (format!("compiler {compiler}"), hash)));
    Ok(hashes)
}

/// Returns the lines of the code, each with what it computes.
fn lines(
    arguments: &Arguments,
    robot: &Robot,
    prefix: &Prefix,
    subjects: &[Subject<'_>],
    calls: &[Call],
    code: &str,
) -> Vec<Traced> {
    let heads = subjects.iter().zip(calls).flat_map(|(subject, call)| {
        let own = format!("{}(", call.function);
        match (arguments.lang, subject) {
            (Language::Rust, _) => vec![format!("fn {}<", subject.name())],
            // the observer calls its program, so the lines of the program come first
            (Language::C, Subject::Observer(program, _)) => vec![format!("{prefix}_{}(", program.function), own],
            (Language::C, _) => vec![own],
        }
    });
    let joints: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
    heads.flat_map(|head| trace(code, &head, &joints)).collect()
}

/// Returns notes on options that have no effect, or too little.
fn notes(arguments: &Arguments, robot: &Robot) -> String {
    let mut notes = arguments.rotors.note(robot);
    let states = arguments.states;
    if states < FEW_STATES {
        let _ = writeln!(
            notes,
            "{TITLE}note{TITLE:#}: {states} random states are few: the bound of the error says little about others"
        );
    }
    notes
}

/// Counts how often the code violates each rule of MISRA C:2012. A rule for which no deviation is recorded is an error.
fn violations(folder: &Path, code: &Code) -> Result<BTreeMap<String, usize>, Failure> {
    let source = rne_emit::without_c_tests(&code.text);
    let found = misra::violations(&toolchain::misra(folder, &code.source, source)?);
    if let Some((rule, places)) = found.iter().find(|(rule, _)| misra::deviation(rule).is_none()) {
        return Err(input_error!(
            "cppcheck reports rule {rule} of MISRA C:2012, for which no deviation is recorded, at {}",
            places.join(", ")
        ));
    }
    Ok(found.into_iter().map(|(rule, places)| (rule, places.len())).collect())
}
