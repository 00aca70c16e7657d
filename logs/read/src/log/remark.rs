//! Remarks on a log that a user has to know, as data.

use std::fmt;

use crate::log::pass::{Interruption, InvalidSample};
use crate::log::survey::{Run, Survey};
use crate::number::short;
use crate::spelling::listed;
use crate::{Counts, Log};

/// Smallest relative difference between measured velocities and differences of positions that is reported.
const DISAGREEMENT: f64 = 0.05;

/// A remark on a log. `Display` says it without the options of any interface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// A sentence on the file itself, such as units that were converted.
    File(String),
    /// Positions of a joint may be in degrees: no unit is given, and their range is wide.
    MayBeDegrees {
        /// The name of the joint in the log.
        joint: String,
        /// The range of the positions, rad, if they are in radians.
        range: f64,
    },
    /// Time goes back within a table, which may contain several logs.
    TimeGoesBack {
        /// How often time goes back.
        times: usize,
        /// The columns with words, which may name the log of a row.
        columns: Vec<String>,
    },
    /// Joints of the log that are not read.
    IgnoredJoints(Vec<String>),
    /// Measured velocities differ from the derivative of positions.
    VelocitiesDisagree {
        /// The name in the log of the joint whose velocities differ most.
        joint: String,
        /// Root mean square of the difference over root mean square of the derivative.
        share: f64,
    },
    /// A position keeps one value while the joint moves.
    PositionFrozen {
        /// The name of the joint in the log.
        joint: String,
        /// The times of the first and of the last sample with the value, s.
        times: [f64; 2],
    },
    /// No velocities of the log are read: they are derived from positions.
    VelocitiesDerived,
    /// Efforts of these joints are currents by the names of columns, and no torque constant is given.
    Currents(Vec<String>),
    /// Efforts of one or two samples that differ strongly from the samples before and after.
    Spikes {
        /// Number of spikes.
        count: usize,
        /// The name in the log of the joint with the first spike.
        joint: String,
        /// The effort of the first spike, N m or N.
        effort: f64,
        /// The time of the first spike, s.
        time: f64,
    },
    /// The log has no efforts.
    NoEfforts,
    /// Efforts are taken as torques, because nothing gives their unit.
    TakenForTorques,
}

impl Remark {
    /// Whether the remark is a warning: the result may be wrong because of it.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        match self {
            Self::File(_) | Self::IgnoredJoints(_) | Self::VelocitiesDerived | Self::TakenForTorques => false,
            Self::MayBeDegrees { .. }
            | Self::VelocitiesDisagree { .. }
            | Self::PositionFrozen { .. }
            | Self::Currents(_)
            | Self::TimeGoesBack { .. }
            | Self::Spikes { .. }
            | Self::NoEfforts => true,
        }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(text) => f.write_str(text),
            Self::MayBeDegrees { joint, range } => {
                write!(f, "positions of {joint} range over {range:.1}, more than 4π")
            }
            Self::TimeGoesBack { times, columns } => {
                let often = if *times == 1 { "once".to_owned() } else { format!("{times} times") };
                write!(f, "time goes back {often}: does the table contain several logs? ")?;
                match columns.as_slice() {
                    [one] => write!(f, "The column {one} may name them"),
                    several => write!(f, "The columns {} may name them", listed(several)),
                }
            }
            Self::IgnoredJoints(names) => write!(f, "joints of the log that are not read: {}", names.join(", ")),
            Self::VelocitiesDisagree { joint, share } if share.is_infinite() => write!(
                f,
                "the positions of {joint} do not change, and its measured velocity is not zero: its velocities may \
                 have a constant error"
            ),
            Self::VelocitiesDisagree { joint, share } => write!(
                f,
                "measured velocities differ from the derivative of positions by {:.0} % at {joint}: stamps may be \
                 wrong, or velocities are filtered or in another unit",
                share * 100.0
            ),
            Self::PositionFrozen { joint, times: [since, until] } => write!(
                f,
                "the position of {joint} keeps one value from {since:.1} s to {until:.1} s, although its velocity says \
                 that it moves: the channel is frozen, and every result of this log is wrong"
            ),
            Self::VelocitiesDerived => f.write_str("velocities are derived from positions"),
            Self::Currents(names) => {
                write!(f, "the names of columns say that efforts of {} are currents", names.join(", "))
            }
            Self::Spikes { count, joint, effort, time } => write!(
                f,
                "{count} {} of one or two samples: the first is {} of {joint} at {time:.3} s; an identification \
                 leaves such samples out",
                if *count == 1 { "effort is a spike" } else { "efforts are spikes" },
                short(*effort)
            ),
            Self::NoEfforts => f.write_str("the log has no efforts, so the motion has no torques"),
            Self::TakenForTorques => f.write_str("efforts are taken as torques, N m, or forces, N"),
        }
    }
}

/// Messages or rows of a log that are left out for one reason.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LeftOut {
    /// Number of messages or rows.
    pub count: u64,
    /// Why they are left out.
    pub reason: Reason,
    /// Whether they are rows of a table or an array, and not messages of a bag.
    pub are_rows: bool,
}

/// The reason for which a message or a row is not a state of the arm.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// It has none of the joints.
    OtherJoints,
    /// It lacks some of the joints.
    SomeJoints,
    /// It has no positions, or another number of them.
    NoPositions,
    /// It has no velocities, although others have.
    NoVelocities,
    /// It has no efforts, although others have.
    NoEfforts,
    /// It has the same time and numbers as the previous one.
    Repeated,
    /// A value in it is not a number.
    NotFinite {
        /// The first such value, and the name of its joint in the log.
        first: Option<(InvalidSample, String)>,
    },
}

impl LeftOut {
    /// Returns the reason in words, such as "without some of the joints".
    #[must_use]
    pub fn why(&self) -> String {
        let record = self.record();
        match &self.reason {
            Reason::OtherJoints => "of other joints".to_owned(),
            Reason::SomeJoints => "without some of the joints".to_owned(),
            Reason::NoPositions => "without positions, or with another number of them".to_owned(),
            Reason::NoVelocities => format!("without velocities, which other {record}s contain"),
            Reason::NoEfforts => format!("without efforts, which other {record}s contain"),
            Reason::Repeated => format!("that repeat the {record} before, with its time"),
            Reason::NotFinite { first } => {
                let what = "with a value that is not a number (NaN, infinite, empty, beyond 1e12)".to_owned();
                let Some((InvalidSample { message, time, quantity, value, .. }, joint)) = first else { return what };
                let value = short(*value);
                format!("{what}; the first is {record} {message} at {time:.3} s, {quantity} of {joint}: {value}")
            }
        }
    }

    /// Returns the word for one record, `row` or `message`.
    #[must_use]
    pub fn record(&self) -> &'static str {
        if self.are_rows { "row" } else { "message" }
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.count == 1 { "" } else { "s" };
        write!(f, "{} {}{plural} {}", self.count, self.record(), self.why())
    }
}

impl Log {
    /// Returns remarks on the log from its survey: first on the file and its motion, then on efforts.
    #[must_use]
    pub fn remarks(&self, survey: &Survey) -> Vec<Remark> {
        let layout = self.layout();
        let mut remarks: Vec<Remark> = layout.notes.iter().cloned().map(Remark::File).collect();
        if let Some((joint, range)) = survey.may_be_degrees(self) {
            remarks.push(Remark::MayBeDegrees { joint: layout.joints[joint].clone(), range });
        }
        let is_back = |run: &&Run| matches!(run.begins, Interruption::Reset { .. });
        let times = survey.runs.iter().filter(is_back).count();
        if times > 0 && !layout.word_columns.is_empty() && self.options.select.is_empty() {
            remarks.push(Remark::TimeGoesBack { times, columns: layout.word_columns.clone() });
        }
        if !layout.ignored.is_empty() {
            remarks.push(Remark::IgnoredJoints(layout.ignored.clone()));
        }
        for frozen in &survey.frozen_positions {
            let joint = layout.joints[frozen.joint].clone();
            remarks.push(Remark::PositionFrozen { joint, times: frozen.times });
        }
        let is_frozen = |joint: usize| survey.frozen_positions.iter().any(|frozen| frozen.joint == joint);
        let known = survey.disagreement.iter().enumerate().filter(|(joint, _)| !is_frozen(*joint));
        let worst = known.max_by(|a, b| a.1.total_cmp(b.1));
        if let Some((joint, share)) = worst.filter(|(_, share)| **share > DISAGREEMENT) {
            remarks.push(Remark::VelocitiesDisagree { joint: layout.joints[joint].clone(), share: *share });
        }
        if !layout.has_velocities {
            remarks.push(Remark::VelocitiesDerived);
        }
        let currents = self.unsaid_currents();
        if !currents.is_empty() {
            remarks.push(Remark::Currents(currents.iter().map(|&name| name.to_owned()).collect()));
        }
        if let Some(first) = survey.spikes.first() {
            let joint = layout.joints[first.joint].clone();
            let (count, effort, time) = (survey.spikes.len(), first.effort, first.time);
            remarks.push(Remark::Spikes { count, joint, effort, time });
        }
        let is_unsaid = !self.has_torque_constants() && layout.units.iter().any(|units| units.effort.is_none());
        if !layout.has_efforts {
            remarks.push(Remark::NoEfforts);
        } else if currents.is_empty() && is_unsaid {
            remarks.push(Remark::TakenForTorques);
        }
        remarks
    }

    /// Returns the numbers of messages or rows that are left out, by reason.
    #[must_use]
    pub fn left_out(&self, survey: &Survey) -> Vec<LeftOut> {
        let counts: &Counts = &survey.counts;
        let first = survey.invalid_sample.map(|first| (first, self.layout().joints[first.joint].clone()));
        let all = [
            (counts.of_others, Reason::OtherJoints),
            (counts.without_joints, Reason::SomeJoints),
            (counts.without_positions, Reason::NoPositions),
            (counts.without_velocities, Reason::NoVelocities),
            (counts.without_efforts, Reason::NoEfforts),
            (counts.repeats, Reason::Repeated),
            (counts.not_finite, Reason::NotFinite { first }),
        ];
        let are_rows = self.layout().format.has_rows();
        let all = all.into_iter().filter(|(count, _)| *count > 0);
        all.map(|(count, reason)| LeftOut { count, reason, are_rows }).collect()
    }
}
