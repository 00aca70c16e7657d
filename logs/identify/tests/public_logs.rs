//! Two public logs of real arms (`logs/README.md`), beside what a textbook's identification in NumPy makes of them.

use std::path::{Path, PathBuf};

use rne_identify::{
    Doubt, Evidence, Identification, JointError, MotionError, Options, Prediction, Standstill, Verdict, identify,
};
use rne_logs::{Log, Motion, median};
use rne_model::Robot;

/// Hz: both sides of the equations, and the log's own filter, as `rne identify` chooses them.
const CUTOFF: f64 = 2.0;
const WIDER: f64 = 4.0;

/// Of the log, to identify from; the rest judges.
const PART: f64 = 0.7;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/logs").join(name)
}

/// A log of one run, filtered, to its ends.
fn motion(name: &str) -> Motion {
    motion_of(&file(name))
}

fn motion_of(log: &Path) -> Motion {
    let options = rne_logs::Options { cutoff: Some(WIDER * CUTOFF), ..rne_logs::Options::default() };
    let log = Log::open(&[log.to_path_buf()], options).unwrap();
    let survey = log.survey(|_| ()).unwrap();
    let mut pieces = log.motions(&survey).unwrap().with_length(1 << 20).with_ends();
    let motion = pieces.next().unwrap().unwrap().motion;
    assert!(pieces.next().is_none());
    motion
}

/// The states of some indices.
fn part(motion: &Motion, range: std::ops::Range<usize>) -> Motion {
    let of = |list: &[Vec<f64>]| list.iter().map(|column| column[range.clone()].to_vec()).collect();
    Motion {
        time: motion.time[range.clone()].to_vec(),
        q: of(&motion.q),
        qd: of(&motion.qd),
        qdd: of(&motion.qdd),
        tau: of(&motion.tau),
        recorded: of(&motion.recorded),
    }
}

/// What is identified from the first part of a log, and its errors on the part that was held back.
fn held_out(arm: &str) -> (Identification, Vec<JointError>) {
    held_out_of(arm, &file(&format!("{arm}.csv")))
}

/// The same of a log that is a part of it.
fn held_out_of(arm: &str, log: &Path) -> (Identification, Vec<JointError>) {
    let robot = std::fs::read_to_string(file(&format!("{arm}_log.yaml"))).unwrap();
    let robot = Robot::from_yaml(&robot).unwrap_or_else(|report| panic!("{report}"));
    let motion = motion_of(log);
    let whole = motion.len();
    let until = motion.time.partition_point(|time| *time < PART * motion.time[whole - 1]);
    let mut options = Options::default();
    options.cutoff = Some(CUTOFF);
    let training = part(&motion, 0..until);
    let found = identify(&robot, options, 1.0, |take| -> Result<(), MotionError> { take(&training) }).unwrap();
    let mut prediction = Prediction::new(&found.robot, Some(CUTOFF));
    prediction.absorb(&part(&motion, until..whole)).unwrap();
    (found, prediction.errors())
}

/// What `logs/baseline.py` prints, in percent.
const BASELINES: [(&str, &[f64]); 2] =
    [("ur10", &[15.2, 7.6, 4.8, 13.7, 20.3, 102.5]), ("panda", &[63.4, 7.5, 16.8, 11.2, 31.5, 22.8, 56.4])];

#[test]
fn public_logs_are_predicted_better_than_by_a_textbook() {
    for (arm, baseline) in BASELINES {
        let (found, errors) = held_out(arm);
        let excited: Vec<bool> = found.joints.iter().map(rne_identify::JointReport::is_excited).collect();
        let filtered: Vec<f64> = errors.iter().map(|error| 100.0 * error.error).collect();
        let unfiltered: Vec<f64> = errors.iter().map(|error| 100.0 * error.unfiltered).collect();
        println!("{arm} error {filtered:.1?} unfiltered {unfiltered:.1?} excited {excited:?} baseline {baseline:?}");
        for joint in (0..baseline.len()).filter(|joint| excited[*joint]) {
            let [error, raw, of] = [filtered[joint], unfiltered[joint], baseline[joint]];
            assert!(error <= of, "{arm}, joint {}: {error} {of}", joint + 1);
            // noise and all; the elbow of the UR10 and joint 5 of the Panda are somewhat worse
            assert!(raw <= 1.1 * of, "{arm}, joint {}: {raw} {of}", joint + 1);
        }
        assert!(median(filtered) < 0.75 * median(baseline.to_vec()));
        assert!(median(unfiltered) < median(baseline.to_vec()));
    }
}

/// In the first ten seconds the shoulder lifts so little that gravity hides an offset, but not Coulomb friction: it
/// stays, the same in both directions.
#[test]
fn coulomb_friction_of_a_short_log_is_kept_without_its_offset() {
    let text = std::fs::read_to_string(file("ur10.csv")).unwrap();
    let first: Vec<&str> = text.lines().take(1 + 330).collect();
    let folder = std::env::temp_dir().join(format!("rne_short_log_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let log = folder.join("ur10.csv");
    std::fs::write(&log, first.join("\n") + "\n").unwrap();
    let (found, errors) = held_out_of("ur10", &log);
    std::fs::remove_dir_all(&folder).unwrap();
    let verdict = Verdict::of(&found, Some(&errors));
    let shoulder = &verdict.joints[1];
    assert!(shoulder.is_predicted && shoulder.doubts.is_empty(), "{shoulder:?}");
    assert!(errors[1].error < 0.1 && found.joints[1].error.error < 0.05, "{errors:?} {:?}", found.joints[1]);
    assert!(found.joints[1].is_friction_excited() && found.joints[1].is_offset_unknown());
    let [_, forward, backward] = found.joints[1].friction.unwrap();
    assert!(
        forward.0 == backward.0 && (14.0..=23.0).contains(&forward.0) && forward.1 < 5.0,
        "{forward:?} {backward:?}"
    );
    let excited = verdict.excited.unwrap();
    assert_eq!((excited.unknown_friction, excited.unknown_offsets), (vec![], vec![1]));
    let text = found.robot_file("a log");
    assert_eq!(text.matches("the log cannot tell an offset from gravity").count(), 1, "{text}");
}

/// The longest time after `after`, s, in which the log's own velocities of a joint (from 0) are at most 0.02 rad/s.
fn longest_rest(name: &str, joint: usize, after: f64) -> (f64, f64) {
    let text = std::fs::read_to_string(file(name)).unwrap();
    let column = text.lines().next().unwrap().split(',').position(|name| name == format!("qd{}", joint + 1)).unwrap();
    let (mut longest, mut start) = ((0.0, 0.0), None);
    for row in text.lines().skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let rests = cells[0] >= after && cells[column].abs() <= 0.02;
        start = rests.then(|| start.unwrap_or(cells[0]));
        if let Some(start) = start.filter(|start| cells[0] - start > longest.1 - longest.0) {
            longest = (start, cells[0]);
        }
    }
    longest
}

/// The verdict names the joints that are not predicted, and why: wrist 3 of the UR10 stands still at the end.
#[test]
fn verdicts_name_the_joints_and_the_reasons() {
    let (found, errors) = held_out("ur10");
    let verdict = Verdict::of(&found, Some(&errors));
    assert_eq!((verdict.evidence, verdict.predicted()), (Evidence::HeldOut, 5));
    let wrist = &verdict.joints[5];
    assert!(!wrist.is_predicted && verdict.joints[..5].iter().all(|joint| joint.is_predicted));
    let Some(Doubt::Standstill(standstill)) = wrist.doubts.first() else { panic!("{wrist:?}") };
    let (start, end) = longest_rest("ur10.csv", 5, 13.5);
    assert!(
        (start - standstill.start).abs() < 0.2 && (end - standstill.end).abs() < 0.05,
        "{standstill:?} {start} {end}"
    );
    assert!(wrist.other.unwrap().part_at_rest > 0.5);
    // manifold: wrist 1 is still predicted
    let grown: Vec<bool> = verdict.joints.iter().map(|joint| joint.growth().is_some()).collect();
    let expected: Vec<bool> = found
        .joints
        .iter()
        .zip(&errors)
        .map(|(of, error)| error.error > 2.0 * of.error.error && error.error > 0.05)
        .collect();
    assert!(grown == expected && grown[3] && grown[5] && !grown[2], "{grown:?}");
    let excited = verdict.excited.unwrap();
    assert_eq!(excited.base_parameters, 36);
    assert_eq!(excited.known_parameters(), found.bases.iter().filter(|base| base.is_excited()).count());
    assert_eq!(excited.known_frictions(), 6);

    let (found, errors) = held_out("panda");
    let verdict = Verdict::of(&found, Some(&errors));
    let predicted: Vec<bool> = verdict.joints.iter().map(|joint| joint.is_predicted).collect();
    assert_eq!(predicted, [false, true, true, true, false, true, false]);
    assert_eq!(verdict.joints[0].doubts, [Doubt::NotExcited]);
    assert!(matches!(verdict.joints[4].doubts[..], [Doubt::Grown(factor)] if factor > 2.0), "{:?}", verdict.joints[4]);
    // without other data nothing has grown
    let fitted = Verdict::of(&found, None);
    assert_eq!(fitted.evidence, Evidence::Fitted);
    assert!(fitted.joints.iter().all(|joint| joint.other.is_none() && joint.growth().is_none()));
}

/// A standstill that pieces of a motion share is one, and a gap between runs ends it.
#[test]
fn standstills_go_on_in_the_next_piece() {
    let robot = Robot::from_yaml(&std::fs::read_to_string(file("ur10_log.yaml")).unwrap()).unwrap();
    let whole = motion("ur10.csv");
    let standstill = |pieces: &[Motion]| -> Standstill {
        let mut prediction = Prediction::new(&robot, Some(CUTOFF));
        for piece in pieces {
            prediction.absorb(piece).unwrap();
        }
        prediction.errors()[5].standstill.unwrap()
    };
    let expected = standstill(std::slice::from_ref(&whole));
    assert!(expected.duration() > 1.0, "{expected:?}");
    let middle = whole.time.partition_point(|time| *time < 0.5 * (expected.start + expected.end));
    let (before, mut after) = (part(&whole, 0..middle), part(&whole, middle..whole.len()));
    assert_eq!(standstill(&[before.clone(), after.clone()]), expected);
    for time in &mut after.time {
        *time += 10.0;
    }
    let apart = standstill(&[before, after]);
    assert!(apart.duration() < expected.duration(), "{apart:?}");
}
