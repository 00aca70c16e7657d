//! Finds changes of an arm from its logs, and reports them with the keys of `rne watch --json`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_identify::{ArmLog, Identification, JointError, Part, Prediction, Purpose};
use rne_model::{Robot, one_line};
use rne_watch::{Baseline, Changes, Event, Report, Settings, Trend, TrendReply, WatchReply, changes, svg, watch};

use crate::arm::Arm;
use crate::arrays::reply::dict_of;
use crate::errors::of_report;
use crate::interruption::interruptible;
use crate::log_errors::{of_arm_log, of_pass, of_watch};
use crate::logs::{Reading, Said, robot_of, said};

/// The largest residual of an effort that counts as zero, N m or N.
const NOTHING: f64 = 1e-9;

/// The baseline with which later logs are compared.
struct Known {
    baseline: Baseline,
    words: String,
    /// The text of the baseline file; `None` if the log is its own baseline.
    text: Option<String>,
}

/// The baseline that the caller asked for.
enum Comparison {
    /// The robot file.
    File,
    Quiet(Vec<PathBuf>),
    Known(Box<Baseline>, String),
}

impl Comparison {
    fn known(
        self,
        robot: &Robot,
        reading: &Reading,
        settings: &Settings,
        remarks: &mut Vec<Said>,
        look: &mut dyn FnMut(f64),
    ) -> PyResult<Option<Known>> {
        match self {
            Self::File => Ok(None),
            Self::Known(baseline, text) => {
                let words = format!("a baseline of {:.1} s", baseline.duration);
                Ok(Some(Known { baseline: *baseline, words, text: Some(text) }))
            }
            Self::Quiet(paths) => {
                let log = open(&paths, robot, reading, None, look)?;
                add(remarks, &log);
                let words = log.summary();
                let names = unexplained(robot, &prediction_errors(robot, &log, look)?);
                if !names.is_empty() {
                    let what = "in the quiet log: is it a log of this arm?";
                    remarks.push((true, format!("the model explains nothing of the torques of {names} {what}")));
                }
                let baseline =
                    Baseline::of_logs(robot, &log, settings, look).map_err(|error| of_watch(&error, &words))?;
                let text = baseline.to_yaml(robot, &words);
                Ok(Some(Known { baseline, words, text: Some(text) }))
            }
        }
    }
}

fn open(
    paths: &[PathBuf],
    robot: &Robot,
    reading: &Reading,
    cutoff: Option<f64>,
    look: &mut dyn FnMut(f64),
) -> PyResult<ArmLog> {
    let mut options = reading.of_arm(Purpose::Watch)?;
    options.log.cutoff = cutoff.or(options.log.cutoff);
    ArmLog::open_with_progress(paths, robot, &options, look).map_err(|error| of_arm_log(&error))
}

/// Adds the remarks on a log that have not been made yet.
fn add(remarks: &mut Vec<Said>, log: &ArmLog) {
    for remark in said(log.remarks()) {
        if !remarks.contains(&remark) {
            remarks.push(remark);
        }
    }
}

/// Returns, for each joint, how far the predicted torques differ from those of a log.
fn prediction_errors(robot: &Robot, log: &ArmLog, look: &mut dyn FnMut(f64)) -> PyResult<Vec<JointError>> {
    let mut prediction = Prediction::new(robot, Some(log.cutoff()));
    log.pass_with_progress(Part::All, &mut |motion| prediction.absorb(motion), look).map_err(of_pass)?;
    Ok(prediction.errors())
}

/// Returns the names of the joints whose torques the model predicts no better than their mean does. Joints about which
/// the robot file says that nothing is known are left out, as in `rne watch`.
fn unexplained(robot: &Robot, errors: &[JointError]) -> String {
    let each = robot.independent_joints().zip(errors).zip(Identification::not_excited(robot));
    let found = each.filter(|((_, error), unknown)| {
        // an effort that is constant and equal to the prediction counts as explained
        let is_nothing = error.deviation == 0.0 && error.residual <= NOTHING;
        !unknown && !is_nothing && (error.error >= 1.0 || error.error.is_nan())
    });
    found.map(|((joint, _), _)| one_line(&joint.name)).collect::<Vec<_>>().join(", ")
}

/// Returns the baseline of the first log, with which the others are compared if no other baseline is given.
fn of_first(robot: &Robot, name: &str, log: &ArmLog, look: &mut dyn FnMut(f64)) -> PyResult<Known> {
    let structure = Baseline::structure(robot, log.cutoff());
    let baseline = Baseline::of_parameters(&structure, log, look).map_err(|error| of_watch(&error, &log.summary()))?;
    Ok(Known { baseline, words: format!("the first, {name}"), text: None })
}

/// Returns the baseline that a log is for itself, compared with the robot file.
fn of_file(robot: &Robot, log: &ArmLog, look: &mut dyn FnMut(f64)) -> PyResult<Known> {
    let baseline = Baseline::of_file(robot, log, look).map_err(|error| of_watch(&error, &log.summary()))?;
    Ok(Known { baseline, words: "the robot file".to_owned(), text: None })
}

struct Watched {
    known: Known,
    report: Report,
    errors: Vec<JointError>,
    words: String,
    read_to: f64,
    picture: String,
}

/// Returns the comparison that the keywords ask for: quiet logs, the text of a baseline, or neither.
fn comparison(
    py: Python<'_>,
    robot: &Robot,
    quiet: Option<Vec<PathBuf>>,
    baseline: Option<(String, String)>,
) -> PyResult<Comparison> {
    match (quiet, baseline) {
        (Some(_), Some(_)) => Err(PyValueError::new_err("give `quiet` or `baseline`, not both")),
        (Some(quiet), None) => Ok(Comparison::Quiet(quiet)),
        (None, Some((name, text))) => {
            let baseline = Baseline::from_yaml(&name, &text, robot).map_err(|report| of_report(py, &report))?;
            Ok(Comparison::Known(Box::new(baseline), text))
        }
        (None, None) => Ok(Comparison::File),
    }
}

/// Events in logs: a dict with the keys of `rne watch --json`, and `picture`, `remarks`, `baseline_file`.
///
/// `settings`: gain, hold, false alarms.
#[pyfunction]
pub(crate) fn watched<'py>(
    py: Python<'py>,
    arm: PyRef<'_, Arm>,
    paths: Vec<PathBuf>,
    reading: Reading,
    quiet: Option<Vec<PathBuf>>,
    baseline: Option<(String, String)>,
    settings: (f64, f64, f64),
) -> PyResult<Bound<'py, PyDict>> {
    let robot = robot_of(&arm)?;
    let comparison = comparison(py, &robot, quiet, baseline)?;
    let settings = Settings { gain: settings.0, hold: settings.1, false_alarms: settings.2 };
    let mut remarks = Vec::new();
    let found = interruptible(py, |look| {
        let known = comparison.known(&robot, &reading, &settings, &mut remarks, look)?;
        let log = open(&paths, &robot, &reading, known.as_ref().map(|known| known.baseline.cutoff), look)?;
        add(&mut remarks, &log);
        let words = log.summary();
        let known = known.map_or_else(|| of_file(&robot, &log, look), Ok)?;
        let report =
            watch(&robot, &known.baseline, &log, &settings, true, look).map_err(|error| of_watch(&error, &words))?;
        let picture = svg(&robot, &report, &settings, &words);
        let judged = log.judged(look).map_err(|error| of_arm_log(&error))?;
        let errors = prediction_errors(&robot, &judged, look)?;
        let names = unexplained(&robot, &errors);
        if !names.is_empty() {
            let what = "does the robot file describe this arm, with its friction?";
            remarks.push((true, format!("the model explains nothing of the torques of {names}: {what}")));
        }
        let read_to = log.read_to();
        Ok::<_, PyErr>(Watched { known, report, errors, words, read_to, picture })
    })??;
    let Watched { known, report, errors, .. } = &found;
    let (baseline, words) = (&known.baseline, &known.words);
    let reply = WatchReply::of(&robot, found.words.clone(), found.read_to, words, baseline, report, errors);
    let reply = dict_of(py, &reply)?;
    reply.set_item("picture", &found.picture)?;
    reply.set_item("remarks", &remarks)?;
    reply.set_item("baseline_file", &known.text)?;
    Ok(reply)
}

struct Followed {
    known: Known,
    trend: Trend,
    events: Vec<Vec<Event>>,
}

/// The trend over groups of logs: a dict with the keys of `rne watch --by log --json`, and `table`, `picture`,
/// `remarks`, `baseline_file`.
#[pyfunction]
pub(crate) fn followed<'py>(
    py: Python<'py>,
    arm: PyRef<'_, Arm>,
    groups: Vec<(String, Vec<PathBuf>)>,
    reading: Reading,
    quiet: Option<Vec<PathBuf>>,
    baseline: Option<(String, String)>,
) -> PyResult<Bound<'py, PyDict>> {
    let robot = robot_of(&arm)?;
    let comparison = comparison(py, &robot, quiet, baseline)?;
    let Some((name, first)) = groups.first() else { return Err(PyValueError::new_err("there is no log")) };
    let mut remarks = Vec::new();
    let found = interruptible(py, |look| {
        // without another baseline, the first log is the one with which the others are compared
        let known = match comparison.known(&robot, &reading, &Settings::default(), &mut remarks, look)? {
            Some(known) => known,
            None => of_first(&robot, name, &open(first, &robot, &reading, None, look)?, look)?,
        };
        let structure = Baseline::structure(&robot, known.baseline.cutoff);
        let mut trend = Trend::new(&structure, &known.baseline);
        let mut events = Vec::new();
        let mut first_failure = None;
        for (name, paths) in &groups {
            let mut one = || -> PyResult<Changes> {
                let log = open(paths, &robot, &reading, Some(known.baseline.cutoff), look)?;
                add(&mut remarks, &log);
                changes(&structure, &known.baseline, &log, look).map_err(|error| of_watch(&error, &log.summary()))
            };
            match one() {
                Ok(found) => {
                    trend.push(name.clone(), &found);
                    events.push(found.events);
                }
                // a log that cannot be evaluated, such as one on which the arm stood still, does not end the trend over
                // the others
                Err(error) if Python::attach(|py| error.is_instance_of::<PyValueError>(py)) => {
                    let reason = Python::attach(|py| error.value(py).to_string());
                    remarks.push((true, format!("{name} is not compared: {reason}")));
                    trend.left_out.push((name.clone(), reason));
                    first_failure.get_or_insert(error);
                }
                Err(error) => return Err(error),
            }
        }
        if let Some(error) = first_failure.filter(|_| trend.rows.is_empty()) {
            return Err(error);
        }
        Ok::<_, PyErr>(Followed { known, trend, events })
    })??;
    let Followed { known, trend, events } = &found;
    let about = format!("{} logs compared with {}", trend.rows.len(), known.words);
    let reply = dict_of(py, &TrendReply::of(&robot, &known.words, trend, events))?;
    reply.set_item("left_out", trend.left_out.iter().cloned().collect::<BTreeMap<String, String>>())?;
    reply.set_item("table", trend.csv(&robot))?;
    reply.set_item("picture", trend.svg(&robot, &about))?;
    reply.set_item("remarks", &remarks)?;
    reply.set_item("baseline_file", &known.text)?;
    Ok(reply)
}
