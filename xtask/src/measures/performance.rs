//! Repeats the measurements of docs/measured/performance.md, whose blocks name a machine and a date.

use std::fs;

use anyhow::{Result, ensure};
use clap::{Args, ValueEnum};
use xshell::{Cmd, Shell, cmd};

use crate::Verdict;
use crate::measures::instructions::{self, Instructions};
use crate::{machine, measures::growth, measures::plain_build, measures::single_calls, packages::python};

/// Writes the measured blocks of docs/measured/performance.md, between `<!-- begin: measured NAME, … -->` and
/// `<!-- end -->`
///
/// All blocks take about ten minutes on an idle machine. The block of tricks does not depend on the machine:
/// RNE_WRITE_DOCUMENTS=1 cargo test --test documents. CARGO_TARGET_DIR is obeyed.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask performance                    all blocks
  cargo xtask performance batch sin_cos      these
  cargo xtask performance --print growth     print a block instead")]
pub(crate) struct Performance {
    /// The blocks; all, unless some are named
    #[arg(value_name = "NAME")]
    names: Vec<Block>,
    /// Print the blocks instead of writing them
    #[arg(long)]
    print: bool,
}

const PAGE: &str = "docs/measured/performance.md";

/// A block of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
enum Block {
    /// Nanoseconds of a call (divan)
    SingleCalls,
    /// Instructions of a call (callgrind)
    Instructions,
    /// Times of sine and cosine of angles up to 3 rad
    SinCos,
    /// Nanoseconds of a state of a batch
    Batch,
    /// Measures of generated code by the number of joints
    Growth,
    /// Nanoseconds of an arm at run time; of the table of functions the rows of one arm and one vector unit
    RunTime,
    /// Torques from Python beside Pinocchio and the Robotics Toolbox, which are fetched
    FromPython,
    /// Microseconds of functions of one state from Python that take long, or longer than in Pinocchio, which is fetched
    PythonCalls,
    /// A plain build beside one for x86-64-v3: one arm, and where the builds differ
    PlainBuild,
}

impl Performance {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let names = if self.names.is_empty() { Block::value_variants() } else { &self.names };
        for block in names {
            let text = block.measure()?;
            if self.print {
                print!("{text}");
            } else {
                machine::write(PAGE, &replaced(&machine::read(PAGE)?, block.name(), &text)?)?;
                println!("{}: written", block.name());
            }
        }
        Ok(Verdict::Holds)
    }
}

impl Block {
    fn name(self) -> &'static str {
        match self {
            Self::SingleCalls => "single_calls",
            Self::Instructions => "instructions",
            Self::SinCos => "sin_cos",
            Self::Batch => "batch",
            Self::Growth => "growth",
            Self::RunTime => "run_time",
            Self::FromPython => "from_python",
            Self::PythonCalls => "python_calls",
            Self::PlainBuild => "plain_build",
        }
    }

    /// Measures and returns the text of the block.
    fn measure(self) -> Result<String> {
        let shell = machine::shell()?;
        Ok(match self {
            Self::SingleCalls => {
                let head = here(&shell)?;
                let bench =
                    cmd!(shell, "cargo bench --quiet --manifest-path benches/Cargo.toml --locked --bench wall_time");
                head + &single_calls::table(&bench.quiet().read()?)
            }
            Self::Instructions => {
                format!("{}.\n\n{}", instructions::compiler()?, Instructions::default().count()?.markdown())
            }
            Self::SinCos => {
                let package = ["--quiet", "--release", "-p", "rne-runtime"];
                let speed = listing(cmd!(shell, "cargo run {package...} --example sin_cos_speed"))?;
                here(&shell)? + &kept(&speed, |line| !line.contains(" up to 100000 rad"))
            }
            Self::Batch => here(&shell)? + &listing(cmd!(shell, "cargo run --quiet --release --example batch_speed"))?,
            Self::RunTime => {
                let options = ["--quiet", "--release", "--no-default-features", "--features", "run_time", "--locked"];
                let bench = cmd!(shell, "cargo run --manifest-path benches/Cargo.toml {options...} --bin run_time");
                here(&shell)? + &kept(&listing(bench)?, is_of_one_arm)
            }
            Self::FromPython => {
                format!("{}```text\n{}\n```\n", here(&shell)?, python::beside_peers("from_python.py")?)
            }
            Self::PythonCalls => {
                let head = here(&shell)?;
                let calls = kept(&python::beside_peers("one_state.py")?, is_slower_or_long);
                format!("{head}```text\n{calls}```\n")
            }
            Self::PlainBuild => here(&shell)? + &plain_build::table()?,
            Self::Growth => {
                let tables = without_empty_lines(&growth::measured(&[])?);
                without_load(&here(&shell)?) + &kept(&without_increments(&tables), is_of_1_10_or_50_joints)
            }
        })
    }
}

/// Returns a paragraph with the date, the machine, the compiler and the commit.
fn here(shell: &Shell) -> Result<String> {
    let processors = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = processors.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(": "));
    let processor = name.map_or(std::env::consts::ARCH, |(_, name)| name);
    let cores = std::thread::available_parallelism()?;
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().filter(|load| !load.is_empty()).unwrap_or("unknown");
    let date = cmd!(shell, "date --utc +%F").quiet().read()?;
    let rustc = cmd!(shell, "rustc --version").quiet().read()?;
    let commit = cmd!(shell, "git log -1 --format=%h").quiet().ignore_stderr().read();
    let is_clean = cmd!(shell, "git diff --quiet HEAD -- . :!docs").quiet().ignore_stderr().run().is_ok();
    let commit = match commit {
        Err(_) => "no commit".to_owned(),
        Ok(commit) if is_clean => commit,
        Ok(commit) => commit + " with changes",
    };
    let machine = format!("{processor}, {cores} cores, load average {load} before the measurement");
    Ok(format!("{date}, {machine}; {rustc}; rne at {commit}.\n\n"))
}

/// Removes the load average from a paragraph, because processor time does not depend on the load.
fn without_load(text: &str) -> String {
    match (text.find(", load average "), text.find(" measurement;")) {
        (Some(start), Some(end)) => text[..start].to_owned() + &text[end + " measurement".len()..],
        _ => text.to_owned(),
    }
}

/// Removes repeated empty lines between paragraphs, and all at the end.
fn without_empty_lines(text: &str) -> String {
    let mut lines: Vec<&str> = text.trim_end().lines().collect();
    lines.dedup_by(|line, before| line.is_empty() && before.is_empty());
    lines.join("\n") + "\n"
}

/// Returns the lines of a text that satisfy a condition.
fn kept(text: &str, is_kept: impl Fn(&str) -> bool) -> String {
    text.lines().filter(|line| is_kept(line)).flat_map(|line| [line, "\n"]).collect()
}

/// Whether the page shows a line: all lines except rows of other arms and other vector units than the chosen ones.
fn is_of_one_arm(line: &str) -> bool {
    let unit = line.split_whitespace().nth(1).unwrap_or_default();
    !["SSE2", "AVX2", "AVX-512"].contains(&unit) || (unit == "AVX2" && line.starts_with("panda "))
}

/// Whether the page shows a line: a call from Python that takes more than ten microseconds or 1.5 times as long as
/// Pinocchio's, a title, or `inverse_dynamics`, with which the others are compared.
fn is_slower_or_long(line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (function, time, peer) = match words[..] {
        [_, function, time, peer, _] => (function, time, peer),
        [_, function, time, _] => (function, time, "inf"),
        _ => return true,
    };
    let (Ok(time), Ok(peer)) = (time.parse::<f64>(), peer.parse::<f64>()) else { return true };
    function == "inverse_dynamics" || time > 10.0 || time > 1.5 * peer
}

/// Whether the page shows a line: all lines except rows of chains with other numbers of joints than 1, 10 and 50.
fn is_of_1_10_or_50_joints(line: &str) -> bool {
    let joints = line.strip_prefix("| ").and_then(|line| line.split(' ').next()?.parse::<u16>().ok());
    joints.is_none_or(|joints| [1, 10, 50].contains(&joints))
}

/// Removes the increments beside each column of a table, because the lines below the tables show the growth.
fn without_increments(text: &str) -> String {
    let row = |line: &str| {
        let cells = line.trim_matches('|').split('|').enumerate();
        let kept: Vec<&str> = cells.filter(|(at, _)| *at == 0 || at % 2 == 1).map(|(_, cell)| cell).collect();
        format!("|{}|\n", kept.join("|"))
    };
    text.lines().map(|line| if line.starts_with('|') { row(line) } else { format!("{line}\n") }).collect()
}

/// Runs a command and returns its output as a block of text.
fn listing(command: Cmd<'_>) -> Result<String> {
    Ok(format!("```text\n{}\n```\n", command.quiet().read()?))
}

/// Returns a page with a new text in one of its blocks.
pub(crate) fn replaced(page: &str, name: &str, text: &str) -> Result<String> {
    let start = format!("<!-- begin: measured {name},");
    ensure!(page.lines().any(|line| line.starts_with(&start)), "the page has no block `{name}`");
    let mut is_inside = false;
    let mut replaced = String::new();
    for line in page.lines() {
        is_inside &= line != "<!-- end -->";
        if !is_inside {
            replaced.push_str(line);
            replaced.push('\n');
        }
        if line.starts_with(&start) {
            replaced.push_str(text);
            is_inside = true;
        }
    }
    Ok(replaced)
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;

    use super::{Block, PAGE, is_of_1_10_or_50_joints, is_of_one_arm, is_slower_or_long, kept, replaced};
    use super::{without_empty_lines, without_increments, without_load};
    use crate::machine;

    #[test]
    fn a_block_is_replaced_and_the_rest_stays() {
        let (begin, end) = ("<!-- begin: measured batch, written by: me -->", "<!-- end -->");
        let page = &format!("a\n{begin}\nold\n{end}\nb\n<!-- begin: x -->\n{end}\n");
        let expected = page.replace("old", "new");
        assert_eq!(replaced(page, "batch", "new\n").expect("it is there"), expected);
        assert!(replaced(page, "growth", "").is_err());
    }

    #[test]
    fn the_pages_have_every_block() {
        for block in Block::value_variants() {
            let page = machine::read(PAGE).expect("the page");
            let value = block.to_possible_value().expect("no block is hidden");
            assert_eq!(block.name(), value.get_name());
            assert!(replaced(&page, block.name(), "").is_ok());
        }
    }

    #[test]
    fn words_that_do_not_belong_are_left_out() {
        assert_eq!(without_load("2 cores, load average 1.61 before the measurement; rustc"), "2 cores; rustc");
        assert_eq!(without_empty_lines("a\n\n\n\nb\n\n\n"), "a\n\nb\n");
        let table =
            "| n | ops | per joint | ms | per joint |\n|---:|---:|---:|---:|---:|\n| 1 | 22 |  | 3.1 |  |\n\n- a\n";
        assert_eq!(without_increments(table), "| n | ops | ms |\n|---:|---:|---:|\n| 1 | 22 | 3.1 |\n\n- a\n");
    }

    #[test]
    fn rows_that_no_decision_needs_are_left_out() {
        let units = "ur5   5.6 11.4\n\nrobot unit function\nur5   AVX2 f 1.0\npanda SSE2 f 1.0\npanda AVX2 f 1.0\n";
        assert_eq!(kept(units, is_of_one_arm), "ur5   5.6 11.4\n\nrobot unit function\npanda AVX2 f 1.0\n");
        let titles = "robot function rne pinocchio / inverse_dynamics\n";
        let shown = "a inverse_dynamics 2.1 1.8 1.0\na g 1.6 1.0 0.8\na h 10.1 12.0 4.8\na i 10.1 4.5\n";
        let calls = format!("{titles}{shown}a f 1.5 1.0 0.7\na j 9.9 4.4\n");
        assert_eq!(kept(&calls, is_slower_or_long), format!("{titles}{shown}"));
        let growth = "| joints | ms |\n|---:|---:|\n| 1 | 3 |\n| 2 | 10 |\n| 10 | 50 |\n\n- a\n";
        assert_eq!(kept(growth, is_of_1_10_or_50_joints), growth.replace("| 2 | 10 |\n", ""));
    }
}
