//! Steps of the classical Runge-Kutta method: arguments for the modules of the package that compute them.

use pyo3::prelude::*;

use crate::arm::Arm;

/// Methods that a module of the package computes: the arguments that are always there, and those of some.
macro_rules! computed_by {
    ($module:literal: $(
        $(#[$doc:meta])* $name:ident ($($given:ident),*; $($wrenches:ident)?; $($payload:ident)?)
    )*) => {$(
        #[pymethods]
        impl Arm {
            $(#[$doc])*
            #[pyo3(signature = ($($given,)* $($wrenches=None,)? *, steps=1, $($payload=None,)? parameters=None))]
            #[allow(clippy::too_many_arguments)] // those of Python
            fn $name<'py>(
                slf: &Bound<'py, Self>,
                $($given: &Bound<'py, PyAny>,)*
                $($wrenches: Option<&Bound<'py, PyAny>>,)?
                steps: i64,
                $($payload: Option<&Bound<'py, PyAny>>,)?
                parameters: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                let arguments = (slf, $($given,)* $($wrenches,)? steps, $($payload,)? parameters);
                slf.py().import($module)?.call_method1(stringify!($name), arguments)
            }
        }
    )*};
}

computed_by! { "rne.integrator":
    /// The state after steps of the classical Runge-Kutta method of duration `step` (s) under torques `tau`.
    ///
    /// `steps` steps follow each other under the same torques. Each of them computes `forward_dynamics` four times; the
    /// error of a motion is of order h⁴. `step` is a number, or an array of shape (N,).
    ///
    /// Returns the positions and the velocities after the steps, two arrays of shape (n,) or (N, n).
    runge_kutta_step (q, qd, tau, step; ; payload)

    /// Derivatives of `runge_kutta_step` by q, by q̇ and by τ: the linear model δx' = A δx + B δτ with x = (q, q̇).
    ///
    /// They are exact up to rounding, by the chain rule over all `steps`.
    ///
    /// Returns A and B, of shape (2 n, 2 n) and (2 n, n), or (N, 2 n, 2 n) and (N, 2 n, n).
    runge_kutta_step_derivatives (q, qd, tau, step; ; payload)
}

computed_by! { "rne.floating_integrator":
    /// The state after steps of the classical Runge-Kutta method where nothing holds the base.
    ///
    /// Arguments and results are those of `floating_euler_step`. `steps` steps follow each other under the same torques
    /// `tau` and the same `wrenches`, which do not change in axes of their tips. Each step of duration `step` (s)
    /// computes `floating_forward_dynamics` four times; the error of a motion is of order h⁴. The turn of the base in a
    /// step must stay below a whole turn. The rotation after a step is orthogonal to rounding.
    ///
    /// Returns the pose after the steps, a homogeneous matrix of shape (4, 4) or (N, 4, 4), the velocity of the base,
    /// linear then angular, in its axes, of shape (6,) or (N, 6), and the positions and the velocities of the joints,
    /// of shape (n,) or (N, n).
    floating_runge_kutta_step (q, qd, tau, pose, twist, step; wrenches; )

    /// Derivatives of `floating_runge_kutta_step` by positions, velocities and τ: the linear model of its steps.
    ///
    /// They are exact up to rounding, by the chain rule over all `steps`. A change of the positions of the base is a
    /// shift of its origin and a rotation vector, both in axes of the base: before the steps for columns, after them
    /// for rows. The velocities of the base are `twist`.
    ///
    /// Returns A and B, of shape (12 + 2 n, 12 + 2 n) and (12 + 2 n, n), or (N, 12 + 2 n, 12 + 2 n) and
    /// (N, 12 + 2 n, n); rows and columns are the positions, then the velocities, each of the base before the joints.
    floating_runge_kutta_step_derivatives (q, qd, tau, pose, twist, step; wrenches; )
}
