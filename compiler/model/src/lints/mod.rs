//! Warnings and notes about values that are allowed but are probably not what the author meant.

pub(crate) mod arm;
pub(crate) mod closed_loops;
pub(crate) mod inertia;
pub(crate) mod link;
pub(crate) mod mirror;
pub(crate) mod resistance;
pub(crate) mod single_value;
