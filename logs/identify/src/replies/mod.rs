//! Reports for people and programs on logs and identified parameters.

pub(crate) mod log_reply;
pub(crate) mod payload_reply;
pub(crate) mod prediction;
pub(crate) mod reply;
pub(crate) mod verdict;
pub(crate) mod written;
