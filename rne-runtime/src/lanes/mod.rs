//! Computation of many states at once: registers with several lanes, and the programs that run in them.

pub mod batch;
#[cfg(feature = "machine")]
#[doc(hidden)]
pub mod machine;
#[doc(hidden)]
pub mod processor;
pub(crate) mod registers;
#[cfg(feature = "rayon")]
pub(crate) mod threads;
