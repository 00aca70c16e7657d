//! Poses as arrays: the logarithm of a pose, and the way from one pose to another.

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rne::Pose;
use rne_codegen::Function;

use crate::arm::Arm;
use crate::arrays::{in_order, refuse_masked, room, writable};

/// The logarithm of a pose: the constant twist that leads from the world to it in one unit of time.
///
/// pose: homogeneous matrices as `forward_kinematics` returns them, shape (4, 4) or (..., 4, 4); lengths in m. The last
/// row is not read. Returns shape (6,) or (..., 6): x, y, z of the linear part (m), then x, y, z of the rotation vector
/// (rad), whose length is from 0 to pi. A rotation by pi has two such vectors; one of them is returned. By Lynch and
/// Park, Modern Robotics, 3.3.3.
#[pyfunction]
pub(crate) fn pose_log<'py>(py: Python<'py>, pose: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let poses = matrices("pose", pose)?;
    let result = room::<f64>(py, None, &[leading(&poses), &[6]].concat())?;
    let read = poses.readonly();
    write(&result, read.as_slice()?.chunks_exact(16).map(|numbers| pose_of(numbers).log()))?;
    Ok(result.into_any())
}

#[pymethods]
impl Arm {
    /// How far the tip or a frame is from a target pose, in world axes.
    ///
    /// Its numbers are in the order of the rows of `jacobian`: x, y, z of the target's position minus the tip's (m),
    /// then the rotation vector of R_target Rᵀ (rad). Joint velocities with J q̇ = k · error lead to the target.
    ///
    /// target: homogeneous matrices as `forward_kinematics` returns them, shape (4, 4), which holds for all states, or
    /// (N, 4, 4). frame: the name of a frame in the place of the tip: a frame in the list `frames` of the robot file,
    /// or a joint for its link frame.
    ///
    /// Returns shape (6,) or (N, 6). A target whose rotation is none is a ValueError.
    #[pyo3(signature = (q, target, *, frame=None, parameters=None))]
    fn pose_error<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        target: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        parameters: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = vec![self.of_joints("q", q)?];
        let poses = self.compute_at(py, frame, Function::ForwardKinematics, given, parameters, None)?;
        let (poses, targets) = (matrices("q", &poses)?, matrices("target", target)?);
        let (of_poses, of_targets) = (leading(&poses).to_vec(), leading(&targets).to_vec());
        let states = match (&of_poses[..], &of_targets[..]) {
            (states, []) | ([], states) => states,
            (states, others) if states == others => states,
            _ => {
                let (found, states) = (targets.shape(), of_poses.iter().product::<usize>());
                return Err(PyValueError::new_err(format!(
                    "`target` has the shape {found:?}, but `q` has {states} states: give one target, (4, 4), or one \
                     for each state, ({states}, 4, 4)"
                )));
            }
        };
        let result = room::<f64>(py, None, &[states, &[6]].concat())?;
        let (poses, targets) = (poses.readonly(), targets.readonly());
        let (poses, targets) = (poses.as_slice()?, targets.as_slice()?);
        let count = states.iter().product();
        let of = |all: &[f64], state: usize| pose_of(&all[if all.len() == 16 { 0 } else { 16 * state }..][..16]);
        write(&result, (0..count).map(|state| of(poses, state).error_to(&of(targets, state))))?;
        Ok(result.into_any())
    }
}

/// Returns an array of homogeneous matrices in double precision, or an error for another shape.
fn matrices<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    refuse_masked(name, value)?;
    let array = match value.cast::<PyArrayDyn<f64>>() {
        Ok(array) => in_order(array.clone())?,
        Err(_) => value.py().import("numpy")?.call_method1("ascontiguousarray", (value, "float64"))?.cast_into()?,
    };
    match array.shape() {
        [.., 4, 4] => {
            let read = array.readonly();
            let mut poses = read.as_slice()?.chunks_exact(16).map(pose_of);
            if let Some(at) = poses.position(|pose| !pose.is_rigid()) {
                return Err(PyValueError::new_err(format!(
                    "the rotation of `{name}`, state {at}, is none: its columns must be unit vectors at right angles, \
                     right-handed"
                )));
            }
            Ok(array.clone())
        }
        shape => Err(PyValueError::new_err(format!(
            "`{name}` has the shape {shape:?}: give homogeneous matrices, shape (4, 4) or (N, 4, 4), as \
             `forward_kinematics` returns them"
        ))),
    }
}

/// Returns the shape without the last two axes, which are those of the matrices.
fn leading<'a>(matrices: &'a Bound<'_, PyArrayDyn<f64>>) -> &'a [usize] {
    &matrices.shape()[..matrices.shape().len() - 2]
}

/// Returns the pose of a homogeneous matrix, which is given by its 16 numbers, row by row.
pub(crate) fn pose_of<T: Copy>(numbers: &[T]) -> Pose<T> {
    let row = |index: usize| [numbers[4 * index], numbers[4 * index + 1], numbers[4 * index + 2]];
    Pose { rotation: [row(0), row(1), row(2)], translation: [numbers[3], numbers[7], numbers[11]] }
}

/// Writes the six numbers of each state to an array.
fn write(room: &Bound<'_, PyArrayDyn<f64>>, results: impl Iterator<Item = [f64; 6]>) -> PyResult<()> {
    let mut writable = writable(room)?;
    let numbers = writable.as_slice_mut().map_err(|error| PyValueError::new_err(error.to_string()))?;
    numbers.chunks_exact_mut(6).zip(results).for_each(|(room, result)| room.copy_from_slice(&result));
    Ok(())
}
