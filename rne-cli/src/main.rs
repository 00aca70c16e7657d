//! The command line of rne: a thin shell over functions that take arguments and return text.
#![forbid(unsafe_code)]

mod answer;
mod arguments;
mod arm;
mod base_parameters;
mod check;
mod closed_form;
mod compare;
mod convert;
mod csv_table;
mod diagnose;
mod emit;
mod equations;
mod eval;
mod example;
mod excite;
mod explain;
mod export;
mod file_name;
mod firmware;
mod functions;
mod golden;
mod heading;
mod highlight;
mod identify;
mod import;
mod input_file;
mod interruption;
mod layout;
mod letters;
mod limits;
mod list;
mod log;
mod log_arguments;
mod log_report;
mod mistyped;
mod motion_log;
mod new;
mod numbers;
mod ops;
mod outcome;
mod output_file;
mod output_folder;
mod physics;
mod plan_file;
mod plot;
mod reading;
mod report;
mod robot_file;
mod search;
mod shell;
mod show;
mod state;
mod state_results;
mod state_table;
mod states;
mod terminal;
mod tour;
mod trajectory_file;
mod watch;
mod worksheet;
mod worksheet_file;

use std::env;
use std::panic;
use std::process::ExitCode;

use clap::Parser as _;

use crate::arguments::{Arguments, Command};
use crate::outcome::{Failure, Outcome};

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
    let (name, outcome) = run(arguments.command);
    match outcome {
        Ok(outcome) => terminal::show(&outcome),
        Err(failure) => terminal::complain(name, &failure),
    }
}

/// A panic of a library that reads a corrupt log becomes an error with the file's name: nothing is printed of it.
fn hush() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !rne_logs::is_guarded() {
            usual(info);
        }
    }));
}

/// The command's name, as its help is asked for, and what it returned.
fn run(command: Option<Command>) -> (&'static str, Result<Outcome, Failure>) {
    match command {
        None => ("rne", tour::run()),
        Some(Command::Check(arguments)) => ("rne check", Ok(check::run(&arguments))),
        Some(Command::Show(arguments)) => ("rne show", show::run(&arguments)),
        Some(Command::Emit(arguments)) => ("rne emit", emit::run(&arguments)),
        Some(Command::Ops(arguments)) => ("rne ops", ops::run(&arguments)),
        Some(Command::Eval(arguments)) => ("rne eval", eval::run(&arguments)),
        Some(Command::Diagnose(arguments)) => ("rne diagnose", diagnose::run(&arguments)),
        Some(Command::Plot(arguments)) => ("rne plot", plot::run(&arguments)),
        Some(Command::Identify(arguments)) => ("rne identify", identify::run(&arguments)),
        Some(Command::Watch(arguments)) => ("rne watch", watch::run(&arguments)),
        Some(Command::Excite(arguments)) => ("rne excite", excite::run(&arguments)),
        Some(Command::List(_)) => ("rne list", list::run()),
        Some(Command::Example(arguments)) => ("rne example", example::run(&arguments)),
        Some(Command::New(arguments)) => ("rne new", new::run(&arguments)),
        Some(Command::Log(arguments)) => ("rne log", log::run(&arguments)),
        Some(Command::Search(arguments)) => ("rne search", search::run(&arguments)),
        Some(Command::Import(arguments)) => ("rne import", import::run(&arguments)),
        Some(Command::Convert(arguments)) => ("rne convert", convert::run(&arguments)),
        Some(Command::Export(arguments)) => ("rne export", export::run(&arguments)),
        Some(Command::Report(arguments)) => ("rne report", report::run(&arguments)),
        Some(Command::Firmware(arguments)) => ("rne firmware", firmware::run(&arguments)),
        Some(Command::Explain(arguments)) => ("rne explain", explain::run(&arguments)),
        Some(Command::Completions(arguments)) => ("rne completions", Ok(shell::completions(&arguments))),
        Some(Command::Man(arguments)) => ("rne man", shell::man(&arguments)),
    }
}
