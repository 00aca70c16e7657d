//! Tests the page of `rne report` in a real browser.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use xshell::{Shell, cmd};

use crate::Verdict;
use crate::machine::{self, Missing};

/// Debian packages for the tests in a browser: Chromium and its driver.
const BROWSER: [&str; 2] = ["chromium", "chromium-driver"];
const PACKAGES: [&str; 3] = ["selenium==4.51.0", "axe-core-python==0.1.0", "pillow==12.0.0"];

/// Opens the pages of `rne report` in headless Chromium and uses them
///
/// The page of every robot file of this repository is opened in normal and in lecture mode, five at three sizes, with
/// CI_FULL all; on that of one robot, on those of five with CI_FULL, nothing moves while the mouse rests on a name:
/// `tests/page/every.py`. With CI_FULL, a few pages are used as a reader uses them: `tests/page/page.py` compares
/// torques and vectors in all axes with those of `rne eval`, follows every statement of the PUMA 560 to its equation,
/// value, unit and arrow and back, and tries sliders, keyboard, fingers, exercises, rules of accessibility, paper,
/// sizes and times.
#[derive(Args)]
#[command(after_help = "\
Needs chromium, chromedriver and python3 with venv; what it fetches is below
target/page, and so are the pages and their pictures.

Examples:
  cargo xtask page                with what is installed there
  cargo xtask page --install      install it first
  CI_FULL=1 cargo xtask page      use the pages of several arms, too
  cargo xtask page --pictures     write the pictures of docs/pictures anew")]
pub(crate) struct Page {
    /// Install what is missing: the browser by apt, the client by pip below target/
    #[arg(long)]
    pub(crate) install: bool,
    /// Write the pictures of the documents anew
    #[arg(long)]
    pictures: bool,
}

impl Page {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let python = python(&shell, self.install)?;
        let rne = rne(&shell)?;
        let folder = machine::target_folder("target")?.join("page");
        let pictures: &[&str] = if self.pictures { &["docs/pictures"] } else { &[] };
        let mut holds = cmd!(shell, "{python} tests/page/every.py {rne} {folder}").quiet().run().is_ok();
        if self.pictures || std::env::var_os("CI_FULL").is_some() {
            holds &= cmd!(shell, "{python} tests/page/page.py {rne} {folder} {pictures...}").quiet().run().is_ok();
        }
        Ok(Verdict::from(holds))
    }
}

/// Returns the Python that has a client of the browser. With `install`, missing packages and the browser are installed.
pub(crate) fn python(shell: &Shell, install: bool) -> Result<PathBuf> {
    let venv = machine::target_folder("target")?.join("page/venv");
    let python = venv.join("bin/python");
    if !(machine::has("chromium") && machine::has("chromedriver")) {
        machine::packages(&BROWSER, install)?;
    }
    let can_import = || {
        let imports = cmd!(shell, "{python} -c 'import selenium, axe_core_python, PIL'");
        python.exists() && imports.quiet().ignore_stderr().run().is_ok()
    };
    if !can_import() {
        if !install {
            return Err(Missing::error("there is no Selenium; `cargo xtask page --install` gets it"));
        }
        if cmd!(shell, "python3 -m venv {venv}").quiet().ignore_stderr().run().is_err() {
            return Err(Missing::error("python3 cannot make a virtual environment (python3-venv)"));
        }
        let packages = PACKAGES;
        let install = cmd!(shell, "{python} -m pip install --quiet --disable-pip-version-check {packages...}");
        if install.quiet().run().is_err() {
            return Err(Missing::error("Selenium cannot be fetched"));
        }
    }
    Ok(python)
}

/// Builds the command line and returns its path.
pub(crate) fn rne(shell: &Shell) -> Result<PathBuf> {
    machine::without_flags(cmd!(shell, "cargo build --quiet --bin rne")).quiet().run()?;
    Ok(machine::target_folder("target")?.join("debug/rne"))
}
