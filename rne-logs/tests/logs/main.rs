//! Logs, read and filtered.

mod bags;
mod filtered;
mod runs;
mod written;
