//! Options for reading a log.

use crate::{Mapping, TimeUnit};

/// Options for reading a log: facts that the log does not contain. `Options::default()` means radians, torques, the
/// only topic, and a cut-off from the spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Names of the joints to read, base to tip; `None` for all joints in the order of the log. Other joints of the log
    /// are ignored and listed.
    pub joints: Option<Vec<String>>,
    /// The topic of a bag, or the prefix of the names of the columns of a table.
    pub topic: Option<String>,
    /// Factors of efforts that are currents, N m/A or N/A: one number for all joints or one per joint. Efforts are not
    /// multiplied if the name of their column gives a torque or a force. If empty, efforts are torques.
    pub torque_constants: Vec<f64>,
    /// The unit of positions and velocities; in a table, only of columns without a unit in their names.
    pub angles: Angles,
    /// For each joint that is read, base to tip, whether it is prismatic, so that its positions are lengths, whatever
    /// `angles` is. If empty, the kinds are unknown, and `angles` applies to all joints.
    pub slides: Vec<bool>,
    /// Longest interval that is no gap, in median intervals, 1.5 to 1000. The default is 3.5: two lost samples are not
    /// a gap.
    pub gap: f64,
    /// The cut-off of the filter, Hz; `None` to determine it from the spectrum.
    pub cutoff: Option<f64>,
    /// Whether states with a spike of an effort ([`Survey::spikes`](crate::Survey)) are left out.
    pub leave_out_spikes: bool,
    /// Whether velocities are derived from positions, even if the log has measured velocities.
    pub derive_velocities: bool,
    /// Whether times of recording are used, even if messages have times of measurement.
    pub recorded: bool,
    /// The unit of a column of times. `None` for the unit in the column's name or type or, without one, s; but a log is
    /// refused if its samples would then be half a second or more apart.
    pub time_unit: Option<TimeUnit>,
    /// Rows per second of a table without times.
    pub rate: Option<f64>,
    /// Quantities of the columns of an array in their order: `time`, `q`, `qd`, `tau`. Each, except `time`, has one
    /// column for every joint. If empty, all of these. Formats with names of columns refuse this option.
    pub columns: Vec<String>,
    /// Pairs of a column of a table and a text: only rows that have all these texts in their columns are read.
    pub select: Vec<(String, String)>,
    /// Meanings of columns of a table, which take precedence over their names. Arrays and bags refuse them.
    pub map: Vec<Mapping>,
}

impl Options {
    /// Whether a joint, given by its index among those that are read, is known to be prismatic.
    pub(crate) fn is_slide(&self, joint: usize) -> bool {
        self.slides.get(joint).copied().unwrap_or(false)
    }
}

/// The unit of positions and velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angles {
    /// Not given: rad, and positions with a range of more than 4π are refused.
    #[default]
    Unsaid,
    /// rad and rad/s, whatever the range.
    Radians,
    /// ° and °/s for every joint that is not known to be prismatic.
    Degrees,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            joints: None,
            topic: None,
            torque_constants: Vec::new(),
            angles: Angles::Unsaid,
            slides: Vec::new(),
            gap: 3.5,
            cutoff: None,
            leave_out_spikes: false,
            derive_velocities: false,
            recorded: false,
            time_unit: None,
            rate: None,
            columns: Vec::new(),
            select: Vec::new(),
            map: Vec::new(),
        }
    }
}
