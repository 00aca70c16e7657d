//! `rne watch`: what happens to an arm, and what does not.

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
