//! The smallest firmware: torques of the PUMA 560, printed by the debugger. cargo run --release --bin torque
#![no_std]
#![no_main]

use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use rne::InverseDynamics;

#[derive(InverseDynamics)]
#[robot(path = "../../../../robots/puma560.yaml", form = "reduced")]
struct Puma560;

#[cortex_m_rt::entry]
fn main() -> ! {
    let q: [f32; 6] = [0.1, -0.4, 0.3, 1.2, -0.7, 0.5]; // rad
    let tau = Puma560.inverse_dynamics(&q, &[0.5; 6], &[1.0; 6]); // N m
    hprintln!("{tau:.3?}");
    debug::exit(debug::EXIT_SUCCESS); // ends QEMU
    panic!("no debugger");
}
