//! Steps of the Runge-Kutta method with a floating base.

use std::cell::RefCell;

use numpy::Element;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rne::compiled::{Arguments, Array, CompiledArm, EvaluationError, Function, Number};
use rne::{BaseAcceleration, BaseTwist, Quaternion};
use rne_runtime::floating_integrator_of_lists::{Linear, Stage, Turning, derivatives, factor, moved, runge_kutta};

use super::{Matrix, Model, Moved, Rows, Steps, chained, computed};
use crate::arrays::{array_of, pose_of_twelve};
use crate::errors::of_evaluation;
use crate::functions::homogeneous;

impl<T: Element + Number> Rows<T> {
    pub(super) fn of_floating_base<'py>(
        &self,
        py: Python<'py>,
        Steps { arm, count: steps, .. }: &Steps<'_, '_>,
        is_derived: bool,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let (dof, count) = (arm.dof(), self.many.unwrap_or(1));
        let of_state = |state| self.moved(arm, state, *steps, is_derived);
        let computed = py.detach(|| (0..count).map(of_state).collect::<Result<Vec<_>, _>>());
        let computed = computed.map_err(|error| of_evaluation(&error))?;
        let (parts, models): (Vec<_>, Vec<_>) = computed.into_iter().unzip();
        if is_derived {
            let is_finite = |numbers: &[T]| numbers.iter().all(|&number| Into::<f64>::into(number).is_finite());
            let is_singular = models.iter().flatten().any(|[a, _]| !a.iter().all(|row| is_finite(row)));
            if is_singular && self.rows.iter().all(|(.., numbers)| is_finite(numbers)) {
                return Err(PyValueError::new_err(
                    "the mass matrix is singular in one of the states: the base or a joint moves no mass, so the step \
                     has no derivatives",
                ));
            }
            return self.models(py, [12 + 2 * dof, dof], models);
        }
        let shapes: [&[usize]; 4] = [&[4, 4], &[6], &[dof], &[dof]];
        let of_all = |part: usize| parts.iter().flat_map(|parts| parts[part].iter().copied()).collect();
        let arrays =
            shapes.iter().enumerate().map(|(part, shape)| array_of(py, self.many.as_slice(), shape, of_all(part)));
        PyTuple::new(py, arrays.collect::<PyResult<Vec<_>>>()?)
    }

    /// Returns the state after all steps, and their linear model if it is requested.
    fn moved(
        &self,
        arm: &CompiledArm,
        state: usize,
        steps: i64,
        is_derived: bool,
    ) -> Result<Moved<T>, EvaluationError> {
        let (dof, gravity) = (arm.dof(), arm.robot().gravity.map(T::from_f64));
        let step = self.at("step", state)[0];
        let pose = pose_of_twelve(self.at("pose", state));
        let orientation = Quaternion::of_rotation(&pose.rotation.map(|row| row.map(Into::<f64>::into)));
        let mut orientation = Quaternion::from_wxyz(orientation.to_wxyz().map(T::from_f64));
        let mut position = pose.translation;
        let twist = self.at("twist", state);
        let mut twist = BaseTwist { linear: three(twist), angular: three(&twist[3..]) };
        let (mut q, mut qd) = (self.at("q", state).to_vec(), self.at("qd", state).to_vec());
        let (zero, failed, mut model) = ([T::zero(); 3], RefCell::new(None), None);
        let of = |function: Function, arguments: &Arguments<'_, T>| {
            computed(arm, function, arguments, 1).unwrap_or_else(|error| {
                *failed.borrow_mut() = Some(error);
                vec![T::zero(); arm.layout(function).len()]
            })
        };
        for _ in 0..steps {
            let mut stages = Vec::new();
            let start = Stage::of(&orientation, &twist, q, qd);
            let (next, mean) = runge_kutta(&start, step, |_, stage| {
                let arguments = self.arguments(state, 1).q(Array::Rows(&stage.q)).qd(Array::Rows(&stage.qd));
                let found = of(Function::FloatingForwardDynamics, &arguments.omega(Array::Rows(&stage.omega)));
                let base = BaseAcceleration { linear: three(&found), angular: three(&found[3..]) };
                if is_derived {
                    // the computed acceleration of the base already contains -g, so gravity is zero here
                    let arguments = arguments
                        .qdd(Array::Rows(&found[6..]))
                        .base_omega(Array::Rows(&stage.omega))
                        .base_omega_dot(Array::Rows(&base.angular))
                        .base_acceleration(Array::Rows(&base.linear))
                        .base_gravity(Array::Rows(&zero));
                    stages.push(StageForces::of(Turning::of(stage, &base, &orientation), dof, |function| {
                        of(function, &arguments)
                    }));
                }
                stage.rates(&base, found[6..].to_vec(), &orientation, &gravity)
            });
            if let Some(error) = failed.take() {
                return Err(error);
            }
            let (next_orientation, next_twist) = next.base(&orientation);
            if is_derived {
                let orientations = [&orientation, &next_orientation];
                model = Some(chained(model, model_of_step(orientations, &twist, &next, step, &stages)));
            }
            position = moved(&position, &mean, step);
            (orientation, twist, q, qd) = (next_orientation, next_twist, next.q, next.qd);
        }
        let mut matrix = vec![T::zero(); 16];
        homogeneous(&[orientation.rotation().as_flattened(), &position].concat(), &mut matrix);
        let twist = [twist.linear, twist.angular].concat();
        Ok((vec![matrix, twist, q, qd], model))
    }
}

fn three<T: Copy>(numbers: &[T]) -> [T; 3] {
    [numbers[0], numbers[1], numbers[2]]
}

/// The derivatives of the forces at a stage of a step, and the factors of the mass matrix there.
struct StageForces<T> {
    turning: Turning<T>,
    dq: Matrix<T>,
    dqd: Matrix<T>,
    domega: Vec<[T; 3]>,
    mass: Matrix<T>,
    inverse: Vec<T>,
}

impl<T: Number> StageForces<T> {
    /// Returns the derivatives and factors for a stage; `of` computes a function at its state.
    fn of(turning: Turning<T>, dof: usize, of: impl Fn(Function) -> Vec<T>) -> Self {
        let size = 6 + dof;
        let rows = |numbers: &[T], columns| -> Matrix<T> { numbers.chunks_exact(columns).map(<[T]>::to_vec).collect() };
        let forces = of(Function::FloatingInverseDynamicsDerivatives);
        let (dq, others) = forces.split_at(size * dof);
        let (dqd, domega) = others.split_at(size * dof);
        let mut mass = rows(&of(Function::FloatingMassMatrix), size);
        let mut inverse = vec![T::zero(); size];
        factor(&mut mass, &mut inverse);
        let domega = domega.chunks_exact(3).map(three).collect();
        Self { turning, dq: rows(dq, dof), dqd: rows(dqd, dof), domega, mass, inverse }
    }
}

/// Returns the matrices A and B of the linear model of one step.
fn model_of_step<T: Number>(
    orientations: [&Quaternion<T>; 2],
    twist: &BaseTwist<T>,
    next: &Stage<Vec<T>, T>,
    step: T,
    stages: &[StageForces<T>],
) -> Model<T> {
    let (dof, size) = (next.q.len(), 6 + next.q.len());
    let mut a = vec![vec![T::zero(); 2 * size]; 2 * size];
    let mut b = vec![vec![T::zero(); dof]; 2 * size];
    let of_stage = |number: usize| {
        let StageForces { turning, dq, dqd, domega, mass, inverse } = stages.get(number)?;
        Some(Linear { turning: *turning, dq, dqd, domega, mass, inverse })
    };
    derivatives(
        orientations,
        twist,
        next,
        step,
        of_stage,
        &mut vec![T::zero(); size],
        &mut |[half, kind], row, at, element| match kind {
            2 => b[half * size + row][at] = element,
            _ => a[half * size + row][kind * size + at] = element,
        },
    );
    [a, b]
}
