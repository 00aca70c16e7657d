//! Writes, compiles, links and runs the code that `rne certify` measures.

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

/// The code of the arm, in files of a folder.
pub(super) struct Code {
    /// The name of the file with the functions, also in the certificate.
    pub(super) source: String,
    /// SHA-256 of the files.
    pub(super) hashes: BTreeMap<String, String>,
    /// The text of the code.
    pub(super) text: String,
    /// The names of the linked programs, one for each call.
    pub(super) images: Vec<String>,
    /// Options of the compiler.
    pub(super) options: Vec<String>,
}

/// Writes the code and a test program for each call, compiles them and links them.
pub(super) fn build(
    arguments: &Arguments,
    robot: &Robot,
    programs: &[Program],
    compiler: &str,
    calls: &[Call],
    bytes: &[u8],
    folder: &Path,
) -> Result<Code, Failure> {
    let stem = stem(arguments, robot);
    let c = arguments.c_code(robot, programs, bytes, Precision::Single)?;
    let header = format!("{stem}.h");
    let is_c = arguments.lang == Language::C;
    let gcc = if is_c { compiler } else { "arm-none-eabi-gcc" };
    let build = Build { folder, gcc, flags: arguments.cpu.flags() };
    build.write(&header, c.header())?;
    build.write("board.c", board::SOURCE)?;
    build.write("board.h", board::HEADER)?;
    build.write("board.ld", board::LINKER_SCRIPT)?;
    let more: Vec<&str> = arguments.cc_options.split_whitespace().collect();
    let (source, text) = if is_c {
        (format!("{stem}.c"), c.source(&header))
    } else {
        (format!("{stem}.rs"), rne_emit::rust_file_with_sin_cos(robot, programs))
    };
    let mut hashes = BTreeMap::from([(source.clone(), sha256(text.as_bytes()))]);
    let (object, options) = if is_c {
        hashes.insert(header.clone(), sha256(c.header().as_bytes()));
        build.write(&source, &text)?;
        (format!("{stem}.o"), build.c(&source, &more)?)
    } else {
        build.write("arm.rs", &text)?;
        build.write("lib.rs", &rust_library(robot.dof(), programs, calls))?;
        ("arm.o".to_owned(), build.rust(compiler, &format!("target-cpu={}", arguments.cpu.name()), &more)?)
    };
    let image = |call: &Call| {
        let (cases, elf) = (format!("{}_cases.c", call.function), format!("{}.elf", call.function));
        build.write(&cases, &board::cases(&header, robot.dof(), call))?;
        build.link(&[&cases, &object], &elf)?;
        Ok(elf)
    };
    let images = calls.iter().map(image).collect::<Result<_, Failure>>()?;
    Ok(Code { source, hashes, text, images, options })
}

/// A folder in which code is compiled for one processor.
struct Build<'a> {
    folder: &'a Path,
    gcc: &'a str,
    /// Options of gcc that choose the processor.
    flags: [&'static str; 4],
}

impl Build<'_> {
    fn write(&self, file: &str, text: &str) -> Result<(), Failure> {
        fs::write(self.folder.join(file), text).map_err(Failure::input)
    }

    fn compile(&self, options: &[&str], files: &[&str]) -> Result<(), Failure> {
        let mut command = Command::new(self.gcc);
        toolchain::text(command.current_dir(self.folder).args(options).args(self.flags).args(files)).map(drop)
    }

    /// Compiles a C source; returns the options as the certificate lists them.
    fn c(&self, source: &str, more: &[&str]) -> Result<Vec<String>, Failure> {
        let own = [&board::OPTIONS[..], &["-ffunction-sections", "-fstack-usage", "-c"]].concat();
        // after the options of the processor, which is the order in the certificate
        self.compile(&own, &[more, &[source]].concat())?;
        Ok(owned(&[&board::OPTIONS[..], &["-ffunction-sections"], &self.flags, more].concat()))
    }

    /// Compiles the library in Rust; returns the options.
    fn rust(&self, compiler: &str, cpu: &str, more: &[&str]) -> Result<Vec<String>, Failure> {
        let target = ["--target", "thumbv7em-none-eabihf", "--edition", "2024"];
        let options = [&target[..], &["-Copt-level=3", "-Cpanic=abort", "-C", cpu], more].concat();
        let mut command = Command::new(compiler);
        command.current_dir(self.folder).args(&options);
        command.args(["--crate-type", "lib", "--crate-name", "arm", "--emit", "obj=arm.o", "lib.rs"]);
        // rustc itself says what to do if the target is not installed
        toolchain::text(&mut command)?;
        Ok(owned(&options))
    }

    /// Links files with the program of the board, which is GNU C.
    fn link(&self, files: &[&str], elf: &str) -> Result<(), Failure> {
        let options =
            ["-std=gnu99", "-O2", "-ffp-contract=off", "-nostartfiles", "-Wl,--gc-sections", "-T", "board.ld"];
        self.compile(&[&options[..], &["-o", elf]].concat(), &[&["board.c"], files].concat())
    }
}

fn owned(options: &[&str]) -> Vec<String> {
    options.iter().map(|&option| option.to_owned()).collect()
}

/// Returns the name of the code files without extension.
pub(super) fn stem(arguments: &Arguments, robot: &Robot) -> String {
    let file = arguments.source.as_ref().unwrap_or(&arguments.file);
    let stem = file.file_stem().filter(|_| !is_stream(file));
    stem.map_or_else(|| robot.name.clone(), |stem| stem.to_string_lossy().into_owned())
}

/// Returns the emitted Rust code as a library that has a C function for each program.
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

/// Runs the code in QEMU. Compares the number of executed instructions with the listing, and the results with those
/// that this computer computes.
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
        .ok_or_else(|| input_error!("QEMU prints what the program does not print:\n{said}"))?;
    if printed.instructions != instructions {
        return Err(input_error!(
            "QEMU executes {} instructions in a call, but the listing shows {instructions}",
            printed.instructions
        ));
    }
    if printed.results.len() != board::STATES as usize {
        return Err(input_error!(
            "QEMU prints the results of {} states instead of {}",
            printed.results.len(),
            board::STATES
        ));
    }
    for (number, found) in (0..board::STATES).zip(&printed.results) {
        let expected = subject.expected(robot, number);
        let expected: Option<Vec<u32>> = expected.map(|numbers| numbers.iter().map(|x| x.to_bits()).collect());
        if expected.as_ref() != Some(found) {
            return Err(input_error!(
                "at state {number}, the results in QEMU, {found:08x?}, do not have the bits of this computer, {:08x?}",
                expected.unwrap_or_default()
            ));
        }
    }
    let machine = core.machine().to_owned();
    Ok(Emulation { machine, instructions: printed.instructions, states: printed.results.len() })
}
