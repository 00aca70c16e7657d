//! What silences the lints of a robot file, in a crate where every warning is an error.
#![deny(warnings)]

use rne::{InverseDynamics, MassMatrix};

#[derive(InverseDynamics, MassMatrix)]
#[robot(path = "../robots/lints.yaml", allow_lints)]
struct Known;

#[derive(InverseDynamics, MassMatrix)]
#[allow(deprecated)]
#[robot(path = "../robots/lints.yaml")]
struct Allowed;

/// A tensor that no body has is a note: published tables have such.
#[derive(InverseDynamics)]
#[robot(yaml = "
    format: 1
    name: published
    source: test
    convention: standard
    gravity: [0, 0, -9.81]
    joints: [{type: revolute, dh: {theta: 0, d: 0, a: 0, alpha: 0}, link: {inertia: {zz: 0.35}}}]
")]
struct Published;

fn main() {
    let _: [f64; 3] = Known.inverse_dynamics(&[0.0; 3], &[0.0; 3], &[0.0; 3]);
    let _: [f64; 3] = Allowed.inverse_dynamics(&[0.0; 3], &[0.0; 3], &[0.0; 3]);
    let _: [f64; 1] = Published.inverse_dynamics(&[0.0], &[0.0], &[0.0]);
    let _ = (Known.mass_matrix(&[0.0_f64; 3]), Allowed.mass_matrix(&[0.0_f64; 3]));
}
