//! `rne watch`: what happens to an arm, and what does not.

use std::fmt::Write as _;
use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};

const ARM: &str = "docs/desk_arm_identified.yaml";
const QUIET: &str = "docs/desk_arm_log.csv";
const KNOCK: &str = "docs/desk_arm_knock.csv";

#[test]
fn free_motion_has_no_event_and_a_knock_is_one() {
    let text = fine(&["watch", ARM, QUIET]);
    assert!(text.contains("\nno events\n") && text.contains("median"), "{text}");
    let output = rne(&["watch", ARM, KNOCK, "--quiet", QUIET, "--json"]);
    assert_eq!(output.status, 1, "{}", output.err);
    let reply: serde_json::Value = serde_json::from_str(&output.out).expect("JSON");
    let events = reply["events"].as_array().expect("a list");
    let of = |joint: u64| events.iter().find(|event| event["joint"] == joint && event["test"] == "external");
    // 2.2 and 1.6 N m for half a second from 9.2 s on
    for (joint, peak) in [(2, -2.2), (3, -1.6)] {
        let event = of(joint).unwrap_or_else(|| panic!("{reply}"));
        let number = |key: &str| event[key].as_f64().expect("a number");
        assert!((number("peak") - peak).abs() < 0.1, "{event}");
        assert!((9.1..9.4).contains(&number("start")) && (9.5..9.8).contains(&number("end")), "{event}");
    }
    assert!(events.iter().all(|event| event["joint"] != 1), "{reply}");
    assert!(reply["joints"][0]["error"].as_f64().is_some_and(|error| error < 0.02), "{reply}");
}

/// Two logs whose times begin at the same number: events of one are not those of the other.
#[test]
fn events_belong_to_their_run() {
    let folder = folder("watch_runs");
    let again = folder.join("again.csv");
    fs::copy(format!("{ROOT}/{KNOCK}"), &again).expect("a copy");
    let again = again.to_str().expect("UTF-8");
    let reply = |arguments: &[&str]| -> serde_json::Value {
        let called = rne(&[&["watch", ARM], arguments, &["--quiet", QUIET, "--json"]].concat());
        assert_eq!(called.status, 1, "{}", called.err);
        serde_json::from_str(&called.out).expect("JSON")
    };
    let events = |reply: &serde_json::Value, run: u64| -> Vec<serde_json::Value> {
        let all = reply["events"].as_array().expect("a list").iter();
        all.filter(|event| event["run"] == run).map(|event| event["peak"].clone()).collect()
    };
    let (one, two) = (reply(&[KNOCK]), reply(&[KNOCK, again]));
    assert!(!events(&one, 1).is_empty());
    assert_eq!(events(&two, 1), events(&one, 1));
    assert_eq!(events(&two, 2), events(&one, 1));
    let text = rne(&["watch", ARM, KNOCK, again, "--quiet", QUIET]).out;
    assert!(text.contains("run 1: 9.") && text.contains("run 2: 9."), "{text}");
}

/// Pieces have no border in the account: a log that is longer than one, with a hand where they meet.
#[test]
fn a_long_log_is_one() {
    let folder = folder("watch_long");
    let (robot, log) = (folder.join("rod.yaml"), folder.join("long.csv"));
    let file = r"
format: 1
name: rod
source: own
convention: standard
gravity: [0, -9.81, 0]
joints:
  - type: revolute
    dh: {theta: 0, d: 0, a: 0.5, alpha: 0}
    link: {mass: 2, com: [-0.25, 0, 0], inertia: {zz: 0.05}}
";
    fs::write(&robot, file).expect("a file");
    // 2 kg at 0.25 m; 0.05 + 2 (0.25)² kg m² about the hinge
    let mut text = "time,q1,qd1,tau1\n".to_owned();
    for state in 0..70_000_u32 {
        let time = f64::from(state) * 0.002;
        let (q, qd, qdd) = ((0.7 * time).sin(), 0.7 * (0.7 * time).cos(), -0.49 * (0.7 * time).sin());
        let ripple = 0.02 * f64::from(state.wrapping_mul(2_654_435_761) >> 16) / 65_536.0;
        // the piece ends at 131 s
        let hand = if (130.8..131.4).contains(&time) { 1.0 } else { 0.0 };
        let tau = 0.175 * qdd + 2.0 * 9.81 * 0.25 * q.cos() + ripple + hand;
        writeln!(text, "{time:.3},{q:.6},{qd:.6},{tau:.5}").expect("a text grows");
    }
    fs::write(&log, text).expect("a file");
    let path = |path: &std::path::Path| path.to_str().expect("UTF-8").to_owned();
    let called = rne(&["watch", &path(&robot), &path(&log), "--json"]);
    assert_eq!(called.status, 1, "{}", called.err);
    let reply: serde_json::Value = serde_json::from_str(&called.out).expect("JSON");
    let events = reply["events"].as_array().expect("a list");
    let external: Vec<_> = events.iter().filter(|event| event["test"] == "external").collect();
    assert_eq!(external.len(), 1, "{reply}");
    let number = |key: &str| external[0][key].as_f64().expect("a number");
    assert!((130.7..130.9).contains(&number("start")) && (131.3..131.6).contains(&number("end")), "{reply}");
    assert!((number("peak") + 1.0).abs() < 0.15, "{reply}");
}

#[test]
fn the_picture_has_the_events() {
    let folder = folder("watch_picture");
    let picture = folder.join("knock.svg");
    let path = picture.to_str().expect("UTF-8");
    let output = rne(&["watch", ARM, KNOCK, "--plot", path]);
    assert_eq!(output.status, 1, "{}", output.err);
    let svg = fs::read_to_string(&picture).expect("a picture");
    assert!(svg.contains("external, peak -2.1") && svg.contains("prediction error"), "{svg}");
    // once more is the same; another picture is not written over it
    assert_eq!(rne(&["watch", ARM, KNOCK, "--plot", path]).status, 1);
    fails(2, &["watch", ARM, QUIET, "--plot", path], &["--force"]);
    assert_eq!(fs::read_to_string(&picture).expect("a picture"), svg);
}

/// A model that explains nothing is no quiet arm.
#[test]
fn another_arm_is_not_in_order() {
    let folder = folder("watch_other");
    let other = folder.join("other.yaml");
    let file = fs::read_to_string(format!("{ROOT}/docs/desk_arm.yaml")).expect("a file");
    fs::write(&other, file.replace("[0, 0, -9.81]", "[9.81, 0, 0]")).expect("a file");
    let called = rne(&["watch", other.to_str().expect("UTF-8"), QUIET]);
    assert_eq!(called.status, 1, "{}", called.out);
    assert!(called.err.contains("warning") && called.err.contains("shoulder"), "{}", called.err);
}

/// A channel of zeros, or of one number, is no arm in order.
#[test]
fn a_dead_channel_is_not_in_order() {
    let folder = folder("watch_dead");
    let log = fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log");
    for (columns, effort, said) in [
        (8..9, "0", "shoulder: does FILE"),
        (7..10, "0", "waist, shoulder, elbow: does"),
        (8..9, "3.3", "shoulder: does FILE"),
    ] {
        let dead = log.lines().enumerate().map(|(at, line)| {
            let cell = |(index, cell)| if at > 0 && columns.contains(&index) { effort } else { cell };
            line.split(',').enumerate().map(cell).collect::<Vec<_>>().join(",") + "\n"
        });
        let path = folder.join("dead.csv");
        fs::write(&path, dead.collect::<String>()).expect("a file");
        let called = rne(&["watch", ARM, path.to_str().expect("UTF-8")]);
        assert_eq!(called.status, 1, "{}", called.out);
        assert!(called.said().contains(&format!("the model explains nothing of the torques of {said}")), "{called:?}");
    }
}

/// The errors of a watch are those of a judge, whatever is usual.
#[test]
fn errors_are_those_of_a_judge() {
    let judged = fine(&["identify", ARM, KNOCK, "--judge", "--all"]);
    let (_, judged) = judged.split_once("error: RMS of").expect("a table");
    for more in [&[][..], &["--quiet", QUIET]] {
        let watched = rne(&[&["watch", ARM, KNOCK], more].concat());
        assert!(watched.out.ends_with(judged), "{}\n{judged}", watched.out);
    }
}

/// A run in which a judge's filter has no room is watched all the same.
#[test]
fn short_runs_are_watched() {
    let path = folder("watch_short").join("short.csv");
    let log = fs::read_to_string(format!("{ROOT}/{KNOCK}")).expect("a log");
    fs::write(&path, log.lines().take(61).collect::<Vec<_>>().join("\n") + "\n").expect("a file");
    let short = path.to_str().expect("UTF-8");
    fails(2, &["identify", ARM, short, "--judge", "--cutoff", "1"], &["--cutoff", "from"]);
    let text = fine(&["watch", ARM, short, "--quiet", QUIET, "--cutoff", "1"]);
    assert!(text.contains("no events") && text.contains("60 of 60 states"), "{text}");
}

/// What is usual of another arm is not what is usual of this one.
#[test]
fn a_quiet_log_of_another_arm_is_not_in_order() {
    let folder = folder("watch_other_quiet");
    let log = fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log");
    // efforts of another sign
    let turned = log.lines().enumerate().map(|(at, line)| {
        let sign = |(index, cell): (usize, &str)| match cell.strip_prefix('-') {
            _ if at == 0 || index < 7 => cell.to_owned(),
            Some(positive) => positive.to_owned(),
            None => format!("-{cell}"),
        };
        line.split(',').enumerate().map(sign).collect::<Vec<_>>().join(",") + "\n"
    });
    let other = folder.join("other.csv");
    fs::write(&other, turned.collect::<String>()).expect("a file");
    let called = rne(&["watch", ARM, QUIET, "--quiet", other.to_str().expect("UTF-8")]);
    assert_eq!(called.status, 1, "{}", called.out);
    let words = called.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("warning") && words.contains("shoulder") && words.contains("--quiet"), "{words}");
    assert!(!rne(&["watch", ARM, QUIET, "--quiet", QUIET]).err.contains("warning"));
}

/// A picture that cannot be written is refused before the logs are read.
#[test]
fn a_picture_without_a_place_is_refused_at_once() {
    let folder = folder("watch_no_place");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    fs::write(path("notes.txt"), "not a picture").expect("a file");
    for (status, name, words) in [(1, "none/knock.svg", "no folder"), (2, ".", "folder"), (2, "notes.txt", "--force")] {
        fails(status, &["watch", ARM, "there_is_none.csv", "--plot", &path(name)], &[words]);
    }
    fails(2, &["watch", ARM, QUIET, "--plot", QUIET], &["is the file that is read"]);
    // a place is tried, and left as it is
    fails(1, &["watch", ARM, "there_is_none.csv", "--plot", &path("knock.svg")], &["there_is_none.csv"]);
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 1);
}

#[test]
fn what_cannot_be_watched_is_said() {
    let folder = folder("watch_wrong");
    let log = fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log");
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).expect("a file");
        path.to_str().expect("UTF-8").to_owned()
    };
    let lines = |count: usize| log.lines().take(count).collect::<Vec<_>>().join("\n") + "\n";
    let short = write("short.csv", &lines(40));
    let empty = write("empty.csv", &lines(1));
    fails(1, &["watch", ARM, &empty], &["empty.csv"]);
    fails(1, &["watch", ARM, &short], &["--cutoff"]);
    fails(1, &["watch", ARM, &short, "--cutoff", "2"], &["too short"]);
    fails(1, &["watch", ARM, QUIET, "--quiet", &short], &["too short"]);
    fails(1, &["watch", ARM, "there_is_none.csv"], &["there_is_none.csv"]);
    fails(2, &["watch", "puma560", QUIET], &["the log has 3 joints, the robot 6"]);
    fails(2, &["watch", ARM, QUIET, "--gain", "0"], &["above 0"]);
    fails(2, &["watch", ARM, QUIET, "--hold", "NaN"], &["above 0"]);
    fails(2, &["watch", ARM, QUIET, "--false-alarms", "-1"], &["--false-alarms"]);
    fails(2, &["watch", ARM], &["LOG"]);
    let without = log.lines().map(|line| line.split(',').take(7).collect::<Vec<_>>().join(",") + "\n");
    let without = write("without.csv", &without.collect::<String>());
    fails(1, &["watch", ARM, &without], &["no efforts"]);
}
