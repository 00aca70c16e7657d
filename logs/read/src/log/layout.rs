//! The content of a log.

use std::ops::Range;

use crate::columns::quantity::Quantity;
use crate::columns::unit::JointUnits;
use crate::formats::format::Format;

/// Content of a log, from its first thousand messages.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[expect(clippy::struct_excessive_bools, reason = "each is a quantity that the log has, or not")]
pub struct Layout {
    /// Format of the first file.
    pub format: Format,
    /// The topic of a bag.
    pub topic: Option<String>,
    /// The joints that are read, by the log's names.
    pub joints: Vec<String>,
    /// The joints of the log that are not read.
    pub ignored: Vec<String>,
    /// Times are those of recording: the messages' own are all equal, or the options say so.
    pub recorded: bool,
    /// Whether the log has velocities; states without them are left out then.
    pub has_velocities: bool,
    /// Whether the log has efforts; states without them are left out then.
    pub has_efforts: bool,
    /// Whether the log has accelerations, which only a [`Mapping`](crate::Mapping) names; else they are derived.
    pub has_accelerations: bool,
    /// Where it has none: the joints none of whose efforts is a number, of the first thousand messages.
    pub without_efforts: Vec<String>,
    /// The median interval, s.
    pub step: f64,
    /// The time of the log's first state, ns, which times are since; 0 where the log's own times begin near zero.
    pub origin: i64,
    /// The units that names of columns say, by joint.
    pub units: Vec<JointUnits>,
    /// The columns of a table that are not read: those like the columns of joints, and all others where no joint has a
    /// velocity, or none an effort.
    pub unread: Vec<String>,
    /// The columns of a table that have words and no numbers, which may say of which arm or part a row is.
    pub word_columns: Vec<String>,
    /// Remarks on what the file is.
    pub notes: Vec<String>,
}

impl Layout {
    /// Places of a quantity among the numbers of a state: positions, then velocities, efforts and accelerations as far
    /// as the log has them.
    pub(crate) fn places(&self, quantity: Quantity) -> Range<usize> {
        let has = |quantity| match quantity {
            Quantity::Position => true,
            Quantity::Velocity => self.has_velocities,
            Quantity::Effort => self.has_efforts,
            Quantity::Acceleration => self.has_accelerations,
        };
        let before = Quantity::ALL.into_iter().take_while(|other| *other != quantity).filter(|other| has(*other));
        let start = before.count() * self.joints.len();
        start..start + if has(quantity) { self.joints.len() } else { 0 }
    }

    /// How many numbers a state has.
    pub(crate) fn width(&self) -> usize {
        self.places(Quantity::Acceleration).end
    }
}
