//! The types of arguments and results, for a number of joints that is known at compile time and for one that is not.
//! Results have the names in the table of functions.

/// The types for a number of joints that is known at compile time.
macro_rules! known {
    (joints) => { &[T; DOF] };
    (coordinates) => { &[T; DOF] };
    (passive) => { &[T; PASSIVE] };
    (PassiveVector) => { [T; PASSIVE] };
    (PassiveRows) => { [[T; DOF]; PASSIVE] };
    (wrenches) => { &[$crate::Wrench<T>; TIPS] };
    (Vector) => { [T; DOF] };
    (Matrix) => { [[T; DOF]; DOF] };
    (FloatingVector) => { [T; NV] };
    (FloatingMatrix) => { [[T; NV]; NV] };
    (FloatingRows) => { [[T; NV]; 6] };
    (SpatialRows) => { [[T; DOF]; 6] };
    (PointRows) => { [[T; DOF]; 3] };
    (SpatialMatrices) => { [[[T; DOF]; DOF]; 6] };
    (Poses) => { [$crate::Pose<T>; DOF] };
    (Wrenches) => { [$crate::Wrench<T>; DOF] };
    (TipRows) => { [[[T; NV]; 6]; TIPS] };
    (TipVectors) => { [[T; 6]; TIPS] };
    (Regressor) => { [[[T; 10]; DOF]; DOF] };
    ($record:ident<$($size:ident),*>) => { $crate::values::records::$record<$($size,)* T> };
    ($of_every_robot:ident) => { $crate::values::shapes::every!($of_every_robot) };
}
pub(crate) use known;

/// The types as in [`known`], for a number of joints that is only known at run time.
#[cfg(all(feature = "arm", feature = "std"))]
macro_rules! counted {
    (joints) => { &[T] };
    (coordinates) => { &[T] };
    (passive) => { &[T] };
    (PassiveVector) => { Vec<T> };
    (PassiveRows) => { Vec<Vec<T>> };
    (wrenches) => { &[$crate::Wrench<T>] };
    (Vector) => { Vec<T> };
    (Matrix) => { Vec<Vec<T>> };
    (FloatingVector) => { Vec<T> };
    (FloatingMatrix) => { Vec<Vec<T>> };
    (FloatingRows) => { [Vec<T>; 6] };
    (SpatialRows) => { [Vec<T>; 6] };
    (PointRows) => { [Vec<T>; 3] };
    (SpatialMatrices) => { [Vec<Vec<T>>; 6] };
    (Poses) => { Vec<$crate::Pose<T>> };
    (Wrenches) => { Vec<$crate::Wrench<T>> };
    (TipRows) => { Vec<[Vec<T>; 6]> };
    (TipVectors) => { Vec<[T; 6]> };
    (Regressor) => { Vec<Vec<[T; 10]>> };
    ($record:ident<$($size:ident),*>) => { $crate::values::records::of_lists::$record<T> };
    ($of_every_robot:ident) => { $crate::values::shapes::every!($of_every_robot) };
}
#[cfg(all(feature = "arm", feature = "std"))]
pub(crate) use counted;

/// The types that are the same for every robot.
macro_rules! every {
    (duration) => { T };
    (Number) => { T };
    (Point) => { [T; 3] };
    (Spatial) => { [T; 6] };
    (rotation) => { &[[T; 3]; 3] };
    (omega) => { &[T; 3] };
    (wrench) => { &$crate::Wrench<T> };
    (payload) => { &$crate::Payload<T> };
    (motion) => { &$crate::BaseMotion<T> };
    (twist) => { &$crate::BaseTwist<T> };
    (pose) => { &$crate::Pose<T> };
    (Pose) => { $crate::Pose<T> };
}
pub(crate) use every;
