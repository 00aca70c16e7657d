//! `rne watch`: what has changed about an arm, and what has not.

use std::fmt::Write as _;
use std::fs;

use crate::call::{ROOT, fails, fine, folder, rne};

pub(crate) const ARM: &str = "docs/desk_arm_identified.yaml";
pub(crate) const QUIET: &str = "docs/desk_arm_log.csv";
pub(crate) const KNOCK: &str = "docs/desk_arm_knock.csv";
pub(crate) const WORN: &str = "docs/desk_arm_worn.csv";

pub(crate) fn json(arguments: &[&str], status: i32) -> serde_json::Value {
    let called = rne(&[&["watch", ARM], arguments, &["--json"]].concat());
    assert_eq!(called.status, status, "{}", called.err);
    serde_json::from_str(&called.out).expect("JSON")
}

pub(crate) fn events(reply: &serde_json::Value) -> &Vec<serde_json::Value> {
    reply["events"].as_array().expect("a list")
}

pub(crate) fn number(of: &serde_json::Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_else(|| panic!("{key} of {of}"))
}

#[test]
fn free_motion_has_no_event_and_a_knock_is_one() {
    let text = fine(&["watch", ARM, QUIET]);
    assert!(text.contains("\nno events\n") && text.contains("of its threshold"), "{text}");
    let reply = json(&[KNOCK, "--quiet", QUIET], 1);
    // 2.2 and 1.6 N m for half a second from 9.2 s on
    assert_eq!(events(&reply).len(), 1, "{reply}");
    let event = &events(&reply)[0];
    assert_eq!((&event["cause"], &event["joint"], &event["also"][0]), (&"contact".into(), &2.into(), &3.into()));
    assert!((number(event, "value") + 2.2).abs() < 0.1, "{event}");
    assert!((9.1..9.4).contains(&number(event, "since")) && (9.5..9.8).contains(&number(event, "until")), "{event}");
    assert!(number(&reply["joints"][0], "error") < 0.02, "{reply}");
}

/// 0.15 N m more friction of the elbow from 8 s on is one event, with its size and its time.
#[test]
fn wear_is_named() {
    let reply = json(&[WORN, "--quiet", QUIET], 1);
    assert_eq!(events(&reply).len(), 1, "{reply}");
    let event = &events(&reply)[0];
    assert_eq!(
        (&event["cause"], &event["name"], &event["parameter"]),
        (&"friction".into(), &"elbow".into(), &"coulomb".into())
    );
    let change = number(event, "value") - number(event, "baseline_value");
    assert!((change - 0.15).abs() < number(event, "half_interval"), "{event}");
    assert!((number(event, "file_value") - 0.2987).abs() < 1e-3 && change > number(event, "threshold"), "{event}");
    assert!((number(event, "since") - 8.0).abs() < 0.3, "{event}");
    assert_eq!((&event["lasts"], &event["unit"]), (&true.into(), &"N m".into()));
    // every other parameter has its margin
    let parameters = reply["parameters"].as_array().expect("a list");
    assert_eq!(parameters.len(), 13, "{reply}");
    for parameter in parameters {
        let ratio = number(parameter, "change").abs() / number(parameter, "threshold");
        assert!((ratio - number(parameter, "ratio")).abs() < 1e-12 && ratio < 1.0, "{parameter}");
    }
}

/// A baseline that was saved gives the numbers of its logs; one of another robot file is refused at its line.
#[test]
fn a_baseline_is_saved_and_used_again() {
    let folder = folder("watch_baseline");
    let path = folder.join("arm.baseline.yaml");
    let saved = path.to_str().expect("UTF-8");
    let before = json(&[WORN, "--quiet", QUIET, "--save-baseline", saved], 1);
    let after = json(&[WORN, "--baseline", saved], 1);
    assert_eq!((&before["events"], &before["parameters"]), (&after["events"], &after["parameters"]));
    // it is not written over without being asked
    fails(2, &["watch", ARM, WORN, "--quiet", KNOCK, "--save-baseline", saved], &["--force"]);
    let other = folder.join("other.yaml");
    let file = fs::read_to_string(format!("{ROOT}/{ARM}")).expect("a file");
    fs::write(&other, file.replace("viscous: 0.40409067", "viscous: 0.41")).expect("a file");
    let other = other.to_str().expect("UTF-8");
    fails(1, &["watch", other, WORN, "--baseline", saved], &["another robot file", "arm.baseline.yaml:"]);
    let text = fs::read_to_string(&path).expect("a baseline");
    for (from, to, said) in [
        ("cutoff: ", "cutoff: -", "above 0"),
        ("noise: [", "noise: [1.0, ", "`noise` has 4 numbers, but 3 are expected"),
        ("rows: ", "row: ", "`rows` is missing"),
        ("delay: ", "delay: x", "a number is expected"),
        ("format: 2", "format: 1", "format"),
        ("solution: [", "solution: [.inf, ", "a number is expected"),
        ("noise: [", "noise: [-", "above 0"),
        ("duration: ", "duration: .inf #", "a number is expected"),
    ] {
        fs::write(&path, text.replacen(from, to, 1)).expect("a file");
        fails(1, &["watch", ARM, WORN, "--baseline", saved], &[said, "arm.baseline.yaml:"]);
    }
    fails(2, &["watch", ARM, WORN, "--baseline", saved, "--quiet", QUIET], &["cannot be used with"]);
    fails(2, &["watch", ARM, WORN, "--save-baseline", saved], &["--quiet"]);
}

/// A row per log, in the table, as CSV and as JSON.
#[test]
fn a_trend_has_a_row_for_each_log() {
    let logs = ["watch", ARM, KNOCK, WORN, "--quiet", QUIET, "--by", "log"];
    let called = rne(&logs);
    assert_eq!(called.status, 1, "{}", called.err);
    assert!(called.out.contains("desk_arm_worn.csv: friction of elbow"), "{}", called.out);
    let csv = rne(&[&logs[..], &["--csv", "-"]].concat()).out;
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let heading = lines.next().expect("a heading");
    let column = heading.iter().position(|name| *name == "elbow_coulomb").expect("a column");
    let rows: Vec<Vec<&str>> = lines.collect();
    let reply: serde_json::Value = serde_json::from_str(&rne(&[&logs[..], &["--json"]].concat()).out).expect("JSON");
    let of_json = reply["logs"].as_array().expect("a list");
    assert_eq!((rows.len(), of_json.len()), (2, 2));
    for ((row, of_json), (value, events)) in rows.iter().zip(of_json).zip([(0.30, "0"), (0.45, "1")]) {
        let of_csv: f64 = row[column].parse().expect("a number");
        assert!((of_csv - number(&of_json["joints"][2], "coulomb")).abs() < 1e-6, "{row:?} {of_json}");
        assert!((of_csv - value).abs() < 0.02 && row.last() == Some(&events), "{row:?}");
    }
    fails(2, &["watch", ARM, KNOCK, "--quiet", QUIET, "--by", "day"], &["not dates", "--by log"]);
}

/// Without groups the table is that of `--all`: the parameters with their thresholds, as in JSON.
#[test]
fn parameters_are_a_table() {
    let folder = folder("watch_csv");
    let path = folder.join("w.csv").to_str().expect("UTF-8").to_owned();
    let call = ["watch", ARM, WORN, "--quiet", QUIET];
    let called = rne(&[&call[..], &["--csv", &path]].concat());
    assert!(called.status == 1 && called.err.contains("w.csv") && called.out.contains("1 event"), "{called:?}");
    let csv = fs::read_to_string(&path).expect("a table");
    assert_eq!(rne(&[&call[..], &["--csv", "-"]].concat()).out, csv);
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let keys = lines.next().expect("a heading");
    assert_eq!(keys.join(","), "cause,joint,name,parameter,change,deviation,threshold,ratio,unit,watched");
    let reply = json(&[WORN, "--quiet", QUIET], 1);
    let parameters = reply["parameters"].as_array().expect("a list");
    let rows: Vec<_> = lines.collect();
    assert_eq!(rows.len(), parameters.len());
    for (row, parameter) in rows.iter().zip(parameters) {
        for (key, cell) in keys.iter().zip(row) {
            let wanted = match &parameter[key] {
                serde_json::Value::Null => String::new(),
                serde_json::Value::String(text) => text.clone(),
                other => other.to_string(),
            };
            let numbers = cell.parse::<f64>().ok().zip(wanted.parse::<f64>().ok());
            let is_number = numbers.is_some_and(|(a, b)| (a - b).abs() <= 1e-14 * a.abs());
            assert!(*cell == wanted || is_number, "{key}: {cell} and {wanted}");
        }
    }
    // the same numbers again need no --force, other ones do
    assert_eq!(rne(&[&call[..], &["--csv", &path]].concat()).status, 1);
    fails(2, &["watch", ARM, KNOCK, "--quiet", QUIET, "--csv", &path], &["--force"]);
    fails(2, &["watch", ARM, KNOCK, "--csv", ARM, "--force"], &["is also the file that rne reads"]);
    fails(2, &["watch", ARM, KNOCK, "--csv", "x.csv", "--json"], &["cannot be used with"]);
}

/// A log is no baseline file, and the message says which option takes a log.
#[test]
fn a_log_is_no_baseline() {
    for log in [QUIET, "docs"] {
        let said = ["is a log, and --baseline reads a file that --save-baseline wrote", "give a log with --quiet"];
        fails(2, &["watch", ARM, WORN, "--baseline", log], &said);
    }
    fails(1, &["watch", ARM, WORN, "--baseline", "nowhere.yaml"], &["nowhere.yaml cannot be read"]);
}

/// Efforts that come a sample later than in the quiet log are one event: no friction, and no contact in what is left.
#[test]
fn another_delay_is_one_event() {
    let folder = folder("watch_delay");
    let text = fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let late = (2..rows.len()).map(|at| [&rows[at][..7], &rows[at - 1][7..]].concat().join(","));
    let lines: Vec<String> = std::iter::once(rows[0].join(",")).chain(late).collect();
    let path = folder.join("late.csv");
    fs::write(&path, lines.join("\n")).expect("a file");
    let reply = json(&[path.to_str().expect("UTF-8"), "--quiet", QUIET], 1);
    let events = reply["events"].as_array().expect("a list");
    assert_eq!(events.len(), 1, "{reply}");
    assert_eq!((&events[0]["parameter"], &events[0]["unit"]), (&"delay".into(), &"s".into()));
    assert!((number(&events[0], "value") - 0.04).abs() < number(&events[0], "half_interval"), "{reply}");
}

/// An arm that stands still in a posture of the quiet log holds itself by friction, which is no event.
#[test]
fn an_arm_at_rest_has_no_event() {
    let folder = folder("watch_rest");
    let text = fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let mut lines = vec![rows[0].join(",")];
    for row in &rows[1..] {
        lines.push([&row[..1], &rows[50][1..4], &["0", "0", "0"], &rows[50][7..]].concat().join(","));
    }
    let path = folder.join("rest.csv");
    fs::write(&path, lines.join("\n")).expect("a file");
    let called = rne(&["watch", ARM, path.to_str().expect("UTF-8"), "--quiet", QUIET]);
    assert!(called.out.contains("no events"), "{}", called.out);
    let words = called.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("not watched: friction of waist, shoulder, elbow: a joint must move"), "{words}");
}

/// A log that is too short is left out of a trend, with the reason, and the others are compared.
#[test]
fn a_log_that_cannot_be_compared_does_not_end_a_trend() {
    let folder = folder("watch_short");
    let short: String =
        fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log").split_inclusive('\n').take(45).collect();
    let path = folder.join("short.csv");
    fs::write(&path, short).expect("a file");
    let path = path.to_str().expect("UTF-8");
    let logs = ["watch", ARM, KNOCK, path, "--quiet", QUIET, "--by", "log"];
    let called = rne(&logs);
    assert_eq!(called.status, 1, "{}", called.err);
    let said = called.err.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("warning: short.csv is not compared:") && said.contains(" s "), "{said}");
    assert!(called.out.contains("desk_arm_knock.csv") && !called.out.contains("  short.csv"), "{}", called.out);
    let reply: serde_json::Value = serde_json::from_str(&rne(&[&logs[..], &["--json"]].concat()).out).expect("JSON");
    assert_eq!((reply["logs"].as_array().map(Vec::len), &reply["left_out"][0]["log"]), (Some(1), &"short.csv".into()));
    // the low-pass is that of the baseline, so another one is no remedy
    fs::write(path, fs::read_to_string(path).expect("it").split_inclusive('\n').take(12).collect::<String>())
        .expect("a file");
    fails(
        1,
        &["watch", ARM, path, "--quiet", QUIET],
        &["short.csv: the motion is too short", "0.4 s are left, but more than"],
    );
    // nothing is left to compare
    fails(1, &["watch", ARM, path, "--quiet", QUIET, "--by", "log"], &["short.csv", " s "]);
}

/// Rows with one text in a column are one group.
#[test]
fn a_column_has_groups() {
    let folder = folder("watch_groups");
    let mut table = String::new();
    for (log, task) in [(QUIET, "pick"), (WORN, "place")] {
        let text = fs::read_to_string(format!("{ROOT}/{log}")).expect("a log");
        let header = usize::from(!table.is_empty());
        for (at, line) in text.lines().enumerate().skip(header) {
            writeln!(table, "{line},{}", if at == 0 { "task" } else { task }).expect("a text grows");
        }
    }
    let path = folder.join("tasks.csv");
    fs::write(&path, table).expect("a file");
    let path = path.to_str().expect("UTF-8");
    let called = rne(&["watch", ARM, path, "--by", "task"]);
    assert_eq!(called.status, 1, "{}", called.err);
    let words = called.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("2 groups compared with") && words.contains("place: friction of elbow"), "{}", called.out);
    assert!(!words.contains("pick: "), "{}", called.out);
    fails(2, &["watch", ARM, path, "--by", "tsk"], &["tsk", "task"]);
}

/// Two logs whose times begin at the same number: events of one are not those of the other.
#[test]
fn events_belong_to_their_run() {
    let folder = folder("watch_runs");
    let again = folder.join("again.csv");
    fs::copy(format!("{ROOT}/{KNOCK}"), &again).expect("a copy");
    let again = again.to_str().expect("UTF-8");
    let values = |reply: &serde_json::Value, run: u64| -> Vec<serde_json::Value> {
        let of_run = events(reply).iter().filter(|event| event["run"] == run);
        of_run.map(|event| event["value"].clone()).collect()
    };
    let (one, two) = (json(&[KNOCK, "--quiet", QUIET], 1), json(&[KNOCK, again, "--quiet", QUIET], 1));
    assert_eq!(values(&one, 1).len(), 1);
    assert_eq!(values(&two, 1), values(&one, 1));
    assert_eq!(values(&two, 2), values(&one, 1));
    let text = rne(&["watch", ARM, KNOCK, again, "--quiet", QUIET]).out;
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("run 1, 9.") && words.contains("run 2, 9."), "{text}");
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
    assert_eq!(events(&reply).len(), 1, "{reply}");
    let event = &events(&reply)[0];
    assert_eq!(event["cause"], "contact", "{reply}");
    let [since, until] = ["since", "until"].map(|key| number(event, key));
    assert!((130.7..130.9).contains(&since) && (131.3..131.6).contains(&until), "{reply}");
    assert!((number(event, "value") + 1.0).abs() < 0.15, "{reply}");
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
        (7..10, "0", "the efforts of all joints are zero"),
        (8..9, "3.3", "although the joint moves"),
    ] {
        let dead = log.lines().enumerate().map(|(at, line)| {
            let cell = |(index, cell)| if at > 0 && columns.contains(&index) { effort } else { cell };
            line.split(',').enumerate().map(cell).collect::<Vec<_>>().join(",") + "\n"
        });
        let path = folder.join("dead.csv");
        fs::write(&path, dead.collect::<String>()).expect("a file");
        let called = rne(&["watch", ARM, path.to_str().expect("UTF-8")]);
        assert_eq!(called.status, 1, "{}", called.out);
        let text = called.said() + &called.out;
        assert!(text.contains(said), "{called:?}");
    }
}

/// The errors of a watch are those of a judge, whatever it is compared with.
#[test]
fn errors_are_those_of_a_judge() {
    let judged = fine(&["identify", ARM, KNOCK, "--judge", "--all"]);
    let (_, judged) = judged.split_once("error: RMS of").expect("a table");
    for more in [&[][..], &["--quiet", QUIET]] {
        let watched = rne(&[&["watch", ARM, KNOCK, "--all"], more].concat());
        assert!(watched.out.ends_with(judged), "{}\n{judged}", watched.out);
    }
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
    assert!(words.contains("warning") && words.contains("shoulder") && words.contains("the quiet log"), "{words}");
    assert!(!rne(&["watch", ARM, KNOCK, "--quiet", QUIET]).err.contains("warning:"));
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
    fails(1, &["watch", ARM, QUIET, "--quiet", &short, "--cutoff", "2"], &["short"]);
    fails(1, &["watch", ARM, "there_is_none.csv"], &["there_is_none.csv"]);
    fails(2, &["watch", ARM, KNOCK, KNOCK, "--quiet", KNOCK], &["is also watched"]);
    fails(2, &["watch", "puma560", QUIET], &["the log has 3 joints (waist, shoulder, elbow), but the robot has 6"]);
    fails(2, &["watch", ARM, QUIET, "--gain", "0"], &["above 0"]);
    fails(2, &["watch", ARM, QUIET, "--hold", "NaN"], &["above 0"]);
    fails(2, &["watch", ARM, QUIET, "--false-alarms", "-1"], &["--false-alarms"]);
    fails(2, &["watch", ARM], &["LOG"]);
    let without = log.lines().map(|line| line.split(',').take(7).collect::<Vec<_>>().join(",") + "\n");
    let without = write("without.csv", &without.collect::<String>());
    fails(1, &["watch", ARM, &without], &["no efforts"]);
    let silent = log.lines().enumerate().map(|(row, line)| {
        let words = line.split(',').enumerate();
        let words = words.map(|(at, word)| if row > 0 && at > 6 { "0" } else { word });
        words.collect::<Vec<_>>().join(",") + "\n"
    });
    let silent = write("silent.csv", &silent.collect::<String>());
    fails(1, &["watch", ARM, &silent, "--quiet", QUIET], &["the efforts of all joints are zero throughout"]);
    // too short to be its own baseline
    let half = write("half.csv", &lines(220));
    fails(1, &["watch", ARM, &half, "--cutoff", "1"], &["too short for a baseline", "--quiet"]);
    fs::create_dir(folder.join("bag")).expect("a folder");
    write("bag/metadata.yaml", "rosbag2_bagfile_information: {}\n");
    let bag = folder.join("bag").to_str().expect("UTF-8").to_owned();
    fails(1, &["watch", &bag, QUIET], &["is a ROS bag, but here a robot file is expected"]);
    // another unit, and a quiet log that is watched
    let milli = log.lines().enumerate().map(|(row, line)| {
        let times = |(at, word): (usize, &str)| match word.parse::<f64>() {
            Ok(number) if row > 0 && at > 6 => (1000.0 * number).to_string(),
            _ => word.to_owned(),
        };
        line.split(',').enumerate().map(times).collect::<Vec<_>>().join(",") + "\n"
    });
    let milli = write("milli.csv", &milli.collect::<String>());
    let words = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let said = words(rne(&["watch", ARM, &milli, "--quiet", QUIET]).err);
    assert!(said.contains("times as large as in the quiet log"), "{said}");
    let said = words(rne(&["watch", ARM, QUIET, WORN]).err);
    assert!(said.contains("the logs are joined to one") && said.contains("--quiet"), "{said}");
    assert!(!said.contains("times as large"), "{said}");
    // the geometry alone
    let massless = fs::read_to_string(format!("{ROOT}/docs/desk_arm.yaml")).expect("a robot file");
    let massless = massless.lines().filter(|line| !line.trim_start().starts_with("link:")).collect::<Vec<_>>();
    let massless = write("massless.yaml", &(massless.join("\n") + "\n"));
    let said = rne(&["watch", &massless, WORN, "--quiet", QUIET]).err;
    assert!(said.contains("FILE contains no masses"), "{said}");
}

/// A position that keeps its last value while its velocity goes on is one event, and a warning of every command that
/// reads logs.
#[test]
fn a_frozen_position_is_one_event() {
    let (folder, text) = (folder("frozen_position"), fs::read_to_string(ROOT.to_owned() + "/" + QUIET).expect("a log"));
    let frozen = |from: usize| {
        let mut last = String::new();
        let lines = text.lines().enumerate().map(|(row, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            if row > from {
                cells[3] = &last;
            } else {
                cells[3].clone_into(&mut last);
            }
            cells.join(",")
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    for (from, since) in [(1, 0.0), (150, 5.96)] {
        let path = folder.join(format!("{from}.csv"));
        fs::write(&path, frozen(from)).expect("a file");
        let path = path.to_str().expect("text");
        let reply = json(&[path, "--quiet", QUIET], 1);
        assert_eq!(events(&reply).len(), 1, "{reply}");
        let event = &events(&reply)[0];
        assert_eq!((&event["cause"], &event["name"]), (&"sensor".into(), &"elbow".into()));
        assert_eq!((&event["parameter"], &event["unit"]), (&"frozen_position".into(), &"rad".into()));
        assert!((number(event, "since") - since).abs() < 0.05, "{event}");
        for command in [&["watch", ARM, path, "--quiet", QUIET][..], &["log", path], &["identify", ARM, path]] {
            let called = rne(command);
            let err = (called.out + &called.err).split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(err.contains("the position of elbow keeps one value from"), "{err}");
            assert!(!err.contains("inf %") && !err.contains("explains nothing"), "{err}");
        }
    }
}
