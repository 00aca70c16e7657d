//! `rne check --repair`: proposes repairs of masses and inertias that no body has, as changes of the file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rne_convert::Description;
use rne_convert::repair::{Body, Candidate, Proposal, bodies_of, proposals, written};

use crate::files::input_file;
use crate::files::output_file;
use crate::outcome::{Failure, Outcome};
use crate::palette::{ERROR, FOUND, GOOD, QUIET, WARNING};

/// Largest number of less likely edits that are named.
const NAMED: usize = 3;

pub(super) fn run(files: &[PathBuf], writes: bool) -> Result<Outcome, Failure> {
    let (mut text, mut at_fault) = (String::new(), false);
    // a plan has no bodies
    for path in files.iter().filter(|path| rne_model::robot_of(path).is_none()) {
        match file(path, writes) {
            Ok((found, is_fine)) => {
                text.push_str(&found);
                at_fault |= !is_fine;
            }
            Err(failure) if files.len() == 1 => return Err(failure),
            Err(failure) => {
                let _ = writeln!(text, "{}", failure.text);
                at_fault = true;
            }
        }
    }
    Ok(Outcome { text, at_fault, ..Outcome::default() })
}

/// Returns what is to say of one file, and whether it needs no repair any more.
fn file(path: &Path, writes: bool) -> Result<(String, bool), Failure> {
    let (bytes, is_file) = match Description::open_by(path, input_file::open).map_err(Failure::input)? {
        Description::Shipped(robot) => (robot.yaml.as_bytes().to_vec(), false),
        Description::RobotFile(bytes) | Description::Urdf(bytes) => (bytes, !input_file::is_stream(path)),
        _ => return Err(input_error!("{} is not a robot file", path.display())),
    };
    let name = input_file::name(path);
    let Ok(whole) = String::from_utf8(bytes) else {
        return Err(input_error!("{name} is not text in UTF-8; save the file with this encoding"));
    };
    let mark = if whole.starts_with('\u{FEFF}') { '\u{FEFF}'.len_utf8() } else { 0 };
    let text = &whole[mark..];
    let bodies = bodies_of(&name, text).map_err(|report| Failure::from(&report))?;
    let found = proposals(&bodies);
    if found.is_empty() {
        let s = if bodies.len() == 1 { "" } else { "s" };
        let about = format!("{} link{s}, no edit of a mass or an inertia to propose", bodies.len());
        return Ok((format!("{GOOD}ok{GOOD:#} {name}  {QUIET}{about}{QUIET:#}\n"), true));
    }
    let mut shown = String::new();
    for proposal in &found {
        shown.push_str(&described(&name, text, &bodies, proposal));
    }
    if !writes {
        return Ok((shown, false));
    }
    if !is_file {
        return Err(input_error!("{name} is no file that can be changed; write it into a file first"));
    }
    let Some(new) = rewritten(text, &bodies, &found) else {
        let unclear = found.iter().filter(|proposal| proposal.repair().is_none());
        let unclear: Vec<String> = unclear.map(|it| rne_model::one_line(&bodies[it.body].name)).collect();
        let why = match &unclear[..] {
            [] => "two repairs change the same numbers".to_owned(),
            [one] => format!("link `{one}` does not have exactly one repair"),
            several => format!("the links {} do not have exactly one repair each", several.join(", ")),
        };
        let _ = writeln!(
            shown,
            "{ERROR}error{ERROR:#}: {name} is not changed, because {why}; change these links in the file yourself, and \
             run the command again"
        );
        return Ok((shown, false));
    };
    output_file::replace(path, &format!("{}{new}", &whole[..mark]))?;
    let _ = writeln!(shown, "{GOOD}repaired{GOOD:#} {name}");
    Ok((shown, true))
}

/// Returns the text with all repairs, if each link has exactly one, and no two change the same element.
fn rewritten(text: &str, bodies: &[Body], found: &[Proposal]) -> Option<String> {
    let repairs: Option<Vec<&Candidate>> = found.iter().map(Proposal::repair).collect();
    written(text, bodies, repairs?)
}

/// Describes a link that needs a repair: the place, what is wrong, and the edits as changes of lines.
fn described(name: &str, text: &str, bodies: &[Body], proposal: &Proposal) -> String {
    let body = &bodies[proposal.body];
    let [line, column] = proposal.place(text, bodies);
    let failed: Vec<&str> = proposal.failed.iter().map(|test| test.sentence()).collect();
    let link = rne_model::one_line(&body.name);
    let failed = failed.join(", and ");
    let mut shown = format!("{name}:{line}:{column}: {WARNING}warning{WARNING:#}: link `{link}`: {failed}\n");
    match proposal.equal {
        0 => {
            let _ = writeln!(shown, "  no single edit repairs this link; compare it with the source of its numbers");
        }
        1 => {}
        equal => {
            let _ = writeln!(shown, "  {equal} edits are equally good; compare each with the source of the numbers:");
        }
    }
    for (index, candidate) in proposal.candidates.iter().take(proposal.equal).enumerate() {
        let number = if proposal.equal > 1 { format!("{}. ", index + 1) } else { String::new() };
        let _ = writeln!(shown, "  {number}{}", rne_model::one_line(&candidate.what));
        edit(&mut shown, text, bodies, candidate);
    }
    let others = proposal.candidates.iter().skip(proposal.equal);
    let others: Vec<String> = others.take(NAMED).map(|other| rne_model::one_line(&other.what)).collect();
    if !others.is_empty() {
        let _ = writeln!(shown, "  {QUIET}less likely: {}{QUIET:#}", others.join("; "));
    }
    shown
}

/// Shows the lines that an edit removes and adds.
fn edit(shown: &mut String, text: &str, bodies: &[Body], candidate: &Candidate) {
    for diff in candidate.diffs(text, bodies) {
        for line in text[diff.span.clone()].lines() {
            let _ = writeln!(shown, "  {ERROR}- {}{ERROR:#}", rne_model::one_line(line));
        }
        for line in diff.new.lines() {
            let _ = writeln!(shown, "  {FOUND}+ {}{FOUND:#}", rne_model::one_line(line));
        }
    }
    for test in &candidate.failed {
        let _ = writeln!(shown, "  this edit is not enough: {}", test.sentence());
    }
}
