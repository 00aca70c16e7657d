//! Instructions, counted by a timer.
//!
//! QEMU's `-icount` gives every instruction the same time, so that a timer counts instructions: how many per tick is found
//! out here. It models neither flash wait states nor the pipeline, and its DWT_CYCCNT reads 0. On your board, read that one.

use core::hint::black_box;

use cortex_m::peripheral::SYST;

/// SysTick has 24 bits.
const COUNTER: u32 = 0x00FF_FFFF;

const CALLS: u32 = 100;

/// Mean instructions of one call of `work`.
pub fn of_a_call(timer: &mut SYST, work: impl Fn()) -> u32 {
    timer.set_reload(COUNTER);
    timer.clear_current();
    timer.enable_counter();
    // `delay` is a loop of two instructions.
    let ticks_of_20_000 = ticks(|| cortex_m::asm::delay(9_999));
    let calls = ticks(|| (0..CALLS).for_each(|_| work()));
    let nothing = ticks(|| (0..CALLS).for_each(|call| { black_box(call); }));
    timer.disable_counter();
    ((calls - nothing) * 20_000 / ticks_of_20_000 + CALLS / 2) / CALLS
}

fn ticks(work: impl Fn()) -> u32 {
    let start = SYST::get_current(); // counts down
    work();
    start.wrapping_sub(SYST::get_current()) & COUNTER
}
