//! A field that has no name, and so cannot be a parameter.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml")]
struct Arm(pub f64);

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml")]
struct Marked(#[robot(skip)] String, core::marker::PhantomData<u8>);

fn main() {}
