//! The lines and the words of texts.

pub(crate) mod lines;
pub(crate) mod prose;
pub(crate) mod wrapping;
