//! `rne identify`: what it finds, what it says of a log that does not tell, and what it refuses.

use std::fs;
use std::path::Path;

use crate::call::{ROOT, fails, fine, folder, rne};

const ARM: &str = "docs/desk_arm.yaml";
const LOG: &str = "docs/desk_arm_log.csv";

/// The log with a change of each row: its number from 0, and its cells.
fn changed(path: &Path, change: impl Fn(usize, &mut Vec<String>)) -> String {
    let log = fs::read_to_string(format!("{ROOT}/{LOG}")).expect("a log");
    let mut text = String::new();
    for (row, line) in log.lines().enumerate() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if row > 0 {
            change(row - 1, &mut cells);
        }
        text += &(cells.join(",") + "\n");
    }
    fs::write(path, text).expect("a file");
    path.to_str().expect("UTF-8").to_owned()
}

/// The columns of the efforts.
const EFFORTS: std::ops::Range<usize> = 7..10;

/// One effort of the shoulder, at 8 s.
fn with_effort(path: &Path, effort: &str) -> String {
    changed(path, |row, cells| {
        if row == 200 {
            effort.clone_into(&mut cells[8]);
        }
    })
}

/// The friction of the shoulder in the account.
fn friction(account: &str) -> Vec<f64> {
    let (_, below) = account.split_once("friction at the joint").expect("a table");
    let line = below.lines().find(|line| line.trim_start().starts_with("shoulder")).expect("a row");
    let numbers = line.split_whitespace().filter_map(|word| word.parse().ok());
    numbers.step_by(2).take(3).collect()
}

/// A spike, or a number that nobody measured, is left out and said; friction stays what it was put in as.
#[test]
fn one_wrong_effort_spoils_nothing() {
    let folder = folder("identify_spike");
    for (effort, said) in [
        ("10000", ["10000 of shoulder at 8.000", "an identification leaves such samples out"]),
        ("-60", ["-60 of shoulder at 8.000", "an identification leaves such samples out"]),
        ("1e300", ["row 201 at 8.000 s", "effort of shoulder: 1.00e300"]),
        ("1e155", ["row 201 at 8.000 s", "effort of shoulder: 1.00e155"]),
        ("inf", ["row 201 at 8.000 s", "left out: 1 row"]),
    ] {
        let log = with_effort(&folder.join("log.csv"), effort);
        let called = rne(&["identify", ARM, &log]);
        let err = called.err.replace("\n         ", " ");
        assert!(called.status == 0 && said.iter().all(|said| err.contains(said)), "{effort}: {called:?}");
        let [viscous, forward, backward] = friction(&called.out)[..] else { panic!("{}", called.out) };
        for (found, truth) in [(viscous, 0.6), (forward, 0.8), (backward, 0.8)] {
            assert!((found - truth).abs() < 0.05, "{effort}: {found} {truth}");
        }
        assert!(called.out.contains("15 of them excited"), "{}", called.out);
        assert!(called.out.lines().chain(called.err.lines()).all(|line| line.len() < 120), "{called:?}");
    }
}

/// A push, or a sensor that fails for a while, spoils nothing either.
#[test]
fn what_is_of_no_free_motion_does_not_count() {
    let folder = folder("identify_push");
    let failed = changed(&folder.join("log.csv"), |row, cells| {
        if (200..205).contains(&row) {
            cells[8] = "300".to_owned();
        }
    });
    for (log, said) in [("docs/desk_arm_knock.csv", "the first at 9.29 s"), (&failed, "the first at 7.81 s")] {
        let called = rne(&["identify", ARM, log]);
        let words = called.said();
        let warned = words.contains("rows of shoulder are outliers and are ignored") && words.contains(said);
        assert!(called.status == 0 && warned, "{called:?}");
        let [viscous, forward, backward] = friction(&called.out)[..] else { panic!("{}", called.out) };
        // the offset, half the difference, is hard to tell from the weight of an arm that moves little
        let offset = 0.5 * (forward - backward);
        for (found, truth, most) in [(viscous, 0.6, 0.03), (forward - offset, 0.8, 0.03), (offset, 0.0, 0.06)] {
            assert!((found - truth).abs() < most, "{log}: {found} {truth}");
        }
        assert!(called.out.contains("15 of them excited") && !called.out.contains("not excited"), "{}", called.out);
    }
    assert!(!rne(&["identify", ARM, LOG]).err.contains("far from all others"));
}

/// An arm that stands still: nothing is excited, and no file is written of it.
#[test]
fn nothing_is_excited_by_an_arm_that_stands_still() {
    let folder = folder("identify_still");
    let log = fs::read_to_string(format!("{ROOT}/{LOG}")).expect("a log");
    let first: Vec<String> = log.lines().nth(1).expect("a row").split(',').map(str::to_owned).collect();
    let still = changed(&folder.join("still.csv"), |_, cells| {
        cells[1..].clone_from_slice(&first[1..]);
        cells[4..7].fill("0".to_owned());
    });
    let out = folder.join("still.yaml");
    let called = rne(&["identify", ARM, &still, "-o", out.to_str().expect("UTF-8")]);
    assert_eq!(called.status, 1, "{called:?}");
    assert!(called.out.contains(", 0 of them excited;"), "{}", called.out);
    assert!(!called.out.contains("± 0 "), "{}", called.out);
    let said = called.said();
    assert!(said.contains("nothing is excited") && said.contains("still.yaml is not written"), "{said}");
    assert!(said.contains("efforts of waist are -2.260 throughout"), "{said}");
    assert!(!out.exists());
}

/// An offset that is larger than Coulomb friction has no place in a robot file, and no arm has efforts of the wrong
/// sign: both are said.
#[test]
fn what_no_model_explains_is_said() {
    let folder = folder("identify_strange");
    let shifted = changed(&folder.join("shifted.csv"), |_, cells| {
        cells[7] = (cells[7].parse::<f64>().expect("a number") + 3.0).to_string();
    });
    let called = rne(&["identify", ARM, &shifted]);
    assert_eq!(called.status, 0, "{called:?}");
    let said = called.said();
    let (_, said) = said.split_once("warning: waist has an offset of ").expect("a warning");
    let number = |text: &str| {
        let word = text.split_whitespace().next().expect("a word");
        word.trim_end_matches(',').parse::<f64>().expect("a number")
    };
    let (_, coulomb) = said.split_once("which is ").expect("both");
    assert!((number(said) - 3.0).abs() < 0.05 && (number(coulomb) - 0.5).abs() < 0.05, "{said}");
    let turned = changed(&folder.join("turned.csv"), |_, cells| {
        cells[7] = (-cells[7].parse::<f64>().expect("a number")).to_string();
    });
    let called = rne(&["identify", ARM, &turned]);
    assert!(called.said().contains("no model of the arm explains the efforts of waist"), "{called:?}");
    for log in [LOG, "docs/desk_arm_knock.csv"] {
        let said = rne(&["identify", ARM, log]).said();
        assert!(!said.contains("no model of the arm") && !said.contains("has an offset"), "{said}");
    }
}

#[test]
fn what_cannot_be_identified_is_said() {
    let folder = folder("identify_wrong");
    let out = folder.join("out.yaml");
    let out = out.to_str().expect("UTF-8");
    fails(1, &["identify", ARM, LOG, "--hold-out", "0.99", "-o", out], &["0 rows of each joint", "21 are needed"]);
    fails(1, &["identify", ARM, LOG, "--cutoff", "0.2", "-o", out], &["rows of each joint", "higher cut-off"]);
    for cutoff in ["1e-300", "1e-9", "0.01", "7.6", "13", "1e5", "1e9", "1e300"] {
        let said = ["--cutoff", "samples at 25.0000 Hz in runs of 15.96 s", "from 0.165 to 7.500 Hz"];
        fails(2, &["identify", ARM, LOG, "--cutoff", cutoff, "-o", out], &said);
        fails(2, &["watch", ARM, LOG, "--cutoff", cutoff], &["--cutoff", "samples at 25.0000 Hz"]);
    }
    fails(2, &["identify", ARM, LOG, "--cutoff", "0"], &["a number of Hz above 0"]);
    for factor in [0.0, 1e-200] {
        let log = changed(&folder.join("log.csv"), |_, cells| {
            for cell in &mut cells[EFFORTS] {
                *cell = (cell.parse::<f64>().expect("a number") * factor).to_string();
            }
        });
        fails(1, &["identify", ARM, &log, "-o", out], &["efforts of all joints are zero"]);
    }
    let huge = changed(&folder.join("log.csv"), |_, cells| cells[7] = "1e200".to_owned());
    fails(
        1,
        &["identify", ARM, &huge, "-o", out],
        &["no row of the log contains a state of the arm", "effort of waist: 1.00e200"],
    );
    let degrees = changed(&folder.join("log.csv"), |_, cells| {
        for cell in &mut cells[1..7] {
            *cell = cell.parse::<f64>().expect("a number").to_degrees().to_string();
        }
    });
    fails(2, &["identify", ARM, &degrees, "-o", out], &["more than 4π", "--degrees"]);
    let text = fine(&["identify", ARM, &degrees, "--degrees"]);
    assert!(text.contains("15 of them excited"), "{text}");
    let without = fs::read_to_string(format!("{ROOT}/{LOG}")).expect("a log").replace("shoulder_effort", "other");
    let path = folder.join("without.csv");
    fs::write(&path, without).expect("a file");
    fails(1, &["identify", ARM, path.to_str().expect("UTF-8")], &["no efforts of shoulder"]);
    assert!(!Path::new(out).exists());
}

/// What `rne log` says of a log, and takes, `rne identify` and `rne watch` do too.
#[test]
fn logs_are_read_as_rne_log_reads_them() {
    let folder = folder("identify_reading");
    let quick = changed(&folder.join("quick.csv"), |_, cells| {
        cells[5] = (1.3 * cells[5].parse::<f64>().expect("a number")).to_string();
    });
    let said = "measured velocities differ from the derivative of positions by 30 % at shoulder";
    for command in ["identify", "watch"] {
        let called = rne(&[command, ARM, &quick]);
        assert!(called.err.contains("warning") && called.said().contains(said), "{called:?}");
        let called = rne(&[command, ARM, &quick, "--derive-velocities"]);
        assert!(!called.said().contains(said), "{called:?}");
    }
    let log = fs::read_to_string(format!("{ROOT}/{LOG}")).expect("a log");
    let untimed: String = log.lines().map(|line| line.split_once(',').expect("cells").1.to_owned() + "\n").collect();
    let path = folder.join("untimed.csv");
    fs::write(&path, untimed).expect("a file");
    let account = |arguments: &[&str]| {
        let text = fine(&[&["identify", ARM], arguments].concat());
        text.split_once('\n').expect("lines").1.to_owned()
    };
    let plain = account(&[LOG]);
    assert_eq!(account(&[path.to_str().expect("UTF-8"), "--rate", "25"]), plain);
    let milliseconds = changed(&folder.join("ms.csv"), |row, cells| cells[0] = (40 * row).to_string());
    assert_eq!(account(&[&milliseconds, "--time-unit", "ms"]), plain);
    // the name that it had
    assert_eq!(account(&[LOG, "--torque-constant", "1"]), account(&[LOG, "--torque-constants", "1,1,1"]));
    // letters that a terminal obeys are not shown
    let named = rne(&["identify", ARM, LOG, "--joints", "waist,shoulder,el\u{1b}[31mbow"]);
    assert!(named.status == 2 && named.err.contains("no joint"), "{named:?}");
    assert!(!named.err.contains('\u{1b}'), "{named:?}");
}

/// Friction of the file is not in a model without friction.
#[test]
fn without_friction_there_is_none() {
    let folder = folder("identify_frictionless");
    let out = folder.join("out.yaml");
    let path = out.to_str().expect("UTF-8");
    let file = "docs/desk_arm_identified.yaml";
    let called = rne(&["identify", file, LOG, "--no-friction", "-o", path]);
    assert_eq!(called.status, 0, "{called:?}");
    let text = fs::read_to_string(&out).expect("a robot file");
    assert!(!text.contains("viscous") && !text.contains("coulomb"), "{text}");
    // what is said of the log is what the file that is written says of it
    let judged = fine(&["identify", path, LOG, "--judge"]);
    let table = |text: &str| text.split_once("error: RMS of").expect("a table").1.to_owned();
    assert_eq!(table(&judged), table(&called.out));
}

/// A file is judged by all states, spikes with them; and it is said how many these are.
#[test]
fn a_file_is_judged_by_all_that_there_is() {
    let folder = folder("identify_judge");
    let text = fine(&["identify", "docs/desk_arm_identified.yaml", LOG, "--judge"]);
    assert!(text.replace('\n', " ").contains("400 of 400 states"), "{text}");
    let spike = with_effort(&folder.join("log.csv"), "10000");
    let judged = rne(&["identify", "docs/desk_arm_identified.yaml", &spike, "--judge"]);
    assert!(judged.said().contains("10000 of shoulder"), "{judged:?}");
    let row = judged.out.lines().find(|line| line.starts_with("  shoulder")).expect("a row");
    let unfiltered = row.split_whitespace().nth(3).and_then(|word| word.parse::<f64>().ok());
    assert!(unfiltered.is_some_and(|percent| percent > 90.0), "{row}");
}

/// A place that cannot be written is told before anything is read.
#[test]
fn places_are_looked_at_first() {
    let folder = folder("identify_places");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    // the log is not looked at: it is not there
    let none = path("none.csv");
    for (option, place, said) in [
        ("-o", path("nowhere/out.yaml"), "there is no folder"),
        ("--plot", path("nowhere/out.svg"), "there is no folder"),
        ("-o", path(""), "is a folder"),
        ("--plot", path(""), "is a folder"),
        ("--plot", "-".to_owned(), "needs the name of a file"),
    ] {
        let status = if said == "there is no folder" { 1 } else { 2 };
        fails(status, &["identify", ARM, &none, option, &place], &[said]);
    }
    let both = path("both");
    let again = path("../identify_places/both");
    fails(2, &["identify", ARM, LOG, "-o", &both, "--plot", &both], &["both the robot file and the picture"]);
    fails(2, &["identify", ARM, LOG, "-o", &both, "--plot", &again], &["both the robot file and the picture"]);
    fs::write(&both, "mine").expect("a file");
    fails(2, &["identify", ARM, LOG, "-o", &both], &["--force"]);
    fails(2, &["identify", ARM, LOG, "--force", "-o", &format!("{ROOT}/{LOG}")], &["is the file that is read"]);
    assert_eq!(fs::read_to_string(&both).expect("a file"), "mine");
    // standard output has the file alone
    let called = rne(&["identify", ARM, LOG, "-o", "-"]);
    assert!(called.status == 0 && called.out.starts_with("# Identified from 400 states"), "{called:?}");
    assert!(called.said().contains("base parameters"), "{called:?}");
    assert!(!Path::new(ROOT).join("-").exists());
    let out = path("out.yaml");
    assert_eq!(rne(&["identify", ARM, LOG, "-o", &out, "--plot", &path("out.svg")]).status, 0);
    assert_eq!(fs::read_to_string(&out).expect("a file"), called.out);
    // once more is the same
    assert!(rne(&["identify", ARM, LOG, "-o", &out]).err.contains("up to date"));
}
