//! What a pipe gets: no colours, and no panic when it closes early.

use std::io::Read as _;
use std::process::Stdio;

use crate::call::{command, fine, folder, rne};

#[test]
fn pipes_get_plain_text() {
    let robot = "robots/puma560.yaml";
    for arguments in [
        &[][..],
        &["check", robot],
        &["show", robot],
        &["emit", robot],
        &["ops", robot],
        &["eval", "robots/planar1.yaml", "--q", "1", "--qd", "1", "--qdd", "1", "--trace"],
    ] {
        assert!(!fine(arguments).contains('\u{1B}'), "{arguments:?}");
    }
    assert!(!rne(&["show", "nowhere"]).err.contains('\u{1B}'));
}

#[test]
fn colours_where_they_are_forced() {
    let output = command(&["show", "robots/planar1.yaml"]).env("CLICOLOR_FORCE", "1").output().expect("rne starts");
    assert!(String::from_utf8_lossy(&output.stdout).contains("\u{1B}[1m"));
}

/// The lines of a listing that begin so, without the sequence of their colour, and that sequence.
fn coloured(arguments: &[&str], start: &str) -> Vec<String> {
    let output = command(arguments).env("CLICOLOR_FORCE", "1").output().expect("rne starts");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let lines = text.lines().filter_map(|line| line.split_once(start)).map(|(colour, _)| colour.to_owned());
    lines.collect()
}

#[test]
fn colours_say_what_a_line_is() {
    let (formula, found) = ("\u{1B}[36m", "\u{1B}[32m");
    // step 2 of the reduced form has two formulas
    let reduced = coloured(&["show", "robots/puma560.yaml", "--form", "reduced", "--without", "rewriting"], "    // U");
    assert!(!reduced.is_empty() && reduced.iter().all(|colour| colour == formula), "{reduced:?}");
    // the second line of a finding that begins with a number is no count of what folded
    let broken = coloured(&["show", "robots/planar1.yaml"], "    //   0");
    assert!(!broken.is_empty() && broken.iter().all(|colour| colour == found), "{broken:?}");
}

#[test]
fn a_reader_that_goes_away() {
    let mut child = command(&["emit", "robots/wam7.yaml"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("rne starts");
    // more than a pipe holds is to come, and nobody reads it
    let mut first = [0; 16];
    child.stdout.take().expect("a pipe").read_exact(&mut first).expect("a beginning");
    let output = child.wait_with_output().expect("rne ends");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn the_tour_is_computed_and_fits() {
    let tour = fine(&[]);
    for part in ["Unimate PUMA 560", "inverse_dynamics_with_wrench", "6 of 6 torques are equal to the last bit"] {
        assert!(tour.contains(part), "no `{part}` in {tour}");
    }
    let dots = |c: &char| ('\u{300}'..='\u{36F}').contains(c);
    for line in tour.lines() {
        // sentences and rules fit every terminal, code is as wide as rustfmt makes it
        let is_code = line.starts_with(' ') || line.contains(" mul ") || line.contains("  qd ");
        let most = if is_code { 100 } else { 80 };
        assert!(line.chars().filter(|c| !dots(c)).count() <= most, "too wide: {line}");
    }
}

#[test]
fn commands_of_the_tour_work() {
    let tour = fine(&[]);
    let commands: Vec<&str> = tour.lines().filter_map(|line| line.strip_prefix("  cargo run -- ")).collect();
    assert_eq!(commands.len(), 7);
    for line in commands {
        // the remark behind a command stands two blanks away
        let line = line.split("  ").next().unwrap_or_default().replace('*', "planar1");
        let arguments: Vec<&str> = line.split(' ').collect();
        assert!(!fine(&arguments).is_empty(), "{line}");
    }
}

/// A folder may hold files with any name.
#[test]
#[cfg(unix)]
fn the_name_of_a_file_is_no_command() {
    let folder = folder("names");
    let file = folder.join("arm\u{1B}]0;title\u{7}\u{9B}2J\u{202E}.yaml");
    std::fs::write(&file, "format: 1\nname: \"\\e[2J\\u202E\"\n").expect("written");
    for colour in [false, true] {
        let mut command = command(&["check", file.to_str().expect("UTF-8")]);
        if colour {
            command.env("CLICOLOR_FORCE", "1");
        }
        let output = command.output().expect("rne starts");
        let text = String::from_utf8(output.stdout).expect("UTF-8").replace("\u{1B}[0m", "");
        assert!(text.contains("arm\u{FFFD}]0;title\u{FFFD}"), "{text:?}");
        assert_eq!(text.contains('\u{1B}'), colour, "{text:?}");
        let controls: Vec<&str> = text.split('\u{1B}').skip(1).filter(|rest| !rest.starts_with('[')).collect();
        assert!(controls.is_empty() && !text.contains(['\u{7}', '\u{9B}', '\u{202E}']), "{text:?}");
        assert!(!text.contains("[2J\u{1B}") && !text.contains("\u{1B}[2J"), "{text:?}");
    }
}
