//! A revolute joint: the link turns about e by q, so its points take part in its turning and in nothing else.

use nalgebra::Vector3;

use super::e;
use crate::Scalar;
use crate::seven_steps::link_state::ForceMoment;

/// Step 1: + q̇ e
pub(super) fn angular_velocity<T: Scalar>(common: Vector3<T>, qd: T) -> Vector3<T> {
    common + e() * qd
}

/// Step 2: + q̈ e + q̇ ω × e
pub(super) fn angular_acceleration<T: Scalar>(common: Vector3<T>, omega: &Vector3<T>, qd: T, qdd: T) -> Vector3<T> {
    (common + e() * qdd) + omega.cross(&e()) * qd
}

pub(super) fn velocity<T: Scalar>(common: Vector3<T>, _qd: T) -> Vector3<T> {
    common
}

pub(super) fn acceleration<T: Scalar>(common: Vector3<T>, _omega: &Vector3<T>, _qd: T, _qdd: T) -> Vector3<T> {
    common
}

/// Step 7: e · n
pub(super) fn actuator<T: Scalar>(wrench: &ForceMoment<T>) -> T {
    wrench.moment.z
}

pub(super) fn offset<T: Scalar>(offset: Vector3<T>, _q: T) -> Vector3<T> {
    offset
}
