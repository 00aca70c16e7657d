//! The numbers that every function is generic over, and the factors of a matrix of them.

pub(crate) mod dual;
pub(crate) mod ldlt;
pub(crate) mod scalar;
pub(crate) mod sin_cos;
pub(crate) mod smooth_sign;
