//! Tables in Parquet files: reading with bounded memory, and writing.

pub(crate) mod column;
pub(crate) mod list_columns;
pub(crate) mod motion_parquet;
pub(crate) mod pages;
pub(crate) mod table;
