//! The parts of a robot: each file has the data of a key of the robot file and reads it.

pub(crate) mod body;
pub(crate) mod contacts;
pub(crate) mod coupling;
pub(crate) mod double;
pub(crate) mod drive;
pub(crate) mod floating_base;
pub(crate) mod formula;
pub(crate) mod frame;
pub(crate) mod friction;
pub(crate) mod golden;
pub(crate) mod inertia;
pub(crate) mod link;
pub(crate) mod matter;
pub(crate) mod pose;
pub(crate) mod quantity;
pub(crate) mod run_time;
pub(crate) mod tips;
pub(crate) mod tree;
pub(crate) mod varying;
