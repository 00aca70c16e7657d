//! Remedies for errors of logs, as data, so that each interface can name its own options.

/// A change of the [`Options`](crate::Options) that helps against an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Give this option.
    Give(Setting),
    /// Leave this option out.
    LeaveOut(Setting),
    /// Read the log with a build that has the formats of bags and Parquet.
    BuildWithFormats,
}

/// An option of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Setting {
    /// [`Options::joints`](crate::Options::joints), with names that are possible.
    Joints(Vec<String>),
    /// [`Options::topic`](crate::Options::topic) of a bag
    Topic,
    /// [`Options::topic`](crate::Options::topic) as the beginning of the names of columns
    Prefix,
    /// [`Options::torque_constants`](crate::Options::torque_constants)
    TorqueConstants,
    /// [`Options::angles`](crate::Options::angles)
    Angles,
    /// [`Options::gap`](crate::Options::gap)
    Gap,
    /// [`Options::cutoff`](crate::Options::cutoff)
    Cutoff,
    /// [`Options::time_unit`](crate::Options::time_unit)
    TimeUnit,
    /// [`Options::rate`](crate::Options::rate)
    Rate,
    /// [`Options::columns`](crate::Options::columns)
    Columns,
    /// [`Options::select`](crate::Options::select) with a column, and a text in it that is possible.
    Select {
        /// The name of the column.
        column: String,
        /// A text in the column.
        value: String,
    },
    /// [`Options::map`](crate::Options::map) for a table with these columns; [`suggested`](crate::suggested) makes a
    /// proposal.
    Map(Vec<String>),
    /// [`Options::map`](crate::Options::map) with the column of times, for a table with these columns.
    TimeColumn(Vec<String>),
}
