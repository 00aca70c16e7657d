//! Writes results for human readers: columns, equations, worksheets, reports.

pub(crate) mod answer;
pub(crate) mod base_parameters;
mod counts;
pub(crate) mod equations;
pub(crate) mod heading;
pub(crate) mod highlight;
pub(crate) mod identified_parameters;
pub(crate) mod layout;
pub(crate) mod letters;
pub(crate) mod link_parameter;
pub(crate) mod log_groups;
pub(crate) mod log_remark;
pub(crate) mod log_report;
pub(crate) mod marks;
pub(crate) mod payload;
pub(crate) mod physics;
pub(crate) mod verdict;
pub(crate) mod watch_dates;
pub(crate) mod watch_report;
pub(crate) mod worksheet;
