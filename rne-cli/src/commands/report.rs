//! `rne report`: an arm's dynamics as a page to look at.

use std::path::PathBuf;

use clap::Args;
use rne_codegen::{Form, Function};

use crate::files::chosen_arm::Rotors;
use crate::files::file_name::Format;
use crate::files::output_file::Output;
use crate::files::plan_file::Compiler;
use crate::outcome::{Failure, Outcome};

/// Write a page that shows an arm, its equations and its torques
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne report puma560 -o puma560.html
  rne report robots/planar2.yaml -o planar2.html --force

The page is one HTML file that needs no network. It shows the arm in 3-D and the
seven steps joint by joint: each component as equation, numbers and code, with
the terms that vanish and why, linked with the vector on the arm; torques over a
motion; exercises. docs/teaching.md describes how to use it.")]
pub(crate) struct Arguments {
    /// Robot file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    /// Page to write; - is standard output
    #[arg(short, long = "output", value_name = "OUT.html")]
    out: PathBuf,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = arguments.rotors.robot(&arguments.file)?;
    let reduced = Compiler::new(&arguments.file, &robot).compile(Function::InverseDynamics, Form::Reduced)?;
    let page = rne_report::page(&robot, Some(&reduced))
        .map_err(|error| Failure::compile(&arguments.file.display().to_string(), &error))?;
    let output = Output { out: Some(arguments.out.clone()), force: arguments.force };
    output.deliver(Format::Html, page, String::new(), &arguments.file)
}
