//! `rne watch`: the dates of events.

use std::fs;
use std::path::Path;

use crate::call::{ROOT, fails, fine, folder, rne};
use crate::watch::{ARM, QUIET, WORN, events, json, number};

/// A log whose times count from 1970, s.
pub(crate) fn dated(folder: &Path, log: &str, name: &str, start: u64) -> String {
    let log = fs::read_to_string(Path::new(ROOT).join(log)).expect("a log");
    let moved = log.lines().enumerate().map(|(at, line)| match line.split_once(',') {
        Some((time, rest)) if at > 0 => {
            let (seconds, parts) = time.split_once('.').unwrap_or((time, "0"));
            let seconds: u64 = seconds.parse().expect("a whole number");
            format!("{}.{parts},{rest}\n", start + seconds)
        }
        _ => format!("{line}\n"),
    });
    let path = folder.join(name);
    fs::write(&path, moved.collect::<String>()).expect("a file");
    path.to_str().expect("UTF-8").to_owned()
}

/// 2026-11-23 and 2026-11-27, 08:00 UTC
pub(crate) const MONDAY: u64 = 1_795_420_800;
pub(crate) const FRIDAY: u64 = 1_795_766_400;

/// Logs of one day are one group, by the date of their times.
#[test]
fn days_are_dates() {
    let folder = folder("watch_days");
    // 2026-11-23 and 2024-02-29, 10:00 UTC
    let paths = [("a.csv", 1_795_428_000), ("b.csv", 1_709_200_800)].map(|(name, at)| dated(&folder, QUIET, name, at));
    let text = fine(&["watch", ARM, &paths[0], &paths[1], "--quiet", QUIET, "--by", "day"]);
    assert!(text.contains("2026-11-23") && text.contains("2024-02-29") && text.contains("no events"), "{text}");
}

/// A change within a log has the date of its start. A log without dates has none.
#[test]
fn events_have_dates() {
    let folder = folder("watch_dates");
    let worn = dated(&folder, WORN, "worn.csv", FRIDAY);
    // the end of the log is its last row: 400 states at 25 Hz
    let reply = json(&[&worn, "--quiet", QUIET], 1);
    let event = &events(&reply)[0];
    let since = event["since_time"].as_str().expect("a date");
    let clock = since.strip_prefix("2026-11-27T08:00:").and_then(|rest| rest.strip_suffix('Z')).expect("RFC 3339");
    let seconds: f64 = clock.parse().expect("seconds");
    assert!((seconds - number(event, "since")).abs() < 1e-3 && (seconds - 8.0).abs() < 0.3, "{event}");
    assert_eq!(event["until_time"], "2026-11-27T08:00:15.960Z", "{event}");
    assert!(event["not_before_time"].is_null() && event["not_after_time"].is_null(), "{event}");
    let text = rne(&["watch", ARM, &worn, "--quiet", QUIET]).out;
    assert!(words(&text).contains("; since 8.0 s (2026-11-27 08:00:08 UTC)"), "{text}");
    // times that begin at zero are no dates
    let reply = json(&[WORN, "--quiet", QUIET], 1);
    let event = &events(&reply)[0];
    for key in ["since_time", "until_time", "not_before_time", "not_after_time"] {
        assert!(event[key].is_null(), "{event}");
    }
    // speeds of this motion are not alike: viscous friction explains less of it
    assert_eq!(event["rivals"], serde_json::json!(["temperature", "speed"]));
}

/// Dates survive a Parquet file.
#[cfg(feature = "parquet")]
#[test]
fn events_of_parquet_have_dates() {
    let folder = folder("watch_dates_parquet");
    let worn = dated(&folder, WORN, "worn.csv", FRIDAY);
    let parquet = folder.join("worn.parquet");
    let parquet = parquet.to_str().expect("UTF-8");
    assert_eq!(rne(&["log", &worn, "-o", parquet]).status, 0);
    let reply = json(&[parquet, "--quiet", QUIET], 1);
    let since = events(&reply)[0]["since_time"].as_str().expect("a date").to_owned();
    assert!(since.starts_with("2026-11-27T08:00:0"), "{since}");
}

/// A change that the whole log has began between the quiet log and the log.
#[test]
fn a_change_of_the_whole_log_has_both_dates() {
    let folder = folder("watch_whole");
    let quiet = dated(&folder, QUIET, "monday.csv", MONDAY);
    let text = fs::read_to_string(format!("{ROOT}/{QUIET}")).expect("a log");
    // 0.3 N m against every motion of the elbow, by its measured speed
    let worn = text.lines().enumerate().map(|(at, line)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if at > 0 {
            let [speed, effort] = [6, 9].map(|column: usize| cells[column].parse::<f64>().expect("a number"));
            cells[9] = format!("{:.5}", effort + 0.3 * (speed / 0.02).tanh());
        }
        cells.join(",") + "\n"
    });
    fs::write(folder.join("plain.csv"), worn.collect::<String>()).expect("a file");
    let plain = folder.join("plain.csv");
    let plain = plain.to_str().expect("UTF-8");
    let worn = dated(&folder, plain, "friday.csv", FRIDAY);
    let at = |reply: &serde_json::Value| {
        let event = &events(reply)[0];
        assert_eq!((&event["name"], &event["whole"]), (&"elbow".into(), &true.into()), "{event}");
        ["since_time", "until_time", "not_before_time", "not_after_time"].map(|key| event[key].clone())
    };
    let saved = folder.join("arm.baseline.yaml");
    let saved = saved.to_str().expect("UTF-8");
    let found = at(&json(&[&worn, "--quiet", &quiet, "--save-baseline", saved], 1));
    let [monday, friday] = ["23", "27"].map(|day| {
        ["00.000", "15.960"].map(|second| serde_json::Value::from(format!("2026-11-{day}T08:00:{second}Z")))
    });
    let none = serde_json::Value::Null;
    assert_eq!(found, [friday[0].clone(), friday[1].clone(), monday[1].clone(), none.clone()]);
    // a saved baseline has the dates of its logs
    assert_eq!(at(&json(&[&worn, "--baseline", saved], 1)), found);
    let text = rne(&["watch", ARM, &worn, "--quiet", &quiet]).out;
    let said = "; already there when friday.csv begins (2026-11-27 08:00:00 UTC); not there when monday.csv ends \
                (2026-11-23 08:00:15 UTC)";
    assert!(words(&text).contains(said), "{text}");
    let text = rne(&["watch", ARM, &quiet, &worn, "--by", "day"]).out;
    assert!(words(&text).contains("2026-11-27: friction of elbow: Coulomb friction"), "{text}");
    assert!(words(&text).contains(said), "{text}");
    // with the quiet log after the other one
    assert_eq!(
        at(&json(&[&quiet, "--quiet", &worn], 1)),
        [monday[0].clone(), monday[1].clone(), none.clone(), friday[0].clone()]
    );
    let text = rne(&["watch", ARM, &quiet, "--quiet", &worn]).out;
    let said = "; still there when monday.csv ends (2026-11-23 08:00:15 UTC); not there when friday.csv begins \
                (2026-11-27 08:00:00 UTC)";
    assert!(words(&text).contains(said), "{text}");
    // nobody knows when the quiet log was, or the log
    assert_eq!(at(&json(&[&worn, "--quiet", QUIET], 1))[2], none);
    let text = rne(&["watch", ARM, plain, "--quiet", &quiet]).out;
    assert!(words(&text).contains("; in the whole log"), "{text}");
    let text = fs::read_to_string(saved).expect("a baseline");
    fs::write(saved, text.replace("quiet_until: 2026-11-23T", "quiet_until: 2026-02-30T")).expect("a file");
    fails(1, &["watch", ARM, &worn, "--baseline", saved], &["a date such as", "arm.baseline.yaml:"]);
}

fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
