//! A sample, into which every format is read: one message, or one row.

use crate::LogError;
use crate::columns::label::Label;
use crate::columns::unit::FileUnits;

/// One instant of a log: the joints of a message or a row, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sample {
    /// When it was measured, by the header of the message or the column of times, ns.
    pub(crate) measured: i64,
    /// When it was recorded, ns; formats that do not say have `measured` here.
    pub(crate) recorded: i64,
    /// The joints' names.
    pub(crate) names: Vec<String>,
    /// Positions by joint; empty where the message has none. Units are the file's, or of SI where it says them.
    pub(crate) position: Vec<f64>,
    /// Velocities by joint; empty where the message has none.
    pub(crate) velocity: Vec<f64>,
    /// Efforts by joint; empty where the message has none.
    pub(crate) effort: Vec<f64>,
    /// Accelerations by joint; empty where the message has none.
    pub(crate) acceleration: Vec<f64>,
}

impl Sample {
    /// Bytes that it takes, about.
    pub(crate) fn size(&self) -> usize {
        let names: usize = self.names.iter().map(|name| name.len() + 32).sum();
        names
            + 8 * (self.position.len() + self.velocity.len() + self.effort.len() + self.acceleration.len())
            + size_of::<Self>()
    }
}

/// A file that is read from its beginning to its end, in memory that does not grow with it.
pub(crate) trait Source {
    /// Reads the next sample in the place of the last; false at the end.
    fn read(&mut self, sample: &mut Sample) -> Result<bool, LogError>;

    /// How much of the file was read, 0 to 1.
    fn progress(&self) -> f64;

    /// Remarks on what was found.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// The names of columns that are not read and may be meant.
    fn unread(&self) -> Vec<String> {
        Vec::new()
    }

    /// The units that the file says; its numbers are in SI units there.
    fn units(&self) -> FileUnits {
        FileUnits::default()
    }

    /// Whether the format, a type, a name or an option says in which unit times are. Where nothing does, they are taken
    /// for seconds.
    fn is_time_unit_known(&self) -> bool {
        true
    }

    /// The names of columns by whose texts rows can be selected; empty where the format has no columns.
    fn label_columns(&self) -> Vec<String> {
        Vec::new()
    }

    /// The names of those of these columns that have words and no numbers, once a row was read.
    fn word_columns(&self) -> Vec<String> {
        Vec::new()
    }

    /// Holds the texts of a column, by its place among [`Source::label_columns`], from the first row on. Where a text
    /// is wanted, only the rows that have it are read.
    fn hold(&mut self, _column: usize, _wanted: Option<&str>) {}

    /// The columns whose texts are held, with those of the last row.
    fn labels(&self) -> &[Label] {
        &[]
    }

    /// The topic that is read, where the format has topics.
    fn topic(&self) -> Option<&str> {
        None
    }
}
