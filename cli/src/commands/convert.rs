//! `rne convert`: writes the same arm in the other convention.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use rne_convert::Converted;
use rne_model::Convention;

use crate::files::file_name::Format;
use crate::files::output_file::Output;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::QUIET;
use crate::render::heading::rounding;
use crate::values::choice::convention;

/// Convert a robot file to the other Denavit-Hartenberg convention
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne convert robots/panda.yaml --convention standard -o panda_standard.yaml
  rne convert robots/ur5.yaml --convention modified

Torques, limits and motors do not change. rne replaces expressions by their
values. If the first joint axis is not z of frame 0, rne moves frame 0 of a
standard table to this axis, and rotates base and gravity with frame 0. The
potential energy is zero at the origin of frame 0, so it changes by a constant.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Denavit-Hartenberg convention of the new robot file
    #[arg(long, value_parser = convention())]
    convention: Convention,
    #[command(flatten)]
    output: Output,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = robot_file::robot(&arguments.file, Shape::Chain)?;
    let Converted { text, rounding: difference, remarks, .. } =
        rne_convert::convert(&robot, arguments.convention).map_err(|report| Failure::from(&report))?;
    let mut remark = String::new();
    for line in remarks {
        let _ = writeln!(remark, "{line}");
    }
    let _ = writeln!(remark, "{QUIET}{}{QUIET:#}", rounding(&difference));
    arguments.output.deliver(Format::RobotFile, text, remark, &arguments.file)
}
