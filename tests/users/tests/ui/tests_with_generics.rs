//! Tests of a struct of which they can make no value.

use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "robots/rod.yaml", tests)]
struct Rod<T> {
    #[robot(skip)]
    tool: T,
}

fn main() {}
