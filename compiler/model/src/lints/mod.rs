//! Values that are allowed and yet are probably not what was meant.

pub(crate) mod arm;
pub(crate) mod closed_loops;
pub(crate) mod inertia;
pub(crate) mod mirror;
pub(crate) mod resistance;
pub(crate) mod single_value;
