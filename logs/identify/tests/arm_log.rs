//! Logs of an arm: joints, low-pass, remarks and errors, as data.

use std::path::{Path, PathBuf};

use rne_identify::{
    ArmLog, ArmLogError, ArmLogOptions, ArmLogRemark, Mismatch, MotionError, Options, Part, PassError, Purpose,
    identify,
};
use rne_logs::{Motion, Remark};
use rne_model::Robot;

/// Three joints, with their names in the columns; 400 states at 25 Hz.
const LOG: &str = "docs/desk_arm_log.csv";

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

fn robot(name: &str) -> Robot {
    let text = std::fs::read_to_string(file(name)).unwrap();
    Robot::from_yaml(&text).unwrap_or_else(|report| panic!("{report}"))
}

fn desk_arm() -> Robot {
    robot("docs/desk_arm.yaml")
}

fn open(robot: &Robot, options: &ArmLogOptions) -> Result<ArmLog, ArmLogError> {
    ArmLog::open(&[file(LOG)], robot, options)
}

/// Joints that are taken from a log.
fn joints(names: &[&str]) -> ArmLogOptions {
    let joints = Some(names.iter().map(|name| (*name).to_owned()).collect());
    ArmLogOptions { log: rne_logs::Options { joints, ..rne_logs::Options::default() }, purpose: Purpose::Fit }
}

/// All states of a part.
fn times(log: &ArmLog, part: Part) -> Vec<f64> {
    let mut times = Vec::new();
    let mut take = |motion: &Motion| {
        times.extend_from_slice(&motion.time);
        Ok::<(), MotionError>(())
    };
    log.pass(part, &mut take).unwrap();
    times
}

#[test]
fn a_log_says_what_it_is() {
    let log = open(&desk_arm(), &ArmLogOptions::default()).unwrap();
    assert_eq!((log.states(), log.runs()), (400, 1));
    assert_eq!(log.summary(), "desk_arm_log.csv (400 states at 25 Hz)");
    // half of the filter that the spectrum chooses, and four times that
    let of_spectrum = rne_logs::Log::open(&[file(LOG)], rne_logs::Options::default()).unwrap();
    let chosen = of_spectrum.survey(|_| ()).unwrap().cutoff.hertz().unwrap();
    assert_eq!((log.cutoff(), log.read_to()), (0.5 * chosen, 2.0 * chosen));
    assert_eq!(log.remarks(), [ArmLogRemark::Log(Remark::TakenForTorques)]);
    let given = ArmLogOptions {
        log: rne_logs::Options { cutoff: Some(1.5), ..rne_logs::Options::default() },
        ..ArmLogOptions::default()
    };
    let given = open(&desk_arm(), &given).unwrap();
    assert_eq!((given.cutoff(), given.read_to()), (1.5, 6.0));
}

#[test]
fn the_purpose_chooses_the_filter_of_the_log() {
    let [fit, judge, watch] = [Purpose::Fit, Purpose::Judge, Purpose::Watch]
        .map(|purpose| open(&desk_arm(), &ArmLogOptions { purpose, ..ArmLogOptions::default() }).unwrap());
    assert_eq!([judge.cutoff(), watch.cutoff()], [fit.cutoff(); 2]);
    assert_eq!(judge.read_to(), fit.read_to());
    // the highest that 25 Hz allows
    assert!((watch.read_to() - 0.3 * 25.0).abs() < 1e-9, "{}", watch.read_to());
    let mut ignored = |_| ();
    assert_eq!(watch.judged(&mut ignored).unwrap().read_to(), fit.read_to());
}

#[test]
fn two_parts_are_the_whole() {
    let log = open(&desk_arm(), &ArmLogOptions::default()).unwrap();
    let whole = times(&log, Part::All);
    let (before, after) = (times(&log, Part::Before(0.7)), times(&log, Part::From(0.7)));
    assert!((whole.len() / 2..whole.len()).contains(&before.len()) && !after.is_empty());
    assert_eq!([before, after].concat(), whole);
}

#[test]
fn a_pass_reports_its_progress_and_stops_at_an_error() {
    let (mut of_open, mut of_pass) = (Vec::new(), Vec::new());
    let log = ArmLog::open_with_progress(&[file(LOG)], &desk_arm(), &ArmLogOptions::default(), &mut |share| {
        of_open.push(share);
    });
    let log = log.unwrap();
    log.pass_with_progress(Part::All, &mut |_| Ok::<(), ()>(()), &mut |share| of_pass.push(share)).unwrap();
    assert!(!of_pass.is_empty());
    assert!(of_open.iter().chain(&of_pass).all(|share| (0.0..=1.0).contains(share)), "{of_open:?} {of_pass:?}");
    let stopped = log.pass(Part::All, &mut |motion| Err(motion.len()));
    assert!(matches!(stopped, Err(PassError::Motion(states)) if states > 0), "{stopped:?}");
}

#[test]
fn a_model_is_identified_from_it() {
    let robot = desk_arm();
    let log = open(&robot, &ArmLogOptions::default()).unwrap();
    let mut options = Options::default();
    options.cutoff = Some(log.cutoff());
    let found = identify::<PassError<MotionError>>(&robot, options, 1.0, |take| log.pass(Part::All, take)).unwrap();
    assert!(found.bases.iter().all(rne_identify::BaseReport::is_excited));
}

#[test]
fn joints_of_other_names_are_matched_by_their_order_or_refused() {
    let mut robot = desk_arm();
    let own = ["waist", "shoulder", "elbow"];
    let matched = |robot: &Robot, options: &ArmLogOptions| {
        let log = open(robot, options)?;
        Ok::<_, ArmLogError>((log.log().layout().joints.clone(), log.remarks()[0].clone()))
    };
    for (joint, name) in robot.joints.iter_mut().zip(["a", "b", "c"]) {
        joint.name = name.to_owned();
    }
    let (names, remark) = matched(&robot, &ArmLogOptions::default()).unwrap();
    assert_eq!(names, own);
    assert!(matches!(&remark, ArmLogRemark::MatchedByOrder { logged, .. } if logged == &own), "{remark:?}");
    // names that are given are not matched, in whatever order
    let (names, remark) = matched(&robot, &joints(&["elbow", "waist", "shoulder"])).unwrap();
    assert_eq!(names, ["elbow", "waist", "shoulder"]);
    assert_eq!(remark, ArmLogRemark::Log(Remark::TakenForTorques));
    // one name of the robot's in another place contradicts the order
    robot.joints[0].name = "elbow".to_owned();
    let error = matched(&robot, &ArmLogOptions::default()).unwrap_err();
    let is_order =
        matches!(&error, ArmLogError::Unmatched { mismatch: Mismatch::Order { joint }, .. } if joint == "elbow");
    assert!(is_order && error.is_of_request(), "{error:?}");
    // as many joints, by their names
    for (name, wanted) in [("robots/planar2.yaml", Mismatch::More), ("robots/ur10.yaml", Mismatch::Fewer)] {
        match open(&self::robot(name), &ArmLogOptions::default()) {
            Err(ArmLogError::Unmatched { logged, mismatch, .. }) => {
                assert_eq!((logged, mismatch), (own.map(str::to_owned).to_vec(), wanted), "{name}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
    let error = open(&desk_arm(), &joints(&["waist"])).unwrap_err();
    assert!(matches!(error, ArmLogError::NamedJoints { named: 1, .. }), "{error:?}");
}

#[test]
fn a_low_pass_without_room_is_refused_with_those_that_have_it() {
    let opened = |cutoff: f64| {
        let log = rne_logs::Options { cutoff: Some(cutoff), ..rne_logs::Options::default() };
        open(&desk_arm(), &ArmLogOptions { log, purpose: Purpose::Fit })
    };
    for wrong in [0.01, 12.0] {
        let error = opened(wrong).unwrap_err();
        let ArmLogError::Cutoff { cutoff, possible: Some([lowest, highest]), .. } = error else { panic!("{error:?}") };
        assert_eq!(cutoff, wrong);
        assert!(opened(lowest).is_ok() && opened(highest).is_ok());
        assert!(opened(0.99 * lowest).is_err() && opened(1.01 * highest).is_err());
    }
}
