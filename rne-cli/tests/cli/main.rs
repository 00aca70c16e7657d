//! The command line as a user meets it: processes, text and exit statuses.

mod ascii;
mod call;
mod certify;
mod check;
mod closed_form;
mod diagnose;
mod documents;
mod emit;
mod emit_c;
mod emit_tests;
mod eval;
mod excite;
mod files;
mod firmware;
mod help;
#[cfg(unix)]
mod hostile;
mod identify;
mod import;
mod log;
mod log_tables;
mod log_written;
mod plans;
mod plot;
mod report;
mod residuals;
mod search;
mod shipped;
mod show;
mod states;
mod terminal;
mod views;
mod watch;
mod watch_dates;
mod watch_pictures;
mod worksheet;
