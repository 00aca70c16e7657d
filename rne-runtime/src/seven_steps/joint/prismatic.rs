//! A prismatic joint: the link slides along e by q and turns as its parent does.

use nalgebra::Vector3;

use super::e;
use crate::Scalar;
use crate::seven_steps::link_state::ForceMoment;

pub(super) fn angular_velocity<T: Scalar>(common: Vector3<T>, _qd: T) -> Vector3<T> {
    common
}

pub(super) fn angular_acceleration<T: Scalar>(common: Vector3<T>, _omega: &Vector3<T>, _qd: T, _qdd: T) -> Vector3<T> {
    common
}

/// Step 3: + q̇ e
pub(super) fn velocity<T: Scalar>(common: Vector3<T>, qd: T) -> Vector3<T> {
    common + e() * qd
}

/// Step 4: + q̈ e + 2 q̇ ω × e
pub(super) fn acceleration<T: Scalar>(common: Vector3<T>, omega: &Vector3<T>, qd: T, qdd: T) -> Vector3<T> {
    let two = T::one() + T::one();
    (common + e() * qdd) + omega.cross(&e()) * (two * qd)
}

/// Step 7: e · f
pub(super) fn actuator<T: Scalar>(wrench: &ForceMoment<T>) -> T {
    wrench.force.z
}

/// The offset of the link: (a, 0, b + q)
pub(super) fn offset<T: Scalar>(offset: Vector3<T>, q: T) -> Vector3<T> {
    Vector3::new(offset.x, offset.y, offset.z + q)
}
