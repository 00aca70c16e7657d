//! ROS 2 bags: the containers MCAP and SQLite, and the messages in them.

pub(crate) mod joint_state;
pub(crate) mod mcap_bag;
pub(crate) mod sqlite_bag;
pub(crate) mod topic;
