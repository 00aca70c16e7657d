//! The Python package: a wheel, and its tests in an environment that has nothing but the wheel.

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// What builds the wheel.
const MATURIN: &str = "maturin>=1.9,<2";

/// What the tests need beside the wheel.
const TESTS: [&str; 1] = ["pytest>=8"];

/// What they need to hold the wheel against Pinocchio on real arms.
const PEERS: [&str; 3] = ["pin==4.1.0", "example-robot-data==6.0.0", "rtb-data==2.0.0"];

/// What runs the notebooks.
const NOTEBOOKS: [&str; 3] = ["nbclient>=0.10", "ipykernel>=6", "matplotlib>=3"];

/// Builds the Python wheel and tests it in a clean environment
///
/// The wheel is built by maturin, installed with numpy into an empty virtual environment, and tested there: against
/// numpy on random arms, and with --peers against Pinocchio on real ones; then the notebooks run.
#[derive(Args)]
#[command(after_help = "\
Needs python3 with venv; what else it needs is fetched into target/python.

Examples:
  cargo xtask python              with what is installed there
  cargo xtask python --install    install it first
  cargo xtask python --install --peers --notebooks")]
pub(crate) struct Python {
    /// Install what is missing, with pip, below target/
    #[arg(long)]
    pub(crate) install: bool,
    /// Compare with Pinocchio on the URDFs of packages
    #[arg(long)]
    pub(crate) peers: bool,
    /// Run the notebooks of python/notebooks
    #[arg(long)]
    pub(crate) notebooks: bool,
}

impl Python {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let folder = machine::target_folder("target")?.join("python");
        let (builder, user) = (folder.join("builder"), folder.join("user"));
        if !machine::has("python3") {
            return Err(Missing::error("there is no python3"));
        }
        for venv in [&builder, &user] {
            if !venv.join("bin/python").exists()
                && cmd!(shell, "python3 -m venv {venv}").quiet().ignore_stderr().run().is_err()
            {
                return Err(Missing::error("python3 cannot make a virtual environment (python3-venv)"));
            }
        }
        let pip = |venv: &std::path::Path, packages: &[&str]| {
            let python = venv.join("bin/python");
            let install = cmd!(shell, "{python} -m pip install --quiet --disable-pip-version-check {packages...}");
            install.quiet().ignore_stderr().run().is_ok()
        };
        let maturin = builder.join("bin/maturin");
        if !(maturin.exists() || self.install && pip(&builder, &[MATURIN])) {
            return Err(Missing::error("there is no maturin; `cargo xtask python --install` gets it"));
        }
        let wheels = folder.join("wheels");
        let _ = std::fs::remove_dir_all(&wheels);
        let build = cmd!(
            shell,
            "{maturin} build --quiet --release --locked --manifest-path python/Cargo.toml
                --target-dir {folder} --out {wheels}"
        );
        machine::without_flags(build).quiet().run()?;
        let wheel = std::fs::read_dir(&wheels)?.find_map(|entry| Some(entry.ok()?.path()));
        let Some(wheel) = wheel else { return Ok(Verdict::from(false)) };
        let python = user.join("bin/python");
        let mut packages = TESTS.to_vec();
        packages.extend(PEERS.iter().filter(|_| self.peers));
        packages.extend(NOTEBOOKS.iter().filter(|_| self.notebooks));
        if self.install && !pip(&user, &packages) {
            return Err(Missing::error(format!("{} cannot be fetched", packages.join(", "))));
        }
        let install = cmd!(
            shell,
            "{python} -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps {wheel}"
        );
        install.quiet().run()?;
        if cmd!(shell, "{python} -c 'import numpy'").quiet().ignore_stderr().run().is_err() && !pip(&user, &["numpy"]) {
            return Err(Missing::error("there is no numpy; `cargo xtask python --install` gets it"));
        }
        let mut holds = cmd!(shell, "{python} -m pytest -q -p no:cacheprovider python/tests").quiet().run().is_ok();
        if self.notebooks {
            holds &= cmd!(shell, "{python} python/notebooks/run.py").quiet().run().is_ok();
        }
        Ok(Verdict::from(holds))
    }
}
