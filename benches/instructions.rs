//! Exact instruction counts of one call, for the default target: `cargo xtask instructions` runs this, prints a table
//! and compares it with the baseline.
//!
//! A count is that of a function that is never inlined: it gets a state by reference, calls, and writes the torques.

// The harness writes public modules.
#![allow(missing_docs)]

use std::hint::black_box;

use gungraun::prelude::*;
use gungraun::{Callgrind, main};
use rne::{
    ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, Scalar, TorqueDerivatives, Wrench,
};
use rne_benches::{PandaReduced, PandaSevenSteps, Puma560Reduced, Puma560SevenSteps, State, states};

fn state<const DOF: usize, T: Scalar>() -> State<DOF, T> {
    black_box(states()[0])
}

/// Robots to what is counted: a call whose state is already made.
mod setup {
    use super::{
        ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, TorqueDerivatives, Wrench, black_box,
        state,
    };

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

    pub(super) fn mass_matrix<const DOF: usize>(robot: impl MassMatrix<DOF>) -> impl FnOnce() -> [[f64; DOF]; DOF] {
        let at = state();
        move || robot.mass_matrix(&at.q)
    }

    pub(super) fn forward_dynamics<const DOF: usize>(robot: impl ForwardDynamics<DOF>) -> impl FnOnce() -> [f64; DOF] {
        let at = state();
        // What the accelerations are as torques does not matter: there are no branches.
        move || robot.forward_dynamics(&at.q, &at.qd, &at.qdd)
    }

    pub(super) fn derivatives<const DOF: usize>(
        robot: impl InverseDynamicsDerivatives<DOF>,
    ) -> impl FnOnce() -> TorqueDerivatives<DOF, f64> {
        let at = state();
        move || robot.inverse_dynamics_derivatives(&at.q, &at.qd, &at.qdd)
    }
}

/// One function for all robots that have it: the UR5 is derived with inverse dynamics only.
macro_rules! benchmarks {
    ($($function:ident $(with $ur5:ident)?;)*) => {$(
        #[library_benchmark(setup = setup::$function)]
        #[bench::puma560_seven_steps(Puma560SevenSteps)]
        #[bench::puma560_reduced(Puma560Reduced)]
        #[bench::panda_seven_steps(PandaSevenSteps)]
        #[bench::panda_reduced(PandaReduced)]
        $(#[bench::ur5_seven_steps($ur5::Ur5SevenSteps)]
        #[bench::ur5_reduced($ur5::Ur5Reduced)])?
        fn $function<T>(call: impl FnOnce() -> T) -> T {
            call()
        }
    )*};
}

benchmarks! {
    inverse_dynamics with rne_benches;
    inverse_dynamics_f32 with rne_benches;
    with_wrench with rne_benches;
    gravity_torques with rne_benches;
    bias_torques with rne_benches;
    mass_matrix;
    forward_dynamics;
    derivatives;
}

library_benchmark_group!(
    name = calls,
    benchmarks = [
        inverse_dynamics,
        inverse_dynamics_f32,
        with_wrench,
        gravity_torques,
        bias_torques,
        mass_matrix,
        forward_dynamics,
        derivatives
    ]
);

// Instructions only: no simulation of caches.
main!(
    config = LibraryBenchmarkConfig::default().tool(Callgrind::with_args(["--cache-sim=no"])),
    library_benchmark_groups = calls
);
