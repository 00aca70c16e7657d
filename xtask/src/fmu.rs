//! Tests exported FMUs with FMPy.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::Missing;
use crate::packages::python::Place;

/// Packages that the tests need.
const PACKAGES: [&str; 4] = ["fmpy==0.3.32", "scipy>=1.11", "pytest>=8", "cmake>=3.20,<5"];

/// Validates and simulates FMUs of `rne export --fmu` with FMPy
///
/// For FMI 2.0 and 3.0: model exchange and co-simulation are compared with the trajectory that scipy integrates, and
/// derivatives with differences. The sources are built by cmake and by FMPy, and compiled with the headers of the
/// standard. Without --install, FMPy must have been installed by an earlier run.
#[derive(Args)]
#[command(after_help = "\
Needs python3 with venv and a C compiler; what else it needs is fetched into target/python.

Examples:
  cargo xtask fmu --install    fetch FMPy, scipy, pytest and cmake first
  cargo xtask fmu")]
pub(crate) struct Fmus {
    /// Install what is missing, with pip, below target/
    #[arg(long)]
    pub(crate) install: bool,
}

impl Fmus {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let place = Place::new()?;
        let python = place.environment("fmi")?;
        if self.install && !place.pip(&python, &PACKAGES) {
            return Err(Missing::error(format!("{} cannot be fetched", PACKAGES.join(", "))));
        }
        let shell = crate::machine::shell()?;
        if cmd!(shell, "{python} -c 'import fmpy, scipy, pytest'").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error("there is no FMPy; `cargo xtask fmu --install` gets it"));
        }
        let program = place.command_line()?;
        let programs = python.with_file_name("").display().to_string();
        let path = std::env::var("PATH").unwrap_or_default();
        let tests = cmd!(shell, "{python} -m pytest -q -p no:cacheprovider tests/fmi");
        let tests = tests.env("RNE", program).env("PATH", format!("{programs}:{path}"));
        Ok(Verdict::from(tests.quiet().run().is_ok()))
    }
}
