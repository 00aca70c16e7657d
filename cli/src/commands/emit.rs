//! `rne emit`: writes code that needs no other files to compile.

pub(super) mod c;
mod files;
pub(super) mod functions;
pub(super) mod options;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rne_codegen::{Form, Order, Program};
use rne_emit::{Precision, Prefix};
use rne_model::Robot;

use crate::commands::emit::c::{Header, Request, c_code, for_gpu, header_beside};
use crate::commands::emit::files::Generated;
use crate::commands::eval::golden;
use crate::files::chosen_arm::Rotors;
use crate::files::file_name::Format;
use crate::files::output_file::is_standard_output;
use crate::files::robot_file::{self, Frames, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::{TITLE, TYPED, WARNING};
use crate::values::choice::{self, FunctionOrAll};

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
    /// Returns the form that the command line asks for. The default is the reduced form, because firmware needs few
    /// operations; for Rust it is the seven steps, because its reader wants to see every vector.
    fn form(&self) -> Form {
        self.form.unwrap_or(match self.lang {
            Language::Rust => Form::SevenSteps,
            Language::C | Language::Cuda | Language::Ptx => Form::Reduced,
        })
    }

    /// Returns whether the code has the indices of the joints under their names. Code of a chain has them only with
    /// `--names`, so that existing code of chains stays the same.
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
    /// Returns three words for a language: its name on the command line, its name in a sentence, and the extension of a
    /// file.
    const fn words(self) -> [&'static str; 3] {
        match self {
            Self::Rust => ["rust", "Rust", "rs"],
            Self::C => ["c", "C", "c"],
            Self::Cuda => ["cuda", "CUDA", "cuh"],
            Self::Ptx => ["ptx", "PTX", "ptx"],
        }
    }

    const fn name(self) -> &'static str {
        self.words()[0]
    }

    const fn title(self) -> &'static str {
        self.words()[1]
    }

    const fn extension(self) -> &'static str {
        self.words()[2]
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

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    options::only_of_one_language(arguments)?;
    options::is_named_once(&arguments.run_time)?;
    if arguments.casadi && !arguments.run_time.is_empty() {
        return Err(usage_error!(
            "the functions that CasADi calls have no parameters, so all numbers of the robot file are constants there: \
             leave out {TYPED}--run-time{TYPED:#} or {TYPED}--casadi{TYPED:#}"
        ));
    }
    let out = arguments.output.as_deref().filter(|out| !is_standard_output(out)).or(arguments.check.as_deref());
    if arguments.check.as_deref().is_some_and(is_standard_output) {
        return Err(usage_error!(
            "{TYPED}--check{TYPED:#} compares with a file, so it needs the name of a file and not standard output"
        ));
    }
    out.map_or(Ok(()), |out| options::is_named_for(arguments.lang, out))?;
    let header = out.filter(|_| arguments.lang == Language::C).map(header_beside).transpose()?;
    let names: Vec<&str> = arguments.run_time.iter().map(String::as_str).collect();
    let of_urdf = if arguments.frames.is_empty() { Frames::Dropped } else { Frames::Kept };
    let (checked, bytes) = robot_file::read_with_run_time(&arguments.file, &names, of_urdf, Shape::Closed)?;
    let robot = arguments.rotors.of(checked.robot);
    if arguments.names_joints(&robot) {
        checked.identifiers.map_err(|report| Failure::from(&report))?;
    }
    let programs = functions::programs(arguments, &robot)?;
    let mut outcome = emitted(arguments, &robot, &programs, &bytes, out, header)?;
    outcome.remark += &not_for_casadi(arguments, &programs);
    outcome.remark += &arguments.rotors.note(&robot);
    outcome.remark += &losses(arguments, &programs);
    Ok(outcome)
}

/// Returns a note on digits that the code loses in single precision; empty if the code uses only double precision.
fn losses(arguments: &Arguments, programs: &[Program]) -> String {
    let lines = rne_emit::losses(programs);
    if lines.is_empty() || arguments.casadi || arguments.real == Some(Real::Double) {
        return String::new();
    }
    format!("{WARNING}warning{WARNING:#}: {}\n", lines.join("\n"))
}

/// Writes the code to files or to standard output, or checks files.
fn emitted(
    arguments: &Arguments,
    robot: &Robot,
    programs: &[Program],
    bytes: &[u8],
    out: Option<&Path>,
    header: Option<Header>,
) -> Result<Outcome, Failure> {
    are_for_options(arguments, robot, programs)?;
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
    let gpu = || for_gpu(arguments.lang, &request, robot, programs);
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
        Some(out) => files::check(arguments, out, &files),
        None => files::write(arguments, &files),
    }
}

/// Refuses options for CasADi and for rollouts if the code has no function that they apply to.
fn are_for_options(arguments: &Arguments, robot: &Robot, programs: &[Program]) -> Result<(), Failure> {
    if arguments.casadi && !programs.iter().any(rne_emit::is_for_casadi) {
        return Err(usage_error!(
            "CasADi can call none of these functions: it calls functions that take vectors and return a number, a \
             vector or a matrix, such as {TYPED}--function inverse_dynamics,forward_dynamics{TYPED:#}"
        ));
    }
    if arguments.casadi {
        let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
        if let Some(name) = rne_emit::casadi_collision(programs, &prefix) {
            return Err(usage_error!(
                "two functions would have the name {name}: one for CasADi, and one of C, whose names begin with \
                 {prefix}. Choose other names in C: {TYPED}--prefix my_arm{TYPED:#}"
            ));
        }
    }
    if arguments.rollout && !programs.iter().any(|program| rne_emit::is_for_rollouts(program.function)) {
        return Err(usage_error!(
            "none of these functions can be rolled out; ask for \
             {TYPED}--function forward_dynamics,forward_dynamics_with_payload{TYPED:#}, or for one of the two"
        ));
    }
    Ok(())
}

/// Lists functions that the command line asks for and that CasADi cannot call.
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

/// Returns the tests of Rust code, if the command line asks for them.
fn rust_tests(arguments: &Arguments, robot: &Robot, programs: &[Program]) -> Result<String, Failure> {
    if !arguments.tests {
        return Ok(String::new());
    }
    let golden = golden::of_programs(robot, programs, Precision::Double)?;
    Ok(rne_emit::rust_tests(robot, programs, &golden))
}
