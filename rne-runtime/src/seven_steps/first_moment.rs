//! The first moment h of a link without mass, which the lecture does not have.
//!
//! Only a set of base parameters has such links. A body has none, and then each function here returns its argument.

use nalgebra::Vector3;

use crate::Scalar;
use crate::seven_steps::link_frame::LinkFrame;
use crate::seven_steps::link_state::LinkMotion;

/// f_i + ω̇_i × h_i + ω_i × (ω_i × h_i)
pub(super) fn with_force<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>, force: Vector3<T>) -> Vector3<T> {
    let Some(h) = &link.first_moment else { return force };
    force + (this.omega_dot.cross(h) + this.omega.cross(&this.omega.cross(h)))
}

/// n_i + h_i × c̈_i
pub(super) fn with_moment<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>, moment: Vector3<T>) -> Vector3<T> {
    link.first_moment.as_ref().map_or(moment, |h| moment + h.cross(&this.acceleration))
}

/// n_{p,i} - h_i × g_i
pub(super) fn without_weight<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>, moment: Vector3<T>) -> Vector3<T> {
    link.first_moment.as_ref().map_or(moment, |h| moment - h.cross(&this.gravity))
}
