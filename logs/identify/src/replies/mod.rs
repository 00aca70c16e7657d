//! Replies to people and programs about a log and its parameters.

pub(crate) mod log_reply;
pub(crate) mod payload_reply;
pub(crate) mod prediction;
pub(crate) mod reply;
pub(crate) mod verdict;
pub(crate) mod written;
