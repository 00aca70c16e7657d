//! The code that `rne certify` compiles, links with a program for a board, and runs.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use rne_certify::board::{self, Call};
use rne_certify::certificate::Emulation;
use rne_certify::cycles::Core;
use rne_certify::sha256;
use rne_codegen::Program;
use rne_emit::Precision;
use rne_model::Robot;

use crate::commands::certify::subject::Subject;
use crate::commands::certify::{Arguments, Language};
use crate::commands::toolchain;
use crate::files::input_file::is_stream;
use crate::outcome::Failure;

/// The code of the arm in files of a folder.
pub(super) struct Code {
    /// The file with the functions, and how the certificate names it.
    pub(super) source: String,
    /// SHA-256 of the files.
    pub(super) hashes: BTreeMap<String, String>,
    /// The text of the code.
    pub(super) text: String,
    /// An image for each call.
    pub(super) images: Vec<String>,
    /// Options of the compiler.
    pub(super) options: Vec<String>,
}

/// Writes the code and a program of the board for each call, and compiles and links them.
pub(super) fn build(
    arguments: &Arguments,
    robot: &Robot,
    programs: &[Program],
    compiler: &str,
    calls: &[Call],
    bytes: &[u8],
    folder: &Path,
) -> Result<Code, Failure> {
    let write = |file: &str, text: &str| fs::write(folder.join(file), text).map_err(Failure::input);
    let stem = stem(arguments, robot);
    let code = arguments.c_code(robot, programs, bytes, Precision::Single)?;
    let (header, c_source) = (format!("{stem}.h"), format!("{stem}.c"));
    let gcc = if arguments.lang == Language::C { compiler } else { "arm-none-eabi-gcc" };
    let flags = arguments.cpu.flags();
    write(&header, code.header())?;
    write("board.c", board::SOURCE)?;
    write("board.h", board::HEADER)?;
    write("board.ld", board::LINKER_SCRIPT)?;
    let compile = |options: &[&str], files: &[&str]| {
        toolchain::text(Command::new(gcc).current_dir(folder).args(options).args(flags).args(files))
    };
    let cpu = format!("target-cpu={}", arguments.cpu.name());
    let more: Vec<&str> = arguments.cc_options.split_whitespace().collect();
    let (source, object, text, options, hashes);
    match arguments.lang {
        Language::C => {
            text = code.source(&header);
            write(&c_source, &text)?;
            let own = [&board::OPTIONS[..], &["-ffunction-sections", "-fstack-usage", "-c"]].concat();
            // behind those of the processor, as the certificate lists them
            compile(&own, &[&more[..], &[&c_source]].concat())?;
            options = [&board::OPTIONS[..], &["-ffunction-sections"], &flags, &more].concat();
            hashes = BTreeMap::from([
                (header.clone(), sha256(code.header().as_bytes())),
                (c_source.clone(), sha256(text.as_bytes())),
            ]);
            object = format!("{stem}.o");
            source = c_source;
        }
        Language::Rust => {
            text = rne_emit::rust_file_with_sin_cos(robot, programs);
            write("arm.rs", &text)?;
            write("lib.rs", &rust_library(robot.dof(), programs, calls))?;
            let target = ["--target", "thumbv7em-none-eabihf", "--edition", "2024"];
            options = [&target[..], &["-Copt-level=3", "-Cpanic=abort", "-C", &cpu], &more].concat();
            let mut command = Command::new(compiler);
            command.current_dir(folder).args(&options);
            command.args(["--crate-type", "lib", "--crate-name", "arm", "--emit", "obj=arm.o", "lib.rs"]);
            // rustc says what to do if the target is not installed
            toolchain::text(&mut command)?;
            hashes = BTreeMap::from([(format!("{stem}.rs"), sha256(text.as_bytes()))]);
            object = "arm.o".to_owned();
            source = format!("{stem}.rs");
        }
    }
    let image = |call: &Call| {
        let (cases, elf) = (format!("{}_cases.c", call.function), format!("{}.elf", call.function));
        write(&cases, &board::cases(&header, robot.dof(), call))?;
        link(&compile, &[&cases, &object], &elf)?;
        Ok(elf)
    };
    let images = calls.iter().map(image).collect::<Result<_, Failure>>()?;
    let options = options.iter().map(|&option| option.to_owned()).collect();
    Ok(Code { source, hashes, text, images, options })
}

/// The name of the files without their endings.
pub(super) fn stem(arguments: &Arguments, robot: &Robot) -> String {
    let file = arguments.source.as_ref().unwrap_or(&arguments.file);
    let stem = file.file_stem().filter(|_| !is_stream(file));
    stem.map_or_else(|| robot.name.clone(), |stem| stem.to_string_lossy().into_owned())
}

/// Links files with the program of the board, which is GNU C.
fn link(
    compile: &impl Fn(&[&str], &[&str]) -> Result<String, Failure>,
    files: &[&str],
    elf: &str,
) -> Result<(), Failure> {
    let options = ["-std=gnu99", "-O2", "-ffp-contract=off", "-nostartfiles", "-Wl,--gc-sections", "-T", "board.ld"];
    compile(&[&options[..], &["-o", elf]].concat(), &[&["board.c"], files].concat()).map(drop)
}

/// The emitted Rust as a library with a function for C for each program.
fn rust_library(dof: usize, programs: &[Program], calls: &[Call]) -> String {
    let mut text = "#![no_std]\nmod arm;\n".to_owned();
    for (program, Call { function: symbol, arguments: arrays, lengths, .. }) in programs.iter().zip(calls) {
        let list = |element: &dyn Fn(usize) -> String| (0..arrays.len()).map(element).collect::<Vec<_>>().join(", ");
        let parameters = list(&|index| format!("a{index}: &[f32; {dof}]"));
        let call = format!("arm::{}({})", program.function, list(&|index| format!("a{index}")));
        let returned = lengths.iter().rev().fold("f32".to_owned(), |of, length| format!("[{of}; {length}]"));
        let function = if lengths.is_empty() {
            format!("fn {symbol}({parameters}) -> f32 {{\n    {call}\n}}")
        } else {
            format!("fn {symbol}({parameters}, out: &mut {returned}) {{\n    *out = {call};\n}}")
        };
        let _ = writeln!(text, "\n#[unsafe(no_mangle)]\npub extern \"C\" {function}");
    }
    text
}

/// Runs the code in QEMU and compares instructions with the listing and results with those of this computer.
pub(super) fn emulate(
    core: Core,
    robot: &Robot,
    subject: &Subject,
    elf: &str,
    instructions: u64,
    folder: &Path,
) -> Result<Emulation, Failure> {
    let said = toolchain::emulated(core, folder, elf)?;
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
    for (number, found) in (0..board::STATES).zip(&printed.results) {
        let expected = subject.expected(robot, number);
        let expected: Option<Vec<u32>> = expected.map(|numbers| numbers.iter().map(|x| x.to_bits()).collect());
        if expected.as_ref() != Some(found) {
            return Err(Failure::input(format_args!(
                "at state {number}, the results in QEMU, {found:08x?}, do not have the bits of this computer, {:08x?}",
                expected.unwrap_or_default()
            )));
        }
    }
    let machine = core.machine().to_owned();
    Ok(Emulation { machine, instructions: printed.instructions, states: printed.results.len() })
}
