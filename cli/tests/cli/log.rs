//! `rne log`: what logs have, their motions, and what is wrong with them.

use std::fmt::Write as _;
use std::fs;

use crate::call::{fails, fine, folder, rne};

#[cfg(feature = "bags")]
const UR10: &str = "logs/read/tests/data/ur10.db3";
#[cfg(feature = "bags")]
const PANDA: &str = "logs/read/tests/data/panda.db3";

/// Numbers of a table that `rne log -o -` writes.
#[cfg(feature = "parquet")]
fn numbers(csv: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    csv.lines().skip(1).map(row).collect()
}

/// Parquet has the numbers of CSV, and the names of the joints; `rne log` reads it as the log that it is.
#[test]
#[cfg(feature = "parquet")]
fn a_motion_is_written_as_parquet() {
    let folder = folder("log_parquet");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let log = "docs/desk_arm_log.csv";
    let called = rne(&["log", log, "-o", &path("motion.parquet")]);
    assert!(called.status == 0 && called.err.contains("motion.parquet, 344 states"), "{called:?}");
    assert!(fs::read(path("motion.parquet")).expect("the motion").starts_with(b"PAR1"));
    let again = fine(&["log", &path("motion.parquet")]);
    for part in ["Parquet", "344 of 344 rows contain states, at 25 Hz", "waist", "shoulder", "elbow"] {
        assert!(again.contains(part), "no `{part}` in {again}");
    }
    // the same filter makes the same numbers of both tables
    assert_eq!(rne(&["log", log, "-o", &path("motion.csv")]).status, 0);
    let of = |name: &str| numbers(&fine(&["log", &path(name), "--cutoff", "2", "-o", "-"]));
    assert_eq!(of("motion.parquet"), of("motion.csv"));
    let same = ["motion.parquet exists and is not changed"];
    fails(2, &["log", log, "-o", &path("motion.parquet")], &same);
}

#[test]
#[cfg(not(feature = "parquet"))]
fn a_build_without_parquet_says_which_build_writes_it() {
    let folder = folder("log_without_parquet");
    let path = folder.join("motion.parquet");
    let said = ["this build of rne does not write Parquet", "cargo install --path cli --features full"];
    fails(1, &["log", "docs/desk_arm_log.csv", "-o", path.to_str().expect("UTF-8")], &said);
    assert!(!path.exists());
}

#[test]
#[cfg(feature = "bags")]
fn a_log_is_described() {
    let said = fine(&["log", UR10, "--robot", "ur10", "--cutoff", "8"]);
    for part in [
        "rosbag2, SQLite, /joint_states",
        "460 of 460 messages contain states, at 125 Hz",
        "wrist_3_joint",
        "cut-off 8 Hz, as given: passes below 5.333 Hz",
        "--torque-constant",
    ] {
        assert!(said.contains(part), "no `{part}` in {said}");
    }
    assert!(!said.contains('\u{1B}'), "a pipe has no colours");
    let json: serde_json::Value = serde_json::from_str(&fine(&["log", PANDA, "--json"])).expect("JSON");
    assert_eq!((json["states"].as_u64(), json["run_count"].as_u64()), (Some(300), Some(1)));
    assert_eq!(
        (json["joints"][6]["name"].as_str(), json["cutoff_from"].as_str()),
        (Some("fer_joint7"), Some("spectrum"))
    );
}

/// The filtered motion is one that other commands take: the torques of its states are those of the plot's kind.
#[test]
#[cfg(feature = "bags")]
fn a_motion_is_what_other_commands_read() {
    let folder = folder("log_motion");
    let motion = folder.join("motion.csv");
    let path = motion.to_str().expect("UTF-8");
    let called = rne(&["log", UR10, "--robot", "ur10", "--cutoff", "8", "-o", path]);
    assert!(called.status == 0 && called.err.contains("wrote"), "{called:?}");
    let text = fs::read_to_string(&motion).expect("the motion");
    assert!(
        text.starts_with("t,q1,q2,q3,q4,q5,q6,qd1,")
            && text.lines().next().is_some_and(|line| line.ends_with("tau6,run"))
    );
    // 48 states of the filter and 4 of the differences at each end
    assert_eq!(text.lines().count(), 1 + 460 - 2 * 52);
    assert_eq!(fine(&["log", UR10, "--robot", "ur10", "--cutoff", "8", "-o", "-"]), text);
    let torques = rne(&["eval", "ur10", "--function", "inverse_dynamics", "--states", path]);
    assert_eq!(torques.status, 0, "{}", torques.err);
    assert_eq!(torques.out.lines().count(), text.lines().count());
    assert!(fine(&["plot", "ur10", "--trajectory", path]).contains("<svg"));
    // a motion is a log itself
    assert!(fine(&["log", path, "--cutoff", "8"]).contains("356 of 356 rows contain states"));
    fails(2, &["log", UR10, "-o", path], &["--force"]);
    fails(2, &["log", path, "-o", path, "--force"], &["is also the file that rne reads"]);
}

/// One rule for names of joints, whatever command reads a log.
#[test]
#[cfg(feature = "bags")]
fn joints_of_other_names_are_taken_by_their_order() {
    let by_order =
        "joints of the log are matched by their order: fer_joint1 is panda_joint1, fer_joint2 is panda_joint2";
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let described = fine(&["log", PANDA, "--robot", "panda"]);
    assert!(words(&described).contains(&format!("note: {by_order}")), "{described}");
    let json = fine(&["log", PANDA, "--robot", "panda", "--json"]);
    assert!(json.contains(by_order), "{json}");
    for command in ["identify", "watch"] {
        let read = rne(&[command, "panda", PANDA]);
        assert!(words(&read.err).contains(&format!("note: {by_order}")), "{read:?}");
    }
    // names that are given are held against the robot's number of joints
    let names = "fer_joint7,fer_joint6,fer_joint5,fer_joint4,fer_joint3,fer_joint2,fer_joint1";
    let named = fine(&["log", PANDA, "--robot", "panda", "--joints", names]);
    assert!(named.contains("\n1  fer_joint7 ") && !words(&named).contains("by their order"), "{named}");
    let too_few = ["names 2 joints of the log", "but the robot has 7 joints: panda_joint1"];
    fails(2, &["log", PANDA, "--robot", "panda", "--joints", "fer_joint1,fer_joint2"], &too_few);
    fails(2, &["log", PANDA, "--robot", "planar2"], &["the log has 7 joints (", "--joints lists"]);
}

#[test]
#[cfg(feature = "bags")]
fn what_is_wrong_is_said() {
    fails(1, &["log", "nowhere.csv"], &["nowhere.csv: there is no such file"]);
    fails(1, &["log", "docs"], &["docs: the folder has no rosbag2 bag", "such as docs/*.csv"]);
    let folder = folder("log_wrong");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        fs::write(&path, bytes).expect("a file");
        path.to_str().expect("UTF-8").to_owned()
    };
    fails(2, &["log", PANDA, "--joints", "fer_joint1,fer_jont2"], &["did you mean fer_joint2?"]);
    for names in ["", " ", ",,", "fer_joint1,", ",fer_joint1"] {
        fails(
            2,
            &["identify", "panda", PANDA, "--joints", names],
            &["a name of a joint is empty; the joints of the log are fer"],
        );
        fails(
            2,
            &["log", PANDA, "--joints", names],
            &["a name of a joint is empty; the joints of the log are fer_joint1, fer"],
        );
    }
    let numbered = rne(&["log", "docs/desk_arm_log.csv", "--joints", "7,1,2"]);
    assert!(numbered.status == 2 && !numbered.err.contains("did you mean"), "{numbered:?}");
    for twice in [[PANDA, PANDA], [PANDA, "logs/read/tests/../tests/data/panda.db3"]] {
        fails(2, &["log", twice[0], twice[1]], &["panda.db3: the file is named twice", "count twice"]);
        fails(2, &["identify", "panda", twice[0], twice[1]], &["named twice"]);
    }
    fails(2, &["log", PANDA, "--topic", "/joints"], &["no topic /joints", "/joint_states"]);
    fails(2, &["log", UR10, "--rate", "125"], &["the messages of this log have times"]);
    fails(2, &["log", PANDA, "--cutoff", "12"], &["too high for samples at 30.0007 Hz"]);
    fails(2, &["log", PANDA, "--torque-constant", "1,2"], &["2 torque constants for 7 joints"]);
    fails(2, &["log", "-"], &["read twice"]);
    fails(1, &["log", "missing.db3"], &["missing.db3"]);
    let whole = fs::read(format!("{}/{PANDA}", crate::call::ROOT)).expect("the bag");
    let cut = write("cut.db3", &whole[..100_000]);
    fails(1, &["log", &cut], &["cut.db3: the bag is cut off: it has 100000 bytes of 135168"]);
    let short = write("short.csv", b"time,q1\n0,1\n0.1,1\n0.2,1\n");
    fails(1, &["log", &short, "--cutoff", "1", "-o", "-"], &["no run (a part of the log without gaps) is long enough"]);
}

/// A bag is read by a build with its feature; another one says how to get it, in `rne log`, `identify` and `watch`.
#[test]
#[cfg(not(feature = "bags"))]
fn a_format_that_is_left_out_names_the_command_that_has_it() {
    const BAG: &str = "logs/read/tests/data/ur10.db3";
    for call in [["log", BAG].as_slice(), &["identify", "ur10", BAG], &["watch", "ur10", BAG]] {
        fails(1, call, &["does not read rosbag2, SQLite", "cargo install --path cli --features full"]);
    }
}

/// Not even with `--force`.
#[test]
fn the_robot_file_of_a_log_is_not_overwritten() {
    let folder = folder("log_robot");
    let (arm, log) = (folder.join("arm.csv"), "docs/desk_arm_log.csv");
    let yaml = fs::read_to_string(format!("{}/docs/desk_arm.yaml", crate::call::ROOT)).expect("the arm");
    fs::write(&arm, &yaml).expect("a file");
    let path = arm.to_str().expect("UTF-8");
    fails(2, &["log", log, "--robot", path, "-o", path, "--force"], &["is also the file that rne reads"]);
    assert_eq!(fs::read_to_string(&arm).expect("it is there"), yaml);
}

/// Degrees are asked for, not taken.
#[test]
fn degrees_are_asked_for() {
    let folder = folder("log_degrees");
    let path = folder.join("degrees.csv");
    let row = |i| {
        let time = f64::from(i) * 0.01;
        format!("{time},{}\n", 60.0 * (time * 2.0).sin())
    };
    let rows: String = (0..400).map(row).collect();
    fs::write(&path, format!("time,q1\n{rows}")).expect("a file");
    let path = path.to_str().expect("UTF-8");
    let called = rne(&["log", path, "--cutoff", "5"]);
    assert!(called.status == 1 && called.out.contains("--degrees"), "{called:?}");
    fails(2, &["log", path, "--cutoff", "5", "-o", "-"], &["more than 4π", "--degrees", "--radians"]);
    let said = fine(&["log", path, "--cutoff", "5", "--degrees"]);
    assert!(said.contains("-1.047 … 1.047"), "{said}");
}

/// The desk arm's log with other names of columns, in this order of joints and with numbers divided by these units.
fn desk_log(path: &std::path::Path, order: [usize; 3], name: impl Fn(usize, usize) -> String, units: [f64; 3]) {
    let text = fs::read_to_string(format!("{}/docs/desk_arm_log.csv", crate::call::ROOT)).expect("the log");
    let mut written = String::from("time");
    for quantity in 0..3 {
        for joint in order {
            let _ = write!(written, ",{}", name(quantity, joint));
        }
    }
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let _ = write!(written, "\n{}", cells[0]);
        for (quantity, unit) in units.iter().enumerate() {
            for joint in order {
                let number: f64 = cells[1 + 3 * quantity + joint].parse().expect("a number");
                let _ = write!(written, ",{}", number / unit);
            }
        }
    }
    fs::write(path, written + "\n").expect("a file");
}

/// Whatever the order of columns and their units, the arm is the same one.
#[test]
fn columns_are_joints_by_number_and_say_their_units() {
    let folder = folder("log_columns");
    let path = folder.join("log.csv");
    let log = path.to_str().expect("UTF-8");
    let plain = |quantity: usize, joint: usize| format!("{}{}", ["q", "qd", "tau"][quantity], joint + 1);
    desk_log(&path, [0, 1, 2], plain, [1.0; 3]);
    let expected = judged(log, &[]);
    desk_log(&path, [2, 0, 1], plain, [1.0; 3]);
    assert_eq!(judged(log, &[]), expected);
    let degree = std::f64::consts::PI / 180.0;
    let said = |quantity: usize, joint: usize| {
        format!("{}{}{}", ["q", "qd", "tau"][quantity], joint + 1, [" [deg]", " [deg/s]", "[mNm]"][quantity])
    };
    desk_log(&path, [2, 0, 1], said, [degree, degree, 1e-3]);
    assert_eq!(judged(log, &[]), expected);
    let noted = fine(&["log", log]);
    assert!(noted.contains("converts numbers from the units in the names of columns: q1 [deg], q2 [deg]"), "{noted}");
    assert!(!noted.contains("--torque-constant"), "{noted}");
    fine(&["log", log, "--robot", "docs/desk_arm.yaml"]);
    // a joint that turns has no millimetres
    let of_slide = |quantity: usize, joint: usize| {
        format!("{}{} [{}]", ["q", "qd", "tau"][quantity], joint + 1, ["mm", "mm/s", "N"][quantity])
    };
    desk_log(&path, [0, 1, 2], of_slide, [1e-3, 1e-3, 1.0]);
    let turns = "the joint waist of the robot turns";
    fails(2, &["log", log, "--robot", "docs/desk_arm.yaml"], &[turns, "positions"]);
    fails(2, &["identify", "docs/desk_arm.yaml", log, "--judge"], &[turns]);
    // currents are none of its torques
    let currents = |quantity: usize, joint: usize| {
        format!("{}{}{}", ["q", "qd", "i"][quantity], joint + 1, ["", "", " [A]"][quantity])
    };
    desk_log(&path, [0, 1, 2], currents, [1.0; 3]);
    let asked = ["efforts of 1, 2, 3 are currents", "--torque-constant"];
    fails(2, &["identify", "docs/desk_arm.yaml", log, "--judge"], &asked);
    let called = rne(&["log", log]);
    assert!(called.status == 1 && asked.iter().all(|part| called.out.contains(part)), "{called:?}");
    fails(2, &["log", log, "-o", "-"], &asked);
    fine(&["log", log, "--torque-constant", "1"]);
}

fn judged(log: &str, more: &[&str]) -> String {
    let called = rne(&judge(log, more));
    assert_eq!(called.status, 0, "{}", called.err);
    called.out
}

fn judge<'a>(log: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    ["identify", "docs/desk_arm.yaml", log, "--judge"].into_iter().chain(more.iter().copied()).collect()
}

/// Names are those of the log: others are refused, whether its joints have names or numbers, and so is another number
/// of them. Numbers say an order.
#[test]
fn joints_are_named_as_the_log_names_them() {
    let folder = folder("log_names");
    let path = folder.join("log.csv");
    let log = path.to_str().expect("UTF-8");
    let plain = |quantity: usize, joint: usize| format!("{}{}", ["q", "qd", "tau"][quantity], joint + 1);
    desk_log(&path, [0, 1, 2], plain, [1.0; 3]);
    let expected = judged(log, &[]);
    for names in ["foo,bar,baz", "waist,shoulder,elbow", "elbow,shoulder,waist"] {
        let said = ["the log has no joint", "its joints are 1, 2, 3", "lists the joints to read"];
        fails(2, &judge(log, &["--joints", names]), &said);
        fails(2, &["watch", "docs/desk_arm.yaml", log, "--joints", names], &said);
        fails(2, &["log", log, "--joints", names], &said);
    }
    assert_eq!(judged(log, &["--joints", "1,2,3"]), expected);
    // a log that says another order is another log
    let reversed = |quantity: usize, joint: usize| format!("{}{}", ["q", "qd", "tau"][quantity], 3 - joint);
    desk_log(&path, [0, 1, 2], reversed, [1.0; 3]);
    assert_eq!(judged(log, &["--joints", "3,2,1"]), expected);
    // `rne log` has the robot's joints by name, of numbers by order
    assert!(fine(&["log", log, "--robot", "docs/desk_arm.yaml"]).contains("\n1  1 "));
    let named = |quantity: usize, joint: usize| {
        format!("{}.{}", ["position", "velocity", "effort"][quantity], ["waist", "shoulder", "elbow"][joint])
    };
    desk_log(&path, [2, 0, 1], named, [1.0; 3]);
    assert_eq!(judged(log, &[]), expected);
    assert!(fine(&["log", log, "--robot", "docs/desk_arm.yaml"]).contains("\n1  waist "));
    // two of its names, and not where they are
    let other = |quantity: usize, joint: usize| {
        format!("{}.{}", ["position", "velocity", "effort"][quantity], ["base", "elbow", "shoulder"][joint])
    };
    desk_log(&path, [0, 1, 2], other, [1.0; 3]);
    fails(2, &judge(log, &[]), &["3 joints (base, elbow, shoulder)", "shoulder has another place", "--joints"]);
    assert_eq!(judged(log, &["--joints", "base,elbow,shoulder"]), expected);
    // fewer or more than the robot has; what is advised is no circle
    let few = "use a log with all joints";
    fails(2, &["identify", "ur10", log], &["the log has 3 joints (base, elbow, shoulder), but the robot has 6 (", few]);
    let there = "names 3 joints of the log, which has base, elbow, shoulder, but the robot has 6 joints: shoulder";
    fails(2, &["identify", "ur10", log, "--joints", "base,elbow,shoulder"], &[there, few]);
    fails(
        2,
        &["watch", "planar2", log],
        &["the log has 3 joints (base, elbow, shoulder), but the robot has 2 (", "--joints lists"],
    );
    let there = "names 1 joint of the log, which has base, elbow, shoulder, but the robot has 3 joints: waist";
    fails(2, &judge(log, &["--joints", "base"]), &[there, "name one joint of the log for each joint of the robot"]);
}

/// Degrees are of what turns, where a robot file says what does.
#[test]
fn metres_of_a_slide_are_no_degrees() {
    let folder = folder("log_slide");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let robot = path("slide.yaml");
    let text = "{format: 1, name: slide, source: own, convention: standard, gravity: [0, 0, -9.81], joints: [\
                {name: rail, type: prismatic, dh: {theta: 0, d: 0, a: 0, alpha: pi/2}, link: {mass: 2}}, \
                {name: arm, type: revolute, dh: {theta: 0, d: 0, a: 0.3, alpha: 0}, \
                link: {mass: 1, com: [-0.1, 0, 0]}}]}";
    fs::write(&robot, text).expect("a robot file");
    let log = |name: &str, header: &str, unit: f64| {
        let rows = (0..600).map(|row| {
            let t = f64::from(row) * 0.01;
            let (rail, arm) = (0.4 * (2.0 * t).sin(), (3.0 * t).sin() / unit);
            format!("{t},{rail},{arm},{},{}\n", 30.0 + t.cos(), (2.5 * t).sin())
        });
        let path = path(name);
        fs::write(&path, format!("{header}\n{}", rows.collect::<String>())).expect("a log");
        path
    };
    let radians = log("log.csv", "t,q1,q2,tau1,tau2", 1.0);
    let account = |arguments: &[&str]| {
        let called = rne(arguments);
        (called.out, called.err)
    };
    let expected = account(&["identify", &robot, &radians, "--judge"]).0;
    let degrees = log("log.csv", "t,q1,q2,tau1,tau2", f64::to_radians(1.0));
    let (found, said) = account(&["identify", &robot, &degrees, "--judge", "--degrees"]);
    assert_eq!(found, expected);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("degrees are only for joints that turn: 1 slides, and is read in m and m/s"), "{said}");
    let said = fine(&["log", &degrees, "--degrees", "--robot", &robot]);
    assert!(
        said.contains("1  1      -0.4 … 0.4") && said.contains("degrees are only for joints that turn: 1"),
        "{said}"
    );
    let watched = account(&["watch", &robot, &degrees, "--degrees"]).1;
    assert!(watched.contains("joints that turn: 1"), "{watched}");
    // without a robot nobody knows, but its column may say it
    let said = fine(&["log", &degrees, "--degrees"]);
    assert!(!said.contains("-0.4 … 0.4") && !said.contains("that turn"), "{said}");
    let named = log("named.csv", "t,q1 [m],q2,tau1,tau2", f64::to_radians(1.0));
    let (found, said) = account(&["identify", &robot, &named, "--judge", "--degrees"]);
    assert_eq!(found.replace("named.csv", "log.csv"), expected);
    assert!(!said.contains("that turn"), "{said}");
}

/// Columns whose names are not understood are named where something is missing, and units that are converted.
#[test]
fn columns_that_are_not_understood_are_named() {
    let folder = folder("log_german");
    let path = folder.join("german.csv");
    let log = path.to_str().expect("UTF-8");
    let german =
        |quantity: usize, joint: usize| format!("Achse{}_{}", joint + 1, ["position", "speed", "Moment"][quantity]);
    desk_log(&path, [0, 1, 2], german, [1.0; 3]);
    let text = fs::read_to_string(&path).expect("a log");
    fs::write(&path, text.replacen("time", "Zeit [s]", 1)).expect("a log");
    let there =
        "the columns of this file are Zeit [s], Achse1_position, Achse2_position, Achse3_position, Achse1_speed";
    fails(2, &["log", log], &["no column has times", there, "--rate"]);
    let unread = "Zeit [s], Achse1_Moment, Achse2_Moment, Achse3_Moment";
    let said = fine(&["log", log, "--rate", "25"]);
    let place = |words: &str| said.find(words).unwrap_or_else(|| panic!("no `{words}` in {said}"));
    assert!(place(&format!("columns that are not read: {unread}")) < place("the log has no efforts"));
    let judge = judge(log, &["--rate", "25"]);
    fails(1, &judge, &["the log has no efforts", &format!("rne does not read the columns {unread}"), "tau1 or"]);
    // what is printed can be typed
    let efforts =
        "--map Achse1.effort=Achse1_Moment --map Achse2.effort=Achse2_Moment --map Achse3.effort=Achse3_Moment";
    fails(1, &judge, &["name the columns:", efforts]);
    fails(2, &["log", log], &["--time-column 'Zeit [s]' names the column of times"]);
    let map = [&["--map", "time=Zeit [s]"], efforts.split(' ').collect::<Vec<_>>().as_slice()].concat();
    let errors = |said: &str| said.split_once('\n').expect("two lines").1.to_owned();
    let mapped = errors(&judged(log, &map));
    // of a log that has all, nothing else is meant
    let timed = fs::read_to_string(&path).expect("a log").replace("Moment", "torque").replacen("Zeit", "t", 1);
    fs::write(&path, &timed).expect("a log");
    assert!(!fine(&["log", log]).contains("not read"));
    assert_eq!(errors(&judged(log, &[])), mapped, "the same log by its names");
    fails(
        2,
        &["log", log, "--rate", "25"],
        &["the column t [s] has times, but a sampling rate can be given only for tables", "remove --rate"],
    );
    fails(
        2,
        &["log", log, "--columns", "time,q,tau"],
        &["an order of columns can be given only for arrays of numpy, but this file is CSV", "remove --columns"],
    );
    let rows = timed.lines().skip(1).map(|line| {
        let (time, others) = line.split_once(',').expect("a time");
        format!("\n{},{others}", 1e3 * time.parse::<f64>().expect("a number"))
    });
    let header = timed.lines().next().expect("a header").replace("t [s]", "t [ms]");
    fs::write(&path, header + &rows.collect::<String>() + "\n").expect("a log");
    assert!(
        fine(&["log", log]).contains("note: rne converts numbers from the units in the names of columns: t [ms]\n")
    );
}

/// The line that a refused table gets can be typed, with the names of the robot's joints.
#[test]
fn a_table_without_known_names_gets_its_map() {
    let folder = folder("log_map");
    let path = folder.join("log.csv");
    let log = path.to_str().expect("UTF-8");
    let strange =
        |quantity: usize, joint: usize| format!("{} axis {}", ["Lage", "Geschw.", "Moment"][quantity], joint + 1);
    desk_log(&path, [0, 1, 2], strange, [1.0; 3]);
    let called = rne(&judge(log, &[]));
    assert_eq!(called.status, 1, "{called:?}");
    let said = called.err.split_whitespace().collect::<Vec<_>>().join(" ");
    insta::assert_snapshot!("map_of_a_refused_table", said.replace(log, "LOG"));
    let (_, line) = said.split_once("name the columns: ").expect("a line to type");
    let (line, _) = line.split_once(" For more").unwrap_or((line, ""));
    let options: Vec<String> = line.split("--map ").skip(1).map(|option| option.trim().replace('\'', "")).collect();
    let map: Vec<&str> = options.iter().flat_map(|option| ["--map", option]).collect();
    let mapped = judged(log, &map);
    desk_log(&path, [0, 1, 2], |quantity, joint| format!("{}{}", ["q", "qd", "tau"][quantity], joint + 1), [1.0; 3]);
    let errors = |said: &str| said.split_once('\n').expect("two lines").1.to_owned();
    assert_eq!(errors(&mapped), errors(&judged(log, &[])));
    for (option, wanted) in [
        ("q1", "write a meaning, `=` and a column"),
        ("base=q1", "neither `time` nor a joint with a quantity"),
        ("base.torque=q1", "the quantities are position, velocity, effort, acceleration"),
        ("base.position=w1", "no column `w1` for base.position"),
        ("base.position=q1 [furlong]", "`furlong` is not a unit for base.position"),
    ] {
        fails(2, &["log", log, "--map", option], &[wanted]);
    }
    fails(2, &["log", log, "--map", "a.effort=tau1", "--map", "b.effort=tau1"], &["the column `tau1` is mapped twice"]);
}

/// A table of three seconds at a hundred hertz.
fn table(time: impl Fn(u32) -> String) -> String {
    let row = |i: u32| {
        let angle = f64::from(i) * 0.01;
        format!("{},{:.6},{:.6}\n", time(i), angle.sin(), (2.0 * angle).cos())
    };
    format!("t,q1,tau1\n{}", (0..300).map(row).collect::<String>())
}

/// The end of a name says the format, and no other is written into it.
#[test]
fn a_motion_is_written_into_names_of_its_format() {
    let folder = folder("log_names");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    fs::write(path("log.csv"), table(|i| format!("{}", f64::from(i) * 0.01))).expect("a file");
    for (name, said) in [
        ("x.mcap", "x.mcap ends with .mcap, which this command does not write; name a file that ends with .csv or"),
        ("x.db3", "x.db3 ends with .db3, which this command does not write"),
        ("x.npy", "x.npy is an array of numpy, which rne log writes with --raw only; name a file that ends with"),
        ("x", "has no ending that gives the format; name a file that ends with .csv or .parquet"),
    ] {
        fails(2, &["log", &path("log.csv"), "--cutoff", "8", "-o", &path(name)], &[said]);
        assert!(!folder.join(name).exists(), "{name}");
    }
    assert_eq!(rne(&["log", &path("log.csv"), "--cutoff", "8", "-o", &path("x.CSV")]).status, 0);
}

/// Whole milliseconds are no seconds, and nobody has to guess what to do.
#[test]
fn the_unit_of_times_is_asked_for() {
    let folder = folder("log_units");
    let path = folder.join("log.csv").to_str().expect("UTF-8").to_owned();
    fs::write(&path, table(|i| i.to_string())).expect("a file");
    for command in [&["log", &path][..], &["identify", "planar2", &path, "-o", "-"], &["watch", "planar2", &path]] {
        fails(2, command, &["the unit of the times is not known", "1 kHz in ms", "--time-unit s, ms, us or ns"]);
    }
    assert!(fine(&["log", &path, "--time-unit", "ms", "--cutoff", "50"]).contains("1000 Hz"));
}

/// A header of 192 bytes, twelve types deep, took minutes.
#[test]
fn a_header_of_numpy_is_read_at_once() {
    let folder = folder("log_npy");
    let path = folder.join("deep.npy").to_str().expect("UTF-8").to_owned();
    let kind = "[('a', ".repeat(12) + "'<f8'" + &")]".repeat(12);
    let header = format!("{{'descr': {kind}, 'fortran_order': False, 'shape': (1, 2)}}\n");
    let length = u16::try_from(header.len()).expect("a short header").to_le_bytes();
    fs::write(&path, [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes()].concat()).expect("a file");
    let said = "the numbers are `[('a', [('a', ";
    for command in [
        &["log", &path][..],
        &["identify", "planar2", &path, "-o", "-"],
        &["watch", "planar2", &path],
        &["eval", "planar2", "--function", "gravity_torques", "--states", &path],
    ] {
        fails(1, command, &[said, "save them as float64"]);
    }
}
