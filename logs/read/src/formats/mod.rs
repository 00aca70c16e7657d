//! A reader for each format of files.

pub(crate) mod csv_rows;
pub(crate) mod csv_table;
pub(crate) mod format;
pub(crate) mod guard;
#[cfg(feature = "bags")]
pub(crate) mod joint_state;
#[cfg(feature = "parquet")]
pub(crate) mod list_columns;
#[cfg(feature = "bags")]
pub(crate) mod mcap_bag;
#[cfg(feature = "parquet")]
pub(crate) mod motion_parquet;
pub(crate) mod npy;
pub(crate) mod npy_array;
#[cfg(feature = "parquet")]
pub(crate) mod parquet_column;
#[cfg(feature = "parquet")]
pub(crate) mod parquet_pages;
#[cfg(feature = "parquet")]
pub(crate) mod parquet_table;
pub(crate) mod sample;
#[cfg(feature = "bags")]
pub(crate) mod sqlite_bag;
#[cfg(feature = "bags")]
pub(crate) mod topic;
