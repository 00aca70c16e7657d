//! Runs the first two commands of the README on a machine with nothing but the programs that the README asks for.

use std::fmt::Write as _;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use xshell::cmd;

use crate::Verdict;
use crate::machine;

/// Runs the README's first two commands in a clone, where only Rust, cc, git, coreutils and sh are on PATH
///
/// The clone is made anew in `target/bare`. HOME is empty there, CARGO_HOME has cargo's registry and nothing else, and
/// of the caller's variables none is kept. So a test that needs a tool which somebody installed by hand fails here.
#[derive(Args)]
#[command(after_help = "\
Exit status: 1 when a command fails.

Examples:
  cargo xtask bare                        cold: everything is compiled in the clone
  cargo xtask bare --target-dir target    with what is compiled already
  cargo xtask bare 'cargo run -- list'    another command")]
pub(crate) struct Bare {
    /// Commands; the first two of the README, unless some are given
    commands: Vec<String>,
    /// Folder of compiled code; a new one, unless one is given
    #[arg(long, value_name = "DIR")]
    target_dir: Option<PathBuf>,
}

/// The programs that the README asks for besides Rust: a C compiler with its binutils, git, coreutils and a shell.
const TOOLS: [&str; 59] = [
    "cc",
    "ar",
    "as",
    "ld",
    "nm",
    "objcopy",
    "objdump",
    "ranlib",
    "readelf",
    "strip",
    "git",
    "sh",
    "arch",
    "basename",
    "cat",
    "chmod",
    "comm",
    "cp",
    "cut",
    "date",
    "dd",
    "df",
    "dirname",
    "du",
    "echo",
    "env",
    "expr",
    "false",
    "head",
    "id",
    "join",
    "ln",
    "ls",
    "mkdir",
    "mkfifo",
    "mktemp",
    "mv",
    "nproc",
    "od",
    "paste",
    "printf",
    "pwd",
    "readlink",
    "realpath",
    "rm",
    "rmdir",
    "seq",
    "sha256sum",
    "sleep",
    "sort",
    "split",
    "stat",
    "tail",
    "tee",
    "test",
    "timeout",
    "touch",
    "tr",
    "true",
];

/// The commands of Rust. They are linked from the toolchain itself, because those of rustup need rustup's folder.
const RUST: [&str; 3] = ["cargo", "rustc", "rustdoc"];

impl Bare {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let folder = machine::root().join("target/bare");
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        let [clone, home, programs] = ["rne", "home", "bin"].map(|name| folder.join(name));
        for made in [&home, &programs] {
            fs::create_dir_all(made)?;
        }
        let root = machine::root();
        cmd!(shell, "git clone --quiet --no-hardlinks {root} {clone}").quiet().run()?;
        let registry = cargo_home()?.join("registry");
        fs::create_dir(home.join(".cargo"))?;
        symlink(&registry, home.join(".cargo/registry")).with_context(|| registry.display().to_string())?;
        link_programs(&programs, &PathBuf::from(cmd!(shell, "rustc --print sysroot").quiet().read()?))?;
        let target = match &self.target_dir {
            Some(target) => std::path::absolute(target)?,
            None => clone.join("target"),
        };
        let commands = if self.commands.is_empty() { commands_of_readme()? } else { self.commands.clone() };
        let mut table = String::new();
        for command in commands {
            println!("bare: {command}");
            let start = Instant::now();
            let status = Command::new(programs.join("sh"))
                .args(["-c", &command])
                .current_dir(&clone)
                .env_clear()
                .envs([("PATH", &programs), ("HOME", &home), ("CARGO_TARGET_DIR", &target)])
                .stdin(Stdio::null())
                .status()?;
            writeln!(table, "bare: {:>6.0} s  {command}", start.elapsed().as_secs_f64())?;
            if !status.success() {
                print!("{table}");
                println!("bare: `{command}` fails where nothing but what the README asks for is installed");
                return Ok(Verdict::Fails);
            }
        }
        print!("{table}");
        Ok(Verdict::Holds)
    }
}

/// Reads the first two commands of the README, which need only Rust and cc: `cargo run` and `cargo test`.
fn commands_of_readme() -> Result<Vec<String>> {
    let readme = machine::read("README.md")?;
    let (_, block) = readme.split_once("```sh\n").context("README.md has no block of commands")?;
    let commands = block.lines().take(2).filter_map(|line| Some(line.split(" #").next()?.trim().to_owned()));
    let commands: Vec<String> = commands.collect();
    if commands != ["cargo run", "cargo test"] {
        bail!("README.md does not begin with `cargo run` and `cargo test`: {commands:?}");
    }
    Ok(commands)
}

/// Returns Cargo's folder, which contains the registry.
fn cargo_home() -> Result<PathBuf> {
    let of_home = || Some(Path::new(&std::env::var_os("HOME")?).join(".cargo"));
    std::env::var_os("CARGO_HOME").map(PathBuf::from).or_else(of_home).context("there is neither CARGO_HOME nor HOME")
}

/// Links the programs of a bare machine into a folder. A program that is not installed here is left out, because not
/// every system has all of coreutils.
fn link_programs(folder: &Path, sysroot: &Path) -> Result<()> {
    for name in RUST {
        symlink(sysroot.join("bin").join(name), folder.join(name))?;
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    for name in TOOLS {
        if let Some(program) =
            std::env::split_paths(&path).map(|place| place.join(name)).find(|program| program.is_file())
        {
            symlink(program, folder.join(name))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{RUST, TOOLS, commands_of_readme};

    #[test]
    fn the_readme_begins_with_what_needs_only_rust_and_cc() {
        assert_eq!(commands_of_readme().expect("two commands"), ["cargo run", "cargo test"]);
    }

    #[test]
    fn no_tool_is_there_that_the_readme_does_not_ask_for() {
        for tool in ["arm-none-eabi-gcc", "qemu-system-arm", "valgrind", "chromium", "python3", "node", "sed", "g++"] {
            assert!(!TOOLS.contains(&tool) && !RUST.contains(&tool), "{tool}");
        }
    }
}
