//! Logs of an arm: how they are read, what is in them, and their filtered motion.

use std::collections::BTreeMap;
use std::path::PathBuf;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rne_identify::{ArmLogOptions, ArmLogRemark, LogReply, Purpose, check_units, joint_options};
use rne_logs::{Angles, Log, LogError, Mapping, Motion, Options, TimeUnit};
use rne_model::Robot;

use crate::arm::Arm;
use crate::arrays::reply::dict_of;
use crate::interruption::interruptible;
use crate::log_errors::{log_remark, of_arm_log, of_log, remark};

/// The keywords by which a log is read, from the dict that the package makes of them.
#[derive(Clone, Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Reading {
    joints: Option<Vec<String>>,
    topic: Option<String>,
    torque_constants: Vec<f64>,
    angles: Option<String>,
    pub(crate) cutoff: Option<f64>,
    gap: f64,
    derive_velocities: bool,
    recorded: bool,
    time_unit: Option<String>,
    rate: Option<f64>,
    columns: Vec<String>,
    map: BTreeMap<String, String>,
    r#where: BTreeMap<String, String>,
}

impl Reading {
    pub(crate) fn options(&self) -> PyResult<Options> {
        let angles = match self.angles.as_deref() {
            None => Angles::Unsaid,
            Some("degrees") => Angles::Degrees,
            Some("radians") => Angles::Radians,
            Some(other) => {
                return Err(PyValueError::new_err(format!("`angles` is \"degrees\" or \"radians\", not {other:?}")));
            }
        };
        for (name, value) in [("cutoff", self.cutoff), ("rate", self.rate)] {
            if value.is_some_and(|hertz| !(hertz.is_finite() && hertz > 0.0)) {
                return Err(PyValueError::new_err(format!("`{name}` is a number of Hz above 0, such as 2")));
            }
        }
        let units = [TimeUnit::Seconds, TimeUnit::Milliseconds, TimeUnit::Microseconds, TimeUnit::Nanoseconds];
        let unit = |name: &String| {
            units.into_iter().find(|unit| unit.name() == name).ok_or_else(|| {
                PyValueError::new_err(format!("`time_unit` is \"s\", \"ms\", \"us\" or \"ns\", not {name:?}"))
            })
        };
        let mapping = |(target, column): (&String, &String)| {
            let target = target.parse().map_err(|error| PyValueError::new_err(format!("`map`: {error}")))?;
            Ok::<_, PyErr>(Mapping { target, column: column.clone() })
        };
        Ok(Options {
            joints: self.joints.clone(),
            topic: self.topic.clone(),
            torque_constants: self.torque_constants.clone(),
            angles,
            gap: self.gap,
            cutoff: self.cutoff,
            derive_velocities: self.derive_velocities,
            recorded: self.recorded,
            time_unit: self.time_unit.as_ref().map(unit).transpose()?,
            rate: self.rate,
            columns: self.columns.clone(),
            map: self.map.iter().map(mapping).collect::<PyResult<_>>()?,
            select: self.r#where.clone().into_iter().collect(),
            ..Options::default()
        })
    }

    /// Returns the options for logs of an arm, which are read for a purpose.
    pub(crate) fn of_arm(&self, purpose: Purpose) -> PyResult<ArmLogOptions> {
        Ok(ArmLogOptions { log: self.options()?, purpose })
    }
}

/// Returns the robot of an arm, to compare it with the torques of logs. If the arm has free parameters, its torques are
/// not known, which is an error.
pub(crate) fn robot_of(arm: &Arm) -> PyResult<Robot> {
    if arm.robot().run_time.is_empty() {
        return Ok(arm.robot().clone());
    }
    Err(PyValueError::new_err("this arm has run-time parameters: read it without `run_time`, so that all have a value"))
}

/// A remark: whether it is a warning, and its words.
pub(crate) type Said = (bool, String);

pub(crate) fn said(remarks: &[ArmLogRemark]) -> Vec<Said> {
    remarks.iter().map(|of| (of.is_warning(), remark(of))).collect()
}

/// Opens a log. If an arm is given, the columns of its joints are selected.
fn open(paths: &[PathBuf], robot: Option<&Robot>, mut options: Options) -> PyResult<(Log, Option<ArmLogRemark>)> {
    let mut matched = None;
    if let Some(robot) = robot {
        (options, matched) = joint_options(paths, robot, options).map_err(|error| of_arm_log(&error))?;
    }
    let log = Log::open(paths, options).map_err(|error| of_log(&error, &[]))?;
    if let Some(robot) = robot {
        check_units(robot, log.layout()).map_err(|error| of_arm_log(&error))?;
    }
    Ok((log, matched))
}

/// What a log has.
#[pyfunction]
pub(crate) fn log_content<'py>(
    py: Python<'py>,
    paths: Vec<PathBuf>,
    arm: Option<PyRef<'_, Arm>>,
    reading: Reading,
) -> PyResult<Bound<'py, PyDict>> {
    let robot = arm.map(|arm| robot_of(&arm)).transpose()?;
    let options = reading.options()?;
    let content = interruptible(py, |look| {
        let (log, matched) = open(&paths, robot.as_ref(), options)?;
        let survey = log.survey(look).map_err(|error| of_log(&error, &[]))?;
        let remarks = log.remarks(&survey);
        let notes = matched.as_ref().map(remark).into_iter().chain(remarks.iter().map(log_remark)).collect();
        Ok::<_, PyErr>(LogReply::of(&log, &survey, notes))
    })??;
    dict_of(py, &content)
}

/// All filtered states of a log. Each quantity has the numbers of one state after those of another.
#[derive(Default)]
struct States {
    time: Vec<f64>,
    run: Vec<u64>,
    quantities: [Vec<f64>; 4],
}

impl States {
    fn take(&mut self, run: u64, motion: &Motion) {
        self.time.extend(&motion.time);
        self.run.extend(std::iter::repeat_n(run + 1, motion.len()));
        let lists = [&motion.q, &motion.qd, &motion.qdd, &motion.tau];
        for (all, list) in self.quantities.iter_mut().zip(lists) {
            for at in 0..motion.len() {
                all.extend(list.iter().map(|joint| joint[at]));
            }
        }
    }
}

/// Returns an array of the shape (states, joints).
pub(crate) fn rows(py: Python<'_>, numbers: Vec<f64>, joints: usize) -> PyResult<Bound<'_, PyAny>> {
    let states = numbers.len() / joints.max(1);
    numpy::PyArray1::from_vec(py, numbers).call_method1("reshape", ((states, joints),))
}

/// The filtered motion of a log: the columns of `rne log --out`.
#[pyfunction]
pub(crate) fn log_motion<'py>(
    py: Python<'py>,
    paths: Vec<PathBuf>,
    arm: Option<PyRef<'_, Arm>>,
    reading: Reading,
) -> PyResult<Bound<'py, PyDict>> {
    let robot = arm.map(|arm| robot_of(&arm)).transpose()?;
    let options = reading.options()?;
    let (states, joints, has_efforts) = interruptible(py, |look| {
        let (log, _) = open(&paths, robot.as_ref(), options)?;
        let of_error = |error: LogError| of_log(&error, &[]);
        let survey = log.survey(&mut *look).map_err(of_error)?;
        let mut motions = log.motions(&survey).map_err(of_error)?;
        let mut states = States::default();
        while let Some(piece) = motions.next() {
            let piece = piece.map_err(of_error)?;
            look(motions.progress());
            states.take(piece.run, &piece.motion);
        }
        Ok::<_, PyErr>((states, log.layout().joints.len(), log.layout().has_efforts))
    })??;
    if states.time.is_empty() {
        let first = paths.first().map(|path| path.display().to_string()).unwrap_or_default();
        return Err(PyValueError::new_err(format!("{first}: no sample is left after the filter")));
    }
    let found = PyDict::new(py);
    found.set_item("time", numpy::PyArray1::from_vec(py, states.time))?;
    found.set_item("run", numpy::PyArray1::from_vec(py, states.run))?;
    let [q, qd, qdd, tau] = states.quantities;
    for (name, numbers) in [("q", q), ("qd", qd), ("qdd", qdd)] {
        found.set_item(name, rows(py, numbers, joints)?)?;
    }
    found.set_item("tau", has_efforts.then(|| rows(py, tau, joints)).transpose()?)?;
    Ok(found)
}
