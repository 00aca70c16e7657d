//! Turns the bytes of a file into a tree of keys and numbers with their places, and makes messages about them.

pub(crate) mod data_file;
pub(crate) mod decode;
pub(crate) mod diagnostic;
pub mod document;
pub(crate) mod expression;
pub(crate) mod identifier;
pub(crate) mod keys;
pub(crate) mod other_formats;
pub(crate) mod render;
pub(crate) mod source;
pub(crate) mod spelling;
pub(crate) mod unit;
