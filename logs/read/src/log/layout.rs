//! The content of a log.

use std::ops::Range;

use crate::columns::quantity::Quantity;
use crate::columns::unit::JointUnits;
use crate::formats::format::Format;

/// Content of a log, found from its first thousand messages.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[expect(clippy::struct_excessive_bools, reason = "each is a quantity that the log has, or not")]
pub struct Layout {
    /// Format of the first file.
    pub format: Format,
    /// The topic that is read, for a bag.
    pub topic: Option<String>,
    /// The names in the log of the joints that are read.
    pub joints: Vec<String>,
    /// The joints of the log that are not read.
    pub ignored: Vec<String>,
    /// Whether times are those of recording, because all times in the messages are equal, or because the options
    /// require it.
    pub recorded: bool,
    /// Whether the log has velocities. If so, messages without them are left out.
    pub has_velocities: bool,
    /// Whether the log has efforts. If so, messages without them are left out.
    pub has_efforts: bool,
    /// Whether the log has accelerations, which are read only by a [`Mapping`](crate::Mapping). Otherwise, they are
    /// derived.
    pub has_accelerations: bool,
    /// If the log has no efforts: the joints without any effort in the first thousand messages.
    pub without_efforts: Vec<String>,
    /// The median interval between states, s.
    pub step: f64,
    /// The origin of times, ns: the time of the log's first state, or 0 if the times in the log begin near zero.
    pub origin: i64,
    /// The units in the names of columns, for each joint.
    pub units: Vec<JointUnits>,
    /// The columns of a table that are not read: those that resemble columns of joints and, if no joint has a velocity
    /// or none has an effort, all others.
    pub unread: Vec<String>,
    /// The columns of a table with words instead of numbers, which may name the arm or the part of the log of a row.
    pub word_columns: Vec<String>,
    /// Remarks on the content of the file.
    pub notes: Vec<String>,
}

impl Layout {
    /// Returns the indices of a quantity in the numbers of a state: positions, then velocities, efforts and
    /// accelerations as far as the log has them.
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

    /// Returns the count of numbers in a state.
    pub(crate) fn width(&self) -> usize {
        self.places(Quantity::Acceleration).end
    }
}
