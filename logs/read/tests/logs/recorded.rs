//! States as they were recorded.

use rne_logs::{Angles, Format, Heading, Options, Quantity, RecordedState};

use crate::written::{file, survey};

/// Every number, in SI units, and the run of each state; what is left out of a motion is left out.
#[test]
fn states_are_those_of_the_file() {
    let rows = [
        "0.00,90,1,2",
        "0.01,91,1.5,2",
        "0.02,92,1,nan",
        "0.03,93,1,2",
        "0.04,94,1,2",
        "0.04,94,1,2",
        // after a gap
        "1.00,95,1,2",
        "1.01,96,1,3",
    ];
    let (_folder, path) = file("log.csv", format!("t,elbow.position,elbow.velocity,elbow.effort\n{}", rows.join("\n")));
    let (log, survey) = survey(&[path], Options { angles: Angles::Degrees, ..Options::default() }).unwrap();
    assert_eq!((log.layout().format, survey.counts.states), (Format::Csv, 6));
    let mut recorded = log.recorded(&survey).unwrap();
    let mut found = Vec::new();
    while let Some(RecordedState { run, stamp, time, q, qd, tau }) = recorded.read().unwrap() {
        assert_eq!(stamp as f64 / 1e9, time);
        found.push((run, (time * 100.0).round() as i32, q[0].to_degrees(), qd[0].to_degrees(), tau[0]));
    }
    assert!((recorded.progress() - 1.0).abs() < 1e-9);
    let wanted = [
        (0, 0, 90.0, 1.0, 2.0),
        (0, 1, 91.0, 1.5, 2.0),
        (0, 3, 93.0, 1.0, 2.0),
        (0, 4, 94.0, 1.0, 2.0),
        (1, 100, 95.0, 1.0, 2.0),
        (1, 101, 96.0, 1.0, 3.0),
    ];
    for ((run, time, q, qd, tau), of) in wanted.iter().zip(&found) {
        assert_eq!((run, time, tau), (&of.0, &of.1, &of.4));
        assert!((q - of.2).abs() < 1e-12 && (qd - of.3).abs() < 1e-12, "{of:?}");
    }
    assert_eq!(found.len(), wanted.len());
    assert_eq!(Heading::of(&log.layout().joints).columns(Quantity::Velocity), ["elbow.velocity"]);
}

/// A log whose unit is not known has no numbers to hand out, filtered or not.
#[test]
fn units_that_are_not_known_are_refused() {
    let rows: String = (0..400).map(|i| format!("{},{}\n", f64::from(i) * 0.01, 60.0 * f64::from(i % 100))).collect();
    let (_folder, path) = file("log.csv", format!("t,q1\n{rows}"));
    let (log, survey) = survey(&[path], Options::default()).unwrap();
    assert!(log.recorded(&survey).unwrap_err().to_string().contains("may be degrees"));
}
