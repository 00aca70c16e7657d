//! Arithmetic that does not round, for deciding what is zero and what is equal.

mod double;
mod field;
mod number;

pub(crate) use field::Image;
pub(crate) use number::{Number, Reading, Turn};
