//! The results of functions for one state, by the names of the shapes in the table of functions.

use core::array;

use rne_codegen::Layout;
use rne_runtime::{BaseAcceleration, BaseTwist, Wrench};
pub use rne_runtime::{
    DynAccelerationDerivatives as AccelerationDerivatives, DynFloatingNextState as FloatingNextState,
    DynFloatingStepDerivatives as FloatingStepDerivatives, DynFloatingTorqueDerivatives as FloatingTorqueDerivatives,
    DynNextState as NextState, DynNextStateDerivatives as NextStateDerivatives, DynStepDerivatives as StepDerivatives,
    DynTorqueDerivatives as Derivatives, DynTorqueGradient as TorqueGradient, DynTorqueHessian as TorqueHessian, Pose,
};

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
/// The momentum of each joint, and its rate.
pub type MomentumAndRate<T> = [Vec<T>; 2];
/// The wrench that must act on a base that nothing holds, and the torques.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatingTorques<T> {
    /// On the base, about the origin of frame 0.
    pub wrench: Wrench<T>,
    /// Torques of the actuators.
    pub tau: Vec<T>,
}

/// Six numbers of a base that nothing holds, and one per joint.
pub type FloatingVector<T> = Vec<T>;
/// Six rows and columns of a base that nothing holds, and one per joint.
pub type FloatingMatrix<T> = Matrix<T>;
/// Six rows with six numbers of a base that nothing holds, and one per joint.
pub type FloatingRows<T> = Matrix<T>;
/// For each tip six rows with six numbers of a base that nothing holds, and one per joint.
pub type TipRows<T> = Vec<Matrix<T>>;
/// Three linear coordinates, then three angular ones, for each tip.
pub type TipVectors<T> = Vec<[T; 6]>;
/// The acceleration of a base that nothing holds, and those of the joints.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatingAccelerations<T> {
    /// Acceleration of the base, less gravity.
    pub base: BaseAcceleration<T>,
    /// Accelerations of the joints.
    pub qdd: Vec<T>,
}

/// The accelerations of a base that nothing holds and of the joints, and the wrenches of contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct AccelerationsAndWrenches<T> {
    /// Accelerations of the base and of the joints.
    pub accelerations: FloatingAccelerations<T>,
    /// Exerted on the robot at each tip, in world axes.
    pub wrenches_on_robot: Vec<Wrench<T>>,
}

/// A number per dependent joint of closed loops.
pub type PassiveVector<T> = Vec<T>;
/// A row per dependent joint, with a number per joint.
pub type PassiveRows<T> = Matrix<T>;

/// A Newton step towards closed loops.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosureStep<T> {
    /// Positions of the dependent joints after the step.
    pub passive: Vec<T>,
    /// The residual of the equations before it.
    pub residual: Vec<T>,
}

/// ∂τ/∂q and ∂τ/∂q̇.
pub type TorqueDerivatives<T> = Derivatives<T>;

/// A result that is made of the numbers of a function, in the order of its layout.
pub(crate) trait Shaped<T> {
    /// Takes as many numbers as the layout has.
    fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self;
}

/// The layout of an element or a part.
fn part(layout: &Layout, index: usize) -> &Layout {
    match layout {
        Layout::Number => layout,
        Layout::Array(_, of) => of,
        Layout::Record(_, parts) => parts.get(index).unwrap_or(layout),
    }
}

impl<T: crate::Number> Shaped<T> for T {
    fn take(_: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
        numbers.next().unwrap_or_else(T::zero)
    }
}

impl<T, E: Shaped<T>> Shaped<T> for Vec<E> {
    fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
        let count = if let Layout::Array(count, _) = layout { *count } else { 1 };
        (0..count).map(|index| E::take(part(layout, index), numbers)).collect()
    }
}

impl<T, E: Shaped<T>, const N: usize> Shaped<T> for [E; N] {
    fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
        array::from_fn(|index| E::take(part(layout, index), numbers))
    }
}

macro_rules! records {
    ($($record:ident { $($field:ident),* })*) => {$(
        impl<T: crate::Number> Shaped<T> for $record<T> {
            fn take(layout: &Layout, numbers: &mut impl Iterator<Item = T>) -> Self {
                let mut parts = 0..;
                let mut next = || part(layout, parts.next().unwrap_or_default());
                // fields are made in the order in which they are written here
                Self { $($field: Shaped::take(next(), numbers)),* }
            }
        }
    )*};
}

records! {
    Pose { rotation, translation } Wrench { force, moment } Derivatives { dq, dqd } FloatingTorques { wrench, tau }
    BaseAcceleration { linear, angular } FloatingAccelerations { base, qdd }
    AccelerationsAndWrenches { accelerations, wrenches_on_robot } FloatingTorqueDerivatives { dq, dqd, domega }
    ClosureStep { passive, residual } TorqueGradient { dq, dqd, dqdd }
    AccelerationDerivatives { dq, dqd, dtau } TorqueHessian { dq_dq, dq_dqd, dqd_dqd, dq_dqdd }
    NextState { q, qd } StepDerivatives { dq, dqd, dtau } NextStateDerivatives { q, qd }
    BaseTwist { linear, angular } FloatingNextState { pose, twist, q, qd }
    FloatingStepDerivatives { q_dq, q_dv, q_dtau, v_dq, v_dv, v_dtau }
}
