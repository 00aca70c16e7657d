//! Columns of tables: finds the joint, quantity and unit of a column by its name.

pub(crate) mod checks;
pub(crate) mod guess;
pub(crate) mod header;
pub(crate) mod heading;
pub(crate) mod label;
pub(crate) mod mapping;
pub(crate) mod quantity;
pub(crate) mod table;
pub(crate) mod time_column;
pub(crate) mod time_unit;
pub(crate) mod unit;
