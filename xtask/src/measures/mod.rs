//! Tasks that count and time the generated code.

pub(crate) mod batch_profile;
pub(crate) mod counts;
pub(crate) mod gpu;
pub(crate) mod growth;
pub(crate) mod instructions;
pub(crate) mod performance;
pub(crate) mod plain_build;
pub(crate) mod single_calls;
pub(crate) mod tree_counts;
