//! `rne list`: the robots that are shipped.

use clap::Args;
use rne_model::Reader;
use rne_robots::ROBOTS;

use crate::check::about;
use crate::layout::{left, width};
use crate::outcome::{Failure, Outcome};
use crate::terminal::{QUIET, TYPED};

/// List the shipped robots, which every command knows by name
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne list
  rne show panda                       a robot of the list, by its name
  rne example panda > my_panda.yaml    its file, to change it

A file of that name comes first. In a crate: #[robot(builtin = \"panda\")].")]
pub(crate) struct Arguments {}

pub(crate) fn run() -> Result<Outcome, Failure> {
    let mut rows = Vec::new();
    for file in ROBOTS {
        let robot = Reader::new(file.name).read(file.yaml).map_err(|report| Failure::from(&report))?.robot;
        let title = robot.title.clone().unwrap_or_default();
        let kinds = about(&robot);
        let kinds = kinds.strip_prefix(&format!("{}, ", file.name)).unwrap_or(&kinds);
        rows.push((file.name, kinds.to_owned(), title));
    }
    let names = rows.iter().map(|(name, ..)| width(name)).max().unwrap_or(0);
    let widest = rows.iter().map(|(_, kinds, _)| width(kinds)).max().unwrap_or(0);
    let line = |(name, kinds, title): &(&str, String, String)| {
        format!("{TYPED}{}{TYPED:#}  {QUIET}{}{QUIET:#}  {title}\n", left(name, names), left(kinds, widest))
    };
    Ok(Outcome::text(rows.iter().map(line).collect()))
}
