//! `rne export`: converts a robot file for programs that read other formats.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use rne_emit::FmiVersion;

use crate::commands::fmu;
use crate::files::file_name::Format;
use crate::files::output_file::Output;
use crate::files::robot_file::{self, Shape};
use crate::outcome::{Failure, Outcome};
use crate::palette::TYPED;

/// Convert a robot file to a URDF or an FMU, for other programs
#[derive(Args)]
#[command(group = ArgGroup::new("format").required(true).args(["urdf", "fmu"]), after_help = "\
Examples:
  rne export robots/ur5.yaml --urdf -o ur5.urdf
  rne export puma560 --urdf
  rne export baxter --urdf -o baxter.urdf        a tree, as any robot
  rne export puma560 --fmu -o puma560.fmu        FMI 3.0: torques in, motion out
  rne export puma560 --fmu 2 --inverse -o torques.fmu    FMI 2.0, motion in

The links of the URDF are `world`, `base` (frame 0), `link_1` … and `tip`. The
frame of a link is on the axis of its joint. Named frames and bodies are links.
A floating base is the root link, with its own name; `world` is then left out.
A joint that follows another one gets a `mimic`; a URDF has none for a joint
that follows several. rne writes the friction of a motor as friction of its
joint: G² B and |G| Tc. A URDF cannot store gravity, so a note reports a
gravity that is not [0, 0, -9.81] in `world`, and motors that are left out.

An FMU contains C code for model exchange and co-simulation. If there is a C
compiler (cc, or the one that CC names), it also has a binary for this computer.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`; - is standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Write the URDF format
    #[arg(long)]
    urdf: bool,
    /// Write an FMU of FMI 2 or 3 [default: 3]; docs/control/fmi.md explains it
    #[arg(long, value_name = "VERSION", num_args = 0..=1, default_missing_value = "3",
        value_parser = ["2", "3", "2.0", "3.0"], hide_possible_values = true)]
    fmu: Option<String>,
    #[command(flatten)]
    options: fmu::Options,
    #[command(flatten)]
    output: Output,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    if let Some(version) = &arguments.fmu {
        let Some(out) = &arguments.output.out else {
            let stem = arguments.file.file_stem().map_or("arm".into(), |stem| stem.to_string_lossy());
            let name = robot_file::shell(&PathBuf::from(format!("{}.fmu", if stem == "-" { "arm" } else { &*stem })));
            return Err(usage_error!(
                "{TYPED}--fmu{TYPED:#} needs the name of the file that it writes: add {TYPED}-o {name}{TYPED:#}"
            ));
        };
        let version = if version.starts_with('2') { FmiVersion::Two } else { FmiVersion::Three };
        return fmu::write(&arguments.file, version, arguments.options, out, arguments.output.force);
    }
    if let Some(option) = arguments.options.given() {
        return Err(usage_error!(
            "{TYPED}{option}{TYPED:#} is for FMUs. Leave it out, or ask for \
            {TYPED}--fmu{TYPED:#} instead of {TYPED}--urdf{TYPED:#}"
        ));
    }
    let robot = robot_file::robot(&arguments.file, Shape::Coupled)?;
    let exported =
        rne_convert::export(&robot).map_err(|error| input_error!("{}: {error}", arguments.file.display()))?;
    let mut remark = String::new();
    for line in exported.remarks {
        let _ = writeln!(remark, "{line}");
    }
    arguments.output.deliver(Format::Urdf, exported.text, remark, &arguments.file)
}
