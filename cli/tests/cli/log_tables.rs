//! `rne log` of tables: several arms in one, columns by their names, and runs that begin for one reason.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::call::{fails, fine, folder, rne};

/// The rows of two arms, with a column of their names.
const TWO_ARMS: &str = "docs/two_arms_log.csv";

/// The lines of a text as one.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).expect("a file");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn two_arms_in_a_table_are_refused_with_what_to_type() {
    let said = ["the column robot_id names two arms, r1 and r2", "--where robot_id=r1", "--by robot_id"];
    fails(2, &["log", TWO_ARMS], &said);
    fails(2, &["identify", "docs/desk_arm.yaml", TWO_ARMS], &said);
    fails(2, &["watch", "docs/desk_arm_identified.yaml", TWO_ARMS], &said);
    // what is said can be typed
    for command in [
        &["log", TWO_ARMS][..],
        &["identify", "docs/desk_arm.yaml", TWO_ARMS, "--judge"],
        &["watch", "docs/desk_arm_identified.yaml", TWO_ARMS],
    ] {
        fine(&[command, &["--where", "robot_id=r1"]].concat());
    }
    fails(
        2,
        &["log", TWO_ARMS, "--where", "robot_id=r9"],
        &["no row has r9 in the column robot_id; the column has r1, r2"],
    );
    fails(2, &["log", TWO_ARMS, "--where", "robot_id"], &["write a column, `=` and a text in it"]);
    fails(2, &["log", TWO_ARMS, "--where", "robot=r1"], &["no column `robot` (did you mean robot_id?)"]);
    fails(2, &["log", TWO_ARMS, "--by", "robot"], &["no column `robot` (did you mean robot_id?)"]);
}

/// The rows of one arm are the log that they were before somebody put two into one table.
#[test]
fn the_rows_of_one_arm_are_its_log() {
    let folder = folder("log_one_arm");
    let table = fs::read_to_string(format!("{}/../{TWO_ARMS}", env!("CARGO_MANIFEST_DIR"))).expect("the table");
    for arm in ["r1", "r2"] {
        let own = |line: &str| {
            line.split_once(',').filter(|(name, _)| ["robot_id", arm].contains(name)).map(|c| c.1.to_owned())
        };
        let alone: Vec<String> = table.lines().filter_map(own).collect();
        let alone = write(&folder, "alone.csv", &alone.join("\n"));
        let of_arm = format!("robot_id={arm}");
        assert_eq!(fine(&["log", TWO_ARMS, "--where", &of_arm, "-o", "-"]), fine(&["log", &alone, "-o", "-"]), "{arm}");
        let judged = |log: &[&str]| {
            let text = fine(&[&["identify", "docs/desk_arm.yaml", "--judge"], log].concat());
            text.split_once('\n').expect("lines").1.to_owned()
        };
        assert_eq!(judged(&[TWO_ARMS, "--where", &of_arm]), judged(&[&alone]), "{arm}");
    }
}

#[test]
fn each_arm_of_a_table_is_described_and_written() {
    let folder = folder("log_by");
    let said = fine(&["log", TWO_ARMS, "--by", "robot_id"]);
    let line = |name: &str| words(said.lines().find(|line| line.starts_with(name)).expect("a line"));
    assert_eq!(line("robot_id"), "robot_id rows states runs duration rate cut-off");
    assert_eq!(line("r1"), "r1 250 250 1 9.960 s 25 Hz 3.223 Hz");
    assert_eq!(line("r2"), "r2 250 250 1 9.960 s 25 Hz 3.223 Hz");
    // what is true of all is said once
    assert_eq!(words(&said).matches("note: all: efforts are taken as torques").count(), 1, "{said}");
    let json: serde_json::Value =
        serde_json::from_str(&fine(&["log", TWO_ARMS, "--by", "robot_id", "--json"])).expect("JSON");
    assert_eq!((json["by"].as_str(), json["values"][1]["value"].as_str()), (Some("robot_id"), Some("r2")));
    assert_eq!(
        (json["values"][1]["rows"].as_u64(), json["values"][1]["log"]["states"].as_u64()),
        (Some(250), Some(250))
    );
    assert!(json["values"][1]["error"].is_null());
    // the column is carried, and the numbers are those of each arm alone
    let path = folder.join("motion.csv");
    let called = rne(&["log", TWO_ARMS, "--by", "robot_id", "-o", path.to_str().expect("UTF-8")]);
    assert!(called.status == 0 && called.err.contains("motion.csv, 388 states"), "{called:?}");
    let text = fs::read_to_string(&path).expect("the motion");
    let alone = ["r1", "r2"].map(|arm| fine(&["log", TWO_ARMS, "--where", &format!("robot_id={arm}"), "-o", "-"]));
    let mut expected = format!("{},robot_id\n", alone[0].lines().next().expect("a header"));
    for (arm, alone) in ["r1", "r2"].into_iter().zip(&alone) {
        alone.lines().skip(1).for_each(|line| writeln!(expected, "{line},{arm}").expect("a text"));
    }
    assert_eq!(text, expected);
    assert_eq!(fine(&["log", TWO_ARMS, "--by", "robot_id", "-o", "-"]), text);
}

/// One arm that cannot be read does not hide the others.
#[test]
fn an_arm_that_cannot_be_described_is_said() {
    let folder = folder("log_by_wrong");
    let table = fs::read_to_string(format!("{}/../{TWO_ARMS}", env!("CARGO_MANIFEST_DIR"))).expect("the table");
    let width = table.lines().next().expect("a header").matches(',').count();
    let log = write(&folder, "log.csv", &format!("{table}r3,0.0{}\n", ",1".repeat(width - 1)));
    let called = rne(&["log", &log, "--by", "robot_id"]);
    assert_eq!(called.status, 1, "{called:?}");
    let said = words(&called.out);
    assert!(said.contains("r3 1 0 0") && said.contains("error: r3:") && said.contains("the log has one joint state"));
    assert!(said.find("error: r3").expect("an error") < said.find("note:").expect("a note"), "{said}");
    let path = folder.join("motion.csv");
    fails(
        1,
        &["log", &log, "--by", "robot_id", "-o", path.to_str().expect("UTF-8")],
        &["robot_id r3:", "one joint state"],
    );
    assert!(!path.exists());
    // nothing at all can be described
    fails(2, &["log", TWO_ARMS, "--by", "waist_position", "--where", "robot_id=r1", "--rate", "1"], &["remove --rate"]);
}

#[test]
fn a_column_of_times_is_named() {
    let folder = folder("log_time_column");
    let table = fs::read_to_string(format!("{}/../docs/desk_arm_log.csv", env!("CARGO_MANIFEST_DIR"))).expect("a log");
    let log = write(&folder, "log.csv", &table.replacen("time,", "sample clock,", 1));
    // the option that keeps the times comes before that which replaces them
    fails(2, &["log", &log], &["--time-column 'sample clock' names the column of times; --rate HZ"]);
    let named = ["--time-column", "sample clock"];
    let motion = |arguments: &[&str]| fine(&[&["log"], arguments, &["-o", "-"]].concat());
    let expected = motion(&["docs/desk_arm_log.csv"]);
    assert_eq!(motion(&[&log, named[0], named[1]]), expected);
    assert_eq!(motion(&[&log, named[0], "sample clock [s]"]), expected);
    assert_eq!(rne(&["identify", "docs/desk_arm.yaml", &log, "--judge", named[0], named[1]]).status, 0);
    fails(2, &["log", &log, named[0], "clock"], &["the table has no column `clock` for time", "sample clock"]);
    fails(2, &["log", &log, named[0], named[1], "--map", "time=sample clock"], &["mapped twice"]);
}

/// In degrees that nobody said, every step is a jump: the reason comes first, and the jumps are one line.
#[test]
fn the_reason_comes_first_and_runs_of_one_reason_are_one_line() {
    let folder = folder("log_folded");
    let mut text = "t,q1,q2\n".to_owned();
    for i in 0..400_u32 {
        // in degrees; the second joint turns faster than 30 rad/s would be
        let t = f64::from(i) * 0.01;
        writeln!(text, "{t:.2},{:.4},{:.4}", 10.0 * t.sin(), 90.0 * (6.0 * t).sin()).expect("a text");
    }
    let log = write(&folder, "log.csv", &text);
    let called = rne(&["log", &log]);
    assert_eq!(called.status, 1, "{called:?}");
    let at = |part: &str| called.out.find(part).unwrap_or_else(|| panic!("no `{part}` in {}", called.out));
    assert!(at("use --degrees if they are degrees") < at("longest interval"), "{}", called.out);
    assert_eq!(called.out.matches("jumped").count(), 1, "{}", called.out);
    let jumps = called.out.lines().find(|line| line.contains("joint 2 jumped by 0.")).expect("a line");
    assert!(jumps.trim_start().starts_with("2 and ") && jumps.contains(" more "), "{jumps}");
    // all of them are in JSON
    let called = rne(&["log", &log, "--json"]);
    let json: serde_json::Value = serde_json::from_str(&called.out).expect("JSON");
    let count = json["run_count"].as_u64().expect("a count");
    assert!(count > 20 && json["runs"].as_array().expect("runs").len() as u64 == count);
    let more: u64 = words(jumps).split(' ').nth(2).expect("a number").parse().expect("a number");
    assert_eq!(more + 2, count);
    // a few are shown one by one
    let few: Vec<String> = fine(&["log", "docs/desk_arm_log.csv", "-o", "-"]).lines().map(str::to_owned).collect();
    let with_gaps = few.iter().enumerate().filter(|(at, _)| ![100, 101, 102, 103, 200, 201, 202, 203].contains(at));
    let log = write(&folder, "gaps.csv", &with_gaps.map(|(_, line)| line.as_str()).collect::<Vec<_>>().join("\n"));
    assert_eq!(fine(&["log", &log]).matches("after a gap of 0.200 s").count(), 2);
}

/// A table has rows; messages are those of a bag.
#[test]
fn rows_of_a_table_are_called_so() {
    let folder = folder("log_rows");
    let table = fs::read_to_string(format!("{}/../docs/desk_arm_log.csv", env!("CARGO_MANIFEST_DIR"))).expect("a log");
    let mut lines: Vec<String> = table.lines().map(str::to_owned).collect();
    let again = lines[10].clone();
    lines.insert(11, again);
    let (time, _) = lines[20].split_once(',').expect("cells");
    lines[20] = format!("{time}{}", ",nan".repeat(9));
    let log = write(&folder, "log.csv", &lines.join("\n"));
    let said = words(&fine(&["log", &log]));
    assert!(said.contains("left out: 1 row that repeat the row before"), "{said}");
    assert!(said.contains("left out: 1 row with a value that is not a number"), "{said}");
    assert!(said.contains("the first is row 20 at") && !said.contains("message"), "{said}");
    let called = rne(&["identify", "docs/desk_arm.yaml", &log, "--judge"]);
    assert!(called.said().contains("left out: 1 row with a value") && !called.err.contains("message"), "{called:?}");
}
