//! `rne list`: lists the shipped robots.

use clap::Args;
use rne_model::Reader;

use crate::outcome::{Failure, Outcome};
use crate::palette::{QUIET, TYPED};
use crate::render::heading::about;
use crate::render::layout::{left, shortened, width};
use crate::terminal;

/// List the shipped robots, whose names stand for their files
#[derive(Args)]
#[command(after_help = "\
Examples:
  rne list
  rne show panda                       a robot of the list, by its name
  rne example panda > my_panda.yaml    its file, to change it

If there is a file with the name that you type, rne reads the file and not the
shipped robot. In a Rust crate, write #[robot(builtin = \"panda\")].")]
pub(crate) struct Arguments {}

pub(crate) fn run(_: &Arguments) -> Result<Outcome, Failure> {
    let mut rows = Vec::new();
    for file in rne_robots::all() {
        let robot =
            Reader::new(file.name).trees().couplings().read(file.yaml).map_err(|report| Failure::from(&report))?.robot;
        let title = robot.title.clone().unwrap_or_default();
        let kinds = about(&robot);
        let kinds = kinds.strip_prefix(&format!("{}, ", file.name)).unwrap_or(&kinds);
        rows.push((file.name, kinds.to_owned(), title));
    }
    Ok(Outcome::text(table(&rows, terminal::room())))
}

/// Returns a line for each robot: name, joints with convention, title. The title is shortened if a line is wider than
/// `room` columns.
fn table(rows: &[(&str, String, String)], room: usize) -> String {
    let names = rows.iter().map(|(name, ..)| width(name)).max().unwrap_or(0);
    let widest = rows.iter().map(|(_, kinds, _)| width(kinds)).max().unwrap_or(0);
    let line = |(name, kinds, title): &(&str, String, String)| {
        let title = shortened(title, room.saturating_sub(names + widest + 4));
        format!("{TYPED}{}{TYPED:#}  {QUIET}{}{QUIET:#}  {title}\n", left(name, names), left(kinds, widest))
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_give_way() {
        let row = |name, title: &str| (name, "RR, standard".to_owned(), title.to_owned());
        let rows = [row("arm", "An arm"), row("elbow", "Ein Arm, über den man lange reden kann")];
        let lines = |room| {
            let text = anstream::adapter::strip_str(&table(&rows, room)).to_string();
            text.lines().map(str::to_owned).collect::<Vec<_>>()
        };
        let whole = ["arm    RR, standard  An arm", "elbow  RR, standard  Ein Arm, über den man lange reden kann"];
        assert_eq!(lines(100), whole);
        assert_eq!(lines(width(whole[1])), whole, "just wide enough");
        assert_eq!(lines(width(whole[1]) - 1)[1], "elbow  RR, standard  Ein Arm, über den man lange reden ka…");
        for room in 30..60 {
            assert!(lines(room).iter().all(|line| width(line) <= room), "{room}: {:?}", lines(room));
        }
        assert_eq!(lines(1).len(), 2);
    }
}
