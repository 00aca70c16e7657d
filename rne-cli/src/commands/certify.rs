//! `rne certify`: what the code of an arm costs on a microcontroller, and how exact it is.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_certify::accuracy::{self, Sample};
use rne_certify::board::{self, Call};
use rne_certify::certificate::{Accuracy, Certificate, Cost, NamedError, trace};
use rne_certify::cycles::{self, Core, Counter};
use rne_certify::image::Image;
use rne_certify::observer::{self, LowPass};
use rne_certify::{misra, sha256};
use rne_codegen::{Argument, Form, Function, Layout, Program};
use rne_emit::Prefix;
use rne_model::{JointKind, Robot};

use crate::commands::certify_code::{Code, build, emulate};
use crate::commands::emit::Real;
use crate::commands::{certify_trace, toolchain};
use crate::files::chosen_arm::Rotors;
use crate::files::input_file::is_stream;
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::files::plan_file::{self, Compiler};
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TYPED};
use crate::values::choice;

/// Certify code for a microcontroller: cycles, stack, error
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne certify docs/desk_arm.yaml --cpu cortex-m4 -o desk_arm.cert.md
  rne certify docs/desk_arm.yaml --cpu cortex-m7 --json
  rne certify docs/desk_arm.yaml --cpu cortex-m4 --check desk_arm.cert.md
  rne certify docs/desk_arm.yaml --observer --gain 20 --period 0.001
  rne certify docs/desk_arm.yaml --evidence evidence

The command compiles the code that `rne emit --lang c` writes. It reads the
instructions with objdump, runs the code in QEMU, compares the results with the
results of this computer, and bounds their error. It fails if the code branches,
computes in double precision or calls a function of others.

Needed: arm-none-eabi-gcc and its objdump. Used if they are installed:
qemu-system-arm and cppcheck (MISRA C:2012). On Debian and Ubuntu:
  apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm cppcheck
The certificate is of one function. It has no joint friction and no limits of
`rne emit --friction --limits`. docs/assurance.md says what each number means.")]
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
    /// cortex-m4 or cortex-m7, with FPU
    #[arg(long, value_name = "CORE", default_value = "cortex-m4", value_parser = core)]
    pub(super) cpu: Core,
    /// Function to certify; see `rne explain functions`
    #[arg(long, value_name = "F", value_parser = choice::function(), default_value = "inverse_dynamics",
        hide_possible_values = true)]
    pub(super) function: Function,
    /// Certify an update of the momentum observer instead
    #[arg(long, conflicts_with = "function")]
    pub(super) observer: bool,
    /// Gain of the observer's low-pass, Hz
    #[arg(long, value_name = "HZ", default_value_t = 20.0, requires = "observer")]
    pub(super) gain: f64,
    /// Period of the observer's updates, s
    #[arg(long, value_name = "S", default_value_t = 0.001, requires = "observer")]
    pub(super) period: f64,
    /// Form: reduced or seven_steps
    #[arg(long, value_name = "F", value_parser = choice::form(), default_value = Form::Reduced.name(),
        hide_possible_values = true)]
    pub(super) form: Form,
    /// Prefix of names in C [default: the robot's name]
    #[arg(long, value_name = "P")]
    pub(super) prefix: Option<Prefix>,
    /// Number of random states
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub(super) states: usize,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Also write the C code, its header and a trace for the independent checker to this folder
    #[arg(long, value_name = "FOLDER")]
    pub(super) evidence: Option<PathBuf>,
    /// Number type of C in FOLDER: float (default), double
    #[arg(long, value_enum, value_name = "TYPE", hide_possible_values = true, requires = "evidence")]
    pub(super) real: Option<Real>,
    /// Print the certificate as JSON
    #[arg(long)]
    pub(super) json: bool,
    /// Output file; - is standard output [default: -]
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// Overwrite OUT even if it is no certificate
    #[arg(long, requires = "output")]
    pub(super) force: bool,
    /// Write nothing; check that this certificate is what rne would write now
    #[arg(long, value_name = "OUT", conflicts_with_all = ["output", "evidence"])]
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
    /// The function whose program is compiled.
    pub(super) fn program(&self) -> Function {
        if self.observer { Function::MomentumAndRate } else { self.function }
    }

    /// The name of the function in C, without its prefix.
    pub(super) fn name(&self) -> &str {
        if self.observer { "observer_update" } else { self.function.name() }
    }

    /// The low-pass of the observer that is certified.
    pub(super) fn low_pass(&self) -> Option<LowPass> {
        self.observer.then_some(LowPass { gain: self.gain, period: self.period })
    }
}

fn core(text: &str) -> Result<Core, String> {
    Core::named(text).ok_or_else(|| "the processors are cortex-m4 and cortex-m7".to_owned())
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    is_observer_of_c(arguments)?;
    let (certificate, lints) = certificate(arguments)?;
    let mut outcome = written(arguments, &certificate)?;
    outcome.remark += &lints;
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
        return check(file, &text);
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
        _ => output_file::write_all(&[(out, text)]).map(Outcome::remark),
    }
}

/// The code of an observer is C; its gain and its period are above zero.
fn is_observer_of_c(arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.observer {
        return Ok(());
    }
    if arguments.lang != Language::C {
        return Err(Failure::usage(format_args!(
            "{TYPED}--observer{TYPED:#} is for {TYPED}--lang c{TYPED:#}: in Rust, the observer is `rne::ObserverState`"
        )));
    }
    if arguments.evidence.is_some() {
        return Err(Failure::usage(format_args!(
            "{TYPED}--evidence{TYPED:#} is for inverse_dynamics: the checker computes no momenta"
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

/// Compares a file with the certificate of now, line by line.
fn check(file: &Path, text: &str) -> Result<Outcome, Failure> {
    let shown = file.display();
    let found = match output_file::existing(file) {
        Existing::Text(found) if found.trim().is_empty() => {
            return Err(Failure::input(format_args!(
                "{shown} is empty; {TYPED}-o{TYPED:#} writes a certificate there"
            )));
        }
        Existing::Text(found) => found,
        Existing::Nothing => return Err(Failure::input(format_args!("there is no file {shown}"))),
        _ => return Err(Failure::input(format_args!("{shown} is no certificate of rne"))),
    };
    if found == text {
        return Ok(Outcome::remark(format!("{GOOD}up to date:{GOOD:#} {shown}\n")));
    }
    // other figures before other hashes
    let (mut differences, mut hashes): (Vec<String>, Vec<String>) = Default::default();
    let mut section = "the head";
    let (old, new): (Vec<&str>, Vec<&str>) = (found.lines().collect(), text.lines().collect());
    for index in 0..old.len().max(new.len()) {
        let [a, b] = [&old, &new].map(|lines| lines.get(index).copied().unwrap_or("the end of the file"));
        section = a.strip_prefix("## ").unwrap_or(section);
        if a != b {
            let is_hash = |line: &str| line.split('`').any(|word| word.len() == 64);
            let list = if is_hash(a) || is_hash(b) { &mut hashes } else { &mut differences };
            list.push(format!("line {} ({section}):\n  file: {a}\n  now:  {b}", index + 1));
        }
    }
    differences.append(&mut hashes);
    let count = differences.len();
    differences.truncate(5);
    Err(Failure::input(format_args!(
        "{shown} is not what rne would write now; {count} lines differ:\n{}",
        differences.join("\n")
    )))
}

/// The certificate, and a remark where the robot file has warnings.
fn certificate(arguments: &Arguments) -> Result<(Certificate, String), Failure> {
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &[], Frames::Dropped, Shape::Chain)?;
    let robot = arguments.rotors.of(checked.robot);
    let program = Compiler::new(&arguments.file, &robot).compile(arguments.program(), arguments.form)?;
    let call = call(arguments, &robot, &program)?;
    let compiler = arguments.cc.clone().unwrap_or_else(|| arguments.lang.compiler().to_owned());
    let version = toolchain::version(&compiler)?;
    if arguments.lang == Language::C && !toolchain::is_gcc(&compiler) {
        return Err(Failure::usage(format_args!(
            "{compiler} is no GCC ({version}); {TYPED}--cc{TYPED:#} takes GCC for Arm: its option -fstack-usage and \
             its binary utilities give the numbers of the certificate"
        )));
    }
    let objdump = match arguments.lang {
        Language::C => toolchain::objdump_of(&compiler),
        Language::Rust => toolchain::objdump_of(""),
    };
    let mut tools = BTreeMap::from([
        ("rne".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        (compiler.clone(), version),
        (objdump.clone(), toolchain::version(&objdump)?),
    ]);
    let folder = tempfile::tempdir().map_err(Failure::input)?;
    let folder = folder.path();
    let code = build(arguments, &robot, &program, &compiler, &call, &bytes, folder)?;
    let image = toolchain::image(&objdump, folder, &code.elf)?;
    let cost = cost(arguments.cpu, &image, &code)?;
    if let Some(evidence) = &arguments.evidence {
        certify_trace::write(arguments, evidence, &robot, &program, &bytes)?;
    }
    let emulation = match toolchain::version_of("qemu-system-arm") {
        None => None,
        Some(version) => {
            tools.insert("qemu-system-arm".to_owned(), version);
            Some(emulate(arguments, &robot, &program, &code, cost.instructions, folder)?)
        }
    };
    let misra = match toolchain::version_of("cppcheck").filter(|_| arguments.lang == Language::C) {
        None => None,
        Some(version) => {
            tools.insert("cppcheck".to_owned(), version);
            let found = misra::violations(&toolchain::misra(folder, &code.source)?);
            if let Some((rule, _)) = found.iter().find(|(rule, _)| misra::deviation(rule).is_none()) {
                return Err(Failure::input(format_args!(
                    "cppcheck reports rule {rule} of MISRA C:2012, for which no deviation is recorded"
                )));
            }
            Some(found)
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
    let proof = program.proof.as_ref().map_or_else(
        || {
            vec![
                "The code is the seven steps of recursive Newton-Euler, so there is no other form to compare."
                    .to_owned(),
            ]
        },
        |proof| rne_emit::evidence(&program, proof),
    );
    let certificate = Certificate {
        command: command(arguments),
        emit: emit(arguments, &code.source),
        robot: robot.name.clone(),
        function: arguments.name().to_owned(),
        language: arguments.lang.name(),
        form: arguments.form.to_string(),
        core: arguments.cpu.name().to_owned(),
        tools,
        options: code.options,
        hashes,
        cost,
        emulation,
        accuracy: accuracy(arguments, &robot, &program)?,
        proof,
        misra,
        trace: code.heads.iter().flat_map(|head| trace(&code.text, head)).collect(),
    };
    Ok((certificate, robot_file::lint_remark(&checked.lints, &arguments.file)))
}

/// The cost of a call: of the function and of those that it calls.
fn cost(core: Core, image: &Image, code: &Code) -> Result<Cost, Failure> {
    let may_be_called = |name: &str| name.contains("sin_cos") || code.functions.iter().any(|own| own == name);
    let figures = image.straight_but_for(&code.symbol, may_be_called).map_err(Failure::input)?;
    let executed = image.executed(&code.symbol, &may_be_called).map_err(Failure::input)?;
    let mut counter = Counter::default();
    for name in &executed {
        counter.add(core, &image.function(name).map_err(Failure::input)?.lines);
    }
    let frame = |function: &rne_certify::image::Function| cycles::stack(&function.lines);
    let stack = image.deepest(&code.symbol, &may_be_called, &frame).map_err(Failure::input)?;
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

/// The call of the function on the board; an error where it takes other arguments than arrays of joints, or returns
/// no plain array.
fn call(arguments: &Arguments, robot: &Robot, program: &Program) -> Result<Call, Failure> {
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    let Some(low_pass) = arguments.low_pass() else {
        let symbol = format!("{prefix}_{}", arguments.name());
        return Ok(Call::of_arrays(&symbol, &arrays(program)?, program.outputs.len()));
    };
    has_few_joints(program)?;
    Ok(low_pass.call(prefix.as_str(), program.dof))
}

fn has_few_joints(program: &Program) -> Result<(), Failure> {
    if program.dof <= board::MOST_JOINTS {
        return Ok(());
    }
    Err(Failure::usage(format_args!(
        "rne certify takes arms with at most {} joints; this arm has {}",
        board::MOST_JOINTS,
        program.dof
    )))
}

/// The arrays that the function takes, as members of a state of the board.
fn arrays(program: &Program) -> Result<Vec<&'static str>, Failure> {
    has_few_joints(program)?;
    let function = program.function;
    let array = |argument: &Argument| match argument {
        Argument::Positions => Some("q"),
        Argument::Rates => Some("qd"),
        Argument::Accelerations | Argument::Torques => Some("qdd"),
        _ => None,
    };
    let arrays: Option<Vec<&str>> = function.arguments().iter().map(array).collect();
    let is_array = matches!(function.layout(program.dof), Layout::Array(_, of) if matches!(*of, Layout::Number));
    match arrays {
        Some(arrays) if is_array => Ok(arrays),
        _ => Err(Failure::usage(format_args!(
            "rne certify cannot call {function}: it takes functions of positions, velocities, accelerations and \
             torques that return one number per joint, such as inverse_dynamics, gravity_torques, bias_torques and \
             forward_dynamics. {TYPED}--observer{TYPED:#} certifies the momentum observer"
        ))),
    }
}

fn accuracy(arguments: &Arguments, robot: &Robot, program: &Program) -> Result<Accuracy, Failure> {
    let sample = Sample { states: arguments.states, seed: arguments.seed };
    let (how, errors) = match arguments.low_pass() {
        None => (
            format!("The function runs at {} random states (seed {}).", sample.states, sample.seed),
            accuracy::errors(robot, program, sample, rne_emit::sin_cos_f32),
        ),
        Some(low_pass) => (
            format!(
                "The observer has a low-pass with a gain of {} Hz and a period of {} s. It runs through {} updates \
                 (seed {}) in motions of {} updates. In a motion, each joint follows a sine within the ranges below, \
                 and each torque is a random number at each update. The exact result is that of all updates since the \
                 beginning of the motion, with the weight and the frequency that the observer stores in `float`.",
                low_pass.gain,
                low_pass.period,
                sample.states,
                sample.seed,
                observer::UPDATES
            ),
            low_pass.errors(robot, program, sample, rne_emit::sin_cos_f32),
        ),
    };
    let errors = errors.ok_or_else(|| Failure::input("the interpreter cannot run this function"))?;
    let takes_torques = program.function.takes(Argument::Torques);
    let ranges = accuracy::ranges(robot);
    let ranges = ranges.iter().zip(&robot.joints).enumerate().map(|(index, (range, joint))| {
        let unit = match joint.row.kind {
            JointKind::Revolute => "rad",
            JointKind::Prismatic => "m",
        };
        let limits = joint.limits;
        let source = |is_given: bool| if is_given { "limits of the robot file" } else { "no limit in the robot file" };
        let accuracy::Range { position: (low, high), velocity, acceleration, torque } = *range;
        let last = match (takes_torques, joint.row.kind) {
            (false, _) => format!("acceleration up to {acceleration} {unit}/s²"),
            (true, JointKind::Revolute) => format!("torque up to {torque} N m ({})", source(limits.effort.is_some())),
            (true, JointKind::Prismatic) => format!("force up to {torque} N ({})", source(limits.effort.is_some())),
        };
        format!(
            "joint {}: position {low:.4} to {high:.4} {unit} ({}), speed up to {velocity:.4} {unit}/s ({}), {last}",
            index + 1,
            source(limits.position.is_some()),
            source(limits.velocity.is_some())
        )
    });
    let names: Vec<String> = if arguments.observer {
        (0..robot.dof()).map(|joint| format!("`external[{joint}]`")).collect()
    } else {
        program.outputs.iter().map(|output| output.name.to_string()).collect()
    };
    let results = errors.into_iter().zip(names).map(|(error, name)| NamedError { name, error });
    let (ranges, results) = (ranges.collect(), results.collect());
    Ok(Accuracy { how, states: sample.states, seed: sample.seed, ranges, results })
}

/// The command that makes the certificate: the file by its name, so that the page is the same in each folder.
/// The command that writes the code that is certified.
fn emit(arguments: &Arguments, source: &str) -> String {
    let file = robot_file::shell(Path::new(&file_name(&arguments.file)));
    let sine = if arguments.lang == Language::Rust { " --with-sin-cos" } else { "" };
    let prefix = arguments.prefix.as_ref().map_or_else(String::new, |prefix| format!(" --prefix {prefix}"));
    let rotors = if arguments.rotors.rotors { " --rotors" } else { "" };
    format!(
        "rne emit {file} --lang {} --function {} --form {}{sine}{prefix}{rotors} -o {source}",
        arguments.lang.name(),
        arguments.program(),
        arguments.form
    )
}

fn command(arguments: &Arguments) -> String {
    let lang = arguments.lang.name();
    let function = match arguments.low_pass() {
        None => format!("--function {}", arguments.function),
        Some(LowPass { gain, period }) => format!("--observer --gain {gain} --period {period}"),
    };
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
    if let Some(prefix) = &arguments.prefix {
        let _ = write!(command, " --prefix {prefix}");
    }
    if arguments.rotors.rotors {
        command.push_str(" --rotors");
    }
    if arguments.json {
        command.push_str(" --json");
    }
    command
}
