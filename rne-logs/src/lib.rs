//! Logs of robot arms as runs of joint states.
#![forbid(unsafe_code)]

mod motion;

pub use crate::motion::Motion;
