//! What a pipe gets: no colours, and no panic when it closes early.

use std::io::Read as _;
use std::process::Stdio;

use crate::call::{ROOT, command, fine, folder, rne};

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

/// What a terminal gets of a call, and the sequences in it that this project has no use for.
#[cfg(unix)]
fn foreign_sequences(arguments: &[&str]) -> (String, Vec<String>) {
    let output = command(arguments).env("CLICOLOR_FORCE", "1").output().expect("rne starts");
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8(text).expect("UTF-8");
    let sequences = text.split('\u{1B}').skip(1).map(|rest| rest.split_inclusive('m').next().unwrap_or_default());
    // the palette, and that of messages with a line of a file
    let is_ours = |sequence: &str| {
        let parameters = sequence.strip_prefix('[').and_then(|rest| rest.strip_suffix('m'));
        let known = ["0", "1", "2", "31", "32", "33", "36", "91", "92", "93", "94", "96"];
        parameters.is_some_and(|parameters| known.contains(&parameters))
    };
    let foreign = sequences.filter(|sequence| !is_ours(sequence)).map(str::to_owned).collect();
    (text, foreign)
}

/// Colours in names of joints, columns, files and words: none of them reaches a terminal, nor a part of the palette
/// that would close the colour of a message or begin that of another.
#[test]
#[cfg(unix)]
fn colours_of_names_are_no_colours() {
    let folder = folder("coloured");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    // 8 conceals; 5;35;41 is in no palette
    let of_line = |line: &str| match line {
        "  - name: j1" => "  - name: \"\\e[8mj1\"".to_owned(),
        line if line.starts_with("title: ") => "title: \"a \\e[5;35;41mtitle\"".to_owned(),
        line => line.to_owned(),
    };
    let arm = std::fs::read_to_string(format!("{ROOT}/robots/planar2.yaml")).expect("a robot");
    let named = arm.lines().map(of_line).collect::<Vec<_>>().join("\n");
    assert_eq!(named.matches("\\e[").count(), 2, "{named}");
    std::fs::write(path("arm.yaml"), &named).expect("written");
    let hidden = path("\u{1B}[8mhidden.yaml");
    std::fs::write(&hidden, &named).expect("written");
    let log = path("log.csv");
    let row = |at: i32| {
        let time = f64::from(at) * 0.01;
        format!("{time},{},{}", (2.0 * time).sin(), (3.0 * time).sin())
    };
    let rows: Vec<String> = (0..400).map(row).collect();
    let text = format!("t,\u{1B}[8mfirst_position,\u{1B}[5;35;41msecond_position\n{}\n", rows.join("\n"));
    std::fs::write(&log, text).expect("written");
    let arm = path("arm.yaml");
    let concealed = "\u{1B}[8mword";
    let calls: [&[&str]; 14] = [
        &["check", &arm],
        &["check", &hidden],
        &["show", &arm],
        &["show", &hidden],
        &["ops", &hidden],
        &["report", &arm, "-o", &hidden],
        &["eval", &arm, "--q", "9,9", "--qd", "0,0", "--qdd", "0,0", "--trace"],
        &["log", &log],
        &["log", &log, "--robot", &arm],
        &["log", &log, "--joints", concealed],
        &["identify", &arm, &log],
        &["explain", concealed],
        &["list", concealed],
        &["emit", concealed],
    ];
    for call in calls {
        let (text, foreign) = foreign_sequences(call);
        assert!(foreign.is_empty(), "{call:?}: {foreign:?} in {text}");
    }
    // shown, so that the reader sees what the name is
    let (text, _) = foreign_sequences(&["explain", concealed]);
    assert!(text.contains("`\u{FFFD}[8mword`"), "{text:?}");
    // a part of the palette is shown too
    let (text, _) = foreign_sequences(&["explain", "\u{1B}[31mword"]);
    assert!(text.contains("`\u{FFFD}[31mword`"), "{text:?}");
}
