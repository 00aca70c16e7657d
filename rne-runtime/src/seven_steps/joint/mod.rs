//! Terms of each kind of joint in the seven steps: one file per kind.
//!
//! A joint lets its link move along or about its axis, e = (0, 0, 1) in form P. Every law takes the part of
//! a step that both kinds of joint have, and adds the term that only its kind has.

mod prismatic;
mod revolute;

use nalgebra::Vector3;
use rne_model::JointKind;

use crate::Scalar;
use crate::seven_steps::link_state::ForceMoment;

/// The laws of a kind of joint.
pub(crate) trait JointLaws {
    /// Step 1: ω of the link, from that of its parent.
    fn angular_velocity<T: Scalar>(self, common: Vector3<T>, qd: T) -> Vector3<T>;

    /// Step 2: ω̇ of the link, from that of its parent and the link's ω.
    fn angular_acceleration<T: Scalar>(self, common: Vector3<T>, omega: &Vector3<T>, qd: T, qdd: T) -> Vector3<T>;

    /// Step 3: velocity of a point of the link.
    fn velocity<T: Scalar>(self, common: Vector3<T>, qd: T) -> Vector3<T>;

    /// Step 4: acceleration of a point of the link.
    fn acceleration<T: Scalar>(self, common: Vector3<T>, omega: &Vector3<T>, qd: T, qdd: T) -> Vector3<T>;

    /// Step 7: what the actuator delivers of the joint's wrench.
    fn actuator<T: Scalar>(self, wrench: &ForceMoment<T>) -> T;

    /// Where the offset (a, 0, b) of the link leads.
    fn offset<T: Scalar>(self, offset: Vector3<T>, q: T) -> Vector3<T>;
}

/// Every law by the kind of the joint.
macro_rules! by_kind {
    ($(fn $law:ident<T: Scalar>(self, $($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        impl JointLaws for JointKind {
            $(fn $law<T: Scalar>(self, $($argument: $type),*) -> $result {
                match self {
                    Self::Revolute => revolute::$law($($argument),*),
                    Self::Prismatic => prismatic::$law($($argument),*),
                }
            })*
        }
    };
}

by_kind! {
    fn angular_velocity<T: Scalar>(self, common: Vector3<T>, qd: T) -> Vector3<T>;
    fn angular_acceleration<T: Scalar>(self, common: Vector3<T>, omega: &Vector3<T>, qd: T, qdd: T) -> Vector3<T>;
    fn velocity<T: Scalar>(self, common: Vector3<T>, qd: T) -> Vector3<T>;
    fn acceleration<T: Scalar>(self, common: Vector3<T>, omega: &Vector3<T>, qd: T, qdd: T) -> Vector3<T>;
    fn actuator<T: Scalar>(self, wrench: &ForceMoment<T>) -> T;
    fn offset<T: Scalar>(self, offset: Vector3<T>, q: T) -> Vector3<T>;
}

/// e, the joint's axis: z in form P.
fn e<T: Scalar>() -> Vector3<T> {
    Vector3::new(T::zero(), T::zero(), T::one())
}
