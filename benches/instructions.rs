//! Exact instruction counts of one call, for the default target: `scripts/instructions` runs this, prints a table and
//! compares it with the baseline.
//!
//! A count is that of a function that is never inlined: it gets a state by reference, calls, and writes the torques.

// The harness writes public modules.
#![allow(missing_docs)]

use std::hint::black_box;

use gungraun::prelude::*;
use gungraun::{Callgrind, main};
use rne::{InverseDynamics, Scalar, Wrench};
use rne_benches::{
    PandaReduced, PandaSevenSteps, Puma560Reduced, Puma560SevenSteps, State, Ur5Reduced, Ur5SevenSteps, states,
};

fn state<const DOF: usize, T: Scalar>() -> State<DOF, T> {
    black_box(states()[0])
}

/// Robots to what is counted: a call whose state is already made.
mod setup {
    use super::{InverseDynamics, Wrench, black_box, state};

    pub(super) fn inverse_dynamics<const DOF: usize>(robot: impl InverseDynamics<DOF>) -> impl FnOnce() -> [f64; DOF] {
        let at = state();
        move || robot.inverse_dynamics(&at.q, &at.qd, &at.qdd)
    }

    pub(super) fn inverse_dynamics_f32<const DOF: usize>(
        robot: impl InverseDynamics<DOF>,
    ) -> impl FnOnce() -> [f32; DOF] {
        let at = state();
        move || robot.inverse_dynamics(&at.q, &at.qd, &at.qdd)
    }

    pub(super) fn with_wrench<const DOF: usize>(robot: impl InverseDynamics<DOF>) -> impl FnOnce() -> [f64; DOF] {
        let (at, wrench) = (state(), black_box(Wrench { force: [3.0, -2.0, 1.0], moment: [0.1, 0.2, -0.3] }));
        move || robot.inverse_dynamics_with_wrench(&at.q, &at.qd, &at.qdd, &wrench)
    }

    pub(super) fn gravity_torques<const DOF: usize>(robot: impl InverseDynamics<DOF>) -> impl FnOnce() -> [f64; DOF] {
        let at = state();
        move || robot.gravity_torques(&at.q)
    }

    pub(super) fn bias_torques<const DOF: usize>(robot: impl InverseDynamics<DOF>) -> impl FnOnce() -> [f64; DOF] {
        let at = state();
        move || robot.bias_torques(&at.q, &at.qd)
    }
}

/// One function for all robots; the rewritten form is another one in `inverse_dynamics` alone.
macro_rules! benchmarks {
    ($($function:ident $(and $rewritten:ident)?;)*) => {$(
        #[library_benchmark(setup = setup::$function)]
        #[bench::puma560_seven_steps(Puma560SevenSteps)]
        #[bench::puma560_reduced(Puma560Reduced)]
        $(#[bench::puma560_rewritten($rewritten::Puma560Rewritten)])?
        #[bench::panda_seven_steps(PandaSevenSteps)]
        #[bench::panda_reduced(PandaReduced)]
        $(#[bench::panda_rewritten($rewritten::PandaRewritten)])?
        #[bench::ur5_seven_steps(Ur5SevenSteps)]
        #[bench::ur5_reduced(Ur5Reduced)]
        fn $function<T>(call: impl FnOnce() -> T) -> T {
            call()
        }
    )*};
}

benchmarks! {
    inverse_dynamics and rne_benches;
    inverse_dynamics_f32 and rne_benches;
    with_wrench;
    gravity_torques;
    bias_torques;
}

library_benchmark_group!(
    name = calls,
    benchmarks = [inverse_dynamics, inverse_dynamics_f32, with_wrench, gravity_torques, bias_torques]
);

// Instructions only: no simulation of caches.
main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = calls
);
