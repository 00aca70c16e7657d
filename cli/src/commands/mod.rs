//! The grammar of the command line: a module for each command, with its `Arguments` and the function `run` that
//! executes it.
//!
//! `tour` is what `rne` does without a command. Some modules are parts of commands: `closed_form` of `show`,
//! `residuals` of `log`; `identify` and `watch` share `prediction_errors`.

mod certify;
mod check;
mod completions;
mod convert;
mod emit;
mod eval;
mod example;
mod export;
mod firmware;
mod fmu;
mod import;
mod list;
mod logs;
mod man;
mod new;
mod ops;
mod search;
mod teaching;
mod toolchain;

use clap::{Parser, Subcommand};

use logs::{excite, identify, log, watch};
use teaching::{diagnose, explain, mark, plot, report, show, tour, worksheet};

use crate::outcome::{Failure, Outcome};
use crate::palette::{HELP_STYLES, TITLE, TYPED};

/// The dynamics compiler for robot arms.
#[derive(Parser)]
#[command(name = "rne", version, styles = HELP_STYLES)]
#[command(about = "The dynamics compiler for robot arms: a DH table in, straight-line code out")]
#[command(max_term_width = 80, help_template = page())]
#[command(after_help = "\
Examples:
  rne check robots/*.yaml                   check files
  rne show robots/puma560.yaml --joint 2    show the code of joint 2
  rne emit robots/puma560.yaml --lang c     write C99 code

FILE is a robot file or a name from `rne list`. `rne explain exit-status` lists
the exit statuses. Without a command rne prints a tour of the PUMA 560.")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

/// Returns the help of rne itself: that of the parser, but with both options on one line, because a page has 40 lines.
fn page() -> String {
    // the styles of the text that the parser makes
    let (title, typed) = (TITLE.0, TYPED.0);
    format!(
        "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{title}Commands:{title:#}\n{{subcommands}}\n\n\
         {title}Options:{title:#} {typed}-h{typed:#}, {typed}--help{typed:#}  Print help   \
         {typed}-V{typed:#}, {typed}--version{typed:#}  Print version{{after-help}}"
    )
}

impl Arguments {
    /// Runs the command; returns its name for messages about its help, and its result.
    pub(crate) fn run(&self) -> (&'static str, Result<Outcome, Failure>) {
        self.command.as_ref().map_or_else(|| ("rne", tour::run()), Command::run)
    }
}

/// Makes `Command` from pairs of a variant and the module that runs it, in the order of the help. clap makes the name
/// of a command from the name of its variant.
macro_rules! commands {
    ($($name:ident $module:ident,)*) => {
        #[derive(Subcommand)]
        #[allow(clippy::large_enum_variant)] // there is one, which is read once
        pub(crate) enum Command {
            $($name($module::Arguments),)*
        }

        impl Command {
            fn run(&self) -> (&'static str, Result<Outcome, Failure>) {
                match self {
                    $(Self::$name(arguments) => (concat!("rne ", stringify!($module)), $module::run(arguments)),)*
                }
            }
        }
    };
}

commands! {
    Check check,
    Show show,
    Emit emit,
    Certify certify,
    Ops ops,
    Report report,
    Eval eval,
    Worksheet worksheet,
    Mark mark,
    Diagnose diagnose,
    Plot plot,
    Log log,
    Identify identify,
    Watch watch,
    Excite excite,
    Search search,
    New new,
    List list,
    Example example,
    Import import,
    Convert convert,
    Export export,
    Firmware firmware,
    Explain explain,
    Completions completions,
    Man man,
}
