//! Robot files: what is read, what is refused, and in which words.

mod agreement;
mod bodies;
mod closed_loops;
mod common;
mod contacts;
mod couplings;
mod errors;
mod everyday;
mod frames;
mod fuzz;
mod good;
mod identifiers;
mod lints;
mod lints_per_link;
mod mirror;
mod motors;
mod parallelogram;
mod rendering;
mod rods;
mod run_time;
mod run_time_properties;
