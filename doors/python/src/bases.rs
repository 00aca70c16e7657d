//! Converts the motion of a floating base from the vectors of other tools to arguments of
//! `Arm.inverse_dynamics_of_floating_base`, and its derivatives to the matrices of these tools.
//! docs/reference/conventions.md has a table of the conventions.

use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use rne::{BaseMotion, Pose};

use crate::arrays::{array_of, in_order, readable, shape_in_words, taken};

/// The largest difference of a quaternion's length from 1: that of a quaternion written with three digits.
const MOST_ROUNDED: f64 = 1e-3;

/// An argument as an array, whose last axes are those of one state and whose first axes count the states.
struct Numbers {
    name: &'static str,
    shape: Vec<usize>,
    elements: Vec<f64>,
    /// How many of the last axes belong to one state.
    axes: usize,
    /// The index of the first element of a vector that is used.
    begin: usize,
}

impl Numbers {
    /// Reads vectors of at least `least` elements, or matrices with at least as many columns.
    fn of(name: &'static str, value: &Bound<'_, PyAny>, axes: usize, least: usize) -> PyResult<Self> {
        Self::after(0, name, value, axes, least)
    }

    /// Reads vectors as `of` does, of which the elements from `begin` on are used.
    fn after(begin: usize, name: &'static str, value: &Bound<'_, PyAny>, axes: usize, least: usize) -> PyResult<Self> {
        let least = begin + least;
        let array = in_order(taken::<f64>(name, value, &(0..0))?)?;
        let shape = array.shape().to_vec();
        if shape.len() < axes || shape.last().is_none_or(|&columns| columns < least) {
            let kind = if axes == 1 { "vectors of at least" } else { "matrices with at least" };
            let columns = if axes == 1 { "numbers" } else { "columns" };
            let shape = shape_in_words(&shape);
            let message = format!("`{name}` has the shape {shape}, but it must have {kind} {least} {columns}");
            return Err(PyValueError::new_err(message));
        }
        let elements = readable(name, &array)?.as_slice()?.to_vec();
        Ok(Self { name, shape, elements, axes, begin })
    }

    /// The axes that count the states.
    fn leading(&self) -> &[usize] {
        &self.shape[..self.shape.len() - self.axes]
    }

    /// Returns the numbers of one state. An argument with one state has the same numbers for all states.
    fn at(&self, state: usize) -> &[f64] {
        let size = self.shape[self.leading().len()..].iter().product::<usize>();
        let states = self.elements.len() / size.max(1);
        &self.elements[size * (state % states.max(1))..][..size]
    }

    fn first<const N: usize>(&self, state: usize) -> [f64; N] {
        std::array::from_fn(|index| self.at(state)[self.begin + index])
    }
}

impl Numbers {
    /// Returns an error if the quaternion in the positions of a base does not have the length 1. `order` names the
    /// order of its elements, for the message.
    fn with_unit_quaternion(self, order: &str) -> PyResult<Self> {
        let size = self.shape.last().copied().unwrap_or(1).max(1);
        let (first, end) = (self.begin + 3, self.begin + 7);
        let lengths = self.elements.chunks_exact(size).map(|q| q[first..end].iter().map(|x| x * x).sum::<f64>().sqrt());
        if let Some(length) = lengths.into_iter().find(|length| (length - 1.0).abs() > MOST_ROUNDED) {
            return Err(PyValueError::new_err(format!(
                "`{}[{first}:{end}]` is a quaternion of the length {length:.4}, but it must have the length 1; its \
                 order \
                 is {order}",
                self.name
            )));
        }
        Ok(self)
    }
}

/// Returns the axes of the states that all arguments share. An argument may also have one state, which is used for all.
fn states_of<'a>(all: &[&'a Numbers]) -> PyResult<&'a [usize]> {
    let is_one = |numbers: &&&Numbers| numbers.leading().iter().product::<usize>() == 1;
    let many = all.iter().find(|numbers| !is_one(numbers));
    let Some(first) = many.or_else(|| all.iter().max_by_key(|numbers| numbers.leading().len())) else {
        return Ok(&[]);
    };
    if let Some(other) = all.iter().find(|other| !is_one(other) && other.leading() != first.leading()) {
        return Err(PyValueError::new_err(format!(
            "`{}` has the shape {}, which has other states than `{}` with the shape {}",
            other.name,
            shape_in_words(&other.shape),
            first.name,
            shape_in_words(&first.shape)
        )));
    }
    Ok(first.leading())
}

/// Returns the motions of all states as a dict of keywords for `Arm.inverse_dynamics_of_floating_base`.
fn told<'py>(
    py: Python<'py>,
    given: &[&Numbers],
    motion: impl Fn(usize) -> BaseMotion<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let leading = states_of(given)?;
    let motions: Vec<_> = (0..leading.iter().product()).map(motion).collect();
    let told = PyDict::new(py);
    let part = |name: &str, part: fn(&BaseMotion<f64>) -> [f64; 3]| {
        told.set_item(name, array_of(py, leading, &[3], motions.iter().flat_map(part).collect())?)
    };
    part("base_omega", |motion| motion.omega)?;
    part("base_omega_dot", |motion| motion.omega_dot)?;
    part("base_acceleration", |motion| motion.acceleration)?;
    part("base_gravity", |motion| motion.gravity)?;
    Ok(told)
}

/// Returns gravity, and the indices at which the base begins in the positions and in the velocities. Gravity is in the
/// axes to which the tool refers the orientation of the base. The function named `base_of` in the module `rne.models`
/// reads them from the model of the tool.
fn base_of(
    py: Python<'_>,
    base_of: &str,
    model: Option<&Bound<'_, PyAny>>,
    gravity: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Numbers, [usize; 2])> {
    match (model, gravity) {
        (None, Some(gravity)) => Ok((Numbers::of("gravity", gravity, 1, 3)?, [0; 2])),
        (Some(model), None) => {
            let found = py.import("rne.models")?.call_method1(base_of, (model,))?;
            let (gravity, position, velocity): (Bound<'_, PyAny>, usize, usize) = found.extract()?;
            Ok((Numbers::of("gravity", &gravity, 1, 3)?, [position, velocity]))
        }
        _ => Err(PyTypeError::new_err(
            "give either `model`, the model of these vectors, or `gravity`, such as gravity=(0, 0, -9.81); without \
             them the direction of gravity is not known",
        )),
    }
}

/// The base whose inertial measurement unit reads these values.
///
/// gyroscope: ω, rad/s, of shape (3,) or (N, 3), in axes of the unit.
/// gyroscope_rate: ω̇, rad/s²: a difference of readings, or zeros.
/// accelerometer: the specific force a - g, m/s². At rest it points up.
/// rotation: 3×3, from the axes of the unit to those of the base. Without it they are the same.
/// position: where the unit is on the base, m, in axes of the base.
///
/// Returns a dict of `base_omega`, `base_omega_dot`, `base_acceleration` (here a - g) and `base_gravity` (here zero).
#[pyfunction]
#[pyo3(signature = (gyroscope, gyroscope_rate, accelerometer, *, rotation=None, position=None))]
pub(crate) fn base_from_imu<'py>(
    py: Python<'py>,
    gyroscope: &Bound<'py, PyAny>,
    gyroscope_rate: &Bound<'py, PyAny>,
    accelerometer: &Bound<'py, PyAny>,
    rotation: Option<&Bound<'py, PyAny>>,
    position: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let omega = Numbers::of("gyroscope", gyroscope, 1, 3)?;
    let omega_dot = Numbers::of("gyroscope_rate", gyroscope_rate, 1, 3)?;
    let felt = Numbers::of("accelerometer", accelerometer, 1, 3)?;
    let mut unit = Pose::identity();
    if let Some(rotation) = rotation {
        let rows = Numbers::of("rotation", rotation, 2, 3)?;
        if rows.shape != [3, 3] {
            let shape = shape_in_words(&rows.shape);
            return Err(PyValueError::new_err(format!("`rotation` has the shape {shape}, but it must be (3, 3)")));
        }
        unit.rotation = std::array::from_fn(|row| std::array::from_fn(|column| rows.elements[3 * row + column]));
        if !unit.is_rigid() {
            return Err(PyValueError::new_err(
                "`rotation` is no rotation: its three rows must have the length 1, be at right angles to each other, \
                 and \
                 be right-handed",
            ));
        }
    }
    if let Some(position) = position {
        unit.translation = Numbers::of("position", position, 1, 3)?.first(0);
    }
    told(py, &[&omega, &omega_dot, &felt], |state| {
        BaseMotion::from_imu_at(&unit, omega.first(state), omega_dot.first(state), felt.first(state))
    })
}

/// Defines Python functions that compute the motion of the base of a model from its vectors. For each it takes the
/// name, the names of the vectors, the name of the function that finds the base in a model, the order of the
/// quaternion's elements, and the conversion.
macro_rules! base_from_vectors {
    ($(
        $(#[$($about:tt)*])*
        $function:ident($q:ident, $v:ident, $a:ident) $base_of:literal $order:literal $motion:path;
    )*) => {
        $(
            $(#[$($about)*])*
            #[pyfunction]
            #[pyo3(signature = ($q, $v, $a, model=None, *, gravity=None))]
            pub(crate) fn $function<'py>(
                py: Python<'py>,
                $q: &Bound<'py, PyAny>,
                $v: &Bound<'py, PyAny>,
                $a: &Bound<'py, PyAny>,
                model: Option<&Bound<'py, PyAny>>,
                gravity: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyDict>> {
                let (gravity, [position, velocity]) = base_of(py, $base_of, model, gravity)?;
                let q = Numbers::after(position, stringify!($q), $q, 1, 7)?.with_unit_quaternion($order)?;
                let v = Numbers::after(velocity, stringify!($v), $v, 1, 6)?;
                let a = Numbers::after(velocity, stringify!($a), $a, 1, 6)?;
                told(py, &[&q, &v, &a, &gravity], |state| {
                    $motion(&q.first(state), &v.first(state), &a.first(state), gravity.first(state))
                })
            }
        )*
    };
}

base_from_vectors! {
/// The base of a Pinocchio model: what a free flyer moves that carries all other joints.
///
/// q, v, a: the vectors of `pinocchio.rnea`, of shape (nq,), (nv,), (nv,) or (N, …). `a` is Pinocchio's spatial
/// acceleration.
/// model: the `pinocchio.Model`. It says which elements of the vectors are those of the base, its gravity, and where it
/// places the free flyer: q has the orientation of the base from there.
/// gravity: instead of the model, m/s², in the axes in which q has the orientation of the base: those of the world,
/// unless the model places its free flyer elsewhere. The first 7, 6 and 6 elements of the vectors are then the base.
///
/// Returns a dict of `base_omega`, `base_omega_dot`, `base_acceleration` and `base_gravity`, in axes of the base.
///
/// Raises TypeError without model and gravity, ValueError where no free flyer of the model carries all other joints.
base_from_pinocchio(q, v, a) "base_of_pinocchio" "x y z w" BaseMotion::from_pinocchio;

/// The base of a MuJoCo model: the body with a free joint that carries all other joints.
///
/// qpos, qvel, qacc: the vectors of `MjData`, of shape (nq,), (nv,), (nv,) or (N, …).
/// model: the `mujoco.MjModel`. It says which elements of the vectors are those of the base, and its gravity, which is
/// zero if its flag `gravity` is off.
/// gravity: instead of the model, m/s², in the world. The first 7, 6 and 6 elements of the vectors are then the base.
///
/// Returns a dict of `base_omega`, `base_omega_dot`, `base_acceleration` and `base_gravity`, in axes of the base.
///
/// Raises TypeError without model and gravity, ValueError where no free joint of the model carries all other joints.
base_from_mujoco(qpos, qvel, qacc) "base_of_mujoco" "w x y z" BaseMotion::from_mujoco;
}

/// The matrices ∂τ/∂q and ∂τ/∂v of `pinocchio.computeRNEADerivatives` with a free flyer; its ∂τ/∂a is `mass`.
///
/// derivatives: what `Arm.floating_inverse_dynamics_derivatives` returns for the base of `base_from_pinocchio`.
/// mass: `Arm.floating_mass_matrix` at the same positions, of shape (6 + n, 6 + n) or (N, 6 + n, 6 + n).
/// q, v: the vectors of Pinocchio.
/// model, gravity: one of them, as in `base_from_pinocchio`.
///
/// Returns two matrices of this shape. Rows are force, moment and torques. Columns are those of Pinocchio's tangent
/// space, in axes of the base: translation and rotation of the base, or its linear and angular velocity, then the
/// joints in the order of the arm.
#[pyfunction]
#[pyo3(signature = (derivatives, mass, q, v, model=None, *, gravity=None))]
pub(crate) fn derivatives_to_pinocchio<'py>(
    py: Python<'py>,
    derivatives: &Bound<'py, PyAny>,
    mass: &Bound<'py, PyAny>,
    q: &Bound<'py, PyAny>,
    v: &Bound<'py, PyAny>,
    model: Option<&Bound<'py, PyAny>>,
    gravity: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyTuple>> {
    let (gravity, [position, velocity]) = base_of(py, "base_of_pinocchio", model, gravity)?;
    let mut parts = derivatives.try_iter()?;
    let mut part = |name| {
        let missing = || PyValueError::new_err("`derivatives` has three matrices: dq, dqd and domega");
        Numbers::of(name, &parts.next().ok_or_else(missing)??, 2, if name == "domega" { 3 } else { 1 })
    };
    let (dq, dqd, domega) = (part("dq")?, part("dqd")?, part("domega")?);
    let mass = Numbers::of("mass", mass, 2, 6)?;
    let (q, v) = (
        Numbers::after(position, "q", q, 1, 7)?.with_unit_quaternion("x y z w")?,
        Numbers::after(velocity, "v", v, 1, 6)?,
    );
    let size = *mass.shape.last().unwrap_or(&6);
    for (matrix, columns) in [(&dq, size - 6), (&dqd, size - 6), (&domega, 3), (&mass, size)] {
        if matrix.shape[matrix.leading().len()..] != [size, columns] {
            return Err(PyValueError::new_err(format!(
                "`{}` has the shape {}, but beside `mass` with {size} columns it must be ({size}, {columns}) for one \
                 state or (N, {size}, {columns}) for many",
                matrix.name,
                shape_in_words(&matrix.shape)
            )));
        }
    }
    let leading = states_of(&[&dq, &dqd, &domega, &mass, &q, &v, &gravity])?;
    let mut by = [const { Vec::new() }; 2];
    for state in 0..leading.iter().product() {
        let (q, a): ([f64; 7], _) = (q.first(state), [0.0; 6]);
        let v: [f64; 6] = v.first(state);
        // in Pinocchio, gravity is in world axes, and the spatial acceleration is a - ω × v
        let base = BaseMotion::from_pinocchio(&q, &v, &a, gravity.first(state));
        let of_row = |matrix: &Numbers, row| {
            let columns = *matrix.shape.last().unwrap_or(&0);
            matrix.at(state)[columns * row..][..columns].to_vec()
        };
        for row in 0..size {
            let linear = of_row(&mass, row);
            let crossed = |[x, y, z]: [f64; 3]| {
                [linear[1] * z - linear[2] * y, linear[2] * x - linear[0] * z, linear[0] * y - linear[1] * x]
            };
            by[0].extend([0.0; 3].into_iter().chain(crossed(base.gravity).map(|x| -x)).chain(of_row(&dq, row)));
            let swung = of_row(&domega, row).into_iter().zip(crossed(base.velocity)).map(|(by, swung)| by - swung);
            by[1].extend(crossed(base.omega).into_iter().chain(swung).chain(of_row(&dqd, row)));
        }
    }
    let [by_q, by_v] = by.map(|numbers| array_of(py, leading, &[size, size], numbers));
    PyTuple::new(py, [by_q?, by_v?])
}
