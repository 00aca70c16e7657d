//! Steps of the classical Runge-Kutta method, by functions of the compiled arm.

mod floating_base;

use numpy::Element;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rne::compiled::{Arguments, Array, CompiledArm, EvaluationError, Function, Number, OutOfRange};
use rne_runtime::integrators;

use crate::arm::{Arm, methods};
use crate::arrays::{Given, Held, are_single, array_of, states};
use crate::errors::of_evaluation;
use crate::functions::run;
use rne_codegen::CheckFor as _;

/// A matrix, row by row.
type Matrix<T> = Vec<Vec<T>>;

/// The matrices A and B of a linear model.
type Model<T> = [Matrix<T>; 2];

/// The homogeneous matrix of the base, its twist, q and qd; then A and B, if they were requested.
type Moved<T> = (Vec<Vec<T>>, Option<Model<T>>);

methods! {
    (q, qd, tau, step, *, steps=1, payload=None, parameters=None)
    (
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        step: &Bound<'py, PyAny>,
        steps: i64,
        payload: Option<&Bound<'py, PyAny>>,
        parameters: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyTuple>>;

    /// The state after steps of the classical Runge-Kutta method of duration `step` (s) under torques `tau`.
    ///
    /// `steps` steps follow each other under the same torques. Each of them computes `forward_dynamics` four times; the
    /// error of a motion is of order h⁴. `step` is a number, or an array of shape (N,).
    ///
    /// Returns the positions and the velocities after the steps, two arrays of shape (n,) or (N, n).
    runge_kutta_step {
        let more = payload.map(|payload| self.payload(payload)).into_iter().collect();
        self.stepped([q, qd, tau], step, steps, more, parameters)?.of_arm(py, payload.is_some(), false)
    }

    /// Derivatives of `runge_kutta_step` by q, by q̇ and by τ: the linear model δx' = A δx + B δτ with x = (q, q̇).
    ///
    /// They are exact up to rounding, by the chain rule over all `steps`.
    ///
    /// Returns A and B, of shape (2 n, 2 n) and (2 n, n), or (N, 2 n, 2 n) and (N, 2 n, n).
    runge_kutta_step_derivatives {
        let more = payload.map(|payload| self.payload(payload)).into_iter().collect();
        self.stepped([q, qd, tau], step, steps, more, parameters)?.of_arm(py, payload.is_some(), true)
    }
}

methods! {
    (q, qd, tau, pose, twist, step, wrenches=None, *, steps=1, parameters=None)
    (
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        pose: &Bound<'py, PyAny>,
        twist: &Bound<'py, PyAny>,
        step: &Bound<'py, PyAny>,
        wrenches: Option<&Bound<'py, PyAny>>,
        steps: i64,
        parameters: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyTuple>>;

    /// The state after steps of the classical Runge-Kutta method with a floating base.
    ///
    /// Arguments and results are those of `floating_euler_step`. `steps` steps follow each other under the same torques
    /// `tau` and the same `wrenches`, which do not change in axes of their tips. Each step of duration `step` (s)
    /// computes `floating_forward_dynamics` four times; the error of a motion is of order h⁴. The turn of the base in a
    /// step must stay below a whole turn. The rotation after a step is orthogonal to rounding.
    ///
    /// Returns the pose after the steps, a homogeneous matrix of shape (4, 4) or (N, 4, 4), the velocity of the base,
    /// linear then angular, in its axes, of shape (6,) or (N, 6), and the positions and the velocities of the joints,
    /// of shape (n,) or (N, n).
    floating_runge_kutta_step {
        let more = self.of_base(pose, twist, wrenches)?;
        self.stepped([q, qd, tau], step, steps, more, parameters)?.of_floating_base(py, false)
    }

    /// Derivatives of `floating_runge_kutta_step` by positions, velocities and τ: the linear model of its steps.
    ///
    /// They are exact up to rounding, by the chain rule over all `steps`. A change of the positions of the base is a
    /// shift of its origin and a rotation vector, both in axes of the base: before the steps for columns, after them
    /// for rows. The velocities of the base are `twist`.
    ///
    /// Returns A and B, of shape (12 + 2 n, 12 + 2 n) and (12 + 2 n, n), or (N, 12 + 2 n, 12 + 2 n) and
    /// (N, 12 + 2 n, n); rows and columns are the positions, then the velocities, each of the base before the joints.
    floating_runge_kutta_step_derivatives {
        let more = self.of_base(pose, twist, wrenches)?;
        self.stepped([q, qd, tau], step, steps, more, parameters)?.of_floating_base(py, true)
    }
}

/// The steps of a call, with the arm and the arguments.
struct Steps<'a, 'py> {
    arm: &'a CompiledArm,
    given: Vec<Given<'py>>,
    count: i64,
}

impl Arm {
    fn of_base<'py>(
        &self,
        pose: &Bound<'py, PyAny>,
        twist: &Bound<'py, PyAny>,
        wrenches: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Vec<Given<'py>>> {
        let twist = Given::vector("twist", 6, twist.clone());
        Function::FloatingForwardDynamics.check_base(self.robot()).map_err(|error| of_evaluation(&error))?;
        Ok(vec![self.of_pose("pose", pose)?, twist, self.of_tips("wrenches", wrenches)?])
    }

    fn stepped<'py>(
        &self,
        [q, qd, tau]: [&Bound<'py, PyAny>; 3],
        step: &Bound<'py, PyAny>,
        steps: i64,
        more: Vec<Given<'py>>,
        parameters: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Steps<'_, 'py>> {
        if steps < 1 {
            let message = format!("`steps` is {steps}; it is the number of steps, 1 or more");
            return Err(PyValueError::new_err(message));
        }
        let mut given = vec![self.of_joints("q", q)?, self.of_joints("qd", qd)?, self.of_joints("tau", tau)?];
        given.extend(more);
        given.push(Given::number("step", step)?);
        given.extend(self.given_parameters(parameters)?);
        Ok(Steps { arm: &self.arm, given, count: steps })
    }
}

impl<'py> Steps<'_, 'py> {
    fn of_arm(&self, py: Python<'py>, is_loaded: bool, is_derived: bool) -> PyResult<Bound<'py, PyTuple>> {
        if are_single(&self.given) {
            Rows::<f32>::of(&self.given)?.of_arm(py, self, is_loaded, is_derived)
        } else {
            Rows::<f64>::of(&self.given)?.of_arm(py, self, is_loaded, is_derived)
        }
    }

    fn of_floating_base(&self, py: Python<'py>, is_derived: bool) -> PyResult<Bound<'py, PyTuple>> {
        if are_single(&self.given) {
            Rows::<f32>::of(&self.given)?.of_floating_base(py, self, is_derived)
        } else {
            Rows::<f64>::of(&self.given)?.of_floating_base(py, self, is_derived)
        }
    }
}

/// The numbers of all arguments, state by state.
struct Rows<T> {
    many: Option<usize>,
    /// For each argument its name, how many numbers it has per state, and all its numbers.
    rows: Vec<(&'static str, usize, Vec<T>)>,
}

impl<T: Element + Number> Rows<T> {
    fn of(given: &[Given<'_>]) -> PyResult<Self> {
        let held: Vec<Held<'_, T>> = given.iter().map(|given| Held::of(given, &(0..0))).collect::<PyResult<_>>()?;
        let many = states(&held)?;
        let of_each = |held: &Held<'_, T>| Ok((held.name(), held.elements(), held.rows(many.unwrap_or(1))?));
        let rows = Self { many, rows: held.iter().map(of_each).collect::<PyResult<_>>()? };
        // `step` is checked here, because the compiled arm only computes accelerations and never reads it
        let mut steps = rows.all("step").iter();
        steps
            .try_for_each(|&step| OutOfRange::check("step", |_| Some(step.into())))
            .map_err(|error| of_evaluation(&error))?;
        Ok(rows)
    }

    /// Returns the numbers of an argument in one state.
    fn at(&self, name: &str, state: usize) -> &[T] {
        let found = self.rows.iter().find(|(own, ..)| *own == name);
        found.map_or(&[], |(_, elements, numbers)| &numbers[state * elements..][..*elements])
    }

    fn all(&self, name: &str) -> &[T] {
        self.rows.iter().find(|(own, ..)| *own == name).map_or(&[], |(.., numbers)| numbers)
    }

    /// Returns the arguments of a range of states, except the positions and velocities, which change within a step.
    fn arguments(&self, from: usize, count: usize) -> Arguments<'_, T> {
        let named = self.rows.iter().filter(|(name, ..)| ["tau", "wrenches", "payload", "parameters"].contains(name));
        named.fold(Arguments::new(), |arguments, (name, elements, numbers)| {
            let numbers = Array::Rows(&numbers[from * elements..][..count * elements]);
            arguments.with(name, numbers).unwrap_or(arguments)
        })
    }

    fn of_arm<'py>(
        &self,
        py: Python<'py>,
        Steps { arm, count: steps, .. }: &Steps<'_, '_>,
        is_loaded: bool,
        is_derived: bool,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let (dof, count) = (arm.dof(), self.many.unwrap_or(1));
        let [dynamics, by_state] = if is_loaded {
            [Function::ForwardDynamicsWithPayload, Function::ForwardDynamicsDerivativesWithPayload]
        } else {
            [Function::ForwardDynamics, Function::ForwardDynamicsDerivatives]
        };
        let step = self.all("step");
        let of_states = |from: usize, count: usize, function: Function, q: &[T], qd: &[T]| {
            let arguments = self.arguments(from, count).q(Array::Rows(q)).qd(Array::Rows(qd));
            computed(arm, function, &arguments, count)
        };
        // computes one step of `count` states, the first of which is the state `from`
        let next = |from: usize, count: usize, [q, qd]: &[Vec<T>; 2]| {
            let accelerations = |q: &Vec<T>, qd: &Vec<T>| of_states(from, count, dynamics, q, qd);
            integrators::runge_kutta_step(accelerations, [q, qd], |at| step[from + at / dof])
        };
        let after = || {
            let mut state = [self.all("q").to_vec(), self.all("qd").to_vec()];
            for _ in 0..*steps {
                state = next(0, count, &state)?;
            }
            Ok(state)
        };
        let model = |state: usize| {
            let (mut model, mut now) = (None, [self.at("q", state).to_vec(), self.at("qd", state).to_vec()]);
            for index in 0..*steps {
                if index > 0 {
                    now = next(state, 1, &now)?;
                }
                let accelerations = |q: &Vec<T>, qd: &Vec<T>| of_states(state, 1, dynamics, q, qd);
                let by = |q: &Vec<T>, qd: &Vec<T>| {
                    let found = of_states(state, 1, by_state, q, qd)?;
                    let matrix = |of: usize| -> Matrix<T> {
                        found[of * dof * dof..][..dof * dof].chunks_exact(dof).map(<[T]>::to_vec).collect()
                    };
                    Ok([matrix(0), matrix(1), matrix(2)])
                };
                let found = integrators::runge_kutta_step_derivatives(accelerations, by, now.each_ref(), step[state])?;
                model = Some(chained(model, side_by_side(found)));
            }
            Ok(model)
        };
        if is_derived {
            let models = py.detach(|| (0..count).map(model).collect::<Result<Vec<_>, EvaluationError>>());
            return self.models(py, [2 * dof, dof], models.map_err(|error| of_evaluation(&error))?);
        }
        let state = py.detach(after).map_err(|error: EvaluationError| of_evaluation(&error))?;
        let [q, qd] = state.map(|numbers| array_of(py, self.many.as_slice(), &[dof], numbers));
        PyTuple::new(py, [q?, qd?])
    }

    /// Returns the arrays of the matrices A and B of all states.
    fn models<'py>(
        &self,
        py: Python<'py>,
        [size, inputs]: [usize; 2],
        models: Vec<Option<Model<T>>>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let of = |part: usize| models.iter().flatten().flat_map(|model| model[part].concat()).collect();
        let [a, b] = [(0, size), (1, inputs)]
            .map(|(part, columns)| array_of(py, self.many.as_slice(), &[size, columns], of(part)));
        PyTuple::new(py, [a?, b?])
    }
}

/// Computes a function of some states and returns the results.
fn computed<T: Number>(
    arm: &CompiledArm,
    function: Function,
    arguments: &Arguments<'_, T>,
    count: usize,
) -> Result<Vec<T>, EvaluationError> {
    let mut found = vec![T::zero(); arm.layout(function).len() * count];
    run(arm, function, count, arguments, &mut found)?;
    Ok(found)
}

/// Returns A and B from the derivatives of positions and velocities with respect to q, q̇ and τ.
fn side_by_side<T: Copy>(found: [[Matrix<T>; 3]; 2]) -> Model<T> {
    let (mut a, mut b) = (Matrix::new(), Matrix::new());
    for [dq, dqd, dtau] in found {
        a.extend(dq.into_iter().zip(dqd).map(|(dq, dqd)| [dq, dqd].concat()));
        b.extend(dtau);
    }
    [a, b]
}

/// Returns the linear model of all steps from that of the steps before and that of the last step.
fn chained<T: Number>(before: Option<Model<T>>, [a, b]: Model<T>) -> Model<T> {
    let Some([by_x, by_u]) = before else { return [a, b] };
    let product = |with: &Matrix<T>, added: Option<&Matrix<T>>| {
        let row = |(at, row): (usize, &Vec<T>)| {
            let mut sum = added.map_or_else(|| vec![T::zero(); with[0].len()], |added| added[at].clone());
            for (factor, with) in row.iter().zip(with) {
                sum.iter_mut().zip(with).for_each(|(sum, &with)| *sum += *factor * with);
            }
            sum
        };
        a.iter().enumerate().map(row).collect()
    };
    [product(&by_x, None), product(&by_u, Some(&b))]
}
