//! The certificate of the generated code on microcontrollers: `firmware/`, docs/embedded.md.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Builds every shipped robot for Cortex-M4F and M7F, reads and runs the code, and compares it with docs/embedded.md
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
  cargo xtask certificate --update    judge, and write docs/embedded.md anew
  cargo xtask certificate --sample    judge the Cortex-M4F alone, in Rust, and every third robot in C
  cargo xtask certificate --install   get what is missing by apt-get (Debian) first")]
pub(crate) struct Certificate {
    /// Write docs/embedded.md anew
    #[arg(long)]
    update: bool,
    /// Judge the Cortex-M4F alone, in Rust, and every third robot in C: neither M7F nor fused multiply-add, RISC-V and
    /// WebAssembly
    #[arg(long, conflicts_with = "update")]
    sample: bool,
    /// First get what is missing by apt-get; where that fails, say so in one line and exit with 0
    #[arg(long)]
    pub(crate) install: bool,
}

/// Newlib is only recommended by the C compiler, which links its memcpy and memset all the same.
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

/// Programs that `rne certify` and its checker start.
pub(crate) const OF_COMMAND_LINE: [&str; 5] =
    ["gcc-arm-none-eabi", "libnewlib-arm-none-eabi", "qemu-system-arm", "cppcheck", "python3"];

impl Certificate {
    pub(crate) fn run(&self) -> Result<Verdict> {
        machine::packages(&PACKAGES, self.install)?;
        let shell = machine::shell()?;
        // Debian's compiler builds the tool as well: what the macro is made of is built once.
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
            // nothing that a network would mend
            anyhow::bail!("firmware/Cargo.lock is not that of its manifests: {}", said.trim());
        }
        if !fetched.status.success() {
            return Err(Missing::error("its crates cannot be downloaded (cargo fetch in firmware/ says why)"));
        }
        let tests = cargo(&["test", "--package", "certificate"]);
        let mut judges = cargo(&["run", "--package", "certificate", "--"]);
        if self.update {
            judges = judges.arg("--update");
        }
        if self.sample {
            judges = judges.arg("--sample");
        }
        Ok(Verdict::from(tests.run().is_ok() && judges.run().is_ok()))
    }
}
