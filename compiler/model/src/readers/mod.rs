//! Readers of a robot file: most of them read one key and all values below it, the others are shared by several keys.

pub(crate) mod bodies;
pub(crate) mod contacts;
pub(crate) mod couplings;
pub(crate) mod drives;
pub(crate) mod floating_base;
pub(crate) mod frames;
pub(crate) mod joints;
pub(crate) mod limits;
pub(crate) mod link;
pub(crate) mod loops;
pub(crate) mod matter;
pub(crate) mod motor;
pub(crate) mod names;
pub(crate) mod parameters;
pub(crate) mod placement;
pub(crate) mod robot;
pub(crate) mod texts;
pub(crate) mod tips;
pub(crate) mod tree;
pub(crate) mod varying;
