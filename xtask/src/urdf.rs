//! Compares robot files that were imported from URDF and MJCF files with Pinocchio and MuJoCo, which read the same
//! files.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};
use crate::packages::python::Place;

/// Python packages with whole robots, for --corpora.
const CORPORA: [&str; 3] = ["dm_control==1.0.50", "gymnasium==1.4.0", "robosuite-models==1.0.0"];

/// Python packages that are installed: Pinocchio, MuJoCo, and arms as URDF.
const PACKAGES: [&str; 4] = ["pin==4.1.0", "mujoco==4.0.0", "example-robot-data==6.0.0", "rtb-data==2.0.0"];

/// Imports real arms and compares them with Pinocchio
///
/// Torques, mass matrix and tip of at least 12 arms of packages, in both conventions: to 1e-10 without snapping, and
/// with it by no more than the import tells. `tests/reference/urdf.py` has the arms and the comparison. With a folder
/// of URDFs of trees: all functions that Pinocchio has, of the whole robots that `tests/reference/trees.py` names, to
/// 1e-12. With --mjcf: the torques of MuJoCo, of the MJCF files and URDFs in a folder, to 1e-9; MuJoCo saves each URDF
/// as MJCF. With --corpora: all whole robots of the packages through every door of the Python wheel, right or refused
/// with a reason, by `tests/reference/corpora.py`.
#[derive(Args)]
#[command(after_help = "\
Needs python3 with venv; Pinocchio and the arms are fetched into target/urdf/venv.

Examples:
  cargo xtask urdf              with what is installed there
  cargo xtask urdf --install    install it first
  cargo xtask urdf --trees DIR  whole robots of the URDFs in a folder
  cargo xtask urdf --mjcf DIR   whole robots as MJCF, beside MuJoCo
  cargo xtask urdf --corpora    whole robots of packages, through every door of the Python wheel
  cargo xtask urdf --trees DIR --write
                                also write the files of tests/functions/trees")]
pub(crate) struct Urdf {
    /// Compare whole robots of the URDFs in this folder instead
    #[arg(long, value_name = "DIR")]
    trees: Option<PathBuf>,
    /// Compare the MJCF files and URDFs in this folder with MuJoCo instead
    #[arg(long, value_name = "DIR", conflicts_with = "trees")]
    mjcf: Option<PathBuf>,
    /// Compare the whole robots of the packages through every door of the Python wheel instead
    #[arg(long, conflicts_with_all = ["trees", "mjcf"])]
    corpora: bool,
    /// Write the robot files and the values of those trees whose licence allows it to tests/functions/trees
    #[arg(long, requires = "trees")]
    write: bool,
    /// Install what is missing, with pip, below target/
    #[arg(long)]
    pub(crate) install: bool,
}

impl Urdf {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let target = machine::target_folder("target")?;
        let venv = target.join("urdf/venv");
        let python = venv.join("bin/python");
        let can_import = || {
            let packages = match self {
                Self { corpora: true, .. } => "dm_control, gymnasium, robosuite_models, mujoco, pinocchio",
                Self { mjcf: Some(_), .. } => "mujoco, pinocchio",
                _ => "pinocchio",
            };
            let import = format!("import {packages}");
            let found = cmd!(shell, "{python} -c {import}").quiet().ignore_stdout().ignore_stderr();
            python.exists() && found.run().is_ok()
        };
        if !can_import() {
            if !self.install {
                return Err(Missing::error(
                    "there is no Pinocchio, or no MuJoCo; `cargo xtask urdf --install` gets both",
                ));
            }
            if !machine::has("python3") {
                return Err(Missing::error("there is no python3"));
            }
            if cmd!(shell, "python3 -m venv {venv}").quiet().ignore_stderr().run().is_err() {
                return Err(Missing::error("python3 cannot make a virtual environment (python3-venv)"));
            }
        }
        if self.install {
            let packages = PACKAGES.iter().chain(CORPORA.iter().filter(|_| self.corpora));
            let install = cmd!(shell, "{python} -m pip install --quiet --disable-pip-version-check {packages...}");
            if install.quiet().ignore_stderr().run().is_err() && !can_import() {
                return Err(Missing::error("Pinocchio and its arms cannot be fetched"));
            }
        }
        if let Some(folder) = &self.mjcf {
            let models = target.join("urdf/mjcf");
            shell.remove_path(&models)?;
            shell.create_dir(&models)?;
            cmd!(shell, "{python} tests/reference/mjcf.py {folder} {models}").quiet().run()?;
            let test = cmd!(shell, "cargo test --quiet --package rne-convert --test mjcf -- --ignored");
            return Ok(Verdict::from(machine::without_flags(test).env("RNE_MJCF", models).quiet().run().is_ok()));
        }
        if self.corpora {
            let wheel = Place::new()?.wheel(self.install)?;
            let install = cmd!(shell, "{python} -m pip install --quiet --disable-pip-version-check");
            install.args(["--force-reinstall", "--no-deps"]).arg(wheel).quiet().run()?;
            let compare = cmd!(shell, "{python} tests/reference/corpora.py");
            return Ok(Verdict::from(compare.quiet().run().is_ok()));
        }
        machine::without_flags(cmd!(shell, "cargo build --quiet --bin rne")).quiet().run()?;
        let rne = target.join("debug/rne");
        let write = self.write.then_some("--write");
        let compare = if let Some(folder) = &self.trees {
            cmd!(shell, "{python} tests/reference/trees.py {rne} {folder} {write...}")
        } else {
            cmd!(shell, "{python} tests/reference/urdf.py {rne}")
        };
        Ok(Verdict::from(compare.quiet().run().is_ok()))
    }
}
