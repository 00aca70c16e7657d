//! What options and arguments are: numbers, states, choices, and how logs are read.

pub(crate) mod choice;
pub(crate) mod limits;
pub(crate) mod log_arguments;
pub(crate) mod numbers;
pub(crate) mod state;
