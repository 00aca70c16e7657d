//! `rne certify`: what the code of an arm costs on a microcontroller, and how exact it is.

pub(super) mod check;
pub(super) mod code;
pub(super) mod subject;
pub(super) mod tools;
pub(super) mod trace;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_certify::accuracy::Sample;
use rne_certify::board::Call;
use rne_certify::certificate::{Certificate, Certified, Cost, trace};
use rne_certify::cycles::{self, Core, Counter};
use rne_certify::image::{Image, NoFigures};
use rne_certify::joint_functions::JointFunction;
use rne_certify::observer::LowPass;
use rne_certify::{misra, sha256};
use rne_codegen::CheckFor as _;
use rne_codegen::{Argument, Form, Function, Order, Program};
use rne_emit::{CCode, Precision, Prefix};
use rne_model::Robot;

use crate::commands::certify::check::{check, code_beside};
use crate::commands::certify::code::{Code, build, emulate};
use crate::commands::certify::subject::Subject;
use crate::commands::certify::tools::Tool;
use crate::commands::emit::c::{self, Request};
use crate::commands::emit::{self, Real};
use crate::commands::toolchain;
use crate::files::chosen_arm::Rotors;
use crate::files::input_file::is_stream;
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::files::plan_file::{self, Compiler};
use crate::files::reading;
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{TITLE, TYPED};
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

    /// The compiler that is used if no other is named.
    const fn compiler(self) -> &'static str {
        match self {
            Self::C => "arm-none-eabi-gcc",
            Self::Rust => "rustc",
        }
    }
}

impl Arguments {
    /// The functions whose programs are compiled, each once, in the order of `rne emit`.
    fn programs(&self) -> Vec<Function> {
        let of_observer = self.observer.then_some(Function::MomentumAndRate);
        let is_asked = |function: &Function| self.functions.contains(function) || of_observer == Some(*function);
        Function::ALL.into_iter().filter(is_asked).collect()
    }

    /// Options that `rne emit` takes, too, and whether they are given.
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

    /// The functions to certify: programs and the observer; then friction and limits.
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

    /// The code in C as `rne emit` writes it.
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

/// Fewer states than these say little about the error.
const FEW_STATES: usize = 100;

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    fits_together(arguments)?;
    let (certificate, remarks) = certificate(arguments)?;
    let mut outcome = written(arguments, &certificate)?;
    outcome.remark += &remarks;
    Ok(outcome)
}

/// The certificate on standard output or in a file, or the check of a file.
fn written(arguments: &Arguments, certificate: &Certificate) -> Result<Outcome, Failure> {
    let text = if arguments.json {
        serde_json::to_string_pretty(certificate).map_err(Failure::input)? + "\n"
    } else {
        certificate.page()
    };
    if let Some(file) = &arguments.check {
        if matches!(output_file::existing(file), Existing::Text(found) if !is_ours(&found)) {
            return Err(Failure::input(format_args!("{} is no certificate of rne", file.display())));
        }
        return check(file, &text, certificate);
    }
    let Some(out) = arguments.output.as_deref().filter(|out| !is_standard_output(out)) else {
        return Ok(Outcome::text(text));
    };
    match output_file::existing(out) {
        Existing::Text(found) if !is_ours(&found) && !arguments.force => Err(Failure::usage(format_args!(
            "{} is no certificate of rne and is not changed; {TYPED}--force{TYPED:#} overwrites it",
            out.display()
        ))),
        Existing::Other if !arguments.force => {
            Err(Failure::usage(format_args!("{} is no certificate of rne and is not changed", out.display())))
        }
        Existing::Folder => Err(Failure::usage(format_args!("{} is a folder; name a file", out.display()))),
        Existing::Special => Err(Failure::usage(format_args!("{} is not a regular file", out.display()))),
        Existing::Unreadable(error) => Err(output_file::unreadable(out, &error)),
        _ => {
            let remark = output_file::write_all(&[(out, text)])?;
            let other = code_beside(out, certificate).err().map(|failure| failure.sentence());
            let note = other.map_or_else(String::new, |other| format!("{TITLE}note{TITLE:#}: {other}\n"));
            Ok(Outcome::remark(remark + &note))
        }
    }
}

/// Whether the options fit together, and the gain and the period of an observer are above zero.
fn fits_together(arguments: &Arguments) -> Result<(), Failure> {
    // rotors are in Rust, too
    let [_, of_c @ ..] = arguments.flags();
    if let Some((option, _)) = of_c.into_iter().find(|(_, is_given)| *is_given && arguments.lang != Language::C) {
        return Err(Failure::usage(format_args!("{TYPED}{option}{TYPED:#} is for {TYPED}--lang c{TYPED:#}")));
    }
    // a list of options that choose code: others write files or stop the compiler
    let chooses = |word: &str| ["-f", "-m", "-O", "-W", "--param", "-C"].iter().any(|start| word.starts_with(start));
    let words = arguments.cc_options.split_whitespace();
    let writes = |word: &str| ["-fdump", "-flto", "-fsyntax-only"].iter().any(|start| word.starts_with(start));
    if let Some(word) = words.into_iter().find(|word| !chooses(word) || writes(word)) {
        return Err(Failure::usage(format_args!(
            "{TYPED}--cc-options{TYPED:#} takes options that choose the code, such as -O3, -fno-schedule-insns or \
             -mtune=cortex-a5, but not `{word}`"
        )));
    }
    let of_joints = |argument: &Argument| {
        matches!(argument, Argument::Positions | Argument::Rates | Argument::Accelerations | Argument::Torques)
    };
    let returns_numbers = |function: &Function| {
        let mut shape = function.shape();
        while let rne_codegen::Shape::Array(_, of) = shape {
            shape = of;
        }
        *shape == rne_codegen::Shape::Number
    };
    let in_rust = |of: &&Function| of.arguments().iter().all(of_joints) && returns_numbers(of);
    if arguments.lang != Language::C
        && let Some(function) = arguments.functions.iter().find(|of| !in_rust(of))
    {
        return Err(Failure::usage(format_args!(
            "{TYPED}--lang rust{TYPED:#} certifies functions that take arrays of the joints alone and return a number, \
             a vector or a matrix, and no struct; for {function}, give {TYPED}--lang c{TYPED:#}"
        )));
    }
    if arguments.evidence.is_some() {
        trace::check_options(arguments, &arguments.programs())?;
    }
    if !arguments.observer {
        return Ok(());
    }
    if arguments.lang != Language::C {
        return Err(Failure::usage(format_args!(
            "{TYPED}--observer{TYPED:#} is for {TYPED}--lang c{TYPED:#}: in Rust, the observer is `rne::ObserverState`"
        )));
    }
    for (option, value) in [("--gain", arguments.gain), ("--period", arguments.period)] {
        // powers of ten between which the numbers of single precision are far from their ends
        if !(1e-6..=1e6).contains(&value) {
            return Err(Failure::usage(format_args!("{option} is {value}; it must be between 1e-6 and 1e6")));
        }
    }
    Ok(())
}

fn is_ours(text: &str) -> bool {
    text.trim().is_empty()
        || text.starts_with("# Certificate of `")
        || text.starts_with("{\n  \"command\": \"rne certify")
}

/// The compiler, its `objdump`, and the versions of both and of rne.
fn compiler(arguments: &Arguments) -> Result<(String, String, BTreeMap<String, String>), Failure> {
    let compiler = arguments.cc.clone().unwrap_or_else(|| arguments.lang.compiler().to_owned());
    let version = match arguments.lang {
        Language::C => toolchain::version_of_gcc(&compiler)?,
        Language::Rust => toolchain::version(&compiler)?,
    };
    let objdump = match arguments.lang {
        Language::C => toolchain::objdump_of(&compiler),
        Language::Rust => toolchain::objdump_of(""),
    };
    let tools = BTreeMap::from([
        ("rne".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        (compiler.clone(), version),
        (objdump.clone(), toolchain::version(&objdump)?),
    ]);
    Ok((compiler, objdump, tools))
}

/// The certificate, and remarks on missing tools, on the checker and on warnings of the robot file.
fn certificate(arguments: &Arguments) -> Result<(Certificate, String), Failure> {
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &[], Frames::Dropped, Shape::Closed)?;
    let robot = arguments.rotors.of(checked.robot);
    if arguments.lang == Language::C && (arguments.names || !robot.is_serial()) {
        checked.identifiers.map_err(|report| Failure::from(&report))?;
    }
    let compiled = Compiler::new(&arguments.file, &robot);
    let functions = arguments.programs();
    functions.iter().try_for_each(|function| function.check_base(&robot)).map_err(Failure::usage)?;
    let programs = functions.into_iter().map(|function| compiled.compile(function, arguments.form));
    let programs: Vec<Program> = programs.collect::<Result<_, _>>()?;
    let programs = emit::in_order(arguments.order, arguments.form, programs)?;
    let subjects = arguments.subjects(&robot, &programs)?;
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(&robot));
    let call = |subject: &Subject| subject.call(prefix.as_str(), &robot);
    let calls: Vec<Call> = subjects.iter().map(call).collect::<Result<_, _>>()?;
    let (compiler, objdump, mut tools) = compiler(arguments)?;
    let ([qemu, cppcheck], mut remarks) = tools::versions(arguments.lang, &arguments.require)?;
    remarks += &notes(arguments, &robot);
    let folder = tempfile::tempdir().map_err(Failure::input)?;
    let folder = folder.path();
    if let Some(evidence) = &arguments.evidence {
        remarks += &trace::write(arguments, evidence, &robot, &programs, &bytes)?;
    }
    let code = build(arguments, &robot, &programs, &compiler, &calls, &bytes, folder)?;
    tools.extend(qemu.iter().map(|version| ("qemu-system-arm".to_owned(), version.clone())));
    let sample = Sample { states: arguments.states, seed: arguments.seed };
    let bar = reading::bar("certified", false);
    let certified = |(index, ((subject, call), elf)): (usize, ((&Subject, &Call), &String))| {
        #[expect(clippy::cast_precision_loss, reason = "functions are few")]
        reading::show(&bar, index as f64 / subjects.len() as f64);
        let callees: Vec<String> = subject.callees().iter().map(|callee| format!("{prefix}_{callee}")).collect();
        let image = toolchain::image(&objdump, folder, elf)?;
        let cost = cost(arguments.cpu, &image, &call.function, &callees).map_err(|fault| subject.refused(&fault))?;
        let emulation = match qemu {
            None => None,
            Some(_) => Some(emulate(arguments.cpu, &robot, subject, elf, cost.instructions, folder)?),
        };
        Ok(Certified {
            function: subject.name().to_owned(),
            cost,
            emulation,
            accuracy: subject.accuracy(&robot, sample)?,
            proof: subject.proof(),
        })
    };
    let certified = subjects.iter().zip(&calls).zip(&code.images).enumerate().map(certified);
    let mut certified = certified.collect::<Result<Vec<Certified>, Failure>>()?.into_iter();
    let first = certified.next().ok_or_else(|| Failure::usage("no function is named"))?;
    let misra = match cppcheck {
        None => None,
        Some(version) => {
            tools.insert("cppcheck".to_owned(), version);
            Some(violations(folder, &code)?)
        }
    };
    let mut hashes = code.hashes;
    let name = if is_stream(&arguments.file) { "robot file".into() } else { file_name(&arguments.file) };
    hashes.insert(name, sha256(&bytes));
    if let Some(plan) = plan_file::read(&arguments.file, &robot)? {
        hashes.insert(file_name(Path::new(&plan.name)), sha256(plan.text.as_bytes()));
    }
    if let Some(hash) = toolchain::hash(&compiler) {
        hashes.insert(format!("compiler {compiler}"), hash);
    }
    let heads = subjects.iter().zip(&calls).flat_map(|(subject, call)| match (arguments.lang, subject) {
        (Language::Rust, _) => vec![format!("fn {}<", subject.name())],
        // the lines of its program come first
        (Language::C, Subject::Observer(program, _)) => {
            vec![format!("{prefix}_{}(", program.function), format!("{}(", call.function)]
        }
        (Language::C, _) => vec![format!("{}(", call.function)],
    });
    let joints: Vec<&str> = robot.independent_joints().map(|joint| joint.name.as_str()).collect();
    let trace = heads.flat_map(|head| trace(&code.text, &head, &joints)).collect();
    let certificate = Certificate {
        command: command(arguments),
        emit: emit(arguments, &code.source),
        robot: robot.name.clone(),
        language: arguments.lang.name(),
        form: arguments.form.to_string(),
        core: arguments.cpu.name().to_owned(),
        tools,
        options: code.options,
        hashes,
        first,
        more: certified.collect(),
        tests: arguments.tests,
        misra,
        trace,
    };
    Ok((certificate, remarks))
}

/// Notes on options that have no effect, or a small one.
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

/// How often the code violates each rule of MISRA C:2012, where a deviation is recorded for all of them.
fn violations(folder: &Path, code: &Code) -> Result<BTreeMap<String, usize>, Failure> {
    let source = rne_emit::without_c_tests(&code.text);
    let found = misra::violations(&toolchain::misra(folder, &code.source, source)?);
    if let Some((rule, places)) = found.iter().find(|(rule, _)| misra::deviation(rule).is_none()) {
        return Err(Failure::input(format_args!(
            "cppcheck reports rule {rule} of MISRA C:2012, for which no deviation is recorded, at {}",
            places.join(", ")
        )));
    }
    Ok(found.into_iter().map(|(rule, places)| (rule, places.len())).collect())
}

/// The cost of a call: of the function and of those that it calls.
fn cost(core: Core, image: &Image, symbol: &str, callees: &[String]) -> Result<Cost, NoFigures> {
    // the compiler makes copies of static functions, with a point in their names
    let is_of = |name: &str, own: &String| name.strip_prefix(own).is_some_and(|s| s.is_empty() || s.starts_with('.'));
    let may_be_called = |name: &str| name.contains("sin_cos") || callees.iter().any(|own| is_of(name, own));
    let figures = image.straight_but_for(symbol, may_be_called)?;
    let executed = image.executed(symbol, &may_be_called)?;
    let mut counter = Counter::default();
    for name in &executed {
        counter.add(core, &image.function(name)?.lines);
    }
    let frame = |function: &rne_certify::image::Function| cycles::stack(&function.lines);
    let stack = image.deepest(symbol, &may_be_called, &frame)?;
    let worst = counter.cycles();
    let mut called = BTreeMap::new();
    for callee in executed.into_iter().skip(1) {
        *called.entry(callee).or_default() += 1;
    }
    Ok(Cost {
        instructions: figures.instructions,
        cycles: worst.total,
        bound: core.bound(),
        waits: worst.waits,
        classes: worst.classes,
        unknown: worst.unknown,
        assumptions: core.assumptions().into_iter().map(str::to_owned).collect(),
        code: figures.code,
        constants: figures.constants,
        stack: figures.stack,
        stack_of_listing: stack,
        calls: called,
    })
}

pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The options that `rne emit` takes, too.
fn of_emit(arguments: &Arguments) -> String {
    let mut options = String::new();
    if let Some(prefix) = &arguments.prefix {
        let _ = write!(options, " --prefix {prefix}");
    }
    for (option, _) in arguments.flags().into_iter().filter(|(_, is_given)| *is_given) {
        let _ = write!(options, " {option}");
    }
    options += &emit::of_order(arguments.order);
    options
}

/// The functions as a list for an option.
fn list(functions: &[Function]) -> String {
    functions.iter().map(|function| function.name()).collect::<Vec<_>>().join(",")
}

/// The command that writes the code that is certified.
fn emit(arguments: &Arguments, source: &str) -> String {
    let file = robot_file::shell(Path::new(&file_name(&arguments.file)));
    let sine = if arguments.lang == Language::Rust { " --with-sin-cos" } else { "" };
    format!(
        "rne emit {file} --lang {} --function {} --form {}{sine}{} -o {source}",
        arguments.lang.name(),
        list(&arguments.programs()),
        arguments.form,
        of_emit(arguments)
    )
}

/// The command that makes the certificate: the file by its name, so that the page is the same in each folder.
fn command(arguments: &Arguments) -> String {
    let lang = arguments.lang.name();
    let mut function = format!("--function {}", list(&arguments.programs()));
    if arguments.observer {
        let _ = write!(function, " --observer --gain {} --period {}", arguments.gain, arguments.period);
    }
    let mut command = format!(
        "rne certify {} --lang {lang} --cpu {} {function} --form {} --states {} --seed {}",
        robot_file::shell(Path::new(&file_name(&arguments.file))),
        arguments.cpu.name(),
        arguments.form,
        arguments.states,
        arguments.seed
    );
    if let Some(compiler) = arguments.cc.as_ref().filter(|compiler| *compiler != arguments.lang.compiler()) {
        let _ = write!(command, " --cc {}", robot_file::shell(Path::new(compiler)));
    }
    if !arguments.cc_options.is_empty() {
        let _ = write!(command, " --cc-options={}", robot_file::shell(Path::new(&arguments.cc_options)));
    }
    command.push_str(&of_emit(arguments));
    if let Some(source) = &arguments.source {
        let _ = write!(command, " --source {}", robot_file::shell(Path::new(&file_name(source))));
    }
    if arguments.json {
        command.push_str(" --json");
    }
    command
}
