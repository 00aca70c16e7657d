//! `rne completions`: prints the script with which a shell completes commands and options.

use clap::{Args, CommandFactory as _};
use clap_complete::Shell;

use crate::commands;
use crate::outcome::{Failure, Outcome};

/// Print a completion script for a shell
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne completions bash > ~/.local/share/bash-completion/completions/rne
  rne completions zsh > ~/.zfunc/_rne
  rne completions fish > ~/.config/fish/completions/rne.fish")]
pub(crate) struct Arguments {
    /// Shell for which rne prints the script
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

#[expect(clippy::unnecessary_wraps, reason = "what every command returns")]
pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut commands::Arguments::command(), "rne", &mut script);
    Ok(Outcome::text(String::from_utf8_lossy(&script).into_owned()))
}
