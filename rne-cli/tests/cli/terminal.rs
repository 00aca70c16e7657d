//! What a pipe gets: no colours, and no panic when it closes early.

use std::io::Read as _;
use std::process::Stdio;

use crate::call::{command, fine, rne};

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
    assert_eq!(commands.len(), 6);
    for line in commands {
        // the remark behind a command stands two blanks away
        let line = line.split("  ").next().unwrap_or_default().replace('*', "planar1");
        let arguments: Vec<&str> = line.split(' ').collect();
        assert!(!fine(&arguments).is_empty(), "{line}");
    }
}
