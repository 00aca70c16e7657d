//! `rne identify`: what it finds, what it says of a log that does not tell, and what it refuses.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::call::{EFFORTS as TAKEN_AS_TORQUES, ROOT, command, fails, fine, folder, rne};

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
        let called = rne(&["identify", ARM, &log, "--all"]);
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
        let called = rne(&["identify", ARM, log, "--all"]);
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
    let called = rne(&["identify", ARM, &still, "--all", "-o", out.to_str().expect("UTF-8")]);
    assert_eq!(called.status, 1, "{called:?}");
    assert!(called.out.contains(", 0 of them excited;"), "{}", called.out);
    assert!(!called.out.contains("± 0 "), "{}", called.out);
    let said = called.said();
    assert!(said.contains("nothing is excited") && said.contains("still.yaml is not written"), "{said}");
    assert!(said.contains("efforts of waist are -2.260 in the whole log"), "{said}");
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
    fails(1, &["identify", ARM, LOG, "--hold-out", "0.99", "-o", out], &["0 rows for each joint", "21 are needed"]);
    fails(1, &["identify", ARM, LOG, "--cutoff", "0.2", "-o", out], &["rows for each joint", "higher cut-off"]);
    for cutoff in ["1e-300", "1e-9", "0.01", "7.6", "13", "1e5", "1e9", "1e300"] {
        let said = ["--cutoff", "have 15.96 s at most", "from 0.165 to 7.500 Hz"];
        fails(2, &["identify", ARM, LOG, "--cutoff", cutoff, "-o", out], &said);
        fails(2, &["watch", ARM, LOG, "--cutoff", cutoff], &["--cutoff", "samples at 25.0000 Hz"]);
    }
    fails(2, &["identify", ARM, LOG, "--cutoff", "0"], &["a number above 0, in Hz"]);
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
    assert!(text.contains("The log determines all 15 base parameters"), "{text}");
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
    let called = rne(&["identify", file, LOG, "--no-friction", "--all", "-o", path]);
    assert_eq!(called.status, 0, "{called:?}");
    let text = fs::read_to_string(&out).expect("a robot file");
    assert!(!text.contains("viscous") && !text.contains("coulomb"), "{text}");
    // what is said of the log is what the file that is written says of it
    let judged = fine(&["identify", path, LOG, "--judge", "--all"]);
    let table = |text: &str| text.split_once("error: RMS of").expect("a table").1.to_owned();
    assert_eq!(table(&judged), table(&called.out));
}

/// A file is judged by all states, spikes with them; and it is said how many these are.
#[test]
fn a_file_is_judged_by_all_that_there_is() {
    let folder = folder("identify_judge");
    let text = fine(&["identify", "docs/desk_arm_identified.yaml", LOG, "--judge", "--all"]);
    assert!(text.replace('\n', " ").contains("400 of 400 states"), "{text}");
    let spike = with_effort(&folder.join("log.csv"), "10000");
    let judged = rne(&["identify", "docs/desk_arm_identified.yaml", &spike, "--judge", "--all"]);
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
    fails(2, &["identify", ARM, LOG, "--force", "-o", &format!("{ROOT}/{LOG}")], &["is also the file that rne reads"]);
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

const UR10: [&str; 2] = ["logs/identify/tests/logs/ur10_log.yaml", "logs/identify/tests/logs/ur10.csv"];
const PANDA: [&str; 2] = ["logs/identify/tests/logs/panda_log.yaml", "logs/identify/tests/logs/panda.csv"];

/// The first block of what is printed.
fn first_block(out: &str) -> String {
    let lines: Vec<&str> = out.lines().take_while(|line| !line.is_empty()).collect();
    assert!(lines.len() <= 10 && lines.iter().all(|line| line.chars().count() <= 80), "{out}");
    lines.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The verdict stands first: how many joints the model predicts and how well, which it does not and why, and what a
/// motion that excites more would teach.
#[test]
fn the_verdict_is_the_first_block() {
    for (log, said) in [
        (
            UR10,
            &[
                "predicts the torque of 5 of 6 joints on held-out data (from 13.5 s on), with RMS errors of ",
                " to 15 % of its standard deviation (limit: 25 %)",
                "wrist_3_joint (68 %) is not predicted: it stands still from 17.9 to 19.2 s, where static friction is",
                "in motion, its error is 26 %",
                "determines 18 of 36 base parameters and the friction of all 6 joints",
                "but not 18 inertias of links 2 to 6: the model holds for similar motions only",
                "`rne excite logs/identify/tests/logs/ur10_log.yaml` designs a better motion",
            ][..],
        ),
        (
            PANDA,
            &[
                "predicts the torque of 4 of 7 joints on held-out data (from 11.8 s on)",
                "fer_joint7 (39 %) is not predicted: its error is 12 % on the fitted part only",
                "fer_joint5 (28 %) is not predicted: its error is 7.1 % on the fitted part only",
                "fer_joint1 (23 %) is not predicted: noise is ",
                "determines 18 of 43 base parameters",
            ],
        ),
    ] {
        let called = rne(&[&["identify"][..], &log, &["--hold-out", "0.3"]].concat());
        assert_eq!(called.status, 0, "{called:?}");
        let block = first_block(&called.out);
        for said in said {
            assert!(block.contains(said), "{said}\n{block}");
        }
        // tables of parameters are for who asks
        let all = rne(&[&["identify"][..], &log, &["--hold-out", "0.3", "--all"]].concat()).out;
        assert_eq!(first_block(&all), block);
        for title in ["base parameters: by least squares", "friction at the joint", "on the held-out part of the log"] {
            assert!(!called.out.contains(title) && all.contains(title), "{}\n{all}", called.out);
        }
    }
    // without other data it is said that there is none
    let block = first_block(&fine(&["identify", ARM, LOG]));
    let said = "reproduces the torque of all 3 joints on the data that it was fitted to";
    assert!(
        block.contains(said) && block.contains("--hold-out 0.3 computes errors on data that it was not"),
        "{block}"
    );
    let block = first_block(&fine(&["identify", ARM, LOG, "--hold-out", "0.3"]));
    assert!(
        !block.contains("fitted") && block.contains("predicts the torque of all 3 joints on held-out data"),
        "{block}"
    );
    // a file that is judged without its friction
    let block = first_block(&fine(&["identify", ARM, LOG, "--judge"]));
    assert!(block.contains("waist (71 %) is not predicted: the robot file has no friction for it"), "{block}");
    assert!(!block.contains("determines") && !block.contains("rne excite"), "{block}");
}

/// On a terminal, which shows both streams, the verdict stands before notes and warnings.
#[test]
fn remarks_come_after_the_verdict() {
    let path = folder("identify_streams").join("both.txt");
    let both = fs::File::create(&path).expect("a file");
    let mut call = command(&[&["identify"][..], &UR10, &["--hold-out", "0.3"]].concat());
    let status = call.stdout(both.try_clone().expect("a file")).stderr(both).status().expect("rne runs");
    let said = fs::read_to_string(&path).expect("a file");
    assert!(status.success() && said.starts_with("ur10_log from ur10.csv"), "{said}");
    let (verdict, warning) = (said.find("wrist_3_joint (68"), said.find("warning: the held-out"));
    assert!(verdict.is_some() && verdict < warning, "{said}");
}

/// However many joints are not predicted, there are ten lines.
#[test]
fn a_verdict_has_ten_lines_at_most() {
    let folder = folder("identify_verdict");
    let shuffled = |path: &Path| {
        changed(path, |row, cells| {
            // efforts that no model explains
            for (column, cell) in cells[EFFORTS].iter_mut().enumerate() {
                *cell = if (row * (7 + column)) % 13 < 6 { "20" } else { "-20" }.to_owned();
            }
        })
    };
    let log = shuffled(&folder.join("a_log_with_quite_a_long_name_so_that_the_heading_takes_two_lines.csv"));
    let called = rne(&["identify", ARM, &log, "--hold-out", "0.4"]);
    let block = first_block(&called.out);
    assert!(block.contains("predicts the torque of no joint on held-out data"), "{block}");
    for joint in ["waist (", "shoulder (", "elbow ("] {
        assert!(block.contains(joint), "{block}");
    }
}

/// A held-out error that is manifold the fitted one is a warning with the joint's name and both numbers.
#[test]
fn a_manifold_error_is_a_warning() {
    let called = rne(&[&["identify"][..], &UR10, &["--hold-out", "0.3"]].concat());
    let said = called.said();
    let (_, said) =
        said.split_once("warning: the held-out error is more than twice the error on the fitted part: ").expect("one");
    for joint in ["wrist_1_joint (10 %, fitted 4.7 %)", "wrist_3_joint (68 %, fitted 21 %)"] {
        assert!(said.contains(joint), "{said}");
    }
    assert!(!said.contains("elbow_joint"), "{said}");
    for arguments in [&[UR10[0], UR10[1]][..], &[ARM, LOG, "--hold-out", "0.3"]] {
        let called = rne(&[&["identify"], arguments].concat());
        assert!(!called.said().contains("held-out error"), "{called:?}");
    }
}

/// `rne log`, `rne identify` and `rne watch` say in the same words that efforts are taken as torques; not where the log
/// or the caller gives a unit.
#[test]
fn efforts_that_are_taken_as_torques_are_said() {
    let folder = folder("identify_efforts");
    let said = |arguments: &[&str]| {
        let called = rne(arguments);
        (called.out + &called.err).split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let sentence = TAKEN_AS_TORQUES.split_whitespace().collect::<Vec<_>>().join(" ");
    let log = fs::read_to_string(format!("{ROOT}/{LOG}")).expect("a log").replace("_effort", "_torque [Nm]");
    let named = folder.join("named.csv");
    fs::write(&named, log).expect("a file");
    let named = named.to_str().expect("UTF-8");
    for command in [&["log"][..], &["identify", ARM], &["identify", ARM, "--judge"], &["watch", ARM]] {
        assert_eq!(said(&[command, &[LOG]].concat()).matches(&sentence).count(), 1, "{command:?}");
        for other in [&[named][..], &[LOG, "--torque-constant", "1"]] {
            assert!(!said(&[command, other].concat()).contains("taken as torques"), "{command:?} {other:?}");
        }
    }
    // both logs of a watch say it once
    let watched = ["watch", "docs/desk_arm_identified.yaml", "docs/desk_arm_knock.csv", "--quiet", LOG];
    assert_eq!(said(&watched).matches(&sentence).count(), 1);
}

/// The numbers of a table's row.
fn row(out: &str, name: &str) -> Vec<f64> {
    let line = out.lines().find(|line| line.starts_with(&format!("  {name} "))).expect("a row");
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// The keys of a value and of all that is in it.
fn keys_of(value: &Value, seen: &mut Vec<String>) {
    match value {
        Value::Object(of) => of.iter().for_each(|(key, value)| {
            seen.push(key.clone());
            keys_of(value, seen);
        }),
        Value::Array(of) => of.iter().for_each(|value| keys_of(value, seen)),
        _ => (),
    }
}

/// The JSON has the numbers of the tables, with deviations.
#[test]
fn the_reply_is_the_account() {
    let arguments = [&["identify"][..], &UR10, &["--hold-out", "0.3"]].concat();
    let json = |more: &[&str]| -> Value {
        let called = rne(&[&arguments[..], more].concat());
        serde_json::from_str(&called.out).unwrap_or_else(|error| panic!("{error}: {called:?}"))
    };
    let reply = json(&["--json"]);
    let keys: Vec<&String> = reply.as_object().expect("an object").keys().collect();
    let mut documented = fs::read_to_string(format!("{ROOT}/docs/control/identify.md")).expect("a page");
    documented = documented.split_once("## As JSON").expect("a section").1.to_owned();
    let mut seen = Vec::new();
    keys_of(&reply, &mut seen);
    for key in seen {
        assert!(documented.contains(&format!("`{key}`")), "{key} is not in docs/control/identify.md");
    }
    assert!(keys.len() >= 11, "{keys:?}");
    assert_eq!(reply["robot"], "ur10_log");
    assert_eq!(reply["logs"][0], UR10[1]);
    assert_eq!(reply["verdict"]["errors_on"], "held_out");
    assert_eq!(reply["verdict"]["not_predicted"][0], "wrist_3_joint");
    assert_eq!(reply["verdict"]["excited_base_parameters"], 18);
    assert_eq!(
        reply["states"].as_u64().expect("a count") + reply["held_out"]["states"].as_u64().expect("a count"),
        602
    );
    let doubt = &reply["joints"][5]["doubts"][0];
    assert!(doubt["reason"] == "standstill" && doubt["from"].as_f64().is_some_and(|from| from > 17.5), "{doubt}");

    let all = rne(&[&arguments[..], &["--all"]].concat()).out;
    let text = rne(&arguments).out;
    let errors = row(&text, "elbow_joint");
    let elbow = &reply["joints"][2];
    let near = |a: &Value, b: f64, step: f64| a.as_f64().is_some_and(|a| (a - b).abs() <= 0.5001 * step);
    assert!(near(&elbow["fitted"]["error"], 0.01 * errors[0], 1e-3), "{elbow} {errors:?}");
    assert!(near(&elbow["held_out"]["error"], 0.01 * errors[1], 1e-3), "{elbow} {errors:?}");
    assert!(near(&elbow["held_out"]["residual"], errors[2], 1e-3), "{elbow} {errors:?}");
    let mass =
        &reply["base_parameters"].as_array().expect("a list").iter().find(|base| base["name"] == "mcx3").expect("mcx3");
    let numbers = row(&all, "mcx3");
    assert!(near(&mass["value"], numbers[0], 1e-4) && near(&mass["deviation"], numbers[1], 1e-4), "{mass} {numbers:?}");
    let friction = &reply["friction"][2];
    let (_, below) = all.split_once("friction at the joint").expect("a table");
    let numbers = row(below, "elbow_joint");
    for (at, key) in ["viscous", "coulomb_forward", "coulomb_backward"].into_iter().enumerate() {
        assert!(near(&friction[key]["value"], numbers[2 * at], 1e-3), "{friction} {numbers:?}");
        assert!(near(&friction[key]["deviation"], numbers[2 * at + 1], 1e-3), "{friction} {numbers:?}");
    }
    assert!(all.contains("lag 10.5 ± 4.8 ms") && near(&reply["delay"]["value"], 0.0105, 1e-4), "{}", reply["delay"]);

    let judged: Value =
        serde_json::from_str(&fine(&["identify", "docs/desk_arm_identified.yaml", LOG, "--judge", "--json"]))
            .expect("JSON");
    assert_eq!(judged["verdict"]["errors_on"], "judged");
    assert!(judged["joints"][0]["judged"]["error"].is_number() && judged["states"] == 400, "{judged}");
    fails(2, &["identify", ARM, LOG, "--json", "-o", "-"], &["--json and -o - both write to standard output"]);
    fails(2, &["identify", ARM, LOG, "--json", "--all"], &["--all"]);
}

/// The offset of the shoulder is hidden by gravity in the first third of the log, and its Coulomb friction is not.
#[test]
fn an_offset_that_gravity_hides_is_named_once() {
    let folder = folder("identify_offset");
    let log = folder.join("short.csv").to_str().expect("UTF-8").to_owned();
    let whole = fs::read_to_string(format!("{ROOT}/{}", UR10[1])).expect("a log");
    let short: Vec<&str> = whole.lines().take(331).collect();
    fs::write(&log, short.join("\n")).expect("a file");
    let arguments = ["identify", UR10[0], &log, "--hold-out", "0.3"];
    let called = rne(&arguments);
    let said = called.err.split_whitespace().collect::<Vec<_>>().join(" ");
    let note = "note: the log does not determine the offset of joint 2: gravity hides it. Therefore rne uses the same \
                Coulomb friction in both directions of joint 2";
    assert_eq!((said.matches(note).count(), called.out.contains("gravity")), (1, false), "{called:?}");
    assert!(called.out.contains("the friction of all 6 joints"), "{called:?}");
    let [fitted, held_out, ..] = row(&called.out, "shoulder_lift_joint")[..] else { panic!("{called:?}") };
    assert!(fitted < 5.0 && held_out < 10.0, "{called:?}");
    let reply: Value = serde_json::from_str(&rne(&[&arguments[..], &["--json"]].concat()).out).expect("JSON");
    assert_eq!(reply["verdict"]["not_excited_offset"], serde_json::json!(["shoulder_lift_joint"]));
    assert_eq!(reply["verdict"]["excited_frictions"], 6);
    let shoulder = &reply["friction"][1];
    assert!(shoulder["excited"] == true && shoulder["offset_excited"] == false, "{shoulder}");
    assert_eq!(shoulder["coulomb_forward"]["value"], shoulder["coulomb_backward"]["value"]);
    assert_eq!(reply["friction"][0]["offset_excited"], true);
}

/// A picture and a robot file name the log, not the title of the file with the geometry; the picture's errors are
/// those of the table.
#[test]
fn titles_name_the_log() {
    let folder = folder("identify_titles");
    let path = |name: &str| folder.join(name).to_str().expect("UTF-8").to_owned();
    let read = |name: &str| fs::read_to_string(folder.join(name)).expect("a file");
    let out = fs::read_to_string(format!("{ROOT}/{ARM}")).expect("a robot file");
    assert!(out.contains("title: Desk arm (RRR)"));
    let (held, whole, judged, arm) = (path("held.svg"), path("whole.svg"), path("judged.svg"), path("arm.yaml"));
    let text = rne(&["identify", ARM, LOG, "--hold-out", "0.3", "--plot", &held, "-o", &arm]).out;
    assert_eq!(rne(&["identify", ARM, LOG, "--plot", &whole]).status, 0);
    assert_eq!(rne(&["identify", &arm, LOG, "--judge", "--plot", &judged]).status, 0);
    let title = "desk_arm identified from desk_arm_log.csv (400 states at 25 Hz)";
    assert!(read("arm.yaml").contains(&format!("title: {title}")));
    for (picture, said) in [
        ("held.svg", [title, "held-out part of the log, from 11.2 s on; both torques low-passed at 1.6 Hz"]),
        ("whole.svg", [title, "the data of the identification; both"]),
        ("judged.svg", ["desk_arm on desk_arm_log.csv (400 states at 25 Hz)", "the whole log; both"]),
    ] {
        let svg = read(picture);
        assert!(said.iter().all(|said| svg.contains(said)) && !svg.contains("RRR"), "{svg:.800}");
    }
    for joint in ["waist", "shoulder", "elbow"] {
        let error = format!(">error {:.1} %<", row(&text, joint)[1]);
        assert!(read("held.svg").contains(&error), "{joint}: {error}");
    }
}

const IDENTIFIED: &str = "docs/desk_arm_identified.yaml";
const LOADED: &str = "docs/desk_arm_loaded.csv";

/// The payload that was computed into the log is found, and the file with it predicts the log.
#[test]
fn a_payload_is_found_and_written() {
    let written = folder("identify_payload").join("with_payload.yaml");
    let written = written.to_str().expect("UTF-8");
    let called = rne(&["identify", IDENTIFIED, LOADED, "--payload", "-o", written]);
    assert_eq!(called.status, 0, "{called:?}");
    let out = called.out;
    let verdict = out.lines().nth(1).expect("a verdict");
    assert!(verdict.starts_with("payload 0.80") && verdict.contains("centre of mass (0.02"), "{out}");
    let reply: Value =
        serde_json::from_str(&fine(&["identify", IDENTIFIED, LOADED, "--payload", "--json"])).expect("JSON");
    let payload = &reply["payload"];
    let number = |value: &Value, truth: f64| {
        let [value, deviation] = ["value", "deviation"].map(|key| value[key].as_f64().expect("a number"));
        assert!((value - truth).abs() < 3.0 * deviation, "{value} ± {deviation}, not {truth}");
        deviation
    };
    assert!(number(&payload["mass"], 0.8) < 0.1);
    for (axis, truth) in [0.02, 0.0, 0.05].into_iter().enumerate() {
        assert!(number(&payload["com"][axis], truth) < 0.04);
    }
    assert_eq!((payload["found"].as_bool(), payload["inertia"].as_array().map(Vec::len)), (Some(true), Some(6)));
    for joint in reply["joints"].as_array().expect("a list") {
        let [before, after] = ["error", "error_with_payload"].map(|key| joint[key].as_f64().expect("a number"));
        assert!(after < 0.1 * before, "{joint}");
    }
    let text = fs::read_to_string(written).expect("a file");
    assert!(text.starts_with("# Identified payload") && text.contains("- payload: 0.80"), "{text}");
    assert!(fine(&["identify", written, LOADED, "--judge"]).contains("predicts the torque of all 3 joints"));
    // the payload is in the file now
    let again = fine(&["identify", written, LOADED, "--payload"]);
    assert!(again.lines().nth(1).is_some_and(|line| line.starts_with("no payload: ")), "{again}");
    let mut keys = Vec::new();
    keys_of(&reply, &mut keys);
    let document = fs::read_to_string(format!("{ROOT}/docs/control/identify.md")).expect("a document");
    assert!(keys.iter().all(|key| document.contains(&format!("`{key}`"))), "{keys:?}");
}

/// The desk arm stands still: the torque of gravity has the mass, and where there is no gravity nothing has it.
#[test]
fn a_payload_at_rest_is_felt_by_gravity_alone() {
    let folder = folder("identify_payload_at_rest");
    let pose = [0.3, 0.4, -0.6];
    let q = pose.map(|angle| angle.to_string()).join(",");
    let weightless = folder.join("weightless.yaml");
    let text = fs::read_to_string(format!("{ROOT}/{IDENTIFIED}")).expect("a file");
    assert!(text.contains("gravity: [0, 0, -9.81]"));
    fs::write(&weightless, text.replace("gravity: [0, 0, -9.81]", "gravity: [0, 0, 0]")).expect("a file");
    let weightless = weightless.to_str().expect("UTF-8");
    for (file, is_felt) in [(IDENTIFIED, true), (weightless, false)] {
        let zeros = "0,0,0";
        let eval = ["eval", file, "--q", &q, "--qd", zeros, "--qdd", zeros, "--payload", "3,0,0,0", "--json"];
        let torques: Value = serde_json::from_str(&fine(&eval)).expect("JSON");
        let torques: Vec<f64> = torques["result"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|torque| torque.as_f64().expect("a number"))
            .collect();
        let log = changed(&folder.join("rest.csv"), |row, cells| {
            for joint in 0..3 {
                cells[1 + joint] = pose[joint].to_string();
                "0".clone_into(&mut cells[4 + joint]);
                // less than the last digit of a sensor
                let noise = [0.011, -0.017, 0.004, -0.002, 0.009][(row * (joint + 2) + row / 7) % 5];
                cells[7 + joint] = (torques[joint] + noise).to_string();
            }
        });
        let output = folder.join("out.yaml");
        let _ = fs::remove_file(&output);
        let path = output.to_str().expect("UTF-8");
        let called = rne(&["identify", file, &log, "--payload", "--json", "-o", path]);
        let reply: Value = serde_json::from_str(&called.out).expect("JSON");
        let mass = &reply["payload"]["mass"];
        assert_eq!(mass["excited"].as_bool(), Some(is_felt), "{} {}", called.out, called.err);
        assert_eq!((called.status, output.exists()), (i32::from(!is_felt), is_felt), "{}", called.err);
        assert_eq!(called.err.contains("does not determine the mass of a payload"), !is_felt, "{}", called.err);
        if is_felt {
            let [value, deviation] = ["value", "deviation"].map(|key| mass[key].as_f64().expect("a number"));
            assert!((value - 3.0).abs() < 3.0 * deviation && deviation > 0.1, "{mass}");
            assert!(
                reply["payload"]["inertia"].as_array().is_some_and(|all| all.iter().all(|of| of["excited"] == false))
            );
        }
    }
}

#[test]
fn payloads_that_cannot_be_told_are_refused() {
    for flag in [&["--rotors"][..], &["--no-friction"], &["--judge"], &["--hold-out", "0.3"], &["--pull", "2"]] {
        let called = rne(&[&["identify", IDENTIFIED, LOADED, "--payload"], flag].concat());
        assert_eq!(called.status, 2, "{flag:?}");
        assert!(called.err.contains("cannot be used with"), "{}", called.err);
    }
    let bare = folder("identify_payload_bare").join("bare.yaml");
    let text = fs::read_to_string(format!("{ROOT}/{ARM}")).expect("a file");
    let without: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("link:")).collect();
    fs::write(&bare, without.join("\n")).expect("a file");
    let called = rne(&["identify", bare.to_str().expect("UTF-8"), LOADED, "--payload"]);
    assert_eq!(called.status, 1);
    assert!(called.err.contains("has a mass") && called.err.contains("-o identified.yaml"), "{}", called.err);
}
