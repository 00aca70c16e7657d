//! Values of options and arguments: numbers, states, choices, and options for logs.

pub(crate) mod choice;
pub(crate) mod closure;
pub(crate) mod definite;
pub(crate) mod limits;
pub(crate) mod log_arguments;
pub(crate) mod numbers;
pub(crate) mod payload;
pub(crate) mod random;
pub(crate) mod state;
mod tip_wrench;
