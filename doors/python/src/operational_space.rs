//! The operational-space inertia of an arm and the dynamically consistent inverse of its Jacobian.

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rne::Scalar;
use rne::compiled::{Function, Number};

use crate::arm::{Arm, methods};
use crate::arrays::{room, writable};

/// Rows of a Jacobian: three linear ones, then three angular ones.
const ROWS: usize = 6;

/// The matrix that is computed: the operational-space inertia, or the inverse of the Jacobian.
#[derive(Clone, Copy, PartialEq)]
enum Returned {
    Inertia,
    Inverse,
}

methods! {
    (q, *, frame=None, rows=None, payload=None, parameters=None, out=None)
    (
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        rows: Option<Vec<i64>>,
        payload: Option<&Bound<'py, PyAny>>,
        parameters: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>>;

    /// The operational-space inertia (J M⁻¹ Jᵀ)⁻¹ at the tip or at a frame, symmetric (Khatib, 1987).
    ///
    /// A force at the tip of an arm at rest, without gravity, is this matrix times the acceleration that it causes.
    /// Its rows and columns are those of `jacobian`: x, y, z of the velocity, then x, y, z of the angular velocity, in
    /// world axes. Units: kg between linear rows, kg m² between angular rows, kg m between both.
    ///
    /// rows: the m rows of the Jacobian that the task controls, such as [0, 1, 2] for the position alone. None is all
    /// six. If n joints move the tip or the frame, at most n rows are independent; more are a ValueError. At a singular
    /// pose, where the rows are linearly dependent, the elements are not finite, or so large that they contain only
    /// rounding errors.
    ///
    /// frame: the name of a frame in the place of the tip: a frame in the list `frames` of the robot file, or a joint
    /// for its link frame. payload: a body at the tip, shape (10,) or (N, 10); `rne.payload` makes one.
    ///
    /// Returns shape (m, m) or (N, m, m).
    operational_space_inertia {
        let rows = self.task(rows, frame)?;
        let [mass, jacobian] = self.mass_and_jacobian(py, q, frame, payload, parameters)?;
        in_operational_space(&mass, &jacobian, &rows, Returned::Inertia, out)
    }

    /// The dynamically consistent inverse M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ of the Jacobian at the tip or at a frame (Khatib, 1987).
    ///
    /// The result J̄ has J J̄ = 1. The joint velocities J̄ v move the tip with the velocity v and have less kinetic
    /// energy than all other joint velocities that do so. Torques (1 - Jᵀ J̄ᵀ) τ do not accelerate the tip, for any τ.
    /// Row i belongs to joint i, column k to row k of `rows`: rad/s or m/s of the joint per m/s or rad/s of the tip.
    ///
    /// The arguments, the errors and the results at a singular pose are those of `operational_space_inertia`.
    ///
    /// Returns shape (n, m) or (N, n, m).
    dynamically_consistent_inverse {
        let rows = self.task(rows, frame)?;
        let [mass, jacobian] = self.mass_and_jacobian(py, q, frame, payload, parameters)?;
        in_operational_space(&mass, &jacobian, &rows, Returned::Inverse, out)
    }
}

impl Arm {
    /// Returns the mass matrix M and the Jacobian J of all states, with the same type of numbers.
    fn mass_and_jacobian<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        frame: Option<&Bound<'py, PyAny>>,
        payload: Option<&Bound<'py, PyAny>>,
        parameters: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<[Bound<'py, PyAny>; 2]> {
        let of_mass = match payload {
            None => Function::MassMatrix,
            Some(_) => Function::MassMatrixWithPayload,
        };
        let payload = payload.map(|payload| self.payload(payload));
        let given = [self.of_joints("q", q)?].into_iter().chain(payload).collect();
        let mass = self.compute(py, of_mass, given, parameters, None)?;
        let given = vec![self.of_joints("q", q)?];
        let jacobian = self.compute_at(py, frame, Function::Jacobian, given, parameters, None)?;
        // M is in double precision if only the payload is, while J has the single precision of the positions
        if mass.cast::<PyArrayDyn<f64>>().is_ok() && jacobian.cast::<PyArrayDyn<f64>>().is_err() {
            return Ok([mass, jacobian.call_method1("astype", ("float64",))?]);
        }
        Ok([mass, jacobian])
    }

    /// Returns the rows of the Jacobian that the task controls, after a check of the argument `rows`.
    fn task(&self, rows: Option<Vec<i64>>, frame: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<usize>> {
        let robot = self.robot();
        let frame = frame.map(|frame| self.frame_name(frame)).transpose()?;
        let id = frame.as_ref().map(|name| robot.frame(name)).transpose();
        let id = id.map_err(|unknown| PyValueError::new_err(unknown.to_string()))?;
        // the joints from the base to the link that carries the frame, which are those that move it
        let on = id.map_or_else(|| robot.tip(), |id| robot.fixed_frame(id)).on;
        let moving = std::iter::successors(on, |&joint| robot.parent(joint)).count();
        let given = rows.unwrap_or_else(|| (0..6).collect());
        let known = given.iter().filter_map(|&row| usize::try_from(row).ok());
        let rows: Vec<usize> = known.filter(|&row| row < ROWS).collect();
        let is_repeated = |at: usize| rows[..at].contains(&rows[at]);
        if rows.is_empty() || rows.len() < given.len() || (0..rows.len()).any(is_repeated) {
            return Err(PyValueError::new_err(format!(
                "`rows` is {given:?}: write different numbers from 0 to 5, which are the rows of `jacobian`: x, y, z \
                 of the velocity, then x, y, z of the angular velocity"
            )));
        }
        if rows.len() > moving {
            let what = frame.map_or_else(|| "the tip".to_owned(), |frame| format!("the frame `{frame}`"));
            let most = match moving {
                0 => "choose another frame".to_owned(),
                _ => format!("name at most {moving} rows that these joints can move independently"),
            };
            return Err(PyValueError::new_err(format!(
                "{moving} joints move {what}, so {} rows of its Jacobian cannot be controlled at once: {most}",
                rows.len()
            )));
        }
        Ok(rows)
    }
}

fn in_operational_space<'py>(
    mass: &Bound<'py, PyAny>,
    jacobian: &Bound<'py, PyAny>,
    rows: &[usize],
    returned: Returned,
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    match (mass.cast::<PyArrayDyn<f32>>(), jacobian.cast::<PyArrayDyn<f32>>()) {
        (Ok(mass), Ok(jacobian)) => computed(mass, jacobian, rows, returned, out),
        _ => computed::<f64>(mass.cast()?, jacobian.cast()?, rows, returned, out),
    }
}

fn computed<'py, T: Element + Number + Scalar>(
    mass: &Bound<'py, PyArrayDyn<T>>,
    jacobian: &Bound<'py, PyArrayDyn<T>>,
    rows: &[usize],
    returned: Returned,
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = mass.py();
    let (dof, task) = (mass.shape().last().copied().unwrap_or_default(), rows.len());
    let of_state = match returned {
        Returned::Inertia => [task, task],
        Returned::Inverse => [dof, task],
    };
    // the axes of the states are those of M, because J does not depend on a payload, which may have many states
    let states = mass.shape().len().checked_sub(2).and_then(|axes| mass.shape().get(..axes)).unwrap_or_default();
    let shape = [states, &of_state].concat();
    let result = room::<T>(py, out, &shape)?;
    let (mass, jacobian) = (mass.readonly(), jacobian.readonly());
    {
        let not_contiguous = |_| PyValueError::new_err("`out` is not contiguous");
        let mut writable = writable(&result)?;
        let numbers = writable.as_slice_mut().map_err(not_contiguous)?;
        let (mass, jacobian) = (mass.as_slice()?, jacobian.as_slice()?);
        py.detach(|| {
            let of_each = numbers.chunks_exact_mut(of_state[0] * of_state[1]);
            for (state, numbers) in of_each.enumerate() {
                let of = |all: &[T], size: usize| -> Vec<Vec<T>> {
                    let start = if all.len() == size { 0 } else { state * size };
                    all[start..start + size].chunks_exact(dof).map(<[T]>::to_vec).collect()
                };
                let all_rows = of(jacobian, ROWS * dof);
                let mut jacobian: Vec<Vec<T>> = rows.iter().map(|&row| all_rows[row].clone()).collect();
                let zeros = vec![vec![T::from_f64(0.0); task]; task];
                let inertia = rne::operational_space(&mut of(mass, dof * dof), &mut jacobian, zeros);
                match returned {
                    Returned::Inertia => numbers.copy_from_slice(&inertia.concat()),
                    Returned::Inverse => {
                        let places = numbers.iter_mut().enumerate();
                        places.for_each(|(at, number)| *number = jacobian[at % task][at / task]);
                    }
                }
            }
        });
    }
    Ok(result.into_any())
}
