//! `rne emit`: code that compiles by itself.

pub(super) mod c;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_codegen::CheckFor as _;
use rne_codegen::{Form, Function, Order, Program, Target, ordered_for_registers};
use rne_emit::{Precision, Prefix};
use rne_model::{FrameId, Robot};

use crate::commands::emit::c::{ForGpu, Header, Request, c_code, for_gpu, header_beside};
use crate::commands::eval::golden;
use crate::files::chosen_arm::{Rotors, not_of_frames};
use crate::files::file_name::{self, Format};
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::files::plan_file::Compiler;
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{GOOD, TITLE, TYPED, WARNING};
use crate::values::choice;
use crate::values::choice::FunctionOrAll;

/// Write the generated code in Rust, C, CUDA or PTX
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne emit robots/puma560.yaml                               to the terminal
  rne emit robots/puma560.yaml --function all -o puma.rs     all functions
  rne emit robots/puma560.yaml --function all --check puma.rs   up to date?
  rne emit robots/puma560.yaml --lang c -o puma560.c         and puma560.h
  rne emit robots/puma560.yaml --lang ptx --real double      for a GPU
  rne emit docs/desk_arm.yaml --lang c --run-time upper,fore --tests
  rne emit robots/panda.yaml --lang c --casadi -o panda.c    for CasADi

Without --function rne writes the functions of the trait InverseDynamics. If the
file of --check is out of date, rne exits with status 1 and prints the command
that updates the file. C code needs no library. On standard output, the C header
and the C source are one file. C compiled with -DRNE_TEST runs the tests.")]
#[allow(clippy::struct_excessive_bools)] // options of a command
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    /// Language: rust, c, cuda or ptx
    #[arg(long, value_enum, default_value_t = Language::Rust, hide_possible_values = true)]
    lang: Language,
    /// Number type of C and PTX: float (default) or double
    #[arg(long, value_enum, value_name = "TYPE", hide_possible_values = true)]
    pub(super) real: Option<Real>,
    /// Prefix of names, not in Rust [default: robot's name]
    #[arg(long, value_name = "P")]
    prefix: Option<Prefix>,
    /// Functions, F,F,… or `all`: `rne explain functions`
    #[arg(long = "function", value_name = "F", value_delimiter = ',', value_parser = choice::function_or_all(),
        hide_possible_values = true)]
    functions: Vec<FunctionOrAll>,
    /// Frames or joints whose kinematics are written
    #[arg(long = "frame", value_name = "NAMES", value_delimiter = ',')]
    frames: Vec<String>,
    /// Form of the code: seven_steps (every intermediate value) or reduced (fewest operations) [default: seven_steps
    /// in Rust, reduced in others]
    #[arg(long, value_name = "F", value_parser = choice::form(), hide_possible_values = true)]
    form: Option<Form>,
    /// Order of statements: formulas (joint by joint) or registers (few live values)
    #[arg(long, value_name = "O", default_value_t = Order::Formulas, value_parser = choice::order(),
        hide_possible_values = true)]
    order: Order,
    /// Parameters of FILE that become function arguments, NAME,NAME,…; the others are constants
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    run_time: Vec<String>,
    /// Add joint friction and its derivatives to C code
    #[arg(long)]
    friction: bool,
    /// Add effort limits to C code: limit_torques
    #[arg(long)]
    limits: bool,
    /// Add a step of Runge-Kutta to C code: runge_kutta_step
    #[arg(long)]
    runge_kutta: bool,
    /// Add kernels to PTX that roll out forward dynamics
    #[arg(long)]
    rollout: bool,
    /// Add functions for CasADi, in double precision
    #[arg(long)]
    casadi: bool,
    /// Add functions for acados to those for CasADi
    #[arg(long, requires = "casadi")]
    acados: bool,
    /// Add the index of each joint under its name
    #[arg(long)]
    names: bool,
    /// Add sine and cosine to Rust code; C always has them
    #[arg(long)]
    with_sin_cos: bool,
    /// Add tests beside `rne::Arm` and laws of physics
    #[arg(long)]
    tests: bool,
    /// Write comments in ASCII: dw for ω̇, ^T for ᵀ
    #[arg(long)]
    ascii: bool,
    /// Output file; C code also gets a header file; - is standard output [default: -]
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Overwrite OUT even if rne did not generate it
    #[arg(long, requires = "output")]
    force: bool,
    /// Write nothing; check that this file is up to date
    #[arg(long, value_name = "OUT", conflicts_with_all = ["output", "force"])]
    check: Option<PathBuf>,
}

impl Arguments {
    /// The form that is asked for. Firmware wants few operations, and a reader of Rust code every vector.
    fn form(&self) -> Form {
        self.form.unwrap_or(match self.lang {
            Language::Rust => Form::SevenSteps,
            Language::C | Language::Cuda | Language::Ptx => Form::Reduced,
        })
    }

    /// Whether the code has the indices of the joints under their names. In code of a chain, they stand on request, so
    /// that its bytes stay what they were.
    fn names_joints(&self, robot: &Robot) -> bool {
        self.names || !robot.is_serial()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Language {
    Rust,
    C,
    Cuda,
    Ptx,
}

impl Language {
    const fn name(self) -> &'static str {
        match self {
            Self::Rust => "rust",
            Self::C => "c",
            Self::Cuda => "cuda",
            Self::Ptx => "ptx",
        }
    }

    const fn title(self) -> &'static str {
        match self {
            Self::Rust => "Rust",
            Self::C => "C",
            Self::Cuda => "CUDA",
            Self::Ptx => "PTX",
        }
    }

    const fn extension(self) -> &'static str {
        match self {
            Self::Rust => "rs",
            Self::C => "c",
            Self::Cuda => "cuh",
            Self::Ptx => "ptx",
        }
    }

    const fn format(self) -> Format {
        match self {
            Self::Rust => Format::Rust,
            Self::C => Format::C,
            Self::Cuda => Format::Cuda,
            Self::Ptx => Format::Ptx,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Real {
    /// 32 bits (default)
    Float,
    /// 64 bits
    Double,
}

impl Real {
    pub(super) const fn precision(self) -> Precision {
        match self {
            Self::Float => Precision::Single,
            Self::Double => Precision::Double,
        }
    }
}

/// A file as it is to be.
struct Generated {
    path: PathBuf,
    text: String,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    only_of_one_language(arguments)?;
    is_named_once(&arguments.run_time)?;
    if arguments.casadi && !arguments.run_time.is_empty() {
        return Err(Failure::usage(format_args!(
            "the functions that CasADi calls have no parameters, so all numbers of the robot file are constants there: \
             leave out {TYPED}--run-time{TYPED:#} or {TYPED}--casadi{TYPED:#}"
        )));
    }
    let out = arguments.output.as_deref().filter(|out| !is_standard_output(out)).or(arguments.check.as_deref());
    if arguments.check.as_deref().is_some_and(is_standard_output) {
        return Err(Failure::usage(format_args!(
            "{TYPED}--check{TYPED:#} compares with a file, so it needs the name of a file and not standard output"
        )));
    }
    out.map_or(Ok(()), |out| is_named_for(arguments.lang, out))?;
    let header = out.filter(|_| arguments.lang == Language::C).map(header_beside).transpose()?;
    let names: Vec<&str> = arguments.run_time.iter().map(String::as_str).collect();
    let of_urdf = if arguments.frames.is_empty() { Frames::Dropped } else { Frames::Kept };
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &names, of_urdf, Shape::Closed)?;
    let robot = arguments.rotors.of(checked.robot);
    if arguments.names_joints(&robot) {
        checked.identifiers.map_err(|report| Failure::from(&report))?;
    }
    let programs = programs(arguments, &robot)?;
    let mut outcome = emitted(arguments, &robot, &programs, &bytes, out, header)?;
    outcome.remark += &not_for_casadi(arguments, &programs);
    outcome.remark += &arguments.rotors.note(&robot);
    outcome.remark += &losses(arguments, &programs);
    Ok(outcome)
}

/// The digits that code loses in single precision, unless it computes in double precision alone.
fn losses(arguments: &Arguments, programs: &[Program]) -> String {
    let lines = rne_emit::losses(programs);
    if lines.is_empty() || arguments.casadi || arguments.real == Some(Real::Double) {
        return String::new();
    }
    format!("{WARNING}warning{WARNING:#}: {}\n", lines.join("\n"))
}

/// The code in files or on standard output, or the check of files.
fn emitted(
    arguments: &Arguments,
    robot: &Robot,
    programs: &[Program],
    bytes: &[u8],
    out: Option<&Path>,
    header: Option<Header>,
) -> Result<Outcome, Failure> {
    if arguments.casadi && !programs.iter().any(rne_emit::is_for_casadi) {
        return Err(Failure::usage(format_args!(
            "CasADi can call none of these functions: it calls functions that take vectors and return a number, a \
             vector or a matrix, such as {TYPED}--function inverse_dynamics,forward_dynamics{TYPED:#}"
        )));
    }
    if arguments.casadi {
        let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
        if let Some(name) = rne_emit::casadi_collision(programs, &prefix) {
            return Err(Failure::usage(format_args!(
                "two functions would have the name {name}: one for CasADi, and one of C, whose names begin with \
                 {prefix}. Choose other names in C: {TYPED}--prefix my_arm{TYPED:#}"
            )));
        }
    }
    if arguments.rollout && !programs.iter().any(|program| rne_emit::is_for_rollouts(program.function)) {
        return Err(Failure::usage(format_args!(
            "none of these functions can be rolled out; ask for \
             {TYPED}--function forward_dynamics,forward_dynamics_with_payload{TYPED:#}, or for one of the two"
        )));
    }
    let precision = if arguments.casadi { Real::Double } else { arguments.real.unwrap_or(Real::Float) }.precision();
    let request = Request {
        file: &arguments.file,
        bytes,
        prefix: arguments.prefix.as_ref(),
        precision,
        friction: arguments.friction,
        limits: arguments.limits,
        runge_kutta: arguments.runge_kutta,
        names: arguments.names_joints(robot),
        rollout: arguments.rollout,
        casadi: arguments.casadi,
        acados: arguments.acados,
        tests: arguments.tests,
        ascii: arguments.ascii,
    };
    let c_code = || c_code(&request, robot, programs);
    let rust_file = if arguments.with_sin_cos { rne_emit::rust_file_with_sin_cos } else { rne_emit::rust_file };
    let names = if arguments.names_joints(robot) { rne_emit::rust_joints(robot) } else { String::new() };
    let rust = || Ok::<_, Failure>(rust_file(robot, programs) + &names + &rust_tests(arguments, robot, programs)?);
    let shown = |text: String| if arguments.ascii { rne_emit::ascii(&text) } else { text };
    let language = if arguments.lang == Language::Cuda { ForGpu::Cuda } else { ForGpu::Ptx };
    let gpu = || for_gpu(language, &request, robot, programs);
    let generated = |path: &Path, text| Generated { path: path.to_owned(), text };
    let files = match (arguments.lang, out, header) {
        (Language::Rust, None, _) => return Ok(Outcome::text(shown(rust()?))),
        (Language::Rust, Some(out), _) => vec![generated(out, shown(rust()?))],
        (Language::C, Some(out), Some(header)) => {
            let code = c_code()?;
            let source = code.source(&header.name);
            vec![generated(&header.path, code.header().to_owned()), generated(out, source)]
        }
        (Language::C, ..) => return Ok(Outcome::text(c_code()?.one_file())),
        (_, None, _) => return Ok(Outcome::text(gpu()?)),
        (_, Some(out), _) => vec![generated(out, gpu()?)],
    };
    match &arguments.check {
        Some(out) => check(arguments, out, &files),
        None => write(arguments, &files),
    }
}

/// Refuses rollouts of a robot whose own equations of motion no kernel integrates.
fn can_be_rolled_out(arguments: &Arguments, robot: &Robot) -> Result<(), Failure> {
    if !robot.closed.is_empty() {
        return Err(Failure::usage(format_args!(
            "a robot with closed loops cannot be rolled out in a kernel; leave {TYPED}--rollout{TYPED:#} out: \
             {TYPED}--function forward_dynamics_of_loops{TYPED:#} writes a kernel of its accelerations"
        )));
    }
    if robot.floating_base.is_some() && arguments.functions.is_empty() {
        return Err(Failure::usage(format_args!(
            "a robot on a floating base cannot be rolled out in a kernel; {TYPED}--function forward_dynamics{TYPED:#} \
             rolls out the robot with a locked base"
        )));
    }
    Ok(())
}

/// The functions asked for, by their names or by other options, that CasADi cannot call.
fn not_for_casadi(arguments: &Arguments, programs: &[Program]) -> String {
    let is_asked = |program: &&Program| {
        program.frame.is_some() || arguments.functions.contains(&FunctionOrAll::One(program.function))
    };
    let left_out = programs.iter().filter(is_asked).filter(|program| !rne_emit::is_for_casadi(program));
    let steps = arguments.runge_kutta.then_some(["runge_kutta_step", "runge_kutta_step_derivatives"]);
    let names: Vec<&str> = left_out.map(|program| program.name.as_str()).chain(steps.into_iter().flatten()).collect();
    if !arguments.casadi || names.is_empty() {
        return String::new();
    }
    format!(
        "{TITLE}note{TITLE:#}: CasADi calls functions that take vectors and return a number, a vector or a matrix. \
         These are functions of C alone: {}\n",
        names.join(", ")
    )
}

/// A file whose name says that it is in another language.
fn is_named_for(lang: Language, out: &Path) -> Result<(), Failure> {
    let extension = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let (is_other, other) = match lang {
        Language::Rust => (matches!(extension.as_str(), "c" | "h" | "cc" | "cpp" | "cxx" | "hpp"), Language::C),
        Language::C => (matches!(extension.as_str(), "rs" | "cc" | "cpp" | "cxx" | "hpp"), Language::Rust),
        Language::Cuda | Language::Ptx => return Ok(()),
    };
    if !is_other {
        return Ok(());
    }
    let right = out.with_extension(lang.extension());
    let instead = if extension == other.extension() {
        format!(", or ask for {TYPED}--lang {}{TYPED:#}", other.name())
    } else {
        String::new()
    };
    Err(Failure::usage(format_args!(
        "{} is not a name for a file in {}; name it {TYPED}{}{TYPED:#}{instead}",
        out.display(),
        lang.title(),
        right.display()
    )))
}

fn is_named_once(run_time: &[String]) -> Result<(), Failure> {
    if run_time.iter().any(String::is_empty) {
        return Err(Failure::usage("--run-time names no parameter; write --run-time NAME,NAME"));
    }
    let twice = run_time.iter().enumerate().find(|(index, name)| run_time[..*index].contains(name));
    twice.map_or(Ok(()), |(_, name)| Err(Failure::usage(format_args!("--run-time names {name} twice"))))
}

fn only_of_one_language(arguments: &Arguments) -> Result<(), Failure> {
    use Language::{C, Cuda, Ptx, Rust};
    let options: [(&str, bool, &[Language], &str); 11] = [
        (
            "--with-sin-cos",
            arguments.with_sin_cos,
            &[Rust],
            "code in other languages always contains its sine and cosine",
        ),
        ("--real", arguments.real.is_some(), &[C, Ptx], "code in Rust and CUDA is generic over the number type"),
        ("--prefix", arguments.prefix.is_some(), &[C, Cuda, Ptx], "a file of Rust is a module with a name of its own"),
        ("--friction", arguments.friction, &[C], "in Rust, the derive `Actuation` computes friction"),
        ("--limits", arguments.limits, &[C], "in Rust, `f64::clamp` limits a torque"),
        ("--runge-kutta", arguments.runge_kutta, &[C], "in Rust, every type with `ForwardDynamics` has the step"),
        ("--rollout", arguments.rollout, &[Ptx], "`CompiledArm::rollout` rolls samples out on the processor"),
        (
            "--order registers",
            arguments.order == Order::Registers,
            &[Rust, C, Cuda],
            "kernels of PTX always have an order in which few values are alive at once",
        ),
        ("--names", arguments.names, &[Rust, C], "code for processors of graphics has functions alone"),
        ("--tests", arguments.tests, &[Rust, C], "code for processors of graphics has functions alone"),
        ("--casadi", arguments.casadi, &[C], "CasADi calls functions of C"),
    ];
    if arguments.casadi && arguments.real == Some(Real::Float) {
        return Err(Failure::usage(format_args!(
            "{TYPED}--real float{TYPED:#} is not for CasADi, which computes in double precision. Write \
             {TYPED}--real double{TYPED:#}"
        )));
    }
    let refused = options.iter().find(|(_, is_given, of, _)| *is_given && !of.contains(&arguments.lang));
    let Some((option, _, of, why)) = refused else { return Ok(()) };
    let of: Vec<String> = of.iter().map(|lang| format!("{TYPED}--lang {}{TYPED:#}", lang.name())).collect();
    Err(Failure::usage(format_args!(
        "{TYPED}{option}{TYPED:#} is for {}: {why}. Leave it out, or ask for another language",
        of.join(" and ")
    )))
}

/// The tests of code in Rust, where they are asked for.
fn rust_tests(arguments: &Arguments, robot: &Robot, programs: &[Program]) -> Result<String, Failure> {
    if !arguments.tests {
        return Ok(String::new());
    }
    let golden = golden::of_programs(robot, programs, Precision::Double)?;
    Ok(rne_emit::rust_tests(robot, programs, &golden))
}

/// The functions asked for, each once, in the order of the traits.
fn functions(arguments: &Arguments, robot: &Robot) -> Vec<Function> {
    let asked = &arguments.functions;
    if asked.contains(&FunctionOrAll::All) {
        return choice::functions_of(robot).collect();
    }
    let (is_for_casadi, has_frames) = (arguments.casadi && robot.closed.is_empty(), !arguments.frames.is_empty());
    let is_asked = |function: &Function| match asked.as_slice() {
        _ if (arguments.acados || arguments.runge_kutta) && *function == Function::ForwardDynamics => true,
        // with its derivatives
        [] if arguments.runge_kutta && *function == Function::ForwardDynamicsDerivatives => true,
        // each option adds its functions
        [] if arguments.runge_kutta || arguments.rollout || is_for_casadi || has_frames => match function {
            Function::InverseDynamics => is_for_casadi,
            Function::ForwardDynamics => is_for_casadi || arguments.rollout,
            function => has_frames && function.of_frame().is_some(),
        },
        // tips are there for their wrenches
        [] => {
            Function::TORQUES.contains(function)
                || matches!(function, Function::ClosureStep | Function::InverseDynamicsOfLoops)
                || (*function == Function::InverseDynamicsWithWrenches && !robot.tips.is_empty())
        }
        asked => asked.contains(&FunctionOrAll::One(*function)),
    };
    // a function by its name is refused by the compiler, which says why the robot has it not
    let of_robot: Vec<Function> = match asked.as_slice() {
        [] if arguments.runge_kutta => rne_codegen::functions_of(robot).chain([Function::ForwardDynamics]).collect(),
        [] => rne_codegen::functions_of(robot).collect(),
        _ => Function::ALL.to_vec(),
    };
    let asked: Vec<Function> = of_robot.into_iter().filter(is_asked).collect();
    let for_derivatives = asked.iter().filter(|_| arguments.casadi);
    let for_derivatives: Vec<Function> =
        for_derivatives.flat_map(|&function| rne_emit::casadi_derivatives(function)).collect();
    let is_needed = |function: &Function| asked.contains(function) || for_derivatives.contains(function);
    Function::ALL.into_iter().filter(is_needed).collect()
}

fn compiled(arguments: &Arguments, compiler: &Compiler<'_>, function: Function) -> Result<Program, Failure> {
    let is_for_derivatives = arguments.casadi && !arguments.functions.contains(&FunctionOrAll::One(function));
    compiler.compile(function, arguments.form()).map_err(|mut failure| {
        if is_for_derivatives {
            let _ = write!(
                failure.text,
                "\n`{function}` is needed for CasADi's derivatives of another function. Name the functions that you \
                 need, such as {TYPED}--function inverse_dynamics{TYPED:#}"
            );
        }
        failure
    })
}

fn programs(arguments: &Arguments, robot: &Robot) -> Result<Vec<Program>, Failure> {
    // kernels of a batch want the fewest instructions
    let target = if arguments.lang == Language::Ptx { Target::Throughput } else { Target::Latency };
    let compiler = Compiler::new(&arguments.file, robot).for_target(target);
    if arguments.rollout {
        can_be_rolled_out(arguments, robot)?;
    }
    let functions = functions(arguments, robot);
    functions.iter().try_for_each(|function| function.check_base(robot)).map_err(Failure::usage)?;
    let (of_frames, of_arm): (Vec<_>, Vec<_>) = functions.iter().partition(|function| function.of_frame().is_some());
    if !arguments.frames.is_empty() && of_frames.is_empty() {
        return Err(not_of_frames("none of the functions that are written is one of them"));
    }
    let of_tip = if arguments.frames.is_empty() { &functions } else { &of_arm };
    let mut programs: Vec<Program> =
        of_tip.iter().map(|&function| compiled(arguments, &compiler, function)).collect::<Result<_, _>>()?;
    for frame in frames(arguments, robot)? {
        let robot = robot.clone().at_frame(frame);
        let compiler = Compiler::new(&arguments.file, &robot).for_target(target);
        for &function in &of_frames {
            let program = compiler.compile(function, arguments.form())?;
            if let Some(other) = programs.iter().find(|other| other.name == program.name) {
                return Err(Failure::usage(format_args!(
                    "the frames {} and {} both give the name {}; write them to two files",
                    other.frame.as_deref().unwrap_or("tip"),
                    robot.frame_name(frame),
                    program.name
                )));
            }
            programs.push(program);
        }
    }
    in_order(arguments.order, arguments.form(), programs)
}

/// Programs with their statements in an order.
pub(super) fn in_order(order: Order, form: Form, programs: Vec<Program>) -> Result<Vec<Program>, Failure> {
    match (order, form) {
        (Order::Formulas, _) => Ok(programs),
        (Order::Registers, Form::SevenSteps) => Err(Failure::usage(format_args!(
            "{TYPED}--order registers{TYPED:#} is for {TYPED}--form reduced{TYPED:#}: code of the seven steps keeps \
             their order, and code in Rust has this form unless you write {TYPED}--form reduced{TYPED:#}"
        ))),
        (Order::Registers, Form::Reduced) => Ok(programs.iter().map(ordered_for_registers).collect()),
    }
}

/// The option of an order, where it is not the usual one.
pub(super) fn of_order(order: Order) -> String {
    if order == Order::Formulas { String::new() } else { format!(" --order {order}") }
}

/// The frames asked for, or those of the list `frames`.
fn frames(arguments: &Arguments, robot: &Robot) -> Result<Vec<FrameId>, Failure> {
    if arguments.frames.is_empty() {
        return Ok((0..robot.frames.len()).map(FrameId::Named).collect());
    }
    arguments.frames.iter().map(|name| robot.frame(name).map_err(Failure::usage)).collect()
}

/// The title before the mark may take several lines.
fn is_ours(text: &str) -> bool {
    let mut heading = text.lines().take_while(|line| line.starts_with("//"));
    let is_mark = |line: &str| line.starts_with(rne_emit::GENERATED);
    heading.any(|line| ["//! ", "// "].iter().any(|mark| line.strip_prefix(mark).is_some_and(is_mark)))
}

/// Writes all files, or none if one of them is another's.
fn write(arguments: &Arguments, files: &[Generated]) -> Result<Outcome, Failure> {
    files.iter().try_for_each(|file| may_be_written(arguments, &file.path))?;
    for path in files.iter().map(|file| &file.path) {
        let made = path.parent().map_or(Ok(()), fs::create_dir_all);
        made.map_err(|error| output_file::unwritable(path, &error))?;
    }
    let files: Vec<(&Path, &str)> = files.iter().map(|file| (file.path.as_path(), file.text.as_str())).collect();
    output_file::write_all(&files).map(Outcome::remark)
}

fn may_be_written(arguments: &Arguments, out: &Path) -> Result<(), Failure> {
    if output_file::is_same(out, &arguments.file) {
        let message = format!("{} is the robot file itself; write the code to another file", out.display());
        return Err(Failure::usage(message));
    }
    file_name::check(out, arguments.lang.format())?;
    match output_file::existing(out) {
        Existing::Nothing => Ok(()),
        Existing::Text(text) if is_ours(&text) || arguments.force => Ok(()),
        Existing::Other if arguments.force => Ok(()),
        Existing::Text(_) | Existing::Other => Err(Failure::usage(format_args!(
            "{} was not generated by rne and is not changed; {TYPED}--force{TYPED:#} overwrites it",
            out.display()
        ))),
        Existing::Folder => Err(Failure::usage(format_args!(
            "{0} is a folder; name a file, such as {0}/robot.{1}",
            out.display(),
            arguments.lang.extension()
        ))),
        Existing::Special => Err(Failure::usage(format_args!("{} is not a regular file; name another", out.display()))),
        Existing::Unreadable(error) => Err(output_file::unreadable(out, &error)),
    }
}

/// Compares all files. The message names the first that differs, and the command that writes them all.
fn check(arguments: &Arguments, out: &Path, files: &[Generated]) -> Result<Outcome, Failure> {
    let mut stale: Option<String> = None;
    let mut force = "";
    let mut remark = String::new();
    for Generated { path, text } in files {
        let shown = path.display();
        let why = match output_file::existing(path) {
            Existing::Text(found) if found == *text => {
                let _ = writeln!(remark, "{GOOD}up to date:{GOOD:#} {shown}");
                continue;
            }
            Existing::Text(found) if is_ours(&found) => {
                format!("{shown} is stale: {}", first_difference(&found, text))
            }
            Existing::Text(_) | Existing::Other => {
                force = " --force";
                format!("{shown} was not generated by rne")
            }
            Existing::Nothing => format!("there is no file {shown}"),
            Existing::Folder => return Err(Failure::usage(format_args!("{shown} is a folder"))),
            Existing::Special => return Err(Failure::usage(format_args!("{shown} is not a regular file"))),
            Existing::Unreadable(error) => format!("{shown} cannot be read: {error}"),
        };
        stale.get_or_insert(why);
    }
    match stale {
        None => Ok(Outcome::remark(remark)),
        Some(why) => Err(Failure::input(format_args!(
            "{why}\n\nto write it: {TYPED}{}{force}{TYPED:#}",
            command(arguments, out)
        ))),
    }
}

fn first_difference(found: &str, expected: &str) -> String {
    let (mut found, mut expected) = (found.lines(), expected.lines());
    let mut number = 1;
    loop {
        match (found.next(), expected.next()) {
            (Some(a), Some(b)) if a == b => number += 1,
            (None, None) => return "its line ends differ".to_owned(),
            (a, b) => {
                let quote =
                    |line: Option<&str>| line.map_or("the end of the file".to_owned(), |line| format!("`{line}`"));
                return format!("line {number} is {}, but rne would write {}", quote(a), quote(b));
            }
        }
    }
}

/// The command that writes `out`.
fn command(arguments: &Arguments, out: &Path) -> String {
    let mut command = format!("rne emit {} --lang {}", robot_file::shell(&arguments.file), arguments.lang.name());
    if let Some(real) = arguments.real {
        let _ = write!(command, " --real {}", real.precision().c_type());
    }
    if let Some(prefix) = &arguments.prefix {
        let _ = write!(command, " --prefix {prefix}");
    }
    for function in &arguments.functions {
        let _ = write!(command, " --function {function}");
    }
    if !arguments.frames.is_empty() {
        let _ = write!(command, " --frame {}", arguments.frames.join(","));
    }
    if arguments.rotors.rotors {
        command.push_str(" --rotors");
    }
    if let Some(form) = arguments.form {
        let _ = write!(command, " --form {form}");
    }
    command.push_str(&of_order(arguments.order));
    if !arguments.run_time.is_empty() {
        let _ = write!(command, " --run-time {}", arguments.run_time.join(","));
    }
    for (option, is_given) in [
        (" --friction", arguments.friction),
        (" --limits", arguments.limits),
        (" --runge-kutta", arguments.runge_kutta),
        (" --rollout", arguments.rollout),
        (" --names", arguments.names),
        (" --with-sin-cos", arguments.with_sin_cos),
        (" --casadi", arguments.casadi),
        (" --acados", arguments.acados),
        (" --tests", arguments.tests),
        (" --ascii", arguments.ascii),
    ] {
        command.push_str(if is_given { option } else { "" });
    }
    let _ = write!(command, " -o {}", robot_file::shell(out));
    command
}
