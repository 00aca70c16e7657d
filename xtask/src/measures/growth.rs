//! Measures how generated code grows with the number of joints: benches/growth.

use anyhow::Result;
use clap::Args;
use xshell::{Cmd, cmd};

use crate::Verdict;
use crate::machine;

/// Measures operations, expansion, compile time and code size by the number of joints
///
/// Random chains in which nothing folds, derived and built: benches/growth says what the columns are. Some minutes.
#[derive(Args)]
#[command(after_help = "\
Examples:
  cargo xtask growth           1, 2, 5, 10, 20, 30, 40 and 50 joints
  cargo xtask growth 1 5 10    these only
  cargo xtask growth --robot benches/trees/g1.yaml
                               what each derive of this robot costs a release build
  cargo xtask growth --arms 300    random arms of 7 to 12 joints instead: what it
                               takes to write each function in the reduced form")]
pub(crate) struct Growth {
    /// Numbers of joints, 1 or more each
    #[arg(value_parser = clap::value_parser!(u16).range(1..))]
    joints: Vec<u16>,
    /// Measure this number of random arms instead, and fail if a function takes more than a second
    #[arg(long, value_name = "N", conflicts_with = "joints", value_parser = clap::value_parser!(u16).range(1..))]
    arms: Option<u16>,
    /// Measure the release build of each derive of this robot file instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["joints", "arms"])]
    robot: Option<String>,
}

impl Growth {
    pub(crate) fn run(&self) -> Result<Verdict> {
        let shell = machine::shell()?;
        let command = match self.arms {
            Some(arms) => printing(&shell, arms),
            None if self.robot.is_some() => {
                command(&shell, &["--robot".into(), self.robot.clone().unwrap_or_default()])
            }
            None => command(&shell, &words(&self.joints)),
        };
        Ok(Verdict::from(command.run().is_ok()))
    }
}

/// Returns the tables as text.
pub(crate) fn measured(joints: &[u16]) -> Result<String> {
    let shell = machine::shell()?;
    Ok(command(&shell, &words(joints)).read()?)
}

/// Returns the command that measures in the development profile. Cargo compiles macros without optimisation in all
/// profiles, so this is what a build of a user takes.
fn command<'a>(shell: &'a xshell::Shell, words: &[String]) -> Cmd<'a> {
    let manifest = "--manifest-path=benches/Cargo.toml";
    cmd!(
        shell,
        "cargo run --quiet --locked {manifest} --no-default-features --features growth --bin growth -- {words...}"
    )
    .quiet()
}

fn words(joints: &[u16]) -> Vec<String> {
    joints.iter().map(u16::to_string).collect()
}

/// Returns the command that measures in the release profile, with which the command line is installed.
fn printing(shell: &xshell::Shell, arms: u16) -> Cmd<'_> {
    let arms = arms.to_string();
    let options = ["--manifest-path=benches/Cargo.toml", "--no-default-features", "--features", "growth"];
    cmd!(shell, "cargo run --quiet --locked --release {options...} --bin printing -- {arms}").quiet()
}
