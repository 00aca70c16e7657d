//! The types of arguments and results, where the number of joints is known and where it is not.

/// Where the number of joints is known.
macro_rules! known {
    (joints) => { &[T; DOF] };
    (coordinates) => { &[T; DOF] };
    (passive) => { &[T; PASSIVE] };
    (passive_vector) => { [T; PASSIVE] };
    (passive_rows) => { [[T; DOF]; PASSIVE] };
    (wrenches) => { &[$crate::Wrench<T>; TIPS] };
    (vector) => { [T; DOF] };
    (matrix) => { [[T; DOF]; DOF] };
    (velocities) => { [T; NV] };
    (velocity_matrix) => { [[T; NV]; NV] };
    (velocity_rows) => { [[T; NV]; 6] };
    (rows6) => { [[T; DOF]; 6] };
    (rows3) => { [[T; DOF]; 3] };
    (matrices6) => { [[[T; DOF]; DOF]; 6] };
    (poses) => { [$crate::Pose<T>; DOF] };
    (loads) => { [$crate::Wrench<T>; DOF] };
    (tip_rows) => { [[[T; NV]; 6]; TIPS] };
    (tip_vectors) => { [[T; 6]; TIPS] };
    (regressor) => { [[[T; 10]; DOF]; DOF] };
    ($record:ident<$($size:ident),*>) => { $crate::records::$record<$($size,)* T> };
    ($of_every_robot:ident) => { $crate::shapes::every!($of_every_robot) };
}
pub(crate) use known;

/// As [`known`], where the number of joints is known at run time only.
#[cfg(all(feature = "arm", feature = "std"))]
macro_rules! counted {
    (joints) => { &[T] };
    (coordinates) => { &[T] };
    (passive) => { &[T] };
    (passive_vector) => { Vec<T> };
    (passive_rows) => { Vec<Vec<T>> };
    (wrenches) => { &[$crate::Wrench<T>] };
    (vector) => { Vec<T> };
    (matrix) => { Vec<Vec<T>> };
    (velocities) => { Vec<T> };
    (velocity_matrix) => { Vec<Vec<T>> };
    (velocity_rows) => { [Vec<T>; 6] };
    (rows6) => { [Vec<T>; 6] };
    (rows3) => { [Vec<T>; 3] };
    (matrices6) => { [Vec<Vec<T>>; 6] };
    (poses) => { Vec<$crate::Pose<T>> };
    (loads) => { Vec<$crate::Wrench<T>> };
    (tip_rows) => { Vec<[Vec<T>; 6]> };
    (tip_vectors) => { Vec<[T; 6]> };
    (regressor) => { Vec<Vec<[T; 10]>> };
    ($record:ident<$($size:ident),*>) => { $crate::records::of_lists::$record<T> };
    ($of_every_robot:ident) => { $crate::shapes::every!($of_every_robot) };
}
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) use counted;

/// The types that are the same for every robot.
macro_rules! every {
    (number) => { T };
    (triple) => { [T; 3] };
    (six) => { [T; 6] };
    (rotation) => { &[[T; 3]; 3] };
    (omega) => { &[T; 3] };
    (wrench) => { &$crate::Wrench<T> };
    (payload) => { &$crate::Payload<T> };
    (motion) => { &$crate::BaseMotion<T> };
    (twist) => { &$crate::BaseTwist<T> };
    (pose) => { &$crate::Pose<T> };
    (a_pose) => { $crate::Pose<T> };
}
pub(crate) use every;
