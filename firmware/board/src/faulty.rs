//! Faulty functions, which prove that the certification refuses them. They are linked but never called.

use core::hint::black_box;

/// Faulty: an index may be out of bounds, which needs a branch and a call of the panic.
#[inline(never)]
fn panics(q: &[f32; 6], joint: usize) -> f32 {
    q[joint]
}

/// Faulty: the number of iterations of a loop depends on data.
#[inline(never)]
fn branches(q: &[f32; 6], joints: usize) -> f32 {
    q.iter().take(joints).fold(1.0, |product, q| product * q)
}

/// Faulty: a constant in double precision in an expression of single precision.
#[inline(never)]
fn doubles(q: &[f32; 6]) -> f32 {
    (f64::from(q[0]) * 0.1) as f32
}

/// Faulty: calls another function.
#[inline(never)]
fn calls(q: &[f32; 6]) -> f32 {
    black_box(callee as fn(f32) -> f32)(q[0])
}

#[inline(never)]
fn callee(x: f32) -> f32 {
    x
}

pub(crate) fn keep() {
    black_box(panics as fn(&[f32; 6], usize) -> f32);
    black_box(branches as fn(&[f32; 6], usize) -> f32);
    black_box(doubles as fn(&[f32; 6]) -> f32);
    black_box(calls as fn(&[f32; 6]) -> f32);
}
