//! Controllers, observers and derivatives for optimisers, composed of the functions of a robot.

pub(crate) mod computed_torque;
pub(crate) mod floating_derivatives;
pub(crate) mod jacobian_derivatives;
pub(crate) mod observer;
pub(crate) mod operational_space;
pub(crate) mod optimisation;
