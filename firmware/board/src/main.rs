//! Runs the certified functions and prints for each a line that the program of the certificate reads:
//!
//! ```text
//! torques ROBOT FORM STATE BITS…         results, each number as its bits in hexadecimal
//! method FORM FUNCTION STATE BITS…       the same of the other functions of the PUMA 560
//! ticks ROBOT FORM TICKS                 SysTick during one call
//! ticks echo DOF TICKS                   the same of a function of known length
//! ```
#![no_std]
#![no_main]

mod echo;
mod faulty;

use core::hint::black_box;
use core::panic::PanicInfo;

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprint, hprintln};
#[cfg(feature = "methods")]
use robots::puma560::{self, Arguments};
use robots::{Numbers, STATES, State, Torques, runtime};

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{}", info);
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}

#[entry]
fn main() -> ! {
    match Peripherals::take() {
        Some(peripherals) => start(peripherals.SYST),
        None => debug::exit(debug::EXIT_FAILURE),
    }
    robots::each(&mut Board);
    #[cfg(feature = "methods")]
    {
        puma560::each(&mut Board);
        robots::each_controller(&mut Board);
    }
    echo::each(|dof, ticks| hprintln!("ticks echo {} {}", dof, ticks));
    let arm = black_box(runtime::arm());
    let State { q, qd, qdd } = State::new(0);
    let start = SYST::get_current();
    let tau = runtime::inverse_dynamics(&arm, &q, &qd, &qdd);
    let end = SYST::get_current();
    hprint!("torques puma560 runtime 0");
    print(&tau);
    hprintln!("ticks puma560 runtime {}", elapsed(start, end));
    faulty::keep();
    debug::exit(debug::EXIT_SUCCESS);
    loop {}
}

/// Starts SysTick, which counts down from its largest value, once per clock cycle of the processor.
fn start(mut timer: SYST) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(0x00ff_ffff);
    timer.clear_current();
    timer.enable_counter();
}

const fn elapsed(start: u32, end: u32) -> u32 {
    start.wrapping_sub(end) & 0x00ff_ffff
}

/// Measures the time of one call, in ticks.
#[inline(never)]
fn ticks<const DOF: usize>(function: Torques<DOF>, state: &State<DOF>) -> u32 {
    let start = SYST::get_current();
    let tau = function(&state.q, &state.qd, &state.qdd);
    let end = SYST::get_current();
    black_box(tau);
    elapsed(start, end)
}

/// Prints the numbers of a result, and ends the line.
fn print(numbers: &impl Numbers<f32>) {
    numbers.each(&mut |number| hprint!(" {:08x}", number.to_bits()));
    hprintln!();
}

struct Board;

impl robots::Visitor for Board {
    fn visit<const DOF: usize>(&mut self, robot: &'static str, form: &'static str, function: Torques<DOF>) {
        for number in 0..STATES {
            let State { q, qd, qdd } = State::new(number);
            hprint!("torques {} {} {}", robot, form, number);
            print(&function(&q, &qd, &qdd));
        }
        hprintln!("ticks {} {} {}", robot, form, ticks(black_box(function), &State::new(0)));
    }
}

#[cfg(feature = "methods")]
impl puma560::Visitor for Board {
    fn visit<N: Numbers<f32>>(&mut self, form: &'static str, function: &'static str, call: impl Fn(&Arguments) -> N) {
        for number in 0..STATES {
            hprint!("method {} {} {}", form, function, number);
            print(&call(&Arguments::at(State::new(number))));
        }
    }
}
