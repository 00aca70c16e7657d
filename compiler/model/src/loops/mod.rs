//! Closed loops: their data, their equations, and the joints whose positions the equations determine.

pub(crate) mod closed_loop;
pub(crate) mod closure;
pub(crate) mod dependents;
pub(crate) mod matrix;
pub(crate) mod mobility;
pub(crate) mod parallelogram;
