//! The types of arguments, results and records, where the number of joints is known and where it is not.

/// The type of an argument, of a result or of a field of a record where the number of joints is known.
#[cfg(feature = "arm")]
macro_rules! known {
    (joints) => { &[T; DOF] };
    (wrenches) => { &[Wrench<T>; TIPS] };
    (vector) => { [T; DOF] };
    (matrix) => { [[T; DOF]; DOF] };
    (velocities) => { [T; NV] };
    (velocity_matrix) => { [[T; NV]; NV] };
    (velocity_rows) => { [[T; NV]; 6] };
    (rows6) => { [[T; DOF]; 6] };
    (rows3) => { [[T; DOF]; 3] };
    (matrices6) => { [[[T; DOF]; DOF]; 6] };
    (poses) => { [Pose<T>; DOF] };
    (joint_wrenches) => { [Wrench<T>; DOF] };
    (tip_rows) => { [[[T; NV]; 6]; TIPS] };
    (tip_vectors) => { [[T; 6]; TIPS] };
    (regressor) => { [[[T; 10]; DOF]; DOF] };
    (TorqueDerivatives) => { TorqueDerivatives<DOF, T> };
    (MomentumAndRate) => { MomentumAndRate<DOF, T> };
    (TorqueGradient) => { TorqueGradient<DOF, T> };
    (TorqueHessian) => { TorqueHessian<DOF, T> };
    (AccelerationDerivatives) => { AccelerationDerivatives<DOF, T> };
    (NextState) => { NextState<DOF, T> };
    (NextStateDerivatives) => { NextStateDerivatives<DOF, T> };
    (FloatingTorques) => { FloatingTorques<DOF, T> };
    (FloatingAccelerations) => { FloatingAccelerations<DOF, T> };
    (AccelerationsAndWrenches) => { AccelerationsAndWrenches<DOF, TIPS, T> };
    (FloatingTorqueDerivatives) => { FloatingTorqueDerivatives<DOF, NV, T> };
    (FloatingNextState) => { FloatingNextState<DOF, T> };
    (FloatingStepDerivatives) => { FloatingStepDerivatives<DOF, NV, T> };
    ($of_every_robot:ident) => { $crate::shapes::every!($of_every_robot) };
}
#[cfg(feature = "arm")]
pub(crate) use known;

/// As [`known`], where the number of joints is known at run time only.
#[cfg(all(feature = "arm", feature = "std"))]
macro_rules! counted {
    (joints) => { &[T] };
    (wrenches) => { &[Wrench<T>] };
    (vector) => { Vec<T> };
    (matrix) => { Vec<Vec<T>> };
    (velocities) => { Vec<T> };
    (velocity_matrix) => { Vec<Vec<T>> };
    (velocity_rows) => { [Vec<T>; 6] };
    (rows6) => { [Vec<T>; 6] };
    (rows3) => { [Vec<T>; 3] };
    (matrices6) => { [Vec<Vec<T>>; 6] };
    (poses) => { Vec<Pose<T>> };
    (joint_wrenches) => { Vec<Wrench<T>> };
    (tip_rows) => { Vec<[Vec<T>; 6]> };
    (tip_vectors) => { Vec<[T; 6]> };
    (regressor) => { Vec<Vec<[T; 10]>> };
    (TorqueDerivatives) => { DynTorqueDerivatives<T> };
    (MomentumAndRate) => { [Vec<T>; 2] };
    (TorqueGradient) => { DynTorqueGradient<T> };
    (TorqueHessian) => { DynTorqueHessian<T> };
    (AccelerationDerivatives) => { DynAccelerationDerivatives<T> };
    (NextState) => { DynNextState<T> };
    (NextStateDerivatives) => { DynNextStateDerivatives<T> };
    (FloatingTorques) => { (Wrench<T>, Vec<T>) };
    (FloatingAccelerations) => { (BaseAcceleration<T>, Vec<T>) };
    (AccelerationsAndWrenches) => { (BaseAcceleration<T>, Vec<T>, Vec<Wrench<T>>) };
    (FloatingTorqueDerivatives) => { DynFloatingTorqueDerivatives<T> };
    (FloatingNextState) => { DynFloatingNextState<T> };
    (FloatingStepDerivatives) => { DynFloatingStepDerivatives<T> };
    ($of_every_robot:ident) => { $crate::shapes::every!($of_every_robot) };
}
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) use counted;

/// The types that are the same for every robot.
#[cfg(feature = "arm")]
macro_rules! every {
    (number) => { T };
    (triple) => { [T; 3] };
    (six) => { [T; 6] };
    (rotation) => { &[[T; 3]; 3] };
    (omega) => { &[T; 3] };
    (wrench) => { &Wrench<T> };
    (payload) => { &Payload<T> };
    (motion) => { &BaseMotion<T> };
    (twist) => { &BaseTwist<T> };
    (pose) => { &Pose<T> };
    (a_pose) => { Pose<T> };
}
#[cfg(feature = "arm")]
pub(crate) use every;

/// Records that functions return: with arrays, and with lists for `DynArm`.
macro_rules! records {
    ($(
        $(#[$doc:meta])*
        $name:ident<$($size:ident),*>, $counted:ident {
            $($(#[$field_doc:meta])* $field:ident: $known:ty | $lists:ty,)*
        }
    )*) => { $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<$(const $size: usize,)* T> { $($(#[$field_doc])* pub $field: $known),* }

        #[doc = concat!("[`", stringify!($name), "`] of a robot with a number of joints known at run time.")]
        #[cfg(feature = "std")]
        #[derive(Clone, Debug, PartialEq)]
        pub struct $counted<T> { $($(#[$field_doc])* pub $field: $lists),* }

        #[cfg(feature = "arm")]
        impl<$(const $size: usize,)* T> From<($($known,)*)> for $name<$($size,)* T> {
            fn from(($($field,)*): ($($known,)*)) -> Self {
                Self { $($field),* }
            }
        }

        #[cfg(all(feature = "arm", feature = "std"))]
        impl<T> From<($($lists,)*)> for $counted<T> {
            fn from(($($field,)*): ($($lists,)*)) -> Self {
                Self { $($field),* }
            }
        }
    )* };
}
pub(crate) use records;
