//! `rne example`: prints the file of a shipped robot.

use clap::Args;

use crate::outcome::{Failure, Outcome};

/// Print the robot file of a shipped robot, as a start
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne example puma560 > my_puma.yaml
  rne example puma560 --plan > my_puma.plan.yaml    its plan file

`rne list` prints the names of the shipped robots.")]
pub(crate) struct Arguments {
    /// Name of a shipped robot; see `rne list`
    #[arg(value_name = "NAME")]
    name: String,
    /// Print the plan file of the robot instead: the choices for code with the fewest operations
    #[arg(long)]
    plan: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = rne_convert::shipped(&arguments.name).map_err(Failure::input)?;
    let text = if arguments.plan {
        robot.plan.ok_or_else(|| input_error!("{} is shipped without a plan", robot.name))?
    } else {
        robot.yaml
    };
    Ok(Outcome::text(text.to_owned()))
}
