//! `rne report`: writes the dynamics of an arm as an HTML page.

use std::path::PathBuf;

use clap::Args;
use rne_codegen::Form;

use crate::files::chosen_arm::{Carried, Rotors};
use crate::files::file_name::Format;
use crate::files::output_file::Output;
use crate::files::plan_file::Compiler;
use crate::files::robot_file::Shape;
use crate::outcome::{Failure, Outcome};

/// Write an HTML page with an arm, its equations and its torques
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne report puma560 -o puma560.html
  rne report robots/planar2.yaml -o planar2.html --force

The page is one HTML file and needs no network. The page shows the arm in 3-D,
the seven steps of inverse dynamics for each joint, torques over a motion, and
exercises. Each component of a step has its equation, its numbers, its code, and
the terms that vanish, with the reasons. The component is linked with its vector
on the arm. docs/teaching/for-teachers.md describes how to use the page.")]
pub(crate) struct Arguments {
    /// Robot file, or a name from `rne list`
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    rotors: Rotors,
    #[command(flatten)]
    carried: Carried,
    /// HTML file to write; - is standard output
    #[arg(short, long = "output", value_name = "OUT.html")]
    out: PathBuf,
    /// Overwrite the output file if it exists
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let robot = arguments.carried.of(arguments.rotors.robot(&arguments.file, Shape::Coupled)?)?;
    let compiler = match arguments.carried.payload {
        Some(_) => Compiler::without_file(&arguments.file, &robot),
        None => Compiler::new(&arguments.file, &robot),
    };
    let reduced = compiler.compile(rne_codegen::function_of_plan(&robot), Form::Reduced)?;
    let page = rne_report::page(&robot, Some(&reduced))
        .map_err(|error| Failure::compile(&arguments.file.display().to_string(), &error))?;
    let output = Output { out: Some(arguments.out.clone()), force: arguments.force };
    output.deliver(Format::Html, page, arguments.rotors.note(&robot), &arguments.file)
}
