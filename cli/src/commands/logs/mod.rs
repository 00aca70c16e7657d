//! The commands that read or write logs of an arm.

pub(super) mod excite;
mod gravity_load;
pub(super) mod identify;
mod judged;
pub(super) mod log;
pub(super) mod prediction_errors;
pub(super) mod residuals;
pub(super) mod watch;
