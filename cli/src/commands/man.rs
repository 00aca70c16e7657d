//! `rne man`: prints or writes the manual pages.

use std::fs;
use std::io;
use std::path::PathBuf;

use clap::{Args, Command, CommandFactory as _};

use crate::commands;
use crate::files::output_file::{self, Existing, is_standard_output};
use crate::outcome::{Failure, Outcome};
use crate::palette::TYPED;

/// Print the manual page, or write the pages of all commands
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne man | man -l -                     show the page
  rne man eval | man -l -                the page of a command
  rne man -o ~/.local/share/man/man1     all pages, for `man rne-eval`")]
pub(crate) struct Arguments {
    /// Print the page of this command [default: the page of rne]
    #[arg(value_name = "COMMAND", conflicts_with_all = ["output", "force"])]
    command: Option<String>,
    /// Write the pages of rne and of all its commands to this folder, which is made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Overwrite files of the folder that are not the same pages
    #[arg(long, requires = "output")]
    force: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let pages = pages().map_err(Failure::input)?;
    let Some(folder) = &arguments.output else {
        let wanted = arguments.command.as_ref().map_or("rne".to_owned(), |command| format!("rne-{command}"));
        let page = pages.iter().find(|(name, _)| *name == wanted).map(|(_, page)| page.clone());
        return page.map(Outcome::text).ok_or_else(|| {
            let names: Vec<&str> = pages.iter().filter_map(|(name, _)| name.strip_prefix("rne-")).collect();
            usage_error!("{wanted} has no page; the commands are {}", names.join(", "))
        });
    };
    let shown = folder.display();
    match output_file::existing(folder) {
        Existing::Folder => {}
        _ if is_standard_output(folder) => {
            return Err(usage_error!(
                "-o needs the name of a folder for the pages; {TYPED}rne man{TYPED:#} and {TYPED}rne man \
                 COMMAND{TYPED:#} print one page"
            ));
        }
        Existing::Nothing => fs::create_dir_all(folder).map_err(|error| output_file::unwritable(folder, &error))?,
        Existing::Unreadable(error) => return Err(output_file::unreadable(folder, &error)),
        Existing::Text(_) | Existing::Other | Existing::Special => {
            return Err(usage_error!("{shown} is not a folder; name the folder of the pages"));
        }
    }
    let files: Vec<_> = pages.iter().map(|(name, page)| (folder.join(format!("{name}.1")), page)).collect();
    for (file, page) in &files {
        output_file::check_new(file, Some(page), &[], arguments.force)?;
    }
    output_file::write_all(&files).map(Outcome::remark)
}

/// Returns the manual pages, beginning with that of rne itself: their file names and texts.
fn pages() -> io::Result<Vec<(String, String)>> {
    let mut root = commands::Arguments::command().disable_help_subcommand(true);
    root.build();
    let mut pages = vec![("rne".to_owned(), page(root.clone(), "rne")?)];
    for command in root.get_subcommands() {
        let name = format!("rne-{}", command.get_name());
        pages.push((name.clone(), page(command.clone(), &name)?));
    }
    Ok(pages)
}

fn page(command: Command, title: &str) -> io::Result<String> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).title(title).render(&mut page)?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
