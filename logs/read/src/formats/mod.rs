//! Readers for the file formats of logs.

#[cfg(feature = "bags")]
pub(crate) mod bags;
pub(crate) mod csv_rows;
pub(crate) mod csv_table;
pub(crate) mod format;
pub(crate) mod guard;
pub(crate) mod npy;
pub(crate) mod npy_array;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
pub(crate) mod sample;
