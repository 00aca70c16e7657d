//! Functions for the tests of `#[robot(…, tests)]`: generated code against [`Arm`](crate::Arm) of the same robot file,
//! and against laws of mechanics. Each function is one test; it panics when the test fails, and names the state.
//!
//! Not part of the public interface: derived code names it.

#[cfg(all(feature = "arm", feature = "std"))]
mod batches;
#[cfg(all(feature = "arm", feature = "std"))]
mod comparison;
#[cfg(all(feature = "arm", feature = "std"))]
mod geometry;
#[cfg(all(feature = "arm", feature = "std"))]
mod golden;
#[cfg(all(feature = "arm", feature = "std"))]
mod motion;
#[cfg(all(feature = "arm", feature = "std"))]
mod robot_file;
#[cfg(all(feature = "arm", feature = "std"))]
mod state;
#[cfg(all(feature = "arm", feature = "std"))]
mod torques;

#[cfg(all(feature = "arm", feature = "std"))]
pub use batches::{
    accelerations_of_a_batch_need_the_torques_that_cause_them, batches_are_those_of_the_runtime,
    derivatives_of_a_batch_are_those_of_the_runtime, mass_matrices_of_a_batch_are_those_of_the_runtime, on_large_stack,
};
#[cfg(all(feature = "arm", feature = "std"))]
pub use geometry::{
    centre_of_mass_is_that_of_the_runtime, derivatives_of_the_jacobian_are_those_of_the_runtime,
    kinematics_are_those_of_the_runtime, rotations_are_orthonormal,
};
#[cfg(all(feature = "arm", feature = "std"))]
pub use golden::{GoldenState, torques_are_those_of_the_golden_file};
#[cfg(all(feature = "arm", feature = "std"))]
pub use motion::{
    accelerations_are_those_of_the_runtime, accelerations_need_the_torques_that_cause_them,
    coriolis_matrix_is_that_of_the_runtime, derivatives_of_accelerations_are_those_of_the_runtime,
    derivatives_of_the_euler_step_are_those_of_the_runtime, energies_are_those_of_the_runtime,
    euler_step_is_that_of_the_runtime, kinetic_energy_is_that_of_the_mass_matrix, mass_matrix_is_symmetric,
    mass_matrix_is_that_of_the_runtime, momenta_are_those_of_the_runtime, momentum_is_that_of_the_mass_matrix,
};
#[cfg(all(feature = "arm", feature = "std"))]
pub use robot_file::RobotFile;
#[cfg(all(feature = "arm", feature = "std"))]
pub use state::{JOINTS, Random};
#[cfg(all(feature = "arm", feature = "std"))]
pub use torques::{
    actuator_torques_are_those_of_the_runtime, derivatives_are_those_of_the_runtime, gradient_is_that_of_the_runtime,
    gravity_and_bias_are_torques_without_motion, hessian_is_that_of_the_runtime,
    joint_wrenches_are_those_of_the_runtime, payload_dynamics_are_those_of_the_runtime,
    regressor_is_that_of_the_runtime, torques_are_linear_in_accelerations, torques_are_those_of_the_runtime,
    torques_on_a_moving_base_are_those_of_the_runtime,
};

/// The tests themselves, where there is a runtime to compare with.
#[cfg(all(feature = "arm", feature = "std"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __with_runtime {
    ($($tests:item)*) => { $($tests)* };
}

/// One message in place of the tests.
#[cfg(not(all(feature = "arm", feature = "std")))]
#[doc(hidden)]
#[macro_export]
macro_rules! __with_runtime {
    ($($tests:item)*) => {
        ::core::compile_error!(
            "the tests of `#[robot(…, tests)]` compare with `rne::Arm`, which needs the features `arm` and `std`: \
             write `rne = { version = \"…\", features = [\"arm\", \"std\"] }` under `[dev-dependencies]`; the library \
             itself can do without"
        );
    };
}

pub use crate::__with_runtime as with_runtime;
