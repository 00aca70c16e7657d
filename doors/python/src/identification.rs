//! Identification of an arm from its logs, with the keys of `rne identify --json`.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_identify::{
    ArmLog, Identification, IdentificationReply, JointError, JudgedPart, MotionError, Options, Part, PassError,
    Prediction, Purpose, Verdict, identify,
};
use rne_logs::Motion;
use rne_model::{Robot, one_line};
use rne_plot::{Comparison, comparison_svg};

use crate::arm::Arm;
use crate::arrays::reply::dict_of;
use crate::interruption::interruptible;
use crate::log_errors::{of_arm_log, of_pass};
use crate::logs::{Reading, Said, robot_of, said};

/// The largest number of states that a picture shows.
const DRAWN: u64 = 4000;

/// The errors of a robot's predicted torques on a part of a log.
pub(crate) struct Judged {
    pub(crate) errors: Vec<JointError>,
    pub(crate) extent: JudgedPart,
}

impl Judged {
    pub(crate) fn of(robot: &Robot, log: &ArmLog, part: Part, look: &mut dyn FnMut(f64)) -> PyResult<Self> {
        let mut prediction = Prediction::new(robot, Some(log.cutoff()));
        let mut extent = JudgedPart::default();
        let mut take = |motion: &Motion| {
            extent.add(motion);
            prediction.absorb(motion)
        };
        log.pass_with_progress(part, &mut take, look).map_err(of_pass)?;
        Ok(Self { errors: prediction.errors(), extent })
    }
}

/// Returns a picture of the measured and predicted torques of a part of a log.
fn picture(
    robot: &Robot,
    log: &ArmLog,
    part: Part,
    judged: &Judged,
    [title, about]: [&str; 2],
    look: &mut dyn FnMut(f64),
) -> PyResult<String> {
    let stride = usize::try_from(judged.extent.states.div_ceil(DRAWN)).unwrap_or(usize::MAX).max(1);
    let prediction = Prediction::new(robot, Some(log.cutoff()));
    let mut time = Vec::new();
    let (mut measured, mut predicted) = (vec![Vec::new(); robot.dof()], vec![Vec::new(); robot.dof()]);
    let mut take = |motion: &Motion| {
        time.extend(motion.time.iter().step_by(stride));
        for (joint, pairs) in prediction.pairs(motion)?.into_iter().enumerate() {
            measured[joint].extend(pairs.iter().step_by(stride).map(|pair| pair.0));
            predicted[joint].extend(pairs.iter().step_by(stride).map(|pair| pair.1));
        }
        Ok::<(), MotionError>(())
    };
    log.pass_with_progress(part, &mut take, look).map_err(of_pass)?;
    let notes: Vec<String> = judged.errors.iter().map(|error| format!("error {:.1} %", 100.0 * error.error)).collect();
    let about = format!("{about}; both torques low-passed at {:.1} Hz", log.cutoff());
    let of =
        Comparison { title, about: &about, time: &time, measured: &measured, predicted: &predicted, notes: &notes };
    Ok(comparison_svg(robot, &of))
}

/// The results, which are computed while other threads of Python may run.
struct Found {
    identification: Identification,
    verdict: Verdict,
    held_out: Option<JudgedPart>,
    cutoff: f64,
    words: String,
    remarks: Vec<Said>,
    picture: String,
}

/// An identified model: a dict with the keys of `rne identify --json`, and `text_of_file`, `picture`, `remarks`.
#[pyfunction]
pub(crate) fn identified<'py>(
    py: Python<'py>,
    arm: PyRef<'_, Arm>,
    paths: Vec<PathBuf>,
    reading: Reading,
    hold_out: Option<f64>,
    rotors: bool,
    friction: bool,
    regularization: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let robot = robot_of(&arm)?;
    let log_options = reading.of_arm(Purpose::Fit)?;
    let found = interruptible(py, |look| {
        let log = ArmLog::open_with_progress(&paths, &robot, &log_options, look).map_err(|error| of_arm_log(&error))?;
        let mut options = Options::default();
        options.friction = friction;
        options.rotors = rotors;
        options.cutoff = Some(log.cutoff());
        let (training, held) = match hold_out {
            Some(part) => (Part::Before(1.0 - part), Some(Part::From(1.0 - part))),
            None => (Part::All, None),
        };
        let found = identify::<PassError<MotionError>>(&robot, options, regularization, |take| {
            log.pass_with_progress(training, take, look)
        })
        .map_err(of_pass)?;
        let judged = Judged::of(&found.robot, &log, held.unwrap_or(Part::All), look)?;
        let held_errors = held.map(|_| &judged.errors[..]);
        let verdict = Verdict::of(&found, held_errors);
        let title = format!("{} identified from {}", one_line(&robot.name), log.summary());
        let about = if held.is_some() { "held-out part of the log" } else { "the data of the identification" };
        let picture = picture(&found.robot, &log, held.unwrap_or(Part::All), &judged, [title.as_str(), about], look)?;
        Ok::<_, PyErr>(Found {
            identification: found,
            verdict,
            held_out: held.map(|_| judged.extent),
            cutoff: log.cutoff(),
            words: log.summary(),
            remarks: said(log.remarks()),
            picture,
        })
    })??;
    dict(py, &found, &paths)
}

fn dict<'py>(py: Python<'py>, found: &Found, paths: &[PathBuf]) -> PyResult<Bound<'py, PyDict>> {
    let Found { identification, verdict, held_out, cutoff, .. } = found;
    let logs = paths.iter().map(|path| path.display().to_string()).collect();
    let reply = dict_of(py, &IdentificationReply::of(identification, verdict, logs, *cutoff, *held_out))?;
    reply.set_item("rows", identification.rows)?;
    reply.set_item("words", &found.words)?;
    reply.set_item("remarks", &found.remarks)?;
    reply.set_item("picture", &found.picture)?;
    // if nothing was identified, there is no robot file
    let text = identification.is_anything_excited().then(|| identification.robot_file(&found.words));
    reply.set_item("robot_file", text)?;
    Ok(reply)
}
