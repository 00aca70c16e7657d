//! Logs, read and filtered.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::format_push_string,
    clippy::format_collect,
    reason = "numbers are small, and so are the texts"
)]

mod bags;
mod columns;
mod corrupt;
mod filtered;
mod formats;
mod runs;
mod written;
