//! Random robots: the compiler against the runtime, interpreted by the thousand and compiled by the dozen.

mod cad;
mod compiled;
mod interpreted;
mod reduced;
mod robots;
