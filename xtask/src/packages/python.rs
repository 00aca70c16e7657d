//! Builds the Python package, a wheel, and tests it in an environment that contains only the wheel and what it
//! requires.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::packages::package::Licences;

/// Package that builds the wheel.
pub(crate) const MATURIN: &str = "maturin>=1.9,<2";

/// Packages that the tests need beside the wheel.
const TESTS: [&str; 1] = ["pytest>=8"];

/// Packages that the tests need to compare the wheel with Pinocchio on real arms; benches/peers reads robot files with
/// yaml.
const PEERS: [&str; 4] = ["pin==4.1.0", "example-robot-data==6.0.0", "rtb-data==2.0.0", "pyyaml>=6"];

/// Packages that the tests need to call the functions of the wheel from CasADi.
const CASADI: [&str; 2] = ["casadi==3.8.2", "pyyaml>=6"];

/// Packages that the tests need to call the functions of the wheel from JAX.
const JAX: [&str; 1] = ["jax==0.10.2"];

/// Packages that the tests need to call the functions of the wheel from PyTorch: gigabytes.
const TORCH: [&str; 1] = ["torch==2.6.0"];

/// Packages whose columns the wheel reads.
const COLUMNS: [&str; 3] = ["pandas>=2", "polars>=1.8", "pyarrow>=17"];

/// Package that is timed beside the wheel, in the version of `benches/peers/run`.
const TOOLBOX: &str = "roboticstoolbox-python==1.5.0";

/// Packages that run the notebooks.
const NOTEBOOKS: [&str; 4] = ["nbclient>=0.10", "ipykernel>=6", "matplotlib>=3", "rosbags>=0.10"];

/// The first lines that a user types, as a short test.
const FIRST: &str = "import rne\n\
                     arm = rne.robots['puma560']\n\
                     print('python, no compiler on PATH:', arm.gravity_torques([0.1] * 6), 'N m')";

/// Builds the Python wheel and tests it in a clean environment
///
/// The wheel is built by maturin, installed with numpy into an empty virtual environment, and tested there: against
/// numpy on random arms, against the command line on logs, with --peers against Pinocchio on real arms, and with
/// --casadi and --jax against expressions that CasADi and JAX derive; then the notebooks run. With --install it is
/// tried once more in an environment that is made anew, where no compiler is on PATH.
#[derive(Args)]
#[command(after_help = "\
Needs python3 with venv; what else it needs is fetched into target/python.

Examples:
  cargo xtask python              with what is installed there
  cargo xtask python --install    install it first
  cargo xtask python --install --peers --casadi --jax --notebooks
  cargo xtask python --install --sdist    minutes: pip builds it from sources")]
#[allow(clippy::struct_excessive_bools)] // each field is an option of the command
pub(crate) struct Python {
    /// Install what is missing, with pip, below target/
    #[arg(long)]
    pub(crate) install: bool,
    /// Compare with Pinocchio on the URDFs of packages
    #[arg(long)]
    pub(crate) peers: bool,
    /// Have CasADi derive the dynamics and solve problems of optimal control
    #[arg(long)]
    pub(crate) casadi: bool,
    /// Have JAX derive the dynamics, and compile calls of the functions
    #[arg(long)]
    pub(crate) jax: bool,
    /// Have PyTorch derive costs of the functions; PyPI's torch takes gigabytes
    #[arg(long)]
    pub(crate) torch: bool,
    /// Run the notebooks of doors/python/notebooks
    #[arg(long)]
    pub(crate) notebooks: bool,
    /// Install the source distribution, built by pip with the Rust that is here; CI_FULL does so too
    #[arg(long, requires = "install")]
    pub(crate) sdist: bool,
}

impl Python {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let place = Place::new()?;
        let mut packages = [&TESTS[..], &COLUMNS].concat();
        packages.extend(PEERS.iter().filter(|_| self.peers));
        packages.extend(CASADI.iter().filter(|_| self.casadi));
        packages.extend(JAX.iter().filter(|_| self.jax));
        packages.extend(TORCH.iter().filter(|_| self.torch));
        packages.extend(NOTEBOOKS.iter().filter(|_| self.notebooks));
        let wheel = place.wheel(self.install)?;
        let python = place.user(&wheel, &packages, self.install)?;
        let shell = &place.shell;
        let program = place.command_line()?;
        let driver = place.fake_driver()?;
        let tests = cmd!(shell, "{python} -m pytest -q -p no:cacheprovider doors/python/tests");
        let tests = tests.env("RNE", program).env("RNE_LIBCUDA", driver);
        let mut holds = tests.quiet().run().is_ok();
        if self.notebooks {
            holds &= cmd!(shell, "{python} doors/python/notebooks/run.py").quiet().run().is_ok();
        }
        if self.install {
            holds &= place.holds_without_compiler(&wheel)?;
        }
        if self.sdist || self.install && std::env::var_os("CI_FULL").is_some() {
            holds &= place.holds_from_sources()?;
        }
        Ok(Verdict::from(holds))
    }
}

/// Compares the times of functions called from Python with those of other packages. Returns the table that a script of
/// `benches/peers/python` prints.
pub(crate) fn beside_peers(script: &str) -> Result<String> {
    let place = Place::new()?;
    let packages = [&TESTS[..], &PEERS, &[TOOLBOX]].concat();
    let wheel = place.wheel(true)?;
    let python = place.user(&wheel, &packages, true)?;
    let shell = &place.shell;
    Ok(cmd!(shell, "{python} benches/peers/python/{script}").quiet().read()?)
}

/// The folder with wheels and virtual environments.
pub(crate) struct Place {
    shell: Shell,
    folder: PathBuf,
}

impl Place {
    pub(crate) fn new() -> Result<Self> {
        if !machine::has("python3") {
            return Err(Missing::error("there is no python3"));
        }
        Ok(Self { shell: machine::shell()?, folder: machine::target_folder("target")?.join("python") })
    }

    /// Returns the Python of a virtual environment, which is created if it does not exist.
    pub(crate) fn environment(&self, name: &str) -> Result<PathBuf> {
        let (shell, venv) = (&self.shell, self.folder.join(name));
        let python = venv.join("bin/python");
        if !python.exists() && cmd!(shell, "python3 -m venv {venv}").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error("python3 cannot make a virtual environment (python3-venv)"));
        }
        Ok(python)
    }

    /// Makes a virtual environment anew, and returns its Python.
    pub(crate) fn new_environment(&self, name: &str) -> Result<PathBuf> {
        let _ = fs::remove_dir_all(self.folder.join(name));
        self.environment(name)
    }

    pub(crate) fn pip(&self, python: &Path, packages: &[&str]) -> bool {
        let shell = &self.shell;
        let install = cmd!(shell, "{python} -m pip install --quiet --disable-pip-version-check {packages...}");
        install.quiet().ignore_stderr().run().is_ok()
    }

    fn maturin(&self, install: bool) -> Result<PathBuf> {
        let python = self.environment("builder")?;
        let maturin = python.with_file_name("maturin");
        if !(maturin.exists() || install && self.pip(&python, &[MATURIN])) {
            return Err(Missing::error("there is no maturin; `cargo xtask python --install` gets it"));
        }
        Ok(maturin)
    }

    /// Whether a wheel was built here before, so that another build takes little time.
    pub(crate) fn has_wheel(&self) -> bool {
        self.folder.join("wheels").exists()
    }

    /// Builds the wheel and returns its path.
    pub(crate) fn wheel(&self, install: bool) -> Result<PathBuf> {
        let (shell, maturin) = (&self.shell, self.maturin(install)?);
        let (wheels, target) = (self.folder.join("wheels"), machine::target_folder("target")?);
        let (profile, _) = machine::profile()?;
        let _ = fs::remove_dir_all(&wheels);
        let _licences = Licences::copied(shell)?;
        let build = cmd!(
            shell,
            "{maturin} build --quiet --profile {profile} --locked --manifest-path doors/python/Cargo.toml
                --target-dir {target} --out {wheels}"
        );
        machine::without_flags(build).quiet().run()?;
        only_file(&wheels)
    }

    /// Builds the command line, whose results the tests compare with those of the wheel. The options are those of the
    /// tests of all formats of logs, so that it is compiled only once.
    pub(crate) fn command_line(&self) -> Result<PathBuf> {
        let shell = &self.shell;
        let build = cmd!(
            shell,
            "cargo build --quiet --profile test --locked --workspace
                --features rne-cli/full --bin rne"
        );
        machine::without_flags(build).quiet().run()?;
        Ok(machine::target_folder("target")?.join("debug").join(format!("rne{}", std::env::consts::EXE_SUFFIX)))
    }

    /// Builds the library that tests load in place of NVIDIA's driver, and returns its path.
    fn fake_driver(&self) -> Result<PathBuf> {
        let shell = &self.shell;
        machine::without_flags(cmd!(shell, "cargo build --quiet --locked --package fake-driver")).quiet().run()?;
        let name = format!("{}fake_driver{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
        Ok(machine::target_folder("target")?.join("debug").join(name))
    }

    /// Installs the wheel and some packages into the environment of the tests. Returns its Python.
    fn user(&self, wheel: &Path, packages: &[&str], install: bool) -> Result<PathBuf> {
        let (shell, python) = (&self.shell, self.environment("user")?);
        if install && !self.pip(&python, packages) {
            return Err(Missing::error(format!("{} cannot be fetched", packages.join(", "))));
        }
        let install = cmd!(
            shell,
            "{python} -m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps {wheel}"
        );
        install.quiet().run()?;
        let imports = cmd!(shell, "{python} -c 'import numpy'").quiet().ignore_stderr().run();
        if imports.is_err() && !self.pip(&python, &["numpy"]) {
            return Err(Missing::error("there is no numpy; `cargo xtask python --install` gets it"));
        }
        Ok(python)
    }

    /// Tests the wheel in a new environment that has only what the wheel requires. PATH contains this environment
    /// alone: no cc, no cargo.
    fn holds_without_compiler(&self, wheel: &Path) -> Result<bool> {
        let python = self.new_environment("clean")?;
        let alone = python.parent().context("an environment has a folder of programs")?;
        let wheel = wheel.display().to_string();
        if !self.pip(&python, &[&[wheel.as_str()], &TESTS[..]].concat()) {
            return Err(Missing::error("the wheel cannot be installed with what it requires"));
        }
        let shell = &self.shell;
        let first = cmd!(shell, "{python} -c {FIRST}").env("PATH", alone);
        // all tests have already passed with a compiler on PATH, so one file of them is enough here
        let tests = if std::env::var_os("CI_FULL").is_some() { "" } else { "test_functions.py" };
        let tests =
            cmd!(shell, "{python} -m pytest -q -p no:cacheprovider doors/python/tests/{tests}").env("PATH", alone);
        Ok(first.quiet().run().is_ok() && tests.quiet().run().is_ok())
    }

    /// Tests the source distribution as pip builds it, in its own folder. Without Rust, maturin would ask for the
    /// package `puccinialin`, which downloads Rust. The Rust on `PATH` is used, so that the test depends on no
    /// download.
    fn holds_from_sources(&self) -> Result<bool> {
        let (shell, maturin) = (&self.shell, self.maturin(true)?);
        let sources = self.folder.join("sources");
        let _ = fs::remove_dir_all(&sources);
        let _licences = Licences::copied(shell)?;
        cmd!(shell, "{maturin} sdist --manifest-path doors/python/Cargo.toml --out {sources}")
            .quiet()
            .ignore_stderr()
            .run()?;
        let sdist = only_file(&sources)?;
        let python = self.new_environment("built")?;
        let install = cmd!(shell, "{python} -m pip install --quiet --disable-pip-version-check --no-cache-dir {sdist}");
        if machine::without_flags(install).env_remove("CARGO_TARGET_DIR").quiet().run().is_err() {
            return Ok(false);
        }
        let size = fs::metadata(&sdist)?.len() / 1024;
        println!("python, built by pip from {size} KiB of sources:");
        Ok(cmd!(shell, "{python} -c {FIRST}").quiet().run().is_ok())
    }
}

/// Returns the only file in a folder.
pub(crate) fn only_file(folder: &Path) -> Result<PathBuf> {
    let file = fs::read_dir(folder)?.find_map(|entry| Some(entry.ok()?.path()));
    file.with_context(|| format!("{} is empty", folder.display()))
}
