//! Measures the generated code on microcontrollers. `cargo xtask certificate` starts this program.

mod board;
mod c_code;
mod functions;
mod image;
mod log;
mod object_file;
mod report;
mod riscv;
mod table;
mod tools;
mod wasm;

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, ensure};
use clap::Parser;

use crate::board::Board;
use crate::image::Figures;
use crate::log::{Agreement, Log};
use crate::report::Report;
use crate::table::{Baseline, Row, Table};

/// Builds, reads and runs the generated code for microcontrollers, and compares it with docs/measured/embedded.md
#[derive(Parser)]
#[command(
    name = "cargo xtask certificate",
    after_help = "\
Exit status: 0 everything is as the document says, or the document is of other compilers; 1 something is not, or a tool
failed.

Examples:
  cargo xtask certificate             judge
  cargo xtask certificate --update    judge, and write docs/measured/embedded.md anew
  cargo xtask certificate --sample    judge the Cortex-M4F alone, in Rust, and every third robot in C"
)]
struct Arguments {
    /// Write docs/measured/embedded.md anew
    #[arg(long)]
    update: bool,
    /// Judge the Cortex-M4F alone, in Rust, and every third robot in C: neither M7F nor fused multiply-add, RISC-V and
    /// WebAssembly
    #[arg(long, conflicts_with = "update")]
    sample: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("embedded certificate: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<ExitCode> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("the package is in a workspace")?;
    let path = workspace.join("../docs/measured/embedded.md");
    let figures = workspace.join("measurements/figures.txt");
    let report = examine(workspace, arguments.sample)?;
    summary(&report)?;
    if arguments.update {
        fs::write(&path, report.document()).context("docs/measured/embedded.md")?;
        fs::write(&figures, report.figures_of_all()).context("firmware/measurements/figures.txt")?;
        println!("wrote docs/measured/embedded.md and firmware/measurements/figures.txt");
        return Ok(ExitCode::SUCCESS);
    }
    let committed = fs::read_to_string(&path).context("docs/measured/embedded.md")?;
    let all = fs::read_to_string(&figures).context("firmware/measurements/figures.txt")?;
    let baseline = Baseline::read(&all);
    let grown: Vec<String> = report.tables.iter().flat_map(|table| table.growth(&baseline)).collect();
    if !grown.is_empty() {
        println!("grown by more than 2 %:\n  {}", grown.join("\n  "));
        println!("if that is meant: cargo xtask certificate --update");
        return Ok(ExitCode::FAILURE);
    }
    for table in report.tables.iter().filter(|table| table.is_of_another_compiler(&baseline)) {
        let (title, compiler) = (&table.title, &table.compiler);
        println!("{title}: not compared, firmware/measurements/figures.txt is of another compiler than {compiler}");
    }
    let is_same = report::is_same(&committed, &report.document()) && all == report.figures_of_all();
    if !arguments.sample && !is_same {
        println!("docs/measured/embedded.md is of older figures; cargo xtask certificate --update writes them anew");
    }
    println!("certified");
    Ok(ExitCode::SUCCESS)
}

/// Option for an LLVM scheduler that takes the number of registers into account; see
/// firmware/example/.cargo/config.toml.
const SCHEDULER: &str = "-Cllvm-args=-pre-RA-sched=list-ilp";

/// Examines the C code in one thread while the Rust code is examined in another one.
fn examine(workspace: &Path, sample: bool) -> Result<Report> {
    let expected = Log::of_host();
    thread::scope(|scope| {
        let c = scope.spawn(|| step("C", || c_code::examine(workspace, sample, &expected)));
        let of_c = || c.join().map_err(|_| anyhow!("C: a panic"))?;
        examine_beside(workspace, sample, &expected, of_c)
    })
}

/// Examines the Rust code, and adds the table of the C code; `of_c` waits for the rows of that table.
fn examine_beside(
    workspace: &Path,
    sample: bool,
    expected: &Log,
    of_c: impl FnOnce() -> Result<Vec<Row>>,
) -> Result<Report> {
    let [rustc, gcc, qemu] = [tools::rustc_version()?, tools::gcc_version()?, tools::qemu_version()?];
    let mut tables = Vec::new();
    let mut table = |title, about: &str, compiler: String, of, rows| {
        tables.push(Table { title, about: about.to_owned(), compiler, of, rows });
    };

    let flags = [SCHEDULER];
    let m4 = Board { machine: "mps2-an386", flags: &flags, features: &["methods"] };
    let m4 = step("Cortex-M4F", || m4.examine(workspace))?;
    let compiler = format!("{rustc}, `{}`", flags.join(" "));
    table(report::M4F, M4F, compiler.clone(), "robot", m4.robots(expected, Agreement::Identical)?);

    if !sample {
        let m7_flags = ["-Ctarget-cpu=cortex-m7"];
        let m7 = Board { machine: "mps2-an500", flags: &m7_flags, features: &[] };
        let m7 = step("Cortex-M7F", || m7.examine(workspace))?;
        let m7_compiler = format!("{rustc}, `{}`", m7_flags.join(" "));
        table(report::M7F, M7F, m7_compiler, "robot", m7.robots(expected, Agreement::Identical)?);

        let fused = Board { machine: "mps2-an386", flags: &flags, features: &["core_float_math"] };
        let fused = step("Cortex-M4F with fused multiply-add", || fused.examine(workspace))?;
        table(report::FUSED, FUSED, compiler.clone(), "robot", fused.robots(expected, board::ROUNDING)?);
    }
    table(report::METHODS, METHODS, compiler.clone(), "function", m4.methods(expected)?);
    table(report::CONTROLLERS, CONTROLLERS, compiler, "robot", m4.controllers(expected)?);

    table(report::C, C, format!("{gcc}, `-O2 -ffp-contract=off`"), "robot", of_c()?);

    let runtime = m4.runtime()?;
    if sample {
        return Ok(Report { qemu, tables, runtime, riscv: None, wasm: None });
    }
    let riscv = Some(step("RISC-V", || riscv::examine(workspace))?);
    let wasm = if tools::has_node() {
        Some(step("WebAssembly", || wasm::examine(workspace, expected))?)
    } else {
        println!("WebAssembly: skipped, there is no Node");
        None
    };
    Ok(Report { qemu, tables, runtime, riscv, wasm })
}

/// Runs a long step, and prints how long it took.
fn step<T>(name: &str, act: impl FnOnce() -> Result<T>) -> Result<T> {
    let start = Instant::now();
    let result = act().with_context(|| name.to_owned())?;
    println!("{name}: {:.0} s", start.elapsed().as_secs_f64());
    Ok(result)
}

/// Largest figures of the PUMA 560 on the M4F that are accepted: [seven steps, reduced].
const LIMITS: [Figures; 2] = [
    Figures { instructions: 1000, code: 4096, constants: 0, stack: 256 },
    Figures { instructions: 700, code: 3072, constants: 0, stack: 256 },
];

/// Prints the most important figures, and checks their bounds.
fn summary(report: &Report) -> Result<()> {
    let puma560 = report.puma560(report::M4F).context("the PUMA 560 is among the robots")?;
    for ((form, figures), limit) in ["seven_steps", "reduced"].iter().zip(puma560).zip(LIMITS) {
        let Figures { instructions, code, constants, stack } = figures;
        let bytes = code + constants;
        println!(
            "PUMA 560 on the Cortex-M4F, {form}: {instructions} instructions, {bytes} bytes of code and constants, \
             {stack} bytes of stack, no branch, no call"
        );
        ensure!(
            instructions <= limit.instructions && bytes <= limit.code && stack <= limit.stack,
            "more than {} instructions, {} bytes of code and constants, {} bytes of stack",
            limit.instructions,
            limit.code,
            limit.stack
        );
    }
    let observer = report.figures(report::METHODS, "observer_update", "reduced");
    let Figures { instructions, .. } = observer.context("the observer is among the functions")?;
    println!("a tick of the PUMA's momentum observer on the Cortex-M4F, reduced: {instructions} instructions");
    ensure!(instructions <= OBSERVER, "more than {OBSERVER} instructions");
    let tick = report.figures(report::CONTROLLERS, "puma560", "reduced").context("the PUMA 560 has a controller")?;
    println!("a tick of the PUMA's controller with its observer, reduced: {} instructions", tick.instructions);
    ensure!(tick.instructions <= TICK, "more than {TICK} instructions");
    let is_of_six = |name: &str| functions::robots().iter().any(|robot| robot.name == name && robot.dof == 6);
    let ticks = report.tables.iter().filter(|table| table.title == report::CONTROLLERS).flat_map(|table| &table.rows);
    for Row { name, figures, .. } in ticks.filter(|row| is_of_six(&row.name)) {
        ensure!(
            figures.instructions <= TICK_OF_SIX,
            "{name}: a tick of the controller of {} instructions",
            figures.instructions
        );
    }
    Ok(())
}

/// Largest number of instructions of a tick of a controller with an observer, in the reduced form: for the PUMA 560,
/// and for each shipped arm with six joints.
const TICK: u64 = 1300;
const TICK_OF_SIX: u64 = 2500;

/// Largest number of instructions of a tick of the momentum observer of the PUMA 560, in the reduced form.
const OBSERVER: u64 = 1000;

const M4F: &str = "\
This table is about `inverse_dynamics` for the target `thumbv7em-none-eabihf`, which `firmware/example` uses too. If a
term of a sum is a product, the compiler uses the instruction `vmla.f32`, which rounds the product and the sum
separately.";

const M7F: &str = "\
This table is about `inverse_dynamics`. The processor has instructions for double precision, but the code does not use
them. The compiler orders the instructions for this processor.";

const FUSED: &str = "\
This table is about `inverse_dynamics` with the cargo feature `core_float_math` of `rne`. With this feature, the form
`reduced` uses the fused multiply-add `vfma.f32`, which rounds once. The sines and cosines of both forms use it, too.

The feature needs a nightly compiler. A stable compiler offers no fused multiply-add here: `f32::math::mul_add` of
`core` is unstable, inline assembly does not accept the registers, and `libm` computes in software.

The results differ from those of the host, because the host rounds products and sums separately: its base instruction
set has no fused multiply-add. The column `results` shows the difference in ulp of the largest torque of the state. The
terms of this torque may cancel, so a small rounding error can be several ulp of the torque.

The feature is not a default because it saves little: `vmla.f32` is as short and as slow as `vfma.f32`.";

const METHODS: &str = "\
The tables above are about `inverse_dynamics`. This table is about the other functions of the PUMA 560. It omits
functions whose code calls memory functions. The compiler writes such calls for large arrays with many zeros, such as
the 360 numbers of `regressor`: the calls clear or copy memory. Apart from these calls, the code of an omitted function
has no branch, and its results are compared with the host like all others.";

const CONTROLLERS: &str = "\
This table is about one tick of a controller, the method `tick` of `rne::ComputedTorque`: computed torque, and an update
of the momentum observer, which estimates the torques of contacts. Torques and observer need the same sines, cosines and
velocities, and the compiler computes them once. The counts contain the control law, the loads of its gains and of the
desired motion, and the low-pass of the observer. The column `results` is about torques and external torques.";

const C: &str = "\
This table is about `inverse_dynamics` in the C code that `rne emit --lang c` writes. The code uses `float`. GCC
compiles the code with `-Wall -Wextra -Wconversion -Werror -pedantic`. The code has one function for sine and cosine,
and calls it for each angle. The column `instructions` includes all of these calls. The columns for bytes include the
function once.

`cargo xtask certificate` also compares the C code of all other functions of the PUMA 560 with the host. The results
have the same bits, also when sines and cosines are inputs (`inverse_dynamics_from_sin_cos`).";
