//! The command line as a user meets it: processes, text and exit statuses.

mod call;
mod check;
mod emit;
mod emit_c;
mod eval;
mod import;
mod plans;
mod search;
mod show;
mod terminal;
