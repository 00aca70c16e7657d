//! The commands about logs of an arm.

pub(super) mod excite;
pub(super) mod identify;
pub(super) mod log;
pub(super) mod prediction_errors;
pub(super) mod residuals;
pub(super) mod watch;
