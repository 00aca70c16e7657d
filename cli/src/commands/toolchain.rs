//! Runs the compiler for a microcontroller, and the programs that read and execute its code.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Output};

use rne_certify::cycles::{self, Core};
use rne_certify::image::{Function, Image};
use rne_certify::listing;

use crate::outcome::Failure;
use crate::palette::TYPED;

/// Returns the Debian package of a program, for programs that rne starts although the user did not name them.
fn package(program: &str) -> Option<&'static str> {
    match program {
        "qemu-system-arm" => Some("qemu-system-arm"),
        "cppcheck" => Some("cppcheck"),
        "arm-none-eabi-objdump" => Some("binutils-arm-none-eabi"),
        "arm-none-eabi-gcc" => Some("gcc-arm-none-eabi libnewlib-arm-none-eabi"),
        _ => None,
    }
}

/// Runs a program and returns the text that it prints. If the program fails, its error becomes that of the command.
pub(crate) fn text(command: &mut Command) -> Result<String, Failure> {
    Ok(String::from_utf8_lossy(&output(command)?.stdout).into_owned())
}

fn output(command: &mut Command) -> Result<Output, Failure> {
    let program = command.get_program().to_string_lossy().into_owned();
    match command.output() {
        Ok(output) if output.status.success() => Ok(output),
        Ok(output) => {
            let said =
                [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
            let lines: Vec<&str> = said.lines().collect();
            let last = lines[lines.len().saturating_sub(20)..].join("\n");
            Err(input_error!("{program} fails ({}):\n{last}", output.status))
        }
        Err(error) if error.kind() == ErrorKind::NotFound && program == "rustc" => {
            Err(Failure::input("there is no rustc; https://rustup.rs installs it"))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Err(match package(&program) {
            Some(package) => input_error!(
                "there is no program {program}; on Debian and Ubuntu, {TYPED}apt-get install {package}{TYPED:#} \
                 installs it"
            ),
            None => input_error!(
                "there is no program {program}; install it, or leave out {TYPED}--cc{TYPED:#}: the compiler is then \
                 arm-none-eabi-gcc or rustc"
            ),
        }),
        Err(error) => Err(input_error!("{program} cannot be started: {error}")),
    }
}

/// Returns the first line of `--version`; `None` where the program is not installed.
pub(crate) fn version_of(program: &str) -> Option<String> {
    let output = Command::new(program).arg("--version").output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).lines().next()?.trim().to_owned())
}

/// Returns the first line of `--version`; an error says how to install the program.
pub(crate) fn version(program: &str) -> Result<String, Failure> {
    let said = text(Command::new(program).arg("--version"))?;
    let line = said.lines().next().map(str::trim).filter(|line| !line.is_empty());
    line.map(str::to_owned).ok_or_else(|| {
        usage_error!(
            "{program} prints nothing for --version, so it is no compiler; name another with {TYPED}--cc{TYPED:#}"
        )
    })
}

/// Returns the version of GCC for Arm; an error says what the program is instead.
pub(crate) fn version_of_gcc(program: &str) -> Result<String, Failure> {
    let version = version(program)?;
    let said = text(Command::new(program).arg("--version"))?;
    let remedy = format!(
        "{TYPED}--cc{TYPED:#} takes GCC for Arm, such as arm-none-eabi-gcc: its option -fstack-usage and its binary \
         utilities give the numbers of the certificate"
    );
    if !said.contains("Free Software Foundation") {
        return Err(usage_error!("{program} is no GCC ({version}); {remedy}"));
    }
    let target = text(Command::new(program).arg("-dumpmachine"))?;
    let target = target.trim();
    if target.starts_with("arm") {
        return Ok(version);
    }
    if target.is_empty() {
        return Err(usage_error!(
            "{program} is no compiler: it prints nothing for -dumpmachine, which asks for the target; {remedy}"
        ));
    }
    Err(usage_error!("{program} is no compiler for Arm: its target is {target}; {remedy}"))
}

/// Returns the SHA-256 of a program's file.
pub(crate) fn hash(program: &str) -> Option<String> {
    let folders = std::env::var_os("PATH")?;
    let path = if program.contains('/') {
        Path::new(program).to_owned()
    } else {
        std::env::split_paths(&folders).map(|folder| folder.join(program)).find(|path| path.is_file())?
    };
    Some(rne_certify::sha256(&fs::read(path).ok()?))
}

/// Returns the binutils program that belongs to a compiler, such as `arm-none-eabi-objdump` for `arm-none-eabi-gcc`.
pub(crate) fn objdump_of(compiler: &str) -> String {
    match compiler.rsplit_once("gcc") {
        Some((prefix, _)) => format!("{prefix}objdump"),
        None => "arm-none-eabi-objdump".to_owned(),
    }
}

/// Returns the functions of a linked program, with their sizes and the stack frames that the compiler recorded in files
/// `.su`.
pub(crate) fn image(objdump: &str, folder: &Path, elf: &str) -> Result<Image, Failure> {
    let read =
        |option: &str| text(Command::new(objdump).current_dir(folder).args([option, "--no-show-raw-insn"]).arg(elf));
    let mut listed = listing::functions(&read("--disassemble")?).map_err(Failure::input)?;
    let mut functions = BTreeMap::new();
    for line in read("--syms")?.lines() {
        // a line of `objdump --syms`, such as: 00000000 g F .text 0000012c .hidden name
        let words: Vec<&str> = line.split_whitespace().collect();
        let (Some(at), Some(name)) = (words.iter().position(|word| *word == "F"), words.last()) else { continue };
        let size = words.get(at + 2).and_then(|size| u64::from_str_radix(size, 16).ok());
        if let (Some(size), Some(lines)) = (size, listed.remove(*name)) {
            functions.insert((*name).to_owned(), Function { size, stack: None, lines });
        }
    }
    let frames = frames(folder);
    for (name, function) in &mut functions {
        // rustc records no stack frames, so they are computed from the instructions
        let of_listing = cycles::stack(&function.lines);
        function.stack = Some(frames.get(name).copied().unwrap_or(of_listing));
    }
    Ok(Image::new(functions))
}

/// Returns the stack frames of functions, from the files that `-fstack-usage` writes.
fn frames(folder: &Path) -> BTreeMap<String, u64> {
    let mut frames = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_none_or(|extension| extension != "su") {
            continue;
        }
        for line in fs::read_to_string(&path).unwrap_or_default().lines() {
            // a line with tabs between its three parts, such as: my_arm.c:101:6:my_arm_inverse_dynamics 96 static
            if let [place, bytes, ..] = line.split('\t').collect::<Vec<_>>().as_slice()
                && let (Some((_, name)), Ok(bytes)) = (place.rsplit_once(':'), bytes.parse())
            {
                frames.insert(name.to_owned(), bytes);
            }
        }
    }
    frames
}

/// Returns the text that a program prints in QEMU, where each instruction takes 1024 ns.
pub(crate) fn emulated(core: Core, folder: &Path, elf: &str) -> Result<String, Failure> {
    text(
        Command::new("qemu-system-arm")
            .current_dir(folder)
            .args(["-M", core.machine(), "-nographic", "-monitor", "none", "-serial", "null"])
            .args(["-semihosting-config", "enable=on,target=native", "-icount", "shift=10", "-kernel", elf]),
    )
}

/// Writes a source into the folder, and returns what the addon `misra` of cppcheck prints about it.
pub(crate) fn misra(folder: &Path, file: &str, source: &str) -> Result<String, Failure> {
    fs::write(folder.join(file), source).map_err(Failure::input)?;
    let output = output(Command::new("cppcheck").current_dir(folder).args([
        "--addon=misra",
        "--std=c99",
        "--enable=style",
        "--quiet",
        "--template={file}:{line}: {id}",
        file,
    ]))?;
    Ok([output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat())
}
