//! The shipped robots, derived: equality with the runtime, golden values, accuracy in single precision, operation
//! counts.

mod dense;
mod equality;
mod golden;
mod lecture;
mod operations;
mod reduced;
mod shipped;
mod single_precision;
mod states;
