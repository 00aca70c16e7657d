//! The generic recursion: against closed forms, physics, and each other.

mod actuation;
mod base_parameters;
mod common;
mod contacts;
mod contract;
mod dyn_arm;
mod evaluation_order;
mod floating_integrator;
mod frames;
mod functions;
mod integrator;
mod load;
mod momentum;
mod observer;
mod physics;
mod pose_log;
mod scalars;
mod section_5;
