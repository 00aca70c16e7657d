//! Motions that excite the parameters of an arm.

pub(crate) mod design;
pub(crate) mod effort;
pub(crate) mod excitation;
pub(crate) mod excitation_error;
pub(crate) mod fourier;
pub(crate) mod motion_limits;
pub(crate) mod random;
