//! A payload from logs, with the keys of `rne identify --payload --json`.

use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_identify::{ArmLog, JointError, MotionError, Part, PassError, Payload, PayloadReply, Purpose};

use crate::arm::Arm;
use crate::identification::Judged;
use crate::interruption::interruptible;
use crate::log_errors::{of_arm_log, of_pass};
use crate::logs::{Reading, Said, robot_of, said};
use crate::reply::dict_of;

/// What was computed without the interpreter.
struct Found {
    payload: Payload,
    without: Judged,
    with: Option<Vec<JointError>>,
    robot_file: Option<String>,
    cutoff: f64,
    remarks: Vec<Said>,
}

/// The payload of a log: a dict with the keys of `rne identify --payload --json`, and `robot_file`, `remarks`.
#[pyfunction]
pub(crate) fn payload_identified<'py>(
    py: Python<'py>,
    arm: PyRef<'_, Arm>,
    paths: Vec<PathBuf>,
    reading: Reading,
) -> PyResult<Bound<'py, PyDict>> {
    let robot = robot_of(&arm)?;
    if robot.joints.iter().all(|joint| joint.row.link.mass == 0.0) {
        return Err(PyValueError::new_err(
            "no link of the arm has a mass, so a payload cannot be told from the links: identify the links from a log \
             without payload first, with rne.identify, and give its `arm`",
        ));
    }
    let options = reading.of_arm(Purpose::Fit)?;
    let found = interruptible(py, |look| {
        let log = ArmLog::open_with_progress(&paths, &robot, &options, look).map_err(|error| of_arm_log(&error))?;
        let payload = Payload::identify::<PassError<MotionError>>(&robot, log.cutoff(), |take| {
            log.pass_with_progress(Part::All, take, look)
        })
        .map_err(of_pass)?;
        let added = if payload.is_there() { payload.added_to(&robot) } else { None };
        let without = Judged::of(&robot, &log, Part::All, look)?;
        let with = added.as_ref().map(|with| Judged::of(with, &log, Part::All, look)).transpose()?;
        let mut remarks = said(log.remarks());
        let is_lost = payload.is_there() && added.is_none();
        if is_lost {
            let why = "the log would take more mass from the last link than this link has, \
                       so the robot and the log are not of the same arm";
            remarks.push((true, why.to_owned()));
        } else if !payload.mass.is_excited {
            let why = "the log does not determine the mass of a payload: record a motion in which gravity or \
                       accelerations load the joints";
            remarks.push((true, why.to_owned()));
        }
        let is_known = payload.mass.is_excited && !is_lost;
        let file = || payload.robot_file(added.as_ref().unwrap_or(&robot), added.is_some(), &log.summary());
        Ok::<_, PyErr>(Found {
            robot_file: is_known.then(file),
            cutoff: log.cutoff(),
            with: with.map(|with| with.errors),
            payload,
            without,
            remarks,
        })
    })??;
    let Found { payload, without, with, .. } = &found;
    let logs = paths.iter().map(|path| path.display().to_string()).collect();
    let errors = [Some(&without.errors[..]), with.as_deref()];
    let reply = dict_of(py, &PayloadReply::of(&robot, payload, errors, logs, found.cutoff, without.extent))?;
    reply.set_item("robot_file", &found.robot_file)?;
    reply.set_item("remarks", &found.remarks)?;
    Ok(reply)
}
