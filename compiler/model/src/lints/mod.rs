//! Values that are allowed and yet are probably not what was meant.

pub(crate) mod lint;
pub(crate) mod mirror;
pub(crate) mod resistance;
