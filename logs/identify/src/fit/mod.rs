//! Parameters from the motions of logs: which of them the torques depend on, and their values with standard deviations.

pub(crate) mod feasible;
pub(crate) mod fitted_model;
pub(crate) mod friction;
pub(crate) mod identifiability;
pub(crate) mod identification;
pub(crate) mod information;
pub(crate) mod least_squares;
pub(crate) mod parameters;
pub(crate) mod payload;
pub mod prior;
pub mod pseudo_inertia;
pub(crate) mod r_factor;
pub(crate) mod regressor;
pub(crate) mod smoothing;
pub(crate) mod steady;
pub(crate) mod stretches;
pub(crate) mod structure;
