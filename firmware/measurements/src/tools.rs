//! Runs the tools of Debian that the measurements need: a Rust compiler with the sources of `core`, the GNU tools for
//! ARM, and QEMU.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, Result, ensure};

/// Debian's Rust compiler, even if rustup has installed another one.
const RUSTC: &str = "/usr/bin/rustc";
const CARGO: &str = "/usr/bin/cargo";

/// A build of a package for a target.
pub(crate) struct Build<'a> {
    /// The target's triple.
    pub(crate) target: &'a str,
    /// The linker.
    pub(crate) linker: &'a str,
    /// Flags of the compiler.
    pub(crate) flags: &'a [&'a str],
    /// The package.
    pub(crate) package: &'a str,
    /// More arguments of cargo.
    pub(crate) arguments: &'a [&'a str],
}

impl Build<'_> {
    /// Builds in release mode, with `core`, and returns the folder of the results.
    pub(crate) fn run(&self, workspace: &Path) -> Result<PathBuf> {
        let folder = target_folder(workspace);
        let linker = format!("CARGO_TARGET_{}_LINKER", self.target.to_uppercase().replace('-', "_"));
        run(Command::new(CARGO)
            .current_dir(workspace)
            .env("RUSTC", RUSTC)
            // enables unstable options: building `core` from its sources, and sizes of stack frames
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTFLAGS", self.flags.join(" "))
            .env(linker, self.linker)
            .env("CARGO_TARGET_DIR", &folder) // one folder for all, so that they share the macro
            .args(["rustc", "--release", "--locked", "--quiet", "-Zbuild-std=core", "--target", self.target])
            .args(["--package", self.package])
            .args(self.arguments))?;
        Ok(folder.join(self.target).join("release"))
    }
}

/// Returns the folder of all build results.
pub(crate) fn target_folder(workspace: &Path) -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.join("target"), PathBuf::from)
}

/// Returns the version of Debian's Rust compiler.
pub(crate) fn rustc_version() -> Result<String> {
    first_line(Command::new(RUSTC).arg("--version"))
}

/// Returns the version of the C compiler for ARM.
pub(crate) fn gcc_version() -> Result<String> {
    first_line(Command::new("arm-none-eabi-gcc").arg("--version"))
}

/// Returns the version of QEMU.
pub(crate) fn qemu_version() -> Result<String> {
    first_line(Command::new("qemu-system-arm").arg("--version"))
}

/// Lists the instructions of an image for ARM.
pub(crate) fn objdump(elf: &Path) -> Result<String> {
    text(Command::new("arm-none-eabi-objdump").args(["--disassemble", "--no-show-raw-insn"]).arg(elf))
}

/// Compiles and links with the C compiler for ARM.
pub(crate) fn gcc<A: AsRef<OsStr>>(folder: &Path, arguments: impl IntoIterator<Item = A>) -> Result<()> {
    run(Command::new("arm-none-eabi-gcc").current_dir(folder).args(arguments)).map(drop)
}

/// Runs an image on a board in QEMU, and returns its output. An instruction takes 1024 ns there.
pub(crate) fn qemu(machine: &str, elf: &Path) -> Result<String> {
    let semihosting = "enable=on,target=native";
    text(
        Command::new("timeout")
            .args(["120", "qemu-system-arm", "-M", machine, "-nographic", "-monitor", "none", "-serial", "null"])
            .args(["-semihosting-config", semihosting, "-icount", "shift=10", "-kernel"])
            .arg(elf),
    )
}

/// Lists the instructions of an object file for RISC-V.
pub(crate) fn riscv_objdump(object: &Path) -> Result<String> {
    text(Command::new("riscv64-unknown-elf-objdump").args(["--disassemble", "--no-show-raw-insn"]).arg(object))
}

/// Links a WebAssembly module that exports these symbols.
pub(crate) fn wasm_ld<'a>(object: &Path, module: &Path, exports: impl Iterator<Item = &'a str>) -> Result<()> {
    let exports = exports.map(|symbol| format!("--export={symbol}"));
    run(Command::new("wasm-ld").arg("--no-entry").args(exports).arg(object).arg("-o").arg(module)).map(drop)
}

/// Whether Node is installed, which runs WebAssembly.
pub(crate) fn has_node() -> bool {
    Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Runs a script in Node, with a module and an input file as its arguments, and returns its output.
pub(crate) fn node(script: &Path, module: &Path, input: &Path) -> Result<String> {
    text(
        Command::new("node")
            .arg(script)
            .arg(module)
            .stdin(fs::File::open(input).with_context(|| input.display().to_string())?),
    )
}

/// Runs a command and returns its output.
pub(crate) fn text(command: &mut Command) -> Result<String> {
    let output = run(command)?;
    String::from_utf8(output.stdout).with_context(|| format!("{command:?} prints no text"))
}

fn first_line(command: &mut Command) -> Result<String> {
    Ok(text(command)?.lines().next().unwrap_or_default().trim().to_owned())
}

fn run(command: &mut Command) -> Result<Output> {
    let output = command.output().with_context(|| format!("{command:?} cannot be started"))?;
    ensure!(
        output.status.success(),
        "{command:?} failed, {}\n{}{}",
        output.status,
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    Ok(output)
}
