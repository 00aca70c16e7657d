//! `rne certify`: what the code of an arm costs on a microcontroller, and how exact it is.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::{Args, ValueEnum};
use rne_certify::accuracy::{self, Sample};
use rne_certify::board;
use rne_certify::certificate::{Accuracy, Certificate, Class, Cost, Emulation, Error, trace};
use rne_certify::cycles::{self, Core, Counter};
use rne_certify::{misra, sha256};
use rne_codegen::{Argument, Form, Function, Interpreter, Layout, Program};
use rne_emit::{Origin, Precision, Prefix};
use rne_model::{JointKind, Robot};

use crate::commands::{certify_trace, toolchain};
use crate::files::chosen_arm::Rotors;
use crate::files::input_file::is_stream;
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::files::plan_file::{self, Compiler};
use crate::files::robot_file;
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
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    /// Programming language of the code: c or rust
    #[arg(long, value_enum, default_value_t = Language::C, hide_possible_values = true)]
    lang: Language,
    /// Compiler [default: arm-none-eabi-gcc for C, rustc for Rust]
    #[arg(long, value_name = "PROGRAM")]
    cc: Option<String>,
    /// Processor: cortex-m4 or cortex-m7, each with a floating-point unit
    #[arg(long, value_name = "CORE", default_value = "cortex-m4", value_parser = core)]
    cpu: Core,
    /// Function to certify; see `rne explain functions`
    #[arg(long, value_name = "F", value_parser = choice::function(), default_value = "inverse_dynamics",
        hide_possible_values = true)]
    function: Function,
    /// Form of the code: reduced or seven_steps
    #[arg(long, value_name = "F", value_parser = choice::form(), default_value = Form::Reduced.name(),
        hide_possible_values = true)]
    form: Form,
    /// Prefix of all names in C code [default: the robot's name]
    #[arg(long, value_name = "P")]
    prefix: Option<Prefix>,
    /// Number of random states at which the error is bounded
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    states: usize,
    /// Seed of the random states
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Also write the C code, its header and a trace for the independent checker to this folder
    #[arg(long, value_name = "FOLDER")]
    evidence: Option<PathBuf>,
    /// Print the certificate as JSON
    #[arg(long)]
    json: bool,
    /// Output file; - is standard output [default: -]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Overwrite the output file even if it is no certificate
    #[arg(long, requires = "output")]
    force: bool,
    /// Write nothing; check that this certificate is what rne would write now
    #[arg(long, value_name = "OUT", conflicts_with = "output")]
    check: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
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

/// The code of the arm in files of a folder.
struct Code {
    /// The name of the function for the linker.
    symbol: String,
    /// The file with the function, and how the certificate names it.
    source: String,
    /// SHA-256 of the files.
    hashes: BTreeMap<String, String>,
    /// Lines of the code with their steps.
    text: String,
    /// The image.
    elf: String,
    /// Options of the compiler.
    options: Vec<String>,
}

fn certificate(arguments: &Arguments) -> Result<Certificate, Failure> {
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &[])?;
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
    let may_be_called = |name: &str| name.contains("sin_cos");
    let figures = image.straight_but_for(&code.symbol, may_be_called).map_err(Failure::input)?;
    let calls = image.calls(&code.symbol, may_be_called).map_err(Failure::input)?;
    let mut counter = Counter::default();
    let mut stack = 0;
    let lines = |name: &str| image.function(name).map(|function| function.lines.as_slice()).map_err(Failure::input);
    for callee in &calls {
        counter.add(arguments.cpu, lines(callee)?);
        stack = stack.max(cycles::stack(lines(callee)?));
    }
    counter.add(arguments.cpu, lines(&code.symbol)?);
    stack += cycles::stack(lines(&code.symbol)?);
    let worst = counter.cycles();
    let mut called = BTreeMap::new();
    for callee in calls {
        *called.entry(callee).or_default() += 1;
    }
    let cost = Cost {
        instructions: figures.instructions,
        cycles: worst.total,
        waits: worst.waits,
        classes: worst.classes.into_iter().map(class).collect(),
        unknown: worst.unknown,
        assumptions: arguments.cpu.assumptions().into_iter().map(str::to_owned).collect(),
        code: figures.code,
        constants: figures.constants,
        stack: figures.stack,
        stack_of_listing: stack,
        calls: called,
    };
    if let Some(evidence) = &arguments.evidence {
        write_evidence(arguments, evidence, &robot, &program, &code.source, folder)?;
    }
    let emulation = match toolchain::version_of("qemu-system-arm") {
        None => None,
        Some(version) => {
            tools.insert("qemu-system-arm".to_owned(), version);
            Some(emulate(arguments, &robot, &program, &code, figures.instructions, folder)?)
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

/// Writes the C code, its header and the trace of its constants.
fn write_evidence(
    arguments: &Arguments,
    evidence: &Path,
    robot: &Robot,
    program: &Program,
    source: &str,
    folder: &Path,
) -> Result<(), Failure> {
    if arguments.lang != Language::C || arguments.function != Function::InverseDynamics || robot.has_rotors() {
        return Err(Failure::usage(format_args!(
            "{TYPED}--evidence{TYPED:#} is for inverse_dynamics in C without rotors: the checker computes this function"
        )));
    }
    let compiler = Compiler::new(&arguments.file, robot);
    let Some(derivation) = compiler.derivation(program)? else {
        return Err(Failure::usage(format_args!(
            "{TYPED}--evidence{TYPED:#} is for {TYPED}--form reduced{TYPED:#}: the constants of this code are rounded one \
             operation after another, so they have no exact expressions"
        )));
    };
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    let trace = certify_trace::trace(robot, program, &derivation, &prefix, Precision::Single);
    let trace = serde_json::to_string_pretty(&trace).map_err(Failure::input)? + "\n";
    fs::create_dir_all(evidence)
        .map_err(|error| Failure::input(format_args!("{} cannot be made: {error}", evidence.display())))?;
    let read = |name: &str| fs::read_to_string(folder.join(name)).map_err(Failure::input);
    let stem = source.trim_end_matches(".c");
    let header = format!("{stem}.h");
    let files = [
        (evidence.join(source), read(source)?),
        (evidence.join(&header), read(&header)?),
        (evidence.join(format!("{stem}.trace.json")), trace),
    ];
    for (path, text) in &files {
        let is_other = match output_file::existing(path) {
            Existing::Nothing => false,
            Existing::Text(found) => {
                found != *text
                    && !arguments.force
                    && !found.contains(rne_emit::GENERATED)
                    && !found.contains("\"steps\"")
            }
            _ => true,
        };
        if is_other {
            return Err(Failure::usage(format_args!("{} is not changed: rne did not write it", path.display())));
        }
    }
    output_file::replace_all(&files).map(drop)
}

fn class(of: cycles::Class) -> Class {
    let cycles::Class { what, mnemonics, instructions, cycles } = of;
    Class { what: what.to_owned(), mnemonics, instructions, cycles }
}

fn file_name(path: &Path) -> String {
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
            "rne certify cannot call {function}: it takes functions of positions, velocities, accelerations and torques \
             that return one number per joint, such as inverse_dynamics, gravity_torques, bias_torques and \
             forward_dynamics"
        ))),
    }
}

/// Writes the code and the program of the board, and compiles and links them.
fn build(
    arguments: &Arguments,
    robot: &Robot,
    program: &Program,
    compiler: &str,
    arrays: &[&str],
    bytes: &[u8],
    folder: &Path,
) -> Result<Code, Failure> {
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    let symbol = format!("{prefix}_{}", arguments.function);
    let name = if is_stream(&arguments.file) { "on standard input".into() } else { file_name(&arguments.file) };
    let write = |file: &str, text: &str| fs::write(folder.join(file), text).map_err(Failure::input);
    let stem =
        arguments.file.file_stem().map_or_else(|| robot.name.clone(), |stem| stem.to_string_lossy().into_owned());
    let origin = Origin::new(&name, &sha256(bytes));
    let programs = std::slice::from_ref(program);
    let code = rne_emit::c_code_of_file(robot, programs, Precision::Single, &prefix, Some(&origin))
        .map_err(|error| Failure::input(format_args!("{}: {error}", arguments.file.display())))?;
    let (header, c_source) = (format!("{stem}.h"), format!("{stem}.c"));
    let gcc = if arguments.lang == Language::C { compiler } else { "arm-none-eabi-gcc" };
    let flags = arguments.cpu.flags();
    write(&header, code.header())?;
    let length = program.outputs.len();
    write("cases.c", &board::cases(&header, &symbol, robot.dof(), arrays, length))?;
    write("board.c", board::SOURCE)?;
    write("board.h", board::HEADER)?;
    write("board.ld", board::LINKER_SCRIPT)?;
    let compile = |options: &[&str], files: &[&str]| {
        toolchain::text(Command::new(gcc).current_dir(folder).args(options).args(flags).args(files))
    };
    let (source, object, text, options, hashes);
    match arguments.lang {
        Language::C => {
            text = code.source(&header);
            write(&c_source, &text)?;
            let own = [&toolchain::OPTIONS[..], &["-ffunction-sections", "-fstack-usage", "-c"]].concat();
            compile(&own, &[&c_source])?;
            options = [&toolchain::OPTIONS[..], &["-ffunction-sections"], &flags].concat();
            hashes = BTreeMap::from([
                (header, sha256(code.header().as_bytes())),
                (c_source.clone(), sha256(text.as_bytes())),
            ]);
            object = format!("{stem}.o");
            source = c_source;
        }
        Language::Rust => {
            text = rne_emit::rust_file_with_sin_cos(robot, programs);
            write("arm.rs", &text)?;
            write("lib.rs", &rust_library(&symbol, arguments.function, robot.dof(), arrays, length))?;
            let cpu = format!("target-cpu={}", arguments.cpu.name());
            options =
                vec!["--target", "thumbv7em-none-eabihf", "--edition", "2024", "-Copt-level=3", "-Cpanic=abort", "-C"];
            let mut command = Command::new(compiler);
            command.current_dir(folder).args(&options).arg(&cpu);
            command.args(["--crate-type", "lib", "--crate-name", "arm", "--emit", "obj=arm.o", "lib.rs"]);
            // rustc says what to do if the target is not installed
            toolchain::text(&mut command)?;
            hashes = BTreeMap::from([(format!("{stem}.rs"), sha256(text.as_bytes()))]);
            object = "arm.o".to_owned();
            source = format!("{stem}.rs");
            let options = options.iter().map(|&option| option.to_owned()).chain([cpu]).collect();
            link(&compile, &object)?;
            return Ok(Code { symbol, source, hashes, text, elf: "board.elf".to_owned(), options });
        }
    }
    link(&compile, &object)?;
    let options = options.iter().map(|&option| option.to_owned()).collect();
    Ok(Code { symbol, source, hashes, text, elf: "board.elf".to_owned(), options })
}

/// Links the code with the program of the board, which is GNU C.
fn link(compile: &impl Fn(&[&str], &[&str]) -> Result<String, Failure>, object: &str) -> Result<(), Failure> {
    let options = [
        "-std=gnu99",
        "-O2",
        "-ffp-contract=off",
        "-nostartfiles",
        "-Wl,--gc-sections",
        "-T",
        "board.ld",
        "-o",
        "board.elf",
    ];
    compile(&options, &["board.c", "cases.c", object]).map(drop)
}

/// The emitted Rust as a library with one function for C.
fn rust_library(symbol: &str, function: Function, dof: usize, arrays: &[&str], length: usize) -> String {
    let list = |element: &dyn Fn(usize) -> String| (0..arrays.len()).map(element).collect::<Vec<_>>().join(", ");
    let parameters = list(&|index| format!("a{index}: &[f32; {dof}]"));
    let passed = list(&|index| format!("a{index}"));
    format!(
        "#![no_std]\nmod arm;\n\n#[unsafe(no_mangle)]\npub extern \"C\" fn {symbol}({parameters}, out: &mut [f32; {length}]) \
         {{\n    *out = arm::{function}({passed});\n}}\n"
    )
}

/// Runs the code in QEMU and compares instructions with the listing and results with those of this computer.
fn emulate(
    arguments: &Arguments,
    robot: &Robot,
    program: &Program,
    code: &Code,
    instructions: u64,
    folder: &Path,
) -> Result<Emulation, Failure> {
    let said = toolchain::emulated(arguments.cpu, folder, &code.elf)?;
    let printed = board::Printed::read(&said)
        .ok_or_else(|| Failure::input(format_args!("QEMU prints what the program does not print:\n{said}")))?;
    if printed.instructions != instructions {
        return Err(Failure::input(format_args!(
            "QEMU executes {} instructions in a call, but the listing shows {instructions}",
            printed.instructions
        )));
    }
    let interpreter = Interpreter::new(program);
    for (number, found) in (0..board::STATES).zip(&printed.results) {
        let [q, qd, qdd] = board::state(number, robot.dof());
        let expected = accuracy::single_precision(robot, &interpreter, [&q, &qd, &qdd], rne_emit::sin_cos_f32);
        let expected: Option<Vec<u32>> = expected.map(|numbers| numbers.iter().map(|x| x.to_bits()).collect());
        if expected.as_ref() != Some(found) {
            return Err(Failure::input(format_args!(
                "at state {number}, the results in QEMU, {found:08x?}, do not have the bits of the results on this computer, {:08x?}",
                expected.unwrap_or_default()
            )));
        }
    }
    let machine = arguments.cpu.machine().to_owned();
    Ok(Emulation { machine, instructions: printed.instructions, states: printed.results.len() })
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
            "joint {}: position {low:.4} to {high:.4} {unit} ({}), speed up to {velocity:.4} {unit}/s ({}), acceleration \
             up to {acceleration} {unit}/s²",
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
        command.push_str(&format!(" --cc {compiler}"));
    }
    if let Some(prefix) = &arguments.prefix {
        command.push_str(&format!(" --prefix {prefix}"));
    }
    if arguments.rotors.rotors {
        command.push_str(" --rotors");
    }
    if arguments.json {
        command.push_str(" --json");
    }
    command
}
