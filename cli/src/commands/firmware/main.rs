//! Torques of a robot arm, in `f32` on a Cortex-M, printed by the debugger or by QEMU: cargo run --release
#![no_std]
#![no_main]

use core::hint::black_box;

use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../robot.yaml", form = "reduced")] // relative to this source file
struct Arm;

const JOINTS: usize = 6;

#[cortex_m_rt::entry]
fn main() -> ! {
    // Without the black box, the compiler would compute the torques itself, because it knows this state.
    let [q, qd, qdd] = black_box([[0.1_f32; JOINTS], [0.5; JOINTS], [1.0; JOINTS]]); // rad, rad/s, rad/s²
    let tau = Arm.inverse_dynamics(&q, &qd, &qdd);
    hprintln!("{tau:.3?} N m");
    debug::exit(debug::EXIT_SUCCESS); // ends QEMU
    panic!("only a debugger, or QEMU, ends a firmware");
}
