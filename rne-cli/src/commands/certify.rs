//! `rne certify`: what the code of an arm costs on a microcontroller, and how exact it is.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_certify::accuracy::{self, Sample};
use rne_certify::board;
use rne_certify::certificate::{Accuracy, Certificate, Class, Cost, Error, trace};
use rne_certify::cycles::{self, Core, Counter};
use rne_certify::image::Image;
use rne_certify::{misra, sha256};
use rne_codegen::{Argument, Form, Function, Layout, Program};
use rne_emit::Prefix;
use rne_model::{JointKind, Robot};

use crate::commands::certify_code::{build, emulate};
use crate::commands::{certify_trace, toolchain};
use crate::files::chosen_arm::Rotors;
use crate::files::input_file::is_stream;
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::files::plan_file::{self, Compiler};
use crate::files::robot_file::{self, Frames};
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
  rne certify docs/desk_arm.yaml --evidence evidence

The command compiles the code that `rne emit --lang c` writes. It reads the
instructions with objdump, runs the code in QEMU, compares the results with the
results of this computer, and bounds their error. It fails if the code branches,
computes in double precision or calls a function other than its own sine.

Needed: arm-none-eabi-gcc and its objdump. Used if they are installed:
qemu-system-arm and cppcheck (MISRA C:2012). On Debian and Ubuntu:
  apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm cppcheck
docs/assurance.md says what each number means.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,
    #[command(flatten)]
    pub(super) rotors: Rotors,
    /// Programming language of the code: c or rust
    #[arg(long, value_enum, default_value_t = Language::C, hide_possible_values = true)]
    pub(super) lang: Language,
    /// Compiler [default: arm-none-eabi-gcc for C, rustc for Rust]
    #[arg(long, value_name = "PROGRAM")]
    pub(super) cc: Option<String>,
    /// Processor: cortex-m4 or cortex-m7, each with a floating-point unit
    #[arg(long, value_name = "CORE", default_value = "cortex-m4", value_parser = core)]
    pub(super) cpu: Core,
    /// Function to certify; see `rne explain functions`
    #[arg(long, value_name = "F", value_parser = choice::function(), default_value = "inverse_dynamics",
        hide_possible_values = true)]
    pub(super) function: Function,
    /// Form of the code: reduced or seven_steps
    #[arg(long, value_name = "F", value_parser = choice::form(), default_value = Form::Reduced.name(),
        hide_possible_values = true)]
    pub(super) form: Form,
    /// Prefix of all names in C code [default: the robot's name]
    #[arg(long, value_name = "P")]
    pub(super) prefix: Option<Prefix>,
    /// Number of random states at which the error is bounded
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub(super) states: usize,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Also write the C code, its header and a trace for the independent checker to this folder
    #[arg(long, value_name = "FOLDER")]
    pub(super) evidence: Option<PathBuf>,
    /// Print the certificate as JSON
    #[arg(long)]
    pub(super) json: bool,
    /// Output file; - is standard output [default: -]
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// Overwrite the output file even if it is no certificate
    #[arg(long, requires = "output")]
    pub(super) force: bool,
    /// Write nothing; check that this certificate is what rne would write now
    #[arg(long, value_name = "OUT", conflicts_with = "output")]
    pub(super) check: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Language {
    C,
    Rust,
}

fn core(text: &str) -> Result<Core, String> {
    Core::named(text).ok_or_else(|| "the processors are cortex-m4 and cortex-m7".to_owned())
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let certificate = certificate(arguments)?;
    let text = if arguments.json {
        serde_json::to_string_pretty(&certificate).map_err(Failure::input)? + "\n"
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

fn is_ours(text: &str) -> bool {
    text.trim().is_empty()
        || text.starts_with("# Certificate of `")
        || text.starts_with("{\n  \"command\": \"rne certify")
}

/// Compares a file with the certificate of now, line by line.
fn check(file: &Path, text: &str) -> Result<Outcome, Failure> {
    let shown = file.display();
    let found = match output_file::existing(file) {
        Existing::Text(found) => found,
        Existing::Nothing => return Err(Failure::input(format_args!("there is no file {shown}"))),
        _ => return Err(Failure::input(format_args!("{shown} is no certificate of rne"))),
    };
    if found == text {
        return Ok(Outcome::remark(format!("{GOOD}up to date:{GOOD:#} {shown}\n")));
    }
    let mut differences: Vec<String> = Vec::new();
    let (old, new): (Vec<&str>, Vec<&str>) = (found.lines().collect(), text.lines().collect());
    for index in 0..old.len().max(new.len()) {
        let [a, b] = [&old, &new].map(|lines| lines.get(index).copied().unwrap_or("the end of the file"));
        if a != b {
            differences.push(format!("line {}:\n  file: {a}\n  now:  {b}", index + 1));
        }
    }
    let count = differences.len();
    differences.truncate(5);
    Err(Failure::input(format_args!(
        "{shown} is not what rne would write now; {count} lines differ:\n{}",
        differences.join("\n")
    )))
}

fn certificate(arguments: &Arguments) -> Result<Certificate, Failure> {
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &[], Frames::Dropped)?;
    let robot = arguments.rotors.of(checked.robot);
    let program = Compiler::new(&arguments.file, &robot).compile(arguments.function, arguments.form)?;
    let arrays = arrays(&program)?;
    let compiler = arguments.cc.clone().unwrap_or_else(|| match arguments.lang {
        Language::C => "arm-none-eabi-gcc".to_owned(),
        Language::Rust => "rustc".to_owned(),
    });
    let objdump = match arguments.lang {
        Language::C => toolchain::objdump_of(&compiler),
        Language::Rust => toolchain::objdump_of(""),
    };
    let mut tools = BTreeMap::from([
        ("rne".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        (compiler.clone(), toolchain::version(&compiler)?),
        (objdump.clone(), toolchain::version(&objdump)?),
    ]);
    let folder = tempfile::tempdir().map_err(Failure::input)?;
    let folder = folder.path();
    let code = build(arguments, &robot, &program, &compiler, &arrays, &bytes, folder)?;
    let image = toolchain::image(&objdump, folder, &code.elf)?;
    let cost = cost(arguments.cpu, &image, &code.symbol)?;
    if let Some(evidence) = &arguments.evidence {
        certify_trace::write(arguments, evidence, &robot, &program, &code.source, folder)?;
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
    Ok(Certificate {
        command: command(arguments),
        robot: robot.name.clone(),
        function: arguments.function.to_string(),
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
        trace: trace(&code.text, &code.symbol),
    })
}

/// The cost of a call: of the function and of the sine that it calls.
fn cost(core: Core, image: &Image, symbol: &str) -> Result<Cost, Failure> {
    let may_be_called = |name: &str| name.contains("sin_cos");
    let figures = image.straight_but_for(symbol, may_be_called).map_err(Failure::input)?;
    let calls = image.calls(symbol, may_be_called).map_err(Failure::input)?;
    let mut counter = Counter::default();
    let mut stack = 0;
    let lines = |name: &str| image.function(name).map(|function| function.lines.as_slice()).map_err(Failure::input);
    for callee in &calls {
        counter.add(core, lines(callee)?);
        stack = stack.max(cycles::stack(lines(callee)?));
    }
    counter.add(core, lines(symbol)?);
    stack += cycles::stack(lines(symbol)?);
    let worst = counter.cycles();
    let mut called = BTreeMap::new();
    for callee in calls {
        *called.entry(callee).or_default() += 1;
    }
    Ok(Cost {
        instructions: figures.instructions,
        cycles: worst.total,
        waits: worst.waits,
        classes: worst.classes.into_iter().map(class).collect(),
        unknown: worst.unknown,
        assumptions: core.assumptions().into_iter().map(str::to_owned).collect(),
        code: figures.code,
        constants: figures.constants,
        stack: figures.stack,
        stack_of_listing: stack,
        calls: called,
    })
}

fn class(of: cycles::Class) -> Class {
    let cycles::Class { what, mnemonics, instructions, cycles } = of;
    Class { what: what.to_owned(), mnemonics, instructions, cycles }
}

pub(super) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// The arrays that the function takes, as members of a state of the board; an error where it takes other arguments or
/// returns no plain array.
fn arrays(program: &Program) -> Result<Vec<&'static str>, Failure> {
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
        _ if program.dof > board::MOST_JOINTS => Err(Failure::usage(format_args!(
            "rne certify takes arms with at most {} joints; this arm has {}",
            board::MOST_JOINTS,
            program.dof
        ))),
        Some(arrays) if is_array => Ok(arrays),
        _ => Err(Failure::usage(format_args!(
            "rne certify cannot call {function}: it takes functions of positions, velocities, accelerations and \
             torques that return one number per joint, such as inverse_dynamics, gravity_torques, bias_torques and \
             forward_dynamics"
        ))),
    }
}

fn accuracy(arguments: &Arguments, robot: &Robot, program: &Program) -> Result<Accuracy, Failure> {
    let sample = Sample { states: arguments.states, seed: arguments.seed };
    let errors = accuracy::errors(robot, program, sample, rne_emit::sin_cos_f32)
        .ok_or_else(|| Failure::input("the interpreter cannot run this function"))?;
    let ranges = accuracy::ranges(robot);
    let ranges = ranges.iter().zip(&robot.joints).enumerate().map(|(index, (range, joint))| {
        let unit = match joint.row.kind {
            JointKind::Revolute => "rad",
            JointKind::Prismatic => "m",
        };
        let source = |is_given: bool| if is_given { "limits of the robot file" } else { "no limit in the robot file" };
        let accuracy::Range { position: (low, high), velocity, acceleration } = *range;
        format!(
            "joint {}: position {low:.4} to {high:.4} {unit} ({}), speed up to {velocity:.4} {unit}/s ({}), \
             acceleration up to {acceleration} {unit}/s²",
            index + 1,
            source(joint.limits.position.is_some()),
            source(joint.limits.velocity.is_some())
        )
    });
    let results = errors.iter().zip(&program.outputs).map(|(error, output)| Error {
        name: output.name.to_string(),
        largest: error.largest,
        bound: error.bound,
        state: error.state,
    });
    Ok(Accuracy { states: sample.states, seed: sample.seed, ranges: ranges.collect(), results: results.collect() })
}

/// The command that makes the certificate: the file by its name, so that the page is the same in each folder.
fn command(arguments: &Arguments) -> String {
    let lang = match arguments.lang {
        Language::C => "c",
        Language::Rust => "rust",
    };
    let mut command = format!(
        "rne certify {} --lang {lang} --cpu {} --function {} --form {} --states {} --seed {}",
        robot_file::shell(Path::new(&file_name(&arguments.file))),
        arguments.cpu.name(),
        arguments.function,
        arguments.form,
        arguments.states,
        arguments.seed
    );
    if let Some(compiler) = &arguments.cc {
        let _ = write!(command, " --cc {compiler}");
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
