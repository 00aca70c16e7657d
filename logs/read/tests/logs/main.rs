//! Logs, read and filtered.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::format_push_string,
    clippy::format_collect,
    reason = "numbers are small, and so are the texts"
)]

#[cfg(feature = "full")]
mod bags;
#[cfg(feature = "full")]
mod bounds;
mod columns;
#[cfg(feature = "full")]
mod corrupt;
mod filtered;
#[cfg(feature = "full")]
mod formats;
mod labels;
#[cfg(not(any(feature = "bags", feature = "parquet")))]
mod left_out;
mod mapped;
mod recorded;
mod runs;
#[cfg(feature = "full")]
mod tables;
mod written;
