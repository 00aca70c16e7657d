//! A payload as an argument, and one from logs, with the keys of `rne identify --payload --json`.

use std::path::PathBuf;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat};
use rne::NegativeMass;
use rne_identify::{ArmLog, JointError, MotionError, Part, PassError, Payload, PayloadReply, Purpose};
use rne_model::Inertia;

use crate::arm::Arm;
use crate::arrays::reply::dict_of;
use crate::arrays::{array_of, in_order, readable, refuse_masked, shape_in_words, shape_of, taken};
use crate::identification::Judged;
use crate::interruption::interruptible;
use crate::log_errors::{of_arm_log, of_pass};
use crate::logs::{Reading, Said, robot_of, said};

/// The argument `payload` of the functions of an `Arm`, shape (10,).
///
/// mass: kg. com: centre of mass (m) from the origin of the tip frame, in its axes. inertia: about the centre of mass
/// (kg m²), the symmetric tensor of shape (3, 3), or None for a point mass.
#[pyfunction]
#[pyo3(signature = (mass, com=None, inertia=None), text_signature = "(mass, com=(0.0, 0.0, 0.0), inertia=None)")]
pub(crate) fn payload<'py>(
    py: Python<'py>,
    mass: &Bound<'py, PyAny>,
    com: Option<&Bound<'py, PyAny>>,
    inertia: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let [mass] = numbers("mass", Some(mass), &[], "a number, in kg")?;
    let [x, y, z] = numbers("com", com, &[3], "three numbers x, y, z, in m")?;
    let allowed = "a symmetric tensor of shape (3, 3), in kg m²";
    let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = numbers("inertia", inertia, &[3, 3], allowed)?;
    NegativeMass::check(mass).map_err(|error| PyValueError::new_err(error.to_string()))?;
    // the two triangles of the tensor may differ as much as digits of a file are rounded
    let is_other = |(one, other): (f64, f64)| (one - other).abs() > 1e-8 + 1e-5 * one.abs().min(other.abs());
    if [(xy, yx), (xz, zx), (yz, zy)].into_iter().any(is_other) {
        return Err(PyValueError::new_err("`inertia` is a symmetric tensor of shape (3, 3)"));
    }
    Inertia { xx, yy, zz, xy, xz, yz }.check_of_payload().map_err(|error| PyValueError::new_err(error.to_string()))?;
    array_of(py, &[], &[10], vec![mass, x, y, z, xx, yy, zz, xy, xz, yz])
}

/// Reads finite numbers of a shape. An error names the argument and the values that it may have. Numbers that are left
/// out are zero.
fn numbers<const N: usize>(
    name: &'static str,
    value: Option<&Bound<'_, PyAny>>,
    shape: &[usize],
    allowed: &str,
) -> PyResult<[f64; N]> {
    let Some(value) = value else { return Ok([0.0; N]) };
    refuse_masked(name, value)?;
    let found = match value.extract() {
        Ok(number) if value.is_instance_of::<PyFloat>() => vec![number],
        _ => {
            let Some(found) = shape_of(value)? else {
                let message = format!("`{name}` is {}, but it must be {allowed}", value.repr()?);
                return Err(PyTypeError::new_err(message));
            };
            if found != shape {
                let found = shape_in_words(&found);
                let message = format!("`{name}` has the shape {found}, but it must be {allowed}");
                return Err(PyValueError::new_err(message));
            }
            readable(name, &in_order(taken::<f64>(name, value, &(0..0))?)?)?.as_slice()?.to_vec()
        }
    };
    if let Some(at) = found.iter().position(|number| !number.is_finite()) {
        let place = match N {
            1 => String::new(),
            3 => format!("[{at}]"),
            _ => format!("[{}, {}]", at / 3, at % 3),
        };
        let number = PyFloat::new(value.py(), found[at]);
        return Err(PyValueError::new_err(format!("`{name}{place}` is {number}, but it must be finite")));
    }
    found.try_into().map_err(|_| PyValueError::new_err(format!("`{name}` must be {allowed}")))
}

/// The results, which are computed while other threads of Python may run.
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
