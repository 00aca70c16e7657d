//! The types of the results of functions for one state; their names are the shapes in the table of functions.

use rne_runtime::Wrench;
pub use rne_runtime::{Pose, of_lists::*};

/// One number.
pub type Number<T> = T;
/// One number per joint.
pub type Vector<T> = Vec<T>;
/// Rows with one number per joint.
pub type Matrix<T> = Vec<Vec<T>>;
/// Three coordinates.
pub type Point<T> = [T; 3];
/// Three rows with one number per joint.
pub type PointRows<T> = Matrix<T>;
/// Three linear coordinates, then three angular ones.
pub type Spatial<T> = [T; 6];
/// Three linear rows, then three angular ones, each with one number per joint.
pub type SpatialRows<T> = Matrix<T>;
/// Six matrices, one for each row of [`SpatialRows`], each of the shape of [`SpatialRows`].
pub type SpatialMatrices<T> = Vec<Matrix<T>>;
/// One pose per joint.
pub type Poses<T> = Vec<Pose<T>>;
/// One wrench per joint.
pub type Wrenches<T> = Vec<Wrench<T>>;
/// For each torque and each link: m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz.
pub type Regressor<T> = Vec<Vec<[T; 10]>>;
/// For each force, moment and torque, and for each body, the base first: the ten numbers of [`Regressor`].
pub type FloatingRegressor<T> = Regressor<T>;
/// Six numbers of a floating base, then one per joint.
pub type FloatingVector<T> = Vec<T>;
/// Six rows and columns of a floating base, then one row and column per joint.
pub type FloatingMatrix<T> = Matrix<T>;
/// Six rows, each with six numbers of a floating base, then one per joint.
pub type FloatingRows<T> = Matrix<T>;
/// For each tip six rows, each with six numbers of a floating base, then one per joint.
pub type TipRows<T> = Vec<Matrix<T>>;
/// For each tip three linear coordinates, then three angular ones.
pub type TipVectors<T> = Vec<[T; 6]>;
/// One number per dependent joint of closed loops.
pub type PassiveVector<T> = Vec<T>;
/// One row per dependent joint, with one number per joint.
pub type PassiveRows<T> = Matrix<T>;
