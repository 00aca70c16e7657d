//! The command line as a user meets it: processes, text and exit statuses.

mod call;
mod check;
mod emit;
mod eval;
mod show;
mod terminal;
