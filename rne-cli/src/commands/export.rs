//! `rne export`: a robot file for programs that read other formats.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use crate::files::file_name::Format;
use crate::files::output_file::Output;
use crate::files::robot_file;
use crate::outcome::{Failure, Outcome};

/// Write an arm as a URDF, for other programs
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne export robots/ur5.yaml --urdf -o ur5.urdf
  rne export puma560 --urdf

Links are `world`, `base` (frame 0), `link_1` … and `tip`; the frame of a link
is on the axis of its joint. Friction is written at the joint: G² B and |G| Tc
of its motor. A URDF cannot store gravity, so a note reports it if it is not
[0, 0, -9.81] in `world`.")]
pub(crate) struct Arguments {
    /// The robot file; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Write a URDF
    #[arg(long, required = true)]
    urdf: bool,
    #[command(flatten)]
    output: Output,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = robot_file::robot(&arguments.file)?;
    let exported = rne_convert::export(&robot)
        .map_err(|error| Failure::input(format_args!("{}: {error}", arguments.file.display())))?;
    let mut remark = String::new();
    for line in exported.remarks {
        let _ = writeln!(remark, "{line}");
    }
    arguments.output.deliver(Format::Urdf, exported.text, remark, &arguments.file)
}
