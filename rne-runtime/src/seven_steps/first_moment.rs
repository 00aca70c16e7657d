//! The first moment h (kg m) of a link with mass 0, which the lecture does not have.
//!
//! Identification of parameters gives such links: only some combinations of the parameters of all links, the base
//! parameters, can be measured. A link with a mass has no h, and then each function here returns its last argument.

use nalgebra::Vector3;

use crate::Scalar;
use crate::seven_steps::link_frame::LinkFrame;
use crate::seven_steps::link_state::LinkMotion;

/// f_i + ω̇_i × h_i + ω_i × (ω_i × h_i)
pub(super) fn add_force_of_h<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>, force: Vector3<T>) -> Vector3<T> {
    let Some(h) = &link.first_moment else { return force };
    force + (this.omega_dot.cross(h) + this.omega.cross(&this.omega.cross(h)))
}

/// n_i + h_i × c̈_i
pub(super) fn add_moment_of_h<T: Scalar>(link: &LinkFrame<T>, this: &LinkMotion<T>, moment: Vector3<T>) -> Vector3<T> {
    link.first_moment.as_ref().map_or(moment, |h| moment + h.cross(&this.acceleration))
}

/// n_{p,i} - h_i × g_i
pub(super) fn subtract_weight_of_h<T: Scalar>(
    link: &LinkFrame<T>,
    this: &LinkMotion<T>,
    moment: Vector3<T>,
) -> Vector3<T> {
    link.first_moment.as_ref().map_or(moment, |h| moment - h.cross(&this.gravity))
}
