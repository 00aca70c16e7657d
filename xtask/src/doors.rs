//! Gives invalid and unusual inputs to the three interfaces: the command line, the Python package and the C library.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, Result, bail};
use clap::Args;
use serde::Deserialize;
use xshell::{Shell, cmd};

use crate::machine::{self, Missing};
use crate::packages::python::Place;
use crate::{Verdict, packages::capi};

/// Gives hostile inputs to the command line, the Python package and the C library
///
/// The scripts of tests/doors hold every input to the same rules: the status that is expected, no panic, a message that
/// names the file, less than 10 s of processor time and 500 MB of memory, no input changed, nothing left behind.
/// A seed draws some of the inputs; --all and CI_FULL run every one. The package and the library are built for --all,
/// where a script is named, and where they were built before.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when an input breaks a rule. Needs Linux and python3 with venv; what it fetches is below target/python.

Examples:
  cargo xtask doors --install                  a draw of a few minutes, by the commit
  cargo xtask doors --seed 7                   another draw; DOORS_SEED names one too
  cargo xtask doors --all                      every input, more than half an hour
  cargo xtask doors --all --script csv_logs    every input of one script")]
pub(crate) struct Doors {
    /// Run every input instead of a draw
    #[arg(long)]
    all: bool,
    /// Draw the inputs by this seed [default: DOORS_SEED, or the commit]
    #[arg(long, value_name = "N")]
    seed: Option<String>,
    /// Run this script alone; may be given several times
    #[arg(long = "script", value_name = "NAME")]
    scripts: Vec<String>,
    /// Install what is missing, with pip, below target/
    #[arg(long)]
    pub(crate) install: bool,
}

/// A script of `tests/doors`, which tests one interface.
struct Script {
    name: &'static str,
    /// The share of its inputs that is drawn when not all are run; smaller for inputs that take long.
    share: f64,
    door: Door,
}

/// The interface that receives a script's inputs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Door {
    CommandLine,
    Wheel,
    Library,
}

const fn script(name: &'static str, share: f64, door: Door) -> Script {
    Script { name, share, door }
}

/// All scripts. Several run at a time, so the slowest come first.
const SCRIPTS: [Script; 16] = [
    script("long_logs", 0.024, Door::CommandLine),
    script("robot_texts", 0.032, Door::CommandLine),
    script("interruptions", 0.04, Door::CommandLine),
    script("parquet_logs", 0.06, Door::CommandLine),
    script("sqlite_bags", 0.06, Door::CommandLine),
    script("csv_logs", 0.06, Door::CommandLine),
    script("mcap_bags", 0.06, Door::CommandLine),
    script("npy_logs", 0.101, Door::CommandLine),
    script("robot_files", 0.101, Door::CommandLine),
    script("urdfs", 0.101, Door::CommandLine),
    script("plans", 0.101, Door::CommandLine),
    script("tables", 0.101, Door::CommandLine),
    script("options", 0.101, Door::CommandLine),
    script("written_files", 0.101, Door::CommandLine),
    script("wheel", 0.101, Door::Wheel),
    script("capi", 0.3, Door::Library),
];

/// The summary that a script writes about its run.
#[derive(Default, Deserialize)]
struct Summary {
    cases: usize,
    failed: usize,
    skipped: usize,
    commands: usize,
    seconds: f64,
    megabytes: f64,
}

impl Doors {
    pub(crate) fn run(&self) -> Result<Verdict> {
        if let Some(unknown) = self.scripts.iter().find(|name| SCRIPTS.iter().all(|script| script.name != **name)) {
            let names: Vec<&str> = SCRIPTS.iter().map(|script| script.name).collect();
            bail!("there is no script `{unknown}`; there are {}", names.join(", "));
        }
        if !cfg!(target_os = "linux") {
            return Err(Missing::error("memory and processor time are limited as on Linux"));
        }
        let shell = machine::shell()?;
        let place = Place::new()?;
        let programs = Programs::new(&shell, &place, self.install)?;
        let python = &programs.python;
        // first a test that the harness finds violations of its rules
        cmd!(shell, "{python} -B -m unittest -q test_harness").env("PYTHONPATH", "tests/doors").quiet().run()?;
        let is_whole = self.all || std::env::var_os("CI_FULL").is_some();
        let seed = self.seed(&shell);
        if !is_whole {
            println!("doors: a draw by seed {seed} (--seed {seed} repeats it, --all runs every input)");
        }
        let mut chosen = Vec::new();
        for script in &SCRIPTS {
            let is_named = self.scripts.iter().any(|name| name == script.name);
            if !is_named && !self.scripts.is_empty() {
                continue;
            }
            if is_named || is_whole || programs.has(script.door, &place) {
                programs.build(script.door, &place, self.install)?;
                chosen.push(script);
            } else {
                println!("doors {}: skipped, it is not built (--all builds it)", script.name);
            }
        }
        let share = |script: &Script| if is_whole { 1.0 } else { script.share };
        let summaries = programs.run_all(&chosen, |script| [seed.clone(), share(script).to_string()])?;
        Ok(Verdict::from(table(&chosen, &summaries)))
    }

    /// Returns the seed: that of `--seed`, of `DOORS_SEED`, or the commit.
    fn seed(&self, shell: &Shell) -> String {
        let commit = || cmd!(shell, "git rev-parse --short HEAD").quiet().ignore_stderr().read().ok();
        let seed = self.seed.clone().or_else(|| std::env::var("DOORS_SEED").ok()).or_else(commit);
        seed.unwrap_or_else(|| "0".to_owned())
    }
}

/// The programs that the scripts need.
struct Programs {
    /// Python with the packages of `tests/doors/requirements.txt`.
    python: PathBuf,
    /// The command line with every format of logs.
    rne: PathBuf,
    /// The prefix below which the C library is installed.
    prefix: PathBuf,
}

impl Programs {
    fn new(shell: &Shell, place: &Place, install: bool) -> Result<Self> {
        let python = place.environment("doors")?;
        let imports = cmd!(shell, "{python} -c 'import numpy, pyarrow, zstandard, lz4'");
        if imports.quiet().ignore_stderr().run().is_err() {
            if !install {
                return Err(Missing::error(
                    "there is no pyarrow or zstandard; `cargo xtask doors --install` gets them",
                ));
            }
            if !place.pip(&python, &["-r", "tests/doors/requirements.txt"]) {
                return Err(Missing::error("the packages of tests/doors/requirements.txt cannot be fetched"));
            }
        }
        Ok(Self { python, rne: place.command_line()?, prefix: capi::prefix()? })
    }

    /// Whether an interface was built here before, so that another build takes little time.
    fn has(&self, door: Door, place: &Place) -> bool {
        match door {
            Door::CommandLine => true,
            Door::Wheel => place.has_wheel(),
            Door::Library => self.prefix.join("include/rne.h").exists(),
        }
    }

    fn build(&self, door: Door, place: &Place, install: bool) -> Result<()> {
        match door {
            Door::CommandLine => {}
            Door::Wheel => {
                let wheel = place.wheel(install)?.display().to_string();
                if !place.pip(&self.python, &["--force-reinstall", "--no-deps", &wheel]) {
                    bail!("{wheel} cannot be installed");
                }
            }
            Door::Library => {
                capi::built(&self.prefix)?;
            }
        }
        Ok(())
    }

    /// Runs the scripts, as many at a time as there are processors, prints their output and returns their summaries.
    fn run_all(&self, scripts: &[&Script], draw: impl Fn(&Script) -> [String; 2] + Sync) -> Result<Vec<Summary>> {
        let folder = tempfile::tempdir()?;
        let rest = Mutex::new(scripts.iter());
        let next = || rest.lock().expect("no panic").next();
        let work = || -> Result<()> {
            while let Some(script) = next() {
                self.run(script, &draw(script), folder.path())?;
            }
            Ok(())
        };
        std::thread::scope(|scope| -> Result<()> {
            let count = std::thread::available_parallelism().map_or(1, usize::from);
            let threads: Vec<_> = (0..count).map(|_| scope.spawn(work)).collect();
            threads.into_iter().try_for_each(|thread| thread.join().expect("no panic"))
        })?;
        scripts.iter().map(|script| summary(folder.path(), script)).collect()
    }

    fn run(&self, script: &Script, [seed, share]: &[String; 2], folder: &Path) -> Result<()> {
        let (shell, python) = (machine::shell()?, &self.python);
        let source = machine::root().join("tests/doors").join(script.name).with_extension("py");
        let summary = folder.join(script.name);
        let run = cmd!(shell, "{python} -B {source} --seed {seed} --share {share} --summary {summary}");
        let run = run.env("RNE", &self.rne).env("PREFIX", &self.prefix);
        let output = run.quiet().ignore_status().output()?;
        print!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        Ok(())
    }
}

/// Reads the summary of a script's run.
fn summary(folder: &Path, script: &Script) -> Result<Summary> {
    let text = fs::read_to_string(folder.join(script.name));
    let text = text.with_context(|| format!("tests/doors/{}.py did not come to its end", script.name))?;
    Ok(serde_json::from_str(&text)?)
}

/// Prints the table of all scripts. Returns whether no input failed.
fn table(scripts: &[&Script], summaries: &[Summary]) -> bool {
    println!("\nscript          cases  failed  skipped  commands  largest MB  largest s of processor time");
    let mut all = Summary::default();
    for (script, summary) in scripts.iter().zip(summaries) {
        println!("{}", row(script.name, summary));
        all.cases += summary.cases;
        all.failed += summary.failed;
        all.skipped += summary.skipped;
        all.commands += summary.commands;
        all.seconds = all.seconds.max(summary.seconds);
        all.megabytes = all.megabytes.max(summary.megabytes);
    }
    println!("{}", row("all", &all));
    all.failed == 0
}

fn row(name: &str, summary: &Summary) -> String {
    let Summary { cases, failed, skipped, commands, seconds, megabytes } = summary;
    format!("{name:<14}{cases:>7}{failed:>8}{skipped:>9}{commands:>10}{megabytes:>12.0}{seconds:>29.1}")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::SCRIPTS;
    use crate::machine;

    #[test]
    fn every_script_of_the_folder_is_run() {
        let files = std::fs::read_dir(machine::root().join("tests/doors")).expect("a folder");
        let paths = files.map(|file| file.expect("an entry").path());
        let scripts = paths.filter(|path| {
            let is_python = path.extension().is_some_and(|extension| extension == "py");
            is_python && std::fs::read_to_string(path).expect("a script").contains("\n    harness.main(CASES)\n")
        });
        let found: BTreeSet<String> =
            scripts.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned()).collect();
        let known: BTreeSet<String> = SCRIPTS.iter().map(|script| script.name.to_owned()).collect();
        assert_eq!(found, known);
    }
}
