//! Computed-torque control of two robot arms at 1 kHz, in `f32`, on a Cortex-M without an operating system: `./run`
//!
//! QEMU's board has no arm, so the same processor also simulates the arms, one after the other. Each starts with an
//! error of 0.2 rad and has to reach its trajectory. Its second joint is pushed for some time, which the observer has
//! to detect.
#![no_std]
#![no_main]

mod clock;
mod report;

use core::hint::black_box;

use clock::{Clock, PERIOD};
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use panic_semihosting as _;
use report::{Report, Row};
use rne::{ComputedTorque, Desired, ForwardDynamics, InverseDynamics, MomentumObserver, ObserverState, Scalar};

#[derive(InverseDynamics, ForwardDynamics, MomentumObserver)]
#[robot(path = "../../../robots/puma560.yaml", form = "reduced")] // relative to this source file
struct Puma560;

#[derive(InverseDynamics, ForwardDynamics, MomentumObserver)]
#[robot(path = "../../../robots/panda.yaml", form = "reduced")]
struct Panda;

/// The error e of every joint of any arm satisfies ë + DAMPING ė + STIFFNESS e = 0, so that it vanishes without
/// overshoot.
const STIFFNESS: f32 = 256.0; // 1/s²
const DAMPING: f32 = 32.0; // 1/s

/// The gain of the observer, which is the cut-off of its low-pass filter in Hz.
const OBSERVER_GAIN: f64 = 20.0;

/// The positions and velocities that the encoders measure.
struct State<const DOF: usize> {
    q: [f32; DOF],
    qd: [f32; DOF],
}

/// Returns the desired motion: every joint moves along a sine about its home position, once in two seconds.
fn reference<const DOF: usize>(home: &[f32; DOF], time: f32) -> Desired<DOF, f32> {
    const AMPLITUDE: f32 = 0.3; // rad
    const OMEGA: f32 = core::f32::consts::PI; // rad/s
    let (sine, cosine) = (OMEGA * time).sin_cos(); // of rne::Scalar; `core` has none
    Desired {
        q: home.map(|home| home + AMPLITUDE * sine),
        qd: [AMPLITUDE * OMEGA * cosine; DOF],
        qdd: [-AMPLITUDE * OMEGA * OMEGA * sine; DOF],
    }
}

/// Simulates the arm for one period, by the semi-implicit Euler method. A real arm replaces this function.
fn simulate<R: ForwardDynamics<DOF>, const DOF: usize>(arm: &R, state: &mut State<DOF>, torques: &[f32; DOF]) {
    let qdd = arm.forward_dynamics(&state.q, &state.qd, torques);
    for (i, qdd) in qdd.into_iter().enumerate() {
        state.qd[i] += PERIOD * qdd;
        state.q[i] += PERIOD * state.qd[i];
    }
}

fn controller<const DOF: usize>() -> ComputedTorque<DOF, f32> {
    let observer = ObserverState::new(OBSERVER_GAIN, PERIOD.into());
    ComputedTorque { stiffness: [STIFFNESS; DOF], damping: [DAMPING; DOF], observer }
}

/// Returns the torques for the next period. It is a separate function, so that torques and observer share sines and
/// velocities.
#[inline(never)]
fn tick<R: InverseDynamics<DOF> + MomentumObserver<DOF>, const DOF: usize>(
    controller: &mut ComputedTorque<DOF, f32>,
    arm: &R,
    q: &[f32; DOF],
    qd: &[f32; DOF],
    desired: &Desired<DOF, f32>,
    applied: &[f32; DOF],
) -> [f32; DOF] {
    controller.tick(arm, q, qd, desired, applied)
}

/// Runs the control loop for one second.
fn control<R, const DOF: usize>(clock: &mut Clock, arm: &R, home: &[f32; DOF]) -> Report<DOF>
where
    R: InverseDynamics<DOF> + ForwardDynamics<DOF> + MomentumObserver<DOF>,
{
    let mut report = Report::new();
    let mut state = State { q: home.map(|home| home + report::INITIAL_ERROR), qd: [0.0; DOF] };
    let mut controller = controller();
    let mut torques = [0.0; DOF];

    cortex_m_stack::repaint_stack();
    clock.start();
    for period in 0..report::PERIODS {
        report.missed += clock.wait();
        let wanted = reference(home, PERIOD * f32::from(period));
        torques = black_box(tick(&mut controller, arm, &state.q, &state.qd, &wanted, &torques)); // to your drives
        let observed = controller.observer.external_torques()[report::PUSHED];
        let control = clock::used();

        let error = (0..DOF).map(|i| (wanted.q[i] - state.q[i]).abs()).fold(0.0, f32::max);
        let mut pushed = torques;
        pushed[report::PUSHED] += report::push(period);
        simulate(arm, black_box(&mut state), &pushed); // the black boxes prevent reordering with the clock
        report.add(period, Row { error, observed, torques }, control, clock::used());
    }
    clock.stop();
    report.stack = cortex_m_stack::stack_size() - cortex_m_stack::stack_painted();
    report
}

/// Controls one arm and prints the report; returns whether the result was good.
fn demonstrate<R, const DOF: usize>(clock: &mut Clock, name: &str, arm: &R, home: &[f32; DOF]) -> bool
where
    R: InverseDynamics<DOF> + ForwardDynamics<DOF> + MomentumObserver<DOF>,
{
    let motion = [*home, [1.0; DOF], [1.0; DOF]];
    let wanted = reference(home, 0.1);
    let mut controller = controller();
    let mut tick = |q, qd, applied| tick(black_box(&mut controller), arm, q, qd, black_box(&wanted), applied);
    let instructions = clock.instructions(|| {
        let [q, qd, applied] = black_box(&motion);
        black_box(tick(q, qd, applied));
    });
    hprintln!("{name}: {instructions:.0} instructions (QEMU) per tick: computed torque with an observer of contacts");
    let report = control(clock, arm, home);
    report.print();
    report.is_good()
}

#[entry]
fn main() -> ! {
    let peripherals = cortex_m::Peripherals::take().expect("taken once");
    let mut clock = Clock::new(peripherals.SYST);
    hprintln!("1 kHz: a period of {:.0} instructions (QEMU)\n", clock.instructions_per_period());
    let tracked = [
        demonstrate(&mut clock, "Unimate PUMA 560", &Puma560, &[0.0, 0.8, -2.4, 0.0, 0.5, 0.0]),
        demonstrate(&mut clock, "Franka Emika Panda", &Panda, &[0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8]),
    ];
    debug::exit(if tracked == [true; 2] { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    panic!("only a debugger, or QEMU, ends a firmware")
}
