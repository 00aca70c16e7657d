#![no_implicit_prelude]
#![forbid(unsafe_code, missing_docs)]
#![deny(warnings, unused, unreachable_pub, unused_qualifications, single_use_lifetimes, missing_copy_implementations)]
#![deny(missing_debug_implementations, trivial_numeric_casts, unused_results, non_ascii_idents, let_underscore_drop)]
//! Nothing is in scope, everything is forbidden.

use ::rne::InverseDynamics as _;

/// The user's own words.
#[derive(::rne::InverseDynamics, ::core::fmt::Debug, ::core::clone::Clone, ::core::marker::Copy)]
#[robot(path = "../robots/two.yaml")]
pub struct Two;

/// Types of the user may be called as those of the language.
#[allow(non_camel_case_types, dead_code, missing_debug_implementations, missing_copy_implementations)]
mod names {
    struct f64;
    struct usize;
    struct str;
    struct u8;
    struct T;
    struct Scalar;
    struct Wrench;
    struct Operations;

    #[derive(::rne::InverseDynamics)]
    #[robot(path = "../robots/rod.yaml")]
    pub(super) struct InverseDynamics;
}

fn main() {
    let [_, force] = Two.inverse_dynamics(&[0.1_f64, 0.2], &[0.0; 2], &[0.0; Two::DOF]);
    ::core::assert!(force.is_finite());
    let [torque] = names::InverseDynamics.gravity_torques(&[0.5_f32]);
    ::core::assert!(torque > 0.0);
}
