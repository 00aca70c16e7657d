//! `SysTick`, the timer that every Cortex-M has. First it counts instructions, then it wakes the control loop.

use core::hint::black_box;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::asm::{delay, wfi};
use cortex_m::interrupt;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

/// Clock rate of the processor of the MPS2 boards, Hz; change this line for another board.
const HERTZ: u32 = 25_000_000;
/// Rate of the control loop, Hz.
const PERIODS_PER_SECOND: u32 = 1000;
const TICKS_PER_PERIOD: u32 = HERTZ / PERIODS_PER_SECOND;
/// Duration of a period, s.
pub const PERIOD: f32 = 1.0 / PERIODS_PER_SECOND as f32;

/// Number of periods that have begun.
static PERIODS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    PERIODS.fetch_add(1, Ordering::Relaxed);
}

/// The timer, with its calibration and the number of the current period.
pub struct Clock {
    timer: SYST,
    instructions_per_tick: f32,
    period: u32,
}

impl Clock {
    /// Takes the timer and measures how many instructions a tick lasts.
    ///
    /// QEMU's `-icount` gives every instruction the same time, so its timers count instructions. QEMU has no pipeline
    /// and no flash with wait states, so these are not cycles. `DWT_CYCCNT`, which counts cycles on a real board, is 0
    /// in QEMU.
    pub fn new(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        let mut clock = Self { timer, instructions_per_tick: 0.0, period: 0 };
        // `delay` is a loop of two instructions.
        let ticks = clock.ticks(|| delay(100_000)) - clock.ticks(|| delay(0));
        clock.instructions_per_tick = 200_000.0 / ticks as f32;
        clock
    }

    /// Number of instructions in one period.
    pub fn instructions_per_period(&self) -> f32 {
        self.instructions_per_tick * TICKS_PER_PERIOD as f32
    }

    /// Measures the instructions of one call, including `bl` and the passing of arguments. The result is a mean over
    /// several calls, because a tick can last several instructions.
    pub fn instructions(&mut self, mut call: impl FnMut()) -> f32 {
        const CALLS: u8 = 100;
        let calls = self.ticks(|| (0..CALLS).for_each(|_| call()));
        let loop_alone = self.ticks(|| (0..CALLS).for_each(|_| black_box(())));
        self.instructions_per_tick * (calls - loop_alone) as f32 / f32::from(CALLS)
    }

    fn ticks(&mut self, work: impl FnOnce()) -> u32 {
        const ALL_BITS: u32 = 0x00FF_FFFF; // 24
        self.timer.set_reload(ALL_BITS);
        self.timer.clear_current();
        self.timer.enable_counter();
        let start = SYST::get_current();
        work();
        let ticks = start.wrapping_sub(SYST::get_current()) & ALL_BITS; // it counts down
        self.timer.disable_counter();
        ticks
    }

    /// Begins the first period; from then on, a new one begins every `PERIOD`.
    pub fn start(&mut self) {
        self.timer.set_reload(TICKS_PER_PERIOD - 1);
        self.timer.clear_current();
        self.timer.enable_interrupt();
        self.timer.enable_counter();
        self.period = PERIODS.load(Ordering::Relaxed);
    }

    /// Stops the timer, so that no further periods begin.
    pub fn stop(&mut self) {
        self.timer.disable_counter();
        self.timer.disable_interrupt();
    }

    /// Sleeps until the next period begins; returns how many periods were missed.
    pub fn wait(&mut self) -> u32 {
        loop {
            // An interrupt between the check and `wfi` would be missed; while interrupts are disabled, it still ends
            // `wfi`.
            let begun = interrupt::free(|_| {
                let begun = PERIODS.load(Ordering::Relaxed).wrapping_sub(self.period);
                if begun == 0 {
                    wfi();
                }
                begun
            });
            if begun > 0 {
                self.period = self.period.wrapping_add(begun);
                return begun - 1;
            }
        }
    }
}

/// Returns the elapsed share of the current period, 0 to 1.
pub fn used() -> f32 {
    1.0 - SYST::get_current() as f32 / TICKS_PER_PERIOD as f32
}
