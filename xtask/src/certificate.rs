//! Certifies the generated code on microcontrollers: `firmware/`, docs/measured/embedded.md.

use anyhow::{Context as _, Result, ensure};
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// Builds every shipped robot for Cortex-M4F and M7F, reads and runs the code, and compares it with
/// docs/measured/embedded.md
///
/// Needs Debian's packages rustc-web, cargo-web, rust-web-src (a compiler with the sources of `core`),
/// gcc-arm-none-eabi, libnewlib-arm-none-eabi, qemu-system-arm, cppcheck, binutils-riscv64-unknown-elf and lld; Node
/// for WebAssembly, which is left out without. They do not disturb rustup's compiler. Five minutes at first, one minute
/// then. CARGO_TARGET_DIR is obeyed.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a function panics, calls, branches or has grown by more than 2 %, 2 when something is missing.

Examples:
  cargo xtask certificate             judge
  cargo xtask certificate --update    judge, and write docs/measured/embedded.md anew
  cargo xtask certificate --sample    judge the Cortex-M4F alone, in Rust, and every third robot in C
  cargo xtask certificate --install   get what is missing by apt-get (Debian) first
  cargo xtask certificate --sample --changed
                                      nothing, unless something has changed since --record")]
#[allow(clippy::struct_excessive_bools)] // each field is an option of the command
pub(crate) struct Certificate {
    /// Write docs/measured/embedded.md anew
    #[arg(long)]
    update: bool,
    /// Judge the Cortex-M4F alone, in Rust, and every third robot in C: neither M7F nor fused multiply-add, RISC-V and
    /// WebAssembly
    #[arg(long, conflicts_with = "update")]
    sample: bool,
    /// Do nothing where nothing that is certified has changed since firmware/certified.txt was written
    #[arg(long, conflicts_with_all = ["update", "record"])]
    changed: bool,
    /// After success, write to firmware/certified.txt what was certified: the state of the last commit
    #[arg(long)]
    record: bool,
    /// First get what is missing by apt-get; where that fails, say so in one line and exit with 0
    #[arg(long)]
    pub(crate) install: bool,
}

/// Packages of Debian. Newlib is named, because the compiler's package only recommends it, although programs need its
/// memcpy and memset.
const PACKAGES: [&str; 9] = [
    "rustc-web",
    "cargo-web",
    "rust-web-src",
    "gcc-arm-none-eabi",
    "libnewlib-arm-none-eabi",
    "qemu-system-arm",
    "cppcheck",
    "binutils-riscv64-unknown-elf",
    "lld",
];

/// Packages with the programs that `rne certify` and its checker start.
pub(crate) const OF_COMMAND_LINE: [&str; 5] =
    ["gcc-arm-none-eabi", "libnewlib-arm-none-eabi", "qemu-system-arm", "cppcheck", "python3"];

impl Certificate {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let certified = certified(&machine::shell()?)?;
        let recorded = machine::read(RECORD).ok();
        if self.changed && certified.is_some() && recorded.as_deref().map(str::trim) == certified.as_deref() {
            println!("certificate: the code is that of {RECORD}, which is certified");
            return Ok(Verdict::Holds);
        }
        let holds = self.judged()?;
        if self.record && holds {
            let certified = certified.context("what is certified is not committed, so it cannot be recorded")?;
            machine::write(RECORD, &format!("{certified}\n"))?;
            println!("certificate: recorded in {RECORD}");
        }
        Ok(Verdict::from(holds))
    }

    fn judged(&self) -> Result<bool> {
        machine::packages(&PACKAGES, self.install)?;
        let shell = machine::shell()?;
        // Debian's compiler also builds the measuring tool, so that the crates of the macro are built only once
        shell.set_var("RUSTC", "/usr/bin/rustc");
        shell.set_var("RUSTC_BOOTSTRAP", "1");
        shell.set_var("CARGO_TARGET_DIR", machine::target_folder("target/embedded")?);

        let compiler = machine::without_flags(cmd!(shell, "/usr/bin/rustc --version")).quiet().read()?;
        let oldest = machine::oldest_compiler()?;
        if machine::version(&compiler) < machine::version(&oldest) {
            return Err(Missing::error(format!(
                "Debian's compiler is {compiler}, and {oldest} is the oldest that will do"
            )));
        }
        let cargo = |arguments: &[&str]| {
            let manifest = "--manifest-path=firmware/Cargo.toml";
            let (command, rest) = arguments.split_at(1);
            machine::without_flags(cmd!(shell, "/usr/bin/cargo {command...} --quiet --locked {manifest} {rest...}"))
                .quiet()
        };
        let fetched = cargo(&["fetch"]).ignore_status().output()?;
        let said = String::from_utf8_lossy(&fetched.stderr);
        if said.contains("lock file") {
            // not caused by the network, so it is an error and not skipped
            anyhow::bail!("firmware/Cargo.lock is not that of its manifests: {}", said.trim());
        }
        if !fetched.status.success() {
            return Err(Missing::error("its crates cannot be downloaded (cargo fetch in firmware/ says why)"));
        }
        let tests = cargo(&["test", "--package", "measurements"]);
        let mut judges = cargo(&["run", "--package", "measurements", "--"]);
        if self.update {
            judges = judges.arg("--update");
        }
        if self.sample {
            judges = judges.arg("--sample");
        }
        Ok(tests.run().is_ok() && judges.run().is_ok())
    }
}

/// The file with the hash of the code that was certified last.
const RECORD: &str = "firmware/certified.txt";

/// The files on which the certificate depends: the list of emitted code, the runtime, and everything that builds, runs
/// and judges them.
const CERTIFIED: [&str; 14] = [
    "docs/measured/embedded.md",
    "firmware/board",
    "firmware/measurements",
    "firmware/robots",
    "firmware/wasm",
    "firmware/Cargo.lock",
    "firmware/certify/board",
    "compiler/emit/src/c",
    "rne-macro/src",
    "rne-runtime/src",
    "robots",
    "src",
    "tests/frozen.txt",
    "tests/shipped/src",
];

/// Returns the hash of these files in the last commit; `None` if some changes are not committed.
fn certified(shell: &Shell) -> Result<Option<String>> {
    if !cmd!(shell, "git status --porcelain -- {CERTIFIED...}").quiet().read()?.is_empty() {
        return Ok(None);
    }
    let files = cmd!(shell, "git ls-tree -r HEAD -- {CERTIFIED...}").quiet().read()?;
    ensure!(!files.is_empty(), "there are no files of the code that is certified");
    Ok(Some(cmd!(shell, "git hash-object --stdin").stdin(files).quiet().read()?))
}
