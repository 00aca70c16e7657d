//! Fuzzing with libFuzzer, which makes unusual inputs and learns from the code that they reach.

use std::fs;
use std::path::Path;

use anyhow::{Result, bail};
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine::{self, Missing};

/// Runs the targets of fuzz/: readers of robot files, expressions, plans and URDFs, and arms through every function
///
/// Each target starts from its corpus in fuzz/corpus. Inputs that fail are kept in fuzz/artifacts. The flags are those
/// of cargo-fuzz without a sanitizer, which would need a nightly compiler: `unsafe` is forbidden where inputs are read.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when an input fails.

Examples:
  cargo xtask fuzz                            every target, a few thousand inputs each
  cargo xtask fuzz urdf --runs 1000000
  cargo xtask fuzz robot_file --grow          and keep the inputs that reach new code")]
pub(crate) struct Fuzz {
    /// The targets; all, unless some are named
    #[arg(value_name = "TARGET")]
    targets: Vec<String>,
    /// How many inputs each
    #[arg(long, default_value_t = 5000, value_name = "N")]
    runs: u64,
    /// Add to the corpus what reaches new code
    #[arg(long)]
    grow: bool,
}

/// Compiler flags that instrument the code for libFuzzer; cargo-fuzz uses the same ones.
const FLAGS: &str = "--cfg fuzzing -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
                     -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
                     -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1";

/// The longest input, bytes.
const LONGEST: u32 = 4096;

/// Options of libFuzzer: at most 10 s per input and 2048 MB, short output, and a fixed seed, so that every run has the
/// same inputs.
const OPTIONS: [&str; 5] = ["-timeout=10", "-rss_limit_mb=2048", "-verbosity=0", "-print_final_stats=1", "-seed=1"];

impl Fuzz {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let targets = targets()?;
        if let Some(unknown) = self.targets.iter().find(|name| !targets.contains(name)) {
            bail!("there is no target `{unknown}`; there are {}", targets.join(", "));
        }
        if !machine::has("c++") {
            return Err(Missing::error("there is no c++, which compiles libFuzzer"));
        }
        let shell = machine::shell()?;
        let folder = machine::target_folder("target")?.join("fuzz");
        // with --target, RUSTFLAGS apply to the programs only, and not to build scripts and macros
        let host = cmd!(shell, "rustc -vV").quiet().read()?;
        let host = host.lines().find_map(|line| line.strip_prefix("host: ")).unwrap_or_default().to_owned();
        let build = cmd!(shell, "cargo build --quiet --release --manifest-path fuzz/Cargo.toml --target {host}");
        machine::without_flags(build).env("RUSTFLAGS", FLAGS).env("CARGO_TARGET_DIR", &folder).run()?;
        let mut failed = Vec::new();
        for target in targets.iter().filter(|name| self.targets.is_empty() || self.targets.contains(name)) {
            let program = folder.join(&host).join("release").join(target);
            let seeds = machine::root().join("fuzz/corpus").join(target);
            let found = folder.join("corpus").join(target);
            let artifacts = machine::root().join("fuzz/artifacts").join(target);
            fs::create_dir_all(&found)?;
            fs::create_dir_all(&artifacts)?;
            // libFuzzer writes new inputs to the first of these folders
            let corpus: &[&Path] = if self.grow { &[&seeds] } else { &[&found, &seeds] };
            let (runs, longest) = (self.runs.to_string(), LONGEST.to_string());
            let artifacts = format!("{}/", artifacts.display());
            println!("fuzz {target}: {runs} inputs");
            let run = cmd!(shell, "{program} {corpus...} -runs={runs} -max_len={longest} {OPTIONS...}");
            let run = run.arg(format!("-artifact_prefix={artifacts}"));
            if run.quiet().run().is_err() {
                failed.push(target.as_str());
            }
        }
        if !failed.is_empty() {
            println!("fuzz: failed: {}; fuzz/artifacts has the inputs", failed.join(", "));
        }
        Ok(Verdict::from(failed.is_empty()))
    }
}

/// Returns the names of the targets, the files in `fuzz/targets`.
fn targets() -> Result<Vec<String>> {
    let files = fs::read_dir(machine::root().join("fuzz/targets"))?;
    let mut names = Vec::new();
    for file in files {
        let path = file?.path();
        names.extend(path.file_stem().and_then(|name| name.to_str()).map(str::to_owned));
    }
    names.sort();
    Ok(names)
}
