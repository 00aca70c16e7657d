//! Functions of a floating base, and of contacts, for files that have neither.

/// An arm on a fixed base.
#[derive(rne::FloatingBase, rne::FloatingEulerStep)]
#[robot(path = "robots/rod.yaml")]
struct Rod;

/// A robot that nothing touches.
#[derive(rne::ContactDynamics)]
#[robot(yaml = "{format: 2, name: free, source: own, convention: standard, gravity: [0, 0, -9.81],
    floating_base: {name: trunk, link: {mass: 20, inertia: {xx: 1, yy: 1, zz: 1}}},
    joints: [{name: j, type: revolute, dh: {theta: 0, d: 0, a: 1, alpha: 0}, link: {mass: 1, inertia: {}}}]}")]
struct Free;

fn main() {
    let _ = (Rod, Free);
}
