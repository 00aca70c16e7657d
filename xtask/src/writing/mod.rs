//! Tasks that check the lines and the wording of texts.

pub(crate) mod lines;
pub(crate) mod prose;
pub(crate) mod wrapping;
