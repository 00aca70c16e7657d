//! The functions of the class `Arm`: arrays in, arrays out. They are those of the compiler's list.

use pyo3::prelude::*;
use rne_codegen::{Argument, Function};

use crate::arm::Arm;
use crate::arrays::Given;

/// What an argument is, where its name does not say it.
macro_rules! about {
    (Wrench) => {
        "`wrench`: force, then moment; shape (6,) or (N, 6).\n\n"
    };
    (Wrenches) => {
        "`wrenches`: force, then moment, of each tip; a dict from names of tips to six numbers, or to arrays of shape \
         (N, 6), where a tip without an entry exerts nothing; or an array of shape (tips, 6) or (N, tips, 6).\n\n"
    };
    (Step) => {
        "`step`: a number, or shape (N,).\n\n"
    };
    (BaseVelocity) => {
        "`omega`: shape (3,) or (N, 3).\n\n"
    };
    (BaseTwist) => {
        "`twist`: linear, then angular; shape (6,) or (N, 6).\n\n"
    };
    (BasePose) => {
        "`pose`: a homogeneous matrix; shape (4, 4) or (N, 4, 4).\n\n"
    };
    (BaseRotation) => {
        "`base_rotation`: shape (3, 3) or (N, 3, 3).\n\n"
    };
    (Passive) => {
        "`passive`: shape (p,) or (N, p), the positions of the dependent joints in their order, or a dict by their \
         names; `close` finds them.\n\n"
    };
    (Payload) => {
        "`payload`: shape (10,) or (N, 10); `rne.payload` makes one. A point mass has the first four numbers alone: \
         shape (4,) or (N, 4).\n\n"
    };
    ($of_joints:ident) => {
        ""
    };
}

/// What is returned.
macro_rules! returned {
    (Number) => {
        "a number, or an array of shape (N,)."
    };
    (Vector) => {
        "shape (n,) or (N, n)."
    };
    (Matrix) => {
        "shape (n, n) or (N, n, n)."
    };
    (Point) => {
        "shape (3,) or (N, 3)."
    };
    (PointRows) => {
        "shape (3, n) or (N, 3, n)."
    };
    (Spatial) => {
        "shape (6,) or (N, 6)."
    };
    (SpatialRows) => {
        "shape (6, n) or (N, 6, n)."
    };
    (SpatialMatrices) => {
        "shape (6, n, n) or (N, 6, n, n)."
    };
    (Pose) => {
        "a homogeneous matrix: shape (4, 4) or (N, 4, 4)."
    };
    (Poses) => {
        "homogeneous matrices: shape (n, 4, 4) or (N, n, 4, 4)."
    };
    (Wrenches) => {
        "force, then moment, of each joint: shape (n, 6) or (N, n, 6)."
    };
    (Regressor) => {
        "the matrix whose product with the `inertial_parameters`, link by link, are the torques: shape (n, 10 n) or \
         (N, n, 10 n)."
    };
    (FloatingRegressor) => {
        "the matrix whose product with the `floating_inertial_parameters`, body by body, are force, moment and \
         torques: shape (6 + n, 10 (n + 1)) or (N, 6 + n, 10 (n + 1))."
    };
    (TorqueDerivatives) => {
        "dq and dqd, two arrays of shape (n, n) or (N, n, n); `out` is one array of shape (2, n, n) or (N, 2, n, n)."
    };
    (FloatingTorques) => {
        "the wrench on the base, force then moment, of shape (6,) or (N, 6), and the torques, of shape (n,) or (N, n); \
         `out` is one array of shape (6 + n,) or (N, 6 + n)."
    };
    (FloatingVector) => {
        "force, then moment, then torques: shape (6 + n,) or (N, 6 + n)."
    };
    (FloatingMatrix) => {
        "shape (6 + n, 6 + n) or (N, 6 + n, 6 + n)."
    };
    (FloatingRows) => {
        "shape (6, 6 + n) or (N, 6, 6 + n)."
    };
    (TipRows) => {
        "shape (tips, 6, 6 + n) or (N, tips, 6, 6 + n)."
    };
    (TipVectors) => {
        "shape (tips, 6) or (N, tips, 6)."
    };
    (FloatingAccelerations) => {
        "the acceleration of the base, linear then angular, of shape (6,) or (N, 6), and those of the joints, of shape \
         (n,) or (N, n); `out` is one array of shape (6 + n,) or (N, 6 + n)."
    };
    (FloatingTorqueDerivatives) => {
        "dq and dqd, of shape (6 + n, n) or (N, 6 + n, n), and domega, of shape (6 + n, 3) or (N, 6 + n, 3); \
         `derivatives_to_pinocchio` makes Pinocchio's matrices of them; `out` is one array of shape \
         ((6 + n) (2 n + 3),) or (N, (6 + n) (2 n + 3))."
    };
    (AccelerationsAndWrenches) => {
        "the acceleration of the base, linear then angular, of shape (6,) or (N, 6), those of the joints, of shape \
         (n,) or (N, n), and the wrenches on the robot, of shape (tips, 6) or (N, tips, 6); `out` is one array of \
         shape (6 + n + 6 tips,) or (N, 6 + n + 6 tips)."
    };
    (PassiveVector) => {
        "shape (p,) or (N, p), p of the dependent joints."
    };
    (PassiveRows) => {
        "shape (p, n) or (N, p, n), p of the dependent joints."
    };
    (ClosureStep) => {
        "the positions after the step, of shape (p,) or (N, p), and what is left of the equations before it, of shape \
         (e,) or (N, e); `out` is one array of shape (p + e,) or (N, p + e)."
    };
    (TorqueGradient) => {
        "dq, dqd and dqdd, three arrays of shape (n,) or (N, n); `out` is one array of shape (3, n) or (N, 3, n)."
    };
    (AccelerationDerivatives) => {
        "dq, dqd and dtau, three arrays of shape (n, n) or (N, n, n); `out` is one array of shape (3, n, n) or \
         (N, 3, n, n)."
    };
    (TorqueHessian) => {
        "dq_dq, dq_dqd, dqd_dqd and dq_dqdd, four arrays of shape (n, n) or (N, n, n); `out` is one array of shape \
         (4, n, n) or (N, 4, n, n)."
    };
    (NextState) => {
        "the positions and the velocities after the step, two arrays of shape (n,) or (N, n); `out` is one array of \
         shape (2, n) or (N, 2, n)."
    };
    (NextStateDerivatives) => {
        "A and B, of shape (2 n, 2 n) and (2 n, n), or (N, 2 n, 2 n) and (N, 2 n, n). `out` has their blocks: shape \
         (2, 3, n, n) or (N, 2, 3, n, n), of the positions and of the velocities, by q, by qd and by tau."
    };
    (FloatingNextState) => {
        "the pose after the step, a homogeneous matrix of shape (4, 4) or (N, 4, 4), the velocity of the base, linear \
         then angular, of shape (6,) or (N, 6), and the positions and the velocities of the joints, of shape (n,) or \
         (N, n); `out` is one array of shape (18 + 2 n,) or (N, 18 + 2 n). It begins with the rows of the rotation and \
         the origin."
    };
    (FloatingStepDerivatives) => {
        "A and B, of shape (12 + 2 n, 12 + 2 n) and (12 + 2 n, n), or (N, 12 + 2 n, 12 + 2 n) and (N, 12 + 2 n, n); \
         rows and columns are the positions, then the velocities, each of the base before the joints. `out` is one \
         array with the rows of q_dq, q_dv, q_dtau, v_dq, v_dv and v_dtau, one behind the other."
    };
    (MomentumAndRate) => {
        "momentum and rate, two arrays of shape (n,) or (N, n); `out` is one array of shape (2, n) or (N, 2, n)."
    };
}

/// What else a caller must know.
macro_rules! details {
    (Pose, $of_c:literal) => {
        "The columns of its rotation are the axes of the tip frame, in world axes; its origin is in m."
    };
    ($returned:ident, $details:literal) => {
        $details
    };
}

macro_rules! methods {
    ($(
        $variant:ident $axes:tt = $name:ident $arguments:tt -> $returned:ident $(at $of_frame:ident)?:
            $summary:literal $(, $details:literal)?;
    )*) => {
        $(method! { $($of_frame)? $variant $name $arguments $returned $summary $($details)? })*
    };
}

macro_rules! method {
    // a function of the tip that can be taken at a frame; at the tip its name at frames is another name of it
    (pose $($rest:tt)*) => {
        at_frame! { $($rest)* }
        at_frame! { pose $($rest)* }
    };
    (jacobian $($rest:tt)*) => {
        at_frame! { $($rest)* }
    };
    (jacobian_rate_times_velocity $($rest:tt)*) => {
        at_frame! { $($rest)* }
    };
    (wrench_torques $($rest:tt)*) => {
        at_frame! { $($rest)* }
    };
    (jacobian_rate $($rest:tt)*) => {
        at_frame! { $($rest)* }
    };
    (jacobian_derivatives $($rest:tt)*) => {
        at_frame! { $($rest)* }
    };
    // `Function::with_payload` is the other one
    (InverseDynamics $($rest:tt)*) => {
        loaded! { InverseDynamics InverseDynamicsWithPayload $($rest)* }
    };
    (GravityTorques $($rest:tt)*) => {
        loaded! { GravityTorques GravityTorquesWithPayload $($rest)* }
    };
    (BiasTorques $($rest:tt)*) => {
        loaded! { BiasTorques BiasTorquesWithPayload $($rest)* }
    };
    (MassMatrix $($rest:tt)*) => {
        loaded! { MassMatrix MassMatrixWithPayload $($rest)* }
    };
    (ForwardDynamics $($rest:tt)*) => {
        loaded! { ForwardDynamics ForwardDynamicsWithPayload $($rest)* }
    };
    (InverseDynamicsDerivatives $($rest:tt)*) => {
        loaded! { InverseDynamicsDerivatives InverseDynamicsDerivativesWithPayload $($rest)* }
    };
    (ForwardDynamicsDerivatives $($rest:tt)*) => {
        loaded! { ForwardDynamicsDerivatives ForwardDynamicsDerivativesWithPayload $($rest)* }
    };
    (MomentumAndRate $($rest:tt)*) => {
        loaded! { MomentumAndRate MomentumAndRateWithPayload $($rest)* }
    };
    // without wrenches no tip exerts anything
    (FloatingBias $name:ident (q: Positions, qd: Rates, omega: BaseVelocity, wrenches: Wrenches) $($rest:tt)*) => {
        of_floating_base! { FloatingBias $name (q: Positions, qd: Rates, omega: BaseVelocity) $($rest)* }
    };
    (
        FloatingForwardDynamics $name:ident
            (q: Positions, qd: Rates, tau: Torques, omega: BaseVelocity, wrenches: Wrenches) $($rest:tt)*
    ) => {
        of_floating_base! {
            FloatingForwardDynamics $name (q: Positions, qd: Rates, tau: Torques, omega: BaseVelocity) $($rest)*
        }
    };
    (
        $variant:ident $name:ident (
            q: Positions, qd: Rates, tau: Torques, pose: BasePose, twist: BaseTwist, step: Step, wrenches: Wrenches
        ) $($rest:tt)*
    ) => {
        of_floating_base! {
            $variant $name
                (q: Positions, qd: Rates, tau: Torques, pose: BasePose, twist: BaseTwist, step: Step) $($rest)*
        }
    };
    (
        $variant:ident $name:ident
            (q: Positions, passive: Passive, qd: Rates, tau: Torques, omega: BaseVelocity, wrenches: Wrenches)
            $($rest:tt)*
    ) => {
        of_floating_base! {
            $variant $name (q: Positions, passive: Passive, qd: Rates, tau: Torques, omega: BaseVelocity) $($rest)*
        }
    };
    (
        $variant:ident $name:ident
            (q: Positions, qd: Rates, qdd: Accelerations, base: Base $(, $wrenches:ident: Wrenches)?) $($rest:tt)*
    ) => {
        on_moving_base! { $variant $name (q: Positions, qd: Rates, qdd: Accelerations) ($($wrenches)?) $($rest)* }
    };
    (
        $variant:ident $name:ident
            (q: Positions, passive: Passive, qd: Rates, qdd: Accelerations, base: Base, wrenches: Wrenches)
            $($rest:tt)*
    ) => {
        on_moving_base! {
            $variant $name (q: Positions, passive: Passive, qd: Rates, qdd: Accelerations) (wrenches) $($rest)*
        }
    };
    (
        $variant:ident $name:ident ($($argument:ident: $kind:ident),*)
            $returned:ident $summary:literal $($details:literal)?
    ) => {
        #[pymethods]
        impl Arm {
            #[doc = $summary]
            ///
            $(#[doc = details!($returned, $details)]
            #[doc = ""])?
            #[doc = concat!($(about!($kind),)* "Returns ", returned!($returned))]
            #[pyo3(signature = ($($argument,)* *, parameters=None, out=None))]
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($argument: &Bound<'py, PyAny>,)*
                parameters: Option<&Bound<'py, PyAny>>,
                out: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                let given = vec![$(given!(self, $argument: $kind)),*];
                self.compute(py, Function::$variant, given, parameters, out)
            }
        }
    };
}

/// A function of a base that moves; a base whose motion is not given stands still.
macro_rules! on_moving_base {
    (
        $variant:ident $name:ident
            ($($argument:ident: $kind:ident),*) ($($wrenches:ident)?)
            $returned:ident $summary:literal $details:literal
    ) => {
        #[pymethods]
        impl Arm {
            #[doc = $summary]
            ///
            #[doc = $details]
            /// Each vector of the base has the shape (3,) or (N, 3). What is left out is zero, `base_gravity` the
            /// robot's own.
            ///
            #[doc = concat!($(about!($kind)),*)]
            $(#[doc = about!(Wrenches)]
            #[doc = concat!("Without `", stringify!($wrenches), "` no tip exerts anything.\n\n")])?
            #[doc = concat!("Returns ", returned!($returned))]
            #[pyo3(signature = ($($argument,)* $($wrenches=None,)? *, base_omega=None, base_omega_dot=None,
                base_acceleration=None, base_gravity=None, parameters=None, out=None))]
            #[allow(clippy::too_many_arguments)] // those of Python
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($argument: &Bound<'py, PyAny>,)*
                $($wrenches: Option<&Bound<'py, PyAny>>,)?
                base_omega: Option<&Bound<'py, PyAny>>,
                base_omega_dot: Option<&Bound<'py, PyAny>>,
                base_acceleration: Option<&Bound<'py, PyAny>>,
                base_gravity: Option<&Bound<'py, PyAny>>,
                parameters: Option<&Bound<'py, PyAny>>,
                out: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                let base = [
                    ("base_omega", base_omega, [0.0; 3]),
                    ("base_omega_dot", base_omega_dot, [0.0; 3]),
                    ("base_acceleration", base_acceleration, [0.0; 3]),
                    ("base_gravity", base_gravity, self.robot().gravity),
                ];
                let base = base.map(|(name, value, left_out)| match value {
                    Some(value) => Given::vector(name, 3, value.clone()),
                    None => Given::own(name, left_out.to_vec()),
                });
                #[allow(unused_mut)] // a function without tips
                let mut given: Vec<_> = [$(given!(self, $argument: $kind)),*].into_iter().chain(base).collect();
                $(given.push(self.of_tips(stringify!($wrenches), $wrenches)?);)?
                self.compute(py, Function::$variant, given, parameters, out)
            }
        }
    };
}

/// A function of a base that moves and that nothing holds; without wrenches no tip exerts anything.
macro_rules! of_floating_base {
    (
        $variant:ident $name:ident ($($argument:ident: $kind:ident),*) $returned:ident $summary:literal $details:literal
    ) => {
        #[pymethods]
        impl Arm {
            #[doc = $summary]
            ///
            #[doc = $details]
            #[doc = concat!($(about!($kind),)* about!(Wrenches))]
            #[doc = concat!("Without `wrenches` no tip exerts anything.\n\nReturns ", returned!($returned))]
            #[pyo3(signature = ($($argument,)* wrenches=None, *, parameters=None, out=None))]
            #[allow(clippy::too_many_arguments)] // those of Python
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($argument: &Bound<'py, PyAny>,)*
                wrenches: Option<&Bound<'py, PyAny>>,
                parameters: Option<&Bound<'py, PyAny>>,
                out: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                let given = vec![$(given!(self, $argument: $kind),)* self.of_tips("wrenches", wrenches)?];
                self.compute(py, Function::$variant, given, parameters, out)
            }
        }
    };
}

/// A function of the tip that can be taken at a frame.
macro_rules! at_frame {
    (pose $variant:ident $name:ident $($rest:tt)*) => {
        at_frame! { $variant pose $($rest)* }
    };
    (
        $variant:ident $name:ident ($($argument:ident: $kind:ident),*)
            $returned:ident $summary:literal $($details:literal)?
    ) => {
        #[pymethods]
        impl Arm {
            #[doc = $summary]
            ///
            $(#[doc = details!($returned, $details)]
            #[doc = ""])?
            /// frame: the name of a frame that stands in the place of the tip: a frame in the list `frames` of the
            /// robot file, or a joint for its link frame. None is the tip.
            #[doc = concat!($(about!($kind),)* "Returns ", returned!($returned))]
            #[pyo3(signature = ($($argument,)* *, frame=None, parameters=None, out=None))]
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($argument: &Bound<'py, PyAny>,)*
                frame: Option<&Bound<'py, PyAny>>,
                parameters: Option<&Bound<'py, PyAny>>,
                out: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                let given = vec![$(given!(self, $argument: $kind)),*];
                self.compute_at(py, frame, Function::$variant, given, parameters, out)
            }
        }
    };
}

/// A function that has another one for the arm with a payload.
macro_rules! loaded {
    (
        $variant:ident $with_payload:ident $name:ident ($($argument:ident: $kind:ident),*)
            $returned:ident $summary:literal $($details:literal)?
    ) => {
        #[pymethods]
        impl Arm {
            #[doc = $summary]
            ///
            $(#[doc = details!($returned, $details)]
            #[doc = ""])?
            #[doc = about!(Payload)]
            #[doc = concat!("Returns ", returned!($returned))]
            #[pyo3(signature = ($($argument,)* *, payload=None, parameters=None, out=None))]
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($argument: &Bound<'py, PyAny>,)*
                payload: Option<&Bound<'py, PyAny>>,
                parameters: Option<&Bound<'py, PyAny>>,
                out: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                let mut given = vec![$(given!(self, $argument: $kind)),*];
                let Some(payload) = payload else {
                    return self.compute(py, Function::$variant, given, parameters, out);
                };
                given.push(given!(self, payload: Payload));
                self.compute(py, Function::$with_payload, given, parameters, out)
            }
        }
    };
}

/// An argument that is one array in Python.
macro_rules! given {
    ($arm:ident, $argument:ident: Wrench) => {
        given!($arm, $argument: Wrench, &["force", "moment"])
    };
    ($arm:ident, $argument:ident: Step) => {
        Given::number(stringify!($argument), $argument)?
    };
    ($arm:ident, $argument:ident: BaseVelocity) => {
        given!($arm, $argument: BaseVelocity, &[])
    };
    ($arm:ident, $argument:ident: BaseTwist) => {
        given!($arm, $argument: BaseTwist, &[])
    };
    ($arm:ident, $argument:ident: BasePose) => {
        $arm.of_pose(stringify!($argument), $argument)?
    };
    ($arm:ident, $argument:ident: Payload) => {
        $arm.payload($argument)
    };
    ($arm:ident, $argument:ident: Wrenches) => {
        $arm.of_tips(stringify!($argument), Some($argument))?
    };
    ($arm:ident, $argument:ident: Passive) => {
        $arm.of_passive(stringify!($argument), $argument)?
    };
    ($arm:ident, $argument:ident: BaseRotation) => {
        $arm.of_rotation(stringify!($argument), $argument)?
    };
    ($arm:ident, $argument:ident: $of_joints:ident) => {
        $arm.of_joints(stringify!($argument), $argument)?
    };
    ($arm:ident, $argument:ident: $kind:ident, $parts:expr) => {
        Given {
            parts: $parts,
            ..Given::vector(stringify!($argument), $arm.elements(Argument::$kind), $argument.clone())
        }
    };
}

rne_codegen::functions!(methods);
