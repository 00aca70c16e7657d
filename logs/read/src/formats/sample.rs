//! A sample: the form into which a message or row of every format is read.

use crate::LogError;
use crate::columns::label::Label;
use crate::columns::unit::FileUnits;

/// One instant of a log: the joints of a message or a row, in their order there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sample {
    /// Time of measurement, from the header of the message or the column of times, ns.
    pub(crate) measured: i64,
    /// Time of recording, ns; equal to `measured` in formats without it.
    pub(crate) recorded: i64,
    /// The joints' names.
    pub(crate) names: Vec<String>,
    /// Positions by joint; empty if the message has none. Units are those of the file, or SI units if the file gives
    /// its units.
    pub(crate) position: Vec<f64>,
    /// Velocities by joint; empty if the message has none.
    pub(crate) velocity: Vec<f64>,
    /// Efforts by joint; empty if the message has none.
    pub(crate) effort: Vec<f64>,
    /// Accelerations by joint; empty if the message has none.
    pub(crate) acceleration: Vec<f64>,
}

impl Sample {
    /// Returns the approximate number of bytes of the sample in memory.
    pub(crate) fn size(&self) -> usize {
        let names: usize = self.names.iter().map(|name| name.len() + 32).sum();
        names
            + 8 * (self.position.len() + self.velocity.len() + self.effort.len() + self.acceleration.len())
            + size_of::<Self>()
    }
}

/// A reader of a file from beginning to end, with memory that does not grow with the file.
pub(crate) trait Source {
    /// Reads the next sample into `sample`; returns false at the end.
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError>;

    /// Returns the fraction of the file that was read, 0 to 1.
    fn progress(&self) -> f64;

    /// Returns remarks on the content of the file.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the names of columns that are not read, but which the user may want to read.
    fn unread(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the units that the file gives. Numbers with these units are converted to SI units.
    fn units(&self) -> FileUnits {
        FileUnits::default()
    }

    /// Whether the format, a type, a name or an option gives the unit of the times. Otherwise, they are taken as
    /// seconds.
    fn is_time_unit_known(&self) -> bool {
        true
    }

    /// Returns the names of columns by whose texts rows can be selected; empty if the format has no columns.
    fn label_columns(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns the names of those [`Source::label_columns`] that have words instead of numbers. It is known after the
    /// first row.
    fn word_columns(&self) -> Vec<String> {
        Vec::new()
    }

    /// Watches the texts of a column, given by its index in [`Source::label_columns`], from the first row on. If a text
    /// is wanted, only rows with this text are read.
    fn hold(&mut self, _column: usize, _wanted: Option<&str>) {}

    /// Returns the watched columns with the texts of the latest row.
    fn labels(&self) -> &[Label] {
        &[]
    }

    /// Returns the topic that is read, if the format has topics.
    fn topic(&self) -> Option<&str> {
        None
    }
}
