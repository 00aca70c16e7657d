//! The tests for builds that contain the runtime to compare with.

mod batches;
mod comparison;
mod golden;
mod laws;
mod random;
mod robot_file;
mod runtime;
mod state;

pub use batches::{
    accelerations_of_a_batch_need_the_torques_that_cause_them, batches_are_those_of_the_runtime,
    derivatives_of_a_batch_are_those_of_the_runtime, mass_matrices_of_a_batch_are_those_of_the_runtime, on_large_stack,
};
pub use golden::{GoldenState, torques_are_those_of_the_golden_file};
pub use laws::*;
pub use random::{JOINTS, Random};
pub use robot_file::RobotFile;
pub use runtime::{array, is_that_of_the_runtime, numbers};
