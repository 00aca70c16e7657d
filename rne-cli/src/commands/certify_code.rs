//! The code that `rne certify` compiles, links with a program for a board, and runs.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use rne_certify::board::{self, Call};
use rne_certify::certificate::Emulation;
use rne_certify::{accuracy, sha256};
use rne_codegen::{Function, Interpreter, Program};
use rne_emit::{Additions, CCode, Origin, Precision, Prefix};
use rne_model::Robot;

use crate::commands::certify::{Arguments, Language, file_name};
use crate::commands::toolchain;
use crate::files::input_file::is_stream;
use crate::outcome::Failure;

/// The code of the arm in files of a folder.
pub(super) struct Code {
    /// The name of the function for the linker.
    pub(super) symbol: String,
    /// The functions of the certificate: those that it calls, without the sine, then itself.
    pub(super) functions: Vec<String>,
    /// The beginnings of these functions in the text of the code.
    pub(super) heads: Vec<String>,
    /// The file with the function, and how the certificate names it.
    pub(super) source: String,
    /// SHA-256 of the files.
    pub(super) hashes: BTreeMap<String, String>,
    /// Lines of the code with their steps.
    pub(super) text: String,
    /// The image.
    pub(super) elf: String,
    /// Options of the compiler.
    pub(super) options: Vec<String>,
}

/// Writes the code and the program of the board, and compiles and links them.
#[allow(clippy::too_many_lines)] // two languages side by side
pub(super) fn build(
    arguments: &Arguments,
    robot: &Robot,
    program: &Program,
    compiler: &str,
    call: &Call,
    bytes: &[u8],
    folder: &Path,
) -> Result<Code, Failure> {
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    let symbol = call.function.clone();
    let called = arguments.observer.then(|| format!("{prefix}_{}", arguments.program()));
    let functions: Vec<String> = called.into_iter().chain([symbol.clone()]).collect();
    let write = |file: &str, text: &str| fs::write(folder.join(file), text).map_err(Failure::input);
    let stem = stem(arguments, robot);
    let programs = std::slice::from_ref(program);
    let code = c_code(arguments, robot, program, bytes, Precision::Single)?;
    let (header, c_source) = (format!("{stem}.h"), format!("{stem}.c"));
    let gcc = if arguments.lang == Language::C { compiler } else { "arm-none-eabi-gcc" };
    let flags = arguments.cpu.flags();
    write(&header, code.header())?;
    write("cases.c", &board::cases(&header, robot.dof(), call))?;
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
            let own = [&board::OPTIONS[..], &["-ffunction-sections", "-fstack-usage", "-c"]].concat();
            compile(&own, &[&c_source])?;
            options = [&board::OPTIONS[..], &["-ffunction-sections"], &flags].concat();
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
            write("lib.rs", &rust_library(arguments.function, robot.dof(), call))?;
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
            let heads = vec![format!("fn {}<", arguments.function)];
            link(&compile, &object)?;
            return Ok(Code { symbol, functions, heads, source, hashes, text, elf: "board.elf".to_owned(), options });
        }
    }
    link(&compile, &object)?;
    let options = options.iter().map(|&option| option.to_owned()).collect();
    let heads = functions.iter().map(|name| format!("{name}(")).collect();
    Ok(Code { symbol, functions, heads, source, hashes, text, elf: "board.elf".to_owned(), options })
}

/// The code in C as `rne emit` writes it.
pub(super) fn c_code(
    arguments: &Arguments,
    robot: &Robot,
    program: &Program,
    bytes: &[u8],
    precision: Precision,
) -> Result<CCode, Failure> {
    let name = if is_stream(&arguments.file) { "on standard input".into() } else { file_name(&arguments.file) };
    let prefix = arguments.prefix.clone().unwrap_or_else(|| Prefix::of(robot));
    let origin = Origin::new(&name, &sha256(bytes));
    let additions = Additions { origin: Some(&origin), ..Additions::default() };
    rne_emit::c_code_with(robot, std::slice::from_ref(program), precision, &prefix, &additions)
        .map_err(|error| Failure::input(format_args!("{}: {error}", arguments.file.display())))
}

/// The name of the files without their endings.
pub(super) fn stem(arguments: &Arguments, robot: &Robot) -> String {
    let stem = arguments.file.file_stem().filter(|_| !is_stream(&arguments.file));
    stem.map_or_else(|| robot.name.clone(), |stem| stem.to_string_lossy().into_owned())
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
fn rust_library(function: Function, dof: usize, call: &Call) -> String {
    let Call { function: symbol, arguments: arrays, length, .. } = call;
    let list = |element: &dyn Fn(usize) -> String| (0..arrays.len()).map(element).collect::<Vec<_>>().join(", ");
    let parameters = list(&|index| format!("a{index}: &[f32; {dof}]"));
    let passed = list(&|index| format!("a{index}"));
    format!(
        "#![no_std]\nmod arm;\n\n#[unsafe(no_mangle)]\npub extern \"C\" fn {symbol}({parameters}, out: &mut [f32; \
         {length}]) {{\n    *out = arm::{function}({passed});\n}}\n"
    )
}

/// Runs the code in QEMU and compares instructions with the listing and results with those of this computer.
pub(super) fn emulate(
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
    if printed.results.len() != board::STATES as usize {
        return Err(Failure::input(format_args!(
            "QEMU prints the results of {} states instead of {}",
            printed.results.len(),
            board::STATES
        )));
    }
    let interpreter = Interpreter::new(program);
    for (number, found) in (0..board::STATES).zip(&printed.results) {
        let [q, qd, qdd] = board::state(number, robot.dof());
        let sin_cos = rne_emit::sin_cos_f32;
        let expected = match arguments.low_pass() {
            None => accuracy::single_precision(robot, &interpreter, [&q, &qd, &qdd], sin_cos),
            Some(low_pass) => low_pass.result(robot, &interpreter, number, sin_cos),
        };
        let expected: Option<Vec<u32>> = expected.map(|numbers| numbers.iter().map(|x| x.to_bits()).collect());
        if expected.as_ref() != Some(found) {
            return Err(Failure::input(format_args!(
                "at state {number}, the results in QEMU, {found:08x?}, do not have the bits of this computer, {:08x?}",
                expected.unwrap_or_default()
            )));
        }
    }
    let machine = arguments.cpu.machine().to_owned();
    Ok(Emulation { machine, instructions: printed.instructions, states: printed.results.len() })
}
