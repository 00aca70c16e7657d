//! C code against derived Rust code, bit for bit: every shipped robot, both forms, both number types, all functions.
//!
//! `cargo test --test c_code_of_every_robot`; a plain `cargo test` leaves it out, and tries some robots: `main.rs`.

mod comparison;
mod compiler;
mod derived;
mod driver;
mod machine;
mod special;
mod states;

use crate::derived::robots;

shipped::for_each_robot!(robots!);

#[test]
fn c_code_of_every_robot_is_derived_code_bit_for_bit() {
    comparison::compare_all(&robots(), false);
}

/// A million states of robots and functions with `RNE_EXHAUSTIVE` set, as `cargo xtask verify` does.
#[test]
fn the_machine_and_the_interpreter_are_derived_code() {
    machine::compare_all(&robots());
}
