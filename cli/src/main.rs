//! The command line of rne: a thin layer over functions that take arguments and return text.
//!
//! The modules in `commands` parse arguments and run commands with the help of `files`, `render` and `values`, none of
//! which depends on a command.
#![forbid(unsafe_code)]

#[macro_use]
mod outcome;
mod commands;
mod files;
mod mistyped;
mod palette;
mod remedy;
mod render;
mod terminal;
mod values;

use std::env;
use std::panic;
use std::process::ExitCode;

use clap::Parser as _;

use crate::commands::Arguments;

fn main() -> ExitCode {
    hush();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let words: Vec<String> = env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
            return match mistyped::explained(&error, &words) {
                Some((name, failure)) => terminal::complain(&name, &failure),
                None => terminal::usage(&error),
            };
        }
    };
    let (name, outcome) = arguments.run();
    match outcome {
        Ok(outcome) => terminal::show(&outcome),
        Err(failure) => terminal::complain(name, &failure),
    }
}

/// Prevents a panic message on the terminal: a panic of a library that reads a corrupt log becomes an error that names
/// the file.
fn hush() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !rne_logs::is_guarded() {
            usual(info);
        }
    }));
}
