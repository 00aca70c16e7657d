//! Closed loops: their data, their equations and the joints that follow from them.

pub(crate) mod closed_loop;
pub(crate) mod closure;
pub(crate) mod dependents;
pub(crate) mod matrix;
pub(crate) mod mobility;
pub(crate) mod parallelogram;
