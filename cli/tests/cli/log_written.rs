//! What `rne log` writes: columns with the names of joints, and samples as they were recorded.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::call::{ROOT, fails, fine, folder, rne};

const LOG: &str = "docs/desk_arm_log.csv";
const ARM: &str = "docs/desk_arm.yaml";
const JOINTS: [&str; 3] = ["waist", "shoulder", "elbow"];

/// The header and the numbers of a table of text.
fn table(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (header, lines.map(row).collect())
}

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(path)).expect("a file")
}

fn column(path: &str, name: &str) -> Vec<f64> {
    let (header, rows) = table(&read(path));
    let at = header.iter().position(|column| column == name).unwrap_or_else(|| panic!("no {name} in {header:?}"));
    rows.iter().map(|row| row[at]).collect()
}

/// The desk arm's log with the joints in another order, and with names of columns as asked for.
fn reordered(path: &str, order: [usize; 3], name: impl Fn(usize, usize) -> String) {
    let (_, rows) = table(&read(LOG));
    let mut text = "time".to_owned();
    for quantity in 0..3 {
        for joint in order {
            write!(text, ",{}", name(quantity, joint)).expect("a text");
        }
    }
    for row in rows {
        write!(text, "\n{}", row[0]).expect("a text");
        for quantity in 0..3 {
            for joint in order {
                write!(text, ",{}", row[1 + 3 * quantity + joint]).expect("a text");
            }
        }
    }
    fs::write(path, text + "\n").expect("a file");
}

/// A table that is written without a robot names its joints, so that no order is lost.
#[test]
fn columns_have_the_names_of_joints() {
    let folder = folder("log_names_of_joints");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let (other, motion, by_order) = (path("other.csv"), path("motion.csv"), path("by_order.csv"));
    // as joints are sorted by their names in messages of ROS
    let word = ["position", "velocity", "effort"];
    reordered(&other, [2, 1, 0], |quantity, joint| format!("{}.{}", JOINTS[joint], word[quantity]));
    assert_eq!(rne(&["log", &other, "--cutoff", "4", "-o", &motion]).status, 0);
    assert_eq!(rne(&["log", &other, "--cutoff", "4", "--robot", ARM, "--output", &by_order]).status, 0);
    let header = table(&read(&motion)).0.join(",");
    assert!(header.starts_with("t,elbow.position,shoulder.position,waist.position,elbow.velocity,"), "{header}");
    assert!(header.ends_with(",waist.acceleration,elbow.effort,shoulder.effort,waist.effort,run"), "{header}");
    for (at, joint) in JOINTS.iter().enumerate() {
        let letters = [("position", "q"), ("velocity", "qd"), ("acceleration", "qdd"), ("effort", "tau")];
        for (word, letters) in letters {
            let named = column(&motion, &format!("{joint}.{word}"));
            assert_eq!(named, column(&by_order, &format!("{letters}{}", at + 1)), "{joint}.{word}");
        }
    }
    // what is written is read back by its names
    let judged = rne(&["identify", ARM, &motion, "--judge", "--cutoff", "0.8"]);
    assert!(judged.status == 0 && !judged.said().contains("order"), "{judged:?}");
    let same = rne(&["identify", ARM, &by_order, "--judge", "--cutoff", "0.8"]);
    let errors = |text: &str| text.split_once('\n').expect("two lines").1.to_owned();
    assert_eq!(errors(&judged.out), errors(&same.out));
    // and so do the commands that take states and trajectories
    let of = |states: &str| rne(&["eval", ARM, "--function", "gravity_torques", "--states", states]).out;
    assert!(of(&motion).lines().count() > 300);
    assert_eq!(of(&motion), of(&by_order));
    let of = |states: &str| {
        let svg = fine(&["plot", ARM, "--trajectory", states]);
        svg.replace("motion.csv", "by_order.csv")
    };
    assert_eq!(of(&motion), of(&by_order));
    // a tool is no joint by the name of a column, so this joint has a number, and a note has its name
    let numbered = path("numbered.csv");
    let map = ["--map", "tcp.position=waist.position", "--map", "tcp.effort=waist.effort", "--joints", "tcp"];
    let called = rne(&[&["log", &other, "--raw", "-o", &numbered][..], &map].concat());
    assert!(called.said().contains("the columns have the numbers of the joints: q1 is tcp"), "{called:?}");
    assert!(read(&numbered).starts_with("t,q1,tau1,run\n"));
}

/// Numbers are an order: the columns are said joint by joint, as a warning.
#[test]
fn an_order_of_numbers_is_a_warning() {
    let folder = folder("log_order");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let log = path("log.csv");
    reordered(&log, [0, 1, 2], |quantity, joint| format!("{}{}", ["q", "qd", "tau"][quantity], joint + 1));
    let said = "warning: the log does not name its joints, so their order decides: q1 is waist, q2 is shoulder, q3 is \
                elbow; --joints gives another order";
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for command in [&["identify", ARM, &log, "--judge"][..], &["watch", "docs/desk_arm_identified.yaml", &log]] {
        assert!(rne(command).said().contains(said), "{command:?}");
        let named = rne(&[command, &["--joints", "1,2,3"]].concat());
        assert!(!named.said().contains("order"), "{named:?}");
    }
    assert!(words(&fine(&["log", &log, "--robot", ARM])).contains(said));
    // an arm of one joint has one order
    let one = path("one.yaml");
    let text = "{format: 1, name: one, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [\
                {name: arm, type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: 0}, \
                link: {mass: 1, com: [-0.1, 0, 0]}}]}";
    fs::write(&one, text).expect("a robot file");
    let row = |i: i32| {
        let time = f64::from(i) * 0.01;
        format!("{time},{},{}\n", time.sin(), 2.0 * time.sin())
    };
    let rows: String = (0..400).map(row).collect();
    fs::write(path("one.csv"), format!("t,q1,tau1\n{rows}")).expect("a log");
    let called = words(&fine(&["log", &path("one.csv"), "--robot", &one]));
    assert!(called.contains("note: the log does not name its joints, so their order decides: q1 is arm"), "{called}");
}

/// The samples are those of the file: all rows, each number.
#[test]
fn samples_are_written_as_they_were_recorded() {
    let folder = folder("log_raw");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let raw = path("raw.csv");
    let called = rne(&["log", LOG, "--raw", "-o", &raw]);
    assert!(called.status == 0 && called.err.contains("raw.csv, 400 states"), "{called:?}");
    assert!(!called.out.contains("cut-off"), "nothing is filtered: {}", called.out);
    let ((_, source), (header, written)) = (table(&read(LOG)), table(&read(&raw)));
    let word = |word: &'static str| JOINTS.map(|joint| format!("{joint}.{word}"));
    let columns = [word("position"), word("velocity"), word("effort")].concat().join(",");
    assert_eq!(header.join(","), format!("t,{columns},run"));
    assert_eq!(source.len(), 400);
    let rows: Vec<Vec<f64>> = written.iter().map(|row| row[..10].to_vec()).collect();
    assert_eq!(rows, source);
    assert!(written.iter().all(|row| row[10..] == [1.0]));
    // a table of samples is a log with the same samples
    let text = fine(&["log", LOG, "--raw", "-o", "-"]);
    assert_eq!(text, read(&raw));
    assert_eq!(fine(&["log", &raw, "--raw", "-o", "-"]), text);
    // an array has the same numbers, 128 bytes of header before them
    let array = path("raw.npy");
    let called = rne(&["log", LOG, "--raw", "--out", &array]);
    assert!(called.status == 0 && called.said().contains("time,q,qd,tau, all but the time once for each joint: waist"));
    let bytes = fs::read(&array).expect("an array");
    let numbers: Vec<f64> =
        bytes[128..].chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().expect("eight bytes"))).collect();
    assert_eq!(numbers.chunks(10).map(<[f64]>::to_vec).collect::<Vec<_>>(), source);
    assert!(String::from_utf8_lossy(&bytes[..128]).contains("'shape': (400, 10)"));
    assert!(fine(&["log", &array]).contains("400 of 400 rows contain states"));
    // velocities that are not read are not written, and the robot says the order
    let ordered = fine(&["log", LOG, "--raw", "--derive-velocities", "--robot", ARM, "-o", "-"]);
    assert!(ordered.starts_with("t,q1,q2,q3,tau1,tau2,tau3,run\n"), "{ordered:.200}");
    // a log that is too short for any filter has samples
    let short = path("short.csv");
    fs::write(&short, read(LOG).lines().take(6).collect::<Vec<_>>().join("\n")).expect("a log");
    assert_eq!(fine(&["log", &short, "--raw", "-o", "-"]).lines().count(), 6);
}

/// Parquet has the samples of CSV, without accelerations.
#[test]
#[cfg(feature = "parquet")]
fn samples_are_written_as_parquet() {
    let folder = folder("log_raw_parquet");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    assert_eq!(rne(&["log", LOG, "--raw", "-o", &path("raw.parquet")]).status, 0);
    let again = fine(&["log", &path("raw.parquet"), "--raw", "-o", "-"]);
    assert_eq!(again, fine(&["log", LOG, "--raw", "-o", "-"]));
}

/// Stamps since 1970 are kept to the nanosecond; the time 0 s has its date.
#[test]
fn absolute_times_are_kept() {
    let folder = folder("log_stamps");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    // 2026-11-23 08:00:10.5 UTC, by `date -u -d @1795420810`
    let stamp = |row: i64| 1_795_420_810_500_000_001 + row * 10_000_000;
    let row = |row: i32| {
        let angle = f64::from(row) * 0.01;
        format!("{},{},{}\n", stamp(row.into()), angle.sin(), angle.cos())
    };
    let rows: String = (0..300).map(row).collect();
    fs::write(path("log.csv"), format!("timestamp_ns,arm.position,arm.effort\n{rows}")).expect("a log");
    let called = rne(&["log", &path("log.csv"), "--raw", "-o", &path("raw.csv")]);
    assert_eq!(called.status, 0, "{called:?}");
    assert!(called.said().contains("the time 0 s of the file is 2026-11-23T08:00:10.500Z"), "{called:?}");
    let text = read(&path("raw.csv"));
    assert!(text.starts_with("timestamp_ns,t,arm.position,arm.effort,run\n"), "{text:.100}");
    for (at, (line, row)) in text.lines().skip(1).zip(0..).enumerate() {
        let mut cells = line.split(',');
        assert_eq!(cells.next().and_then(|cell| cell.parse().ok()), Some(stamp(row)), "row {at}");
        let time: f64 = cells.next().and_then(|cell| cell.parse().ok()).expect("a time");
        assert!((time - 0.01 * f64::from(u32::try_from(at).expect("a row"))).abs() < 1e-12, "row {at}");
    }
    // the table that was written is absolute again
    assert_eq!(fine(&["log", &path("raw.csv"), "--raw", "-o", "-"]), text);
    let json: serde_json::Value = serde_json::from_str(&fine(&["log", &path("raw.csv"), "--json"])).expect("JSON");
    assert_eq!(json["origin_ns"].as_i64(), Some(stamp(0)));
    // a filtered table has the columns that it had, and the note
    let called = rne(&["log", &path("log.csv"), "--cutoff", "10", "-o", &path("motion.csv")]);
    assert!(called.said().contains("2026-11-23T08:00:10.500Z") && read(&path("motion.csv")).starts_with("t,arm."));
    #[cfg(feature = "parquet")]
    {
        assert_eq!(rne(&["log", &path("log.csv"), "--raw", "-o", &path("raw.parquet")]).status, 0);
        assert_eq!(fine(&["log", &path("raw.parquet"), "--raw", "-o", "-"]), text);
    }
}

#[test]
fn options_that_do_not_go_with_samples_are_refused() {
    let folder = folder("log_raw_refused");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let said = ["--raw writes the samples without a filter", "--cutoff is the cut-off of the filter"];
    fails(2, &["log", LOG, "--raw", "--cutoff", "4", "-o", &path("x.csv")], &said);
    fails(2, &["log", LOG, "--raw"], &["--output"]);
    let two = "docs/two_arms_log.csv";
    let said = ["an array has only numbers"];
    fails(2, &["log", two, "--raw", "--by", "robot_id", "-o", &path("x.npy")], &said);
    let both = fine(&["log", two, "--raw", "--by", "robot_id", "-o", "-"]);
    assert!(both.lines().next().is_some_and(|line| line.ends_with(",run,robot_id")), "{both:.300}");
    assert_eq!(both.lines().count(), 501);
    // a unit that is not known is no number of a table
    let row = |i: i32| format!("{},{}\n", f64::from(i) * 0.01, 60.0 * (f64::from(i) * 0.02).sin());
    let rows: String = (0..400).map(row).collect();
    fs::write(path("degrees.csv"), format!("time,q1\n{rows}")).expect("a log");
    fails(2, &["log", &path("degrees.csv"), "--raw", "-o", &path("x.csv")], &["more than 4π", "--degrees"]);
    assert!(!folder.join("x.csv").exists() && !folder.join("x.npy").exists());
}
