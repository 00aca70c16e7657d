//! The commands that explain an arm, and the commands for a class.

pub(super) mod closed_form;
pub(super) mod diagnose;
pub(super) mod explain;
pub(super) mod mark;
pub(super) mod plot;
pub(super) mod report;
pub(super) mod show;
pub(super) mod tour;
pub(super) mod worksheet;
