//! Certifies the shipped robots: tests/certify/.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Certifies the emitted C and Rust of the shipped robots, in single and double precision
///
/// The script tests/certify/all.py says what a certificate is. It draws some of the robots, and random arms, by the
/// commit; with CI_FULL set, it takes all robots.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a certificate fails.

Examples:
  cargo xtask certify-all --install          first get compiler, QEMU and cppcheck by apt-get (Debian)
  CI_FULL=1 cargo xtask certify-all          all robots
  cargo xtask certify-all panda              this robot")]
pub(crate) struct CertifyAll {
    /// First get what is missing by apt-get and rustup
    #[arg(long)]
    pub(crate) install: bool,
    /// Robots to certify
    robots: Vec<String>,
}

const PACKAGES: [&str; 5] =
    ["gcc-arm-none-eabi", "libnewlib-arm-none-eabi", "qemu-system-arm", "cppcheck", "python3-minimal"];

impl CertifyAll {
    pub(crate) fn run(&self) -> Result<Verdict> {
        machine::packages(&PACKAGES, self.install)?;
        let shell = machine::shell()?;
        if self.install {
            cmd!(shell, "rustup target add thumbv7em-none-eabihf").quiet().ignore_stderr().run()?;
        }
        machine::without_flags(cmd!(shell, "cargo build --quiet --bin rne")).quiet().run()?;
        let rne = machine::target_folder("target")?.join("debug/rne");
        let seed = cmd!(shell, "git rev-parse --short HEAD").quiet().read()?;
        let all = std::env::var_os("CI_FULL").map(|_| "--all");
        let robots = &self.robots;
        let script = cmd!(shell, "python3 tests/certify/all.py --rne {rne} --seed {seed} {all...} {robots...}");
        Ok(Verdict::from(machine::without_flags(script).quiet().run().is_ok()))
    }
}
