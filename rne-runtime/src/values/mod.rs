//! Arguments and results: vectors, poses, wrenches, and records of them.

pub(crate) mod base_motion;
pub(crate) mod base_state;
pub(crate) mod joint_order;
pub(crate) mod names;
pub(crate) mod numbers;
pub(crate) mod operations;
pub(crate) mod payload;
pub(crate) mod pose;
pub(crate) mod pose_log;
pub(crate) mod quaternion;
pub(crate) mod records;
pub(crate) mod shapes;
pub(crate) mod wrench;
