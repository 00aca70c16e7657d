//! C code against derived Rust code, bit for bit: both forms, both number types, all functions of robots of several
//! kinds. `cargo xtask verify` takes every shipped robot: `every_robot.rs`.
//!
//! The derived code is `inline`: it has the operations of the compiled target, as C has them. What the processor's own
//! instructions make of it is compared in `tests/processor.rs`.
//!
//! What the compiler of C is told is what users of embedded systems tell it.

mod comparison;
mod compiler;
mod derived;
mod driver;
mod kernel;
mod machine;
mod observer;
mod parameters;
mod special;
mod states;

// standard and modified rows, both kinds of joints, a tool, motors
derived::robots! {
    [planar3, "../../robots/planar3.yaml"]
    [puma560, "../../robots/puma560.yaml"]
    [scara_cobra600, "../../robots/scara_cobra600.yaml"]
    [stanford, "../../robots/stanford.yaml"]
}

#[test]
fn c_code_is_derived_code_bit_for_bit() {
    comparison::compare_all(&robots(), true);
}

#[test]
fn the_machine_and_the_interpreter_are_derived_code() {
    machine::compare_all(&robots());
}
