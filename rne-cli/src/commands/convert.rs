//! `rne convert`: the same arm in the other convention.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne_convert::Converted;
use rne_model::Convention;

use crate::files::file_name::Format;
use crate::files::output_file::Output;
use crate::files::robot_file;
use crate::outcome::{Failure, Outcome};
use crate::palette::QUIET;
use crate::render::heading::rounding;
use crate::values::choice::convention;

/// Write the table of an arm in the other convention
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne convert robots/panda.yaml --convention standard -o panda_standard.yaml
  rne convert robots/ur5.yaml --convention modified

Torques, limits and motors do not change; expressions are replaced by their
values. If the first axis is not z of frame 0, a standard table moves frame 0
there and rotates base and gravity with it.")]
pub(crate) struct Arguments {
    /// The robot file; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Convention of the new table
    #[arg(long, value_parser = convention())]
    convention: Convention,
    #[command(flatten)]
    output: Output,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = robot_file::robot(&arguments.file)?;
    let Converted { text, rounding: difference, remarks, .. } =
        rne_convert::convert(&robot, arguments.convention).map_err(|report| Failure::from(&report))?;
    let mut remark = String::new();
    for line in remarks {
        let _ = writeln!(remark, "{line}");
    }
    let _ = writeln!(remark, "{QUIET}{}{QUIET:#}", rounding(&difference));
    arguments.output.deliver(Format::RobotFile, text, remark, &arguments.file)
}
