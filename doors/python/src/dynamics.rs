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
        $(at_frame! { ($($of_frame)?) $variant $name $arguments $returned $summary ($($details)?) })*
    };
}

/// A function of the tip can be taken at a frame; at the tip its name at frames is another name of it.
macro_rules! at_frame {
    ((pose) $variant:ident $name:ident $($rest:tt)*) => {
        at_frame! { (at) $variant $name $($rest)* }
        at_frame! { (at) $variant pose $($rest)* }
    };
    (() $($rest:tt)*) => {
        with_payload! { [] $($rest)* }
    };
    (($of_frame:ident) $($rest:tt)*) => {
        with_payload! { [frame] $($rest)* }
    };
}

/// A function of which [`Function::with_payload`] is another one takes a payload.
macro_rules! with_payload {
    ($frame:tt InverseDynamics $($rest:tt)*) => { sorted! { $frame [payload] InverseDynamics $($rest)* } };
    ($frame:tt GravityTorques $($rest:tt)*) => { sorted! { $frame [payload] GravityTorques $($rest)* } };
    ($frame:tt BiasTorques $($rest:tt)*) => { sorted! { $frame [payload] BiasTorques $($rest)* } };
    ($frame:tt MassMatrix $($rest:tt)*) => { sorted! { $frame [payload] MassMatrix $($rest)* } };
    ($frame:tt ForwardDynamics $($rest:tt)*) => { sorted! { $frame [payload] ForwardDynamics $($rest)* } };
    ($frame:tt MomentumAndRate $($rest:tt)*) => { sorted! { $frame [payload] MomentumAndRate $($rest)* } };
    ($frame:tt InverseDynamicsDerivatives $($rest:tt)*) => {
        sorted! { $frame [payload] InverseDynamicsDerivatives $($rest)* }
    };
    ($frame:tt ForwardDynamicsDerivatives $($rest:tt)*) => {
        sorted! { $frame [payload] ForwardDynamicsDerivatives $($rest)* }
    };
    ($frame:tt $($rest:tt)*) => { sorted! { $frame [] $($rest)* } };
}

/// Sorts the arguments: those that must be given, the wrenches at the tips of a base that moves, and the vectors of its
/// motion. The last two may be left out.
macro_rules! sorted {
    ($frame:tt $payload:tt $variant:ident $name:ident ($($arguments:tt)*) $($rest:tt)*) => {
        sorted! { @ [] [] [] ($($arguments)*) held $frame $payload $variant $name $($rest)* }
    };
    (@ $required:tt [] $base:tt (wrenches: Wrenches) moves $($rest:tt)*) => {
        method! { $required [wrenches] $base $($rest)* }
    };
    (@ $required:tt [] [] (base: Base $(, $($more:tt)*)?) $moves:ident $($rest:tt)*) => {
        sorted! {
            @ $required [] [base_omega base_omega_dot base_acceleration base_gravity] ($($($more)*)?) moves $($rest)*
        }
    };
    (@ [$($required:tt)*] [] [] (omega: BaseVelocity $(, $($more:tt)*)?) $moves:ident $($rest:tt)*) => {
        sorted! { @ [$($required)* omega: BaseVelocity,] [] [] ($($($more)*)?) moves $($rest)* }
    };
    (@ [$($required:tt)*] [] [] (twist: BaseTwist $(, $($more:tt)*)?) $moves:ident $($rest:tt)*) => {
        sorted! { @ [$($required)* twist: BaseTwist,] [] [] ($($($more)*)?) moves $($rest)* }
    };
    (
        @ [$($required:tt)*] [] [] ($argument:ident: $kind:ident $(, $($more:tt)*)?) $moves:ident $($rest:tt)*
    ) => {
        sorted! { @ [$($required)* $argument: $kind,] [] [] ($($($more)*)?) $moves $($rest)* }
    };
    (@ $required:tt [] $base:tt () $moves:ident $($rest:tt)*) => {
        method! { $required [] $base $($rest)* }
    };
}

/// What an argument is that may be left out.
macro_rules! about_optional {
    (wrenches) => {
        concat!(about!(Wrenches), "Without `wrenches` no tip exerts anything.\n\n")
    };
    (base_omega) => {
        "`base_omega`, `base_omega_dot`, `base_acceleration`, `base_gravity`: shape (3,) or (N, 3). What is left out \
         is zero, `base_gravity` the robot's own.\n\n"
    };
    (frame) => {
        "`frame`: the name of a frame that stands in the place of the tip: a frame in the list `frames` of the robot \
         file, or a joint for its link frame. None is the tip.\n\n"
    };
    (payload) => {
        about!(Payload)
    };
    ($other:ident) => {
        ""
    };
}

macro_rules! method {
    (
        [$($argument:ident: $kind:ident,)*] [$($wrenches:ident)?] [$($base:ident)*] [$($frame:ident)?]
            [$($payload:ident)?] $variant:ident $name:ident $returned:ident $summary:literal ($($details:literal)?)
    ) => {
        #[pymethods]
        impl Arm {
            #[doc = $summary]
            ///
            $(#[doc = details!($returned, $details)]
            #[doc = ""])?
            #[doc = concat!(
                $(about!($kind),)* $(about_optional!($base),)* $(about_optional!($wrenches),)?
                $(about_optional!($frame),)? $(about_optional!($payload),)? "Returns ", returned!($returned)
            )]
            #[pyo3(signature = ($($argument,)* $($wrenches=None,)? *, $($base=None,)* $($frame=None,)?
                $($payload=None,)? parameters=None, out=None))]
            #[allow(clippy::too_many_arguments)] // those of Python
            fn $name<'py>(
                &self,
                py: Python<'py>,
                $($argument: &Bound<'py, PyAny>,)*
                $($wrenches: Option<&Bound<'py, PyAny>>,)?
                $($base: Option<&Bound<'py, PyAny>>,)*
                $($frame: Option<&Bound<'py, PyAny>>,)?
                $($payload: Option<&Bound<'py, PyAny>>,)?
                parameters: Option<&Bound<'py, PyAny>>,
                out: Option<&Bound<'py, PyAny>>,
            ) -> PyResult<Bound<'py, PyAny>> {
                #[allow(unused_mut)] // a function without what may be left out
                let (mut function, mut given) = (Function::$variant, vec![$(given!(self, $argument: $kind)),*]);
                $(given.push(self.of_base_motion(stringify!($base), $base));)*
                $(given.push(self.of_tips(stringify!($wrenches), $wrenches)?);)?
                $(if let Some(payload) = $payload {
                    function = function.with_payload().unwrap_or(function);
                    given.push(given!(self, payload: Payload));
                })?
                let frame: Option<&Bound<'py, PyAny>> = None;
                $(let frame = frame.or($frame);)?
                self.compute_at(py, frame, function, given, parameters, out)
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
