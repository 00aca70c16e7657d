//! Every function of a robot, by the runtime and by generated code of both forms: against independent values, against
//! each other, and against physics.

mod arm;
#[path = "../random/arms.rs"]
mod arms;
mod base_states;
mod calibrated;
mod case;
mod centre_of_mass;
mod check;
mod closed_loops;
mod compiled_trees;
#[path = "../c_code/compiler.rs"]
mod compiler;
mod conventions;
mod couplings;
mod derivatives;
#[path = "../c_code/driver.rs"]
mod driver;
mod dual_numbers;
mod energy;
mod equality;
mod first_moments;
mod floating_base;
mod frames;
mod golden;
mod imported_loops;
mod integrator;
mod kinematics;
mod matrices;
mod momentum;
mod motors;
mod operational_space;
mod operations;
mod own_tests;
mod payload;
mod peers;
mod published;
mod random_arms;
#[path = "../random/motors.rs"]
mod random_motors;
#[path = "../random/trees.rs"]
mod random_trees;
mod real_trees;
mod regressor_product;
#[path = "../random/robots.rs"]
mod robots;
mod rotors;
mod single_precision;
#[path = "../c_code/states.rs"]
mod states;
mod tree_functions;
mod trees;
mod wrenches;
mod written;
