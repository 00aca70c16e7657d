//! The parts of a robot: each file has the data of one key of the robot file, or numbers that these parts need.

pub(crate) mod body;
pub(crate) mod coupling;
pub(crate) mod double;
pub(crate) mod drive;
pub(crate) mod floating_base;
pub(crate) mod formula;
pub(crate) mod frame;
pub(crate) mod friction;
pub(crate) mod golden;
pub(crate) mod inertia;
pub(crate) mod pose;
pub(crate) mod quantity;
pub(crate) mod run_time;
pub(crate) mod tips;
