//! Two public logs of real arms (`logs/README.md`), beside what a textbook's identification in NumPy makes of them.

use std::path::{Path, PathBuf};

use rne_identify::{JointError, MotionError, Options, Prediction, identify};
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
    let options = rne_logs::Options { cutoff: Some(WIDER * CUTOFF), ..rne_logs::Options::default() };
    let log = Log::open(&[file(name)], options).unwrap();
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

/// Errors on the part that was held back, and whether each joint is excited.
fn held_out(arm: &str) -> (Vec<JointError>, Vec<bool>) {
    let robot = std::fs::read_to_string(file(&format!("{arm}_log.yaml"))).unwrap();
    let robot = Robot::from_yaml(&robot).unwrap_or_else(|report| panic!("{report}"));
    let motion = motion(&format!("{arm}.csv"));
    let whole = motion.len();
    let until = motion.time.partition_point(|time| *time < PART * motion.time[whole - 1]);
    let mut options = Options::default();
    options.cutoff = Some(CUTOFF);
    let training = part(&motion, 0..until);
    let found = identify(&robot, options, 1.0, |take| -> Result<(), MotionError> { take(&training) }).unwrap();
    let mut prediction = Prediction::new(&found.robot, Some(CUTOFF));
    prediction.absorb(&part(&motion, until..whole)).unwrap();
    (prediction.errors(), found.joints.iter().map(rne_identify::JointReport::is_excited).collect())
}

/// What `logs/baseline.py` prints, in percent.
const BASELINES: [(&str, &[f64]); 2] =
    [("ur10", &[15.2, 7.6, 4.8, 13.7, 20.3, 102.5]), ("panda", &[63.4, 7.5, 16.8, 11.2, 31.5, 22.8, 56.4])];

#[test]
fn public_logs_are_predicted_better_than_by_a_textbook() {
    for (arm, baseline) in BASELINES {
        let (errors, excited) = held_out(arm);
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
