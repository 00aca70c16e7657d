//! The results of functions for one state, by the names of the shapes in the table of functions.

use rne_runtime::Wrench;
pub use rne_runtime::{Pose, of_lists::*};

/// One number.
pub type Number<T> = T;
/// A number per joint.
pub type Vector<T> = Vec<T>;
/// Rows with a number per joint.
pub type Matrix<T> = Vec<Vec<T>>;
/// Three coordinates.
pub type Point<T> = [T; 3];
/// Three rows with a number per joint.
pub type PointRows<T> = Matrix<T>;
/// Three linear coordinates, then three angular ones.
pub type Spatial<T> = [T; 6];
/// Three linear rows, then three angular ones, with a number per joint.
pub type SpatialRows<T> = Matrix<T>;
/// A matrix for each of six rows, of the form of [`SpatialRows`].
pub type SpatialMatrices<T> = Vec<Matrix<T>>;
/// A pose per joint.
pub type Poses<T> = Vec<Pose<T>>;
/// A wrench per joint.
pub type Wrenches<T> = Vec<Wrench<T>>;
/// Per torque and link: m, m cx, m cy, m cz, Jxx, Jxy, Jxz, Jyy, Jyz, Jzz.
pub type Regressor<T> = Vec<Vec<[T; 10]>>;
/// Per force, moment and torque and per body, the base first: the same ten.
pub type FloatingRegressor<T> = Regressor<T>;
/// Six numbers of a floating base, and one per joint.
pub type FloatingVector<T> = Vec<T>;
/// Six rows and columns of a floating base, and one per joint.
pub type FloatingMatrix<T> = Matrix<T>;
/// Six rows with six numbers of a floating base, and one per joint.
pub type FloatingRows<T> = Matrix<T>;
/// For each tip six rows with six numbers of a floating base, and one per joint.
pub type TipRows<T> = Vec<Matrix<T>>;
/// Three linear coordinates, then three angular ones, for each tip.
pub type TipVectors<T> = Vec<[T; 6]>;
/// A number per dependent joint of closed loops.
pub type PassiveVector<T> = Vec<T>;
/// A row per dependent joint, with a number per joint.
pub type PassiveRows<T> = Matrix<T>;
