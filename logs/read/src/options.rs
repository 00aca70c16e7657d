//! Options of a log: facts that the log does not contain.

use crate::{Mapping, TimeUnit};

/// Options of a log: facts that the log does not contain. `Options::default()` means radians, torques, the only topic,
/// and a cut-off from the spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The joints to read, base to tip; without them all of the log in its order. Joints of the log that are not among
    /// them are ignored and listed.
    pub joints: Option<Vec<String>>,
    /// The topic of a bag, or how the columns' names of a table begin.
    pub topic: Option<String>,
    /// Factors of efforts that are currents, N m/A or N/A: one number for all joints or one per joint. Efforts of a
    /// column whose name gives a torque or a force are not multiplied. Empty: efforts are torques.
    pub torque_constants: Vec<f64>,
    /// The unit of positions and velocities, of a table those whose columns' names say none.
    pub angles: Angles,
    /// By joint that is read, base to tip, whether it slides: its positions are lengths then, whatever `angles` is.
    /// Empty: nobody knows, and `angles` is of all.
    pub slides: Vec<bool>,
    /// An interval of more steps than this is a gap, 1.5 to 1000. The default is 3.5: three samples that were lost are
    /// not a gap.
    pub gap: f64,
    /// The cut-off of the filter, Hz; without it the spectrum chooses.
    pub cutoff: Option<f64>,
    /// States with an effort that stands far out of those about it are left out: [`Survey::spikes`](crate::Survey).
    pub leave_out_spikes: bool,
    /// Velocities are the derivative of positions, also where the log has measured ones.
    pub derive_velocities: bool,
    /// Times are those of recording, also where messages have their own.
    pub recorded: bool,
    /// The unit of a column of times, or of an array's; without it what the column's name or type says, else s, unless
    /// samples are half a second or more apart then: such a log is refused.
    pub time_unit: Option<TimeUnit>,
    /// Rows per second of a table without times.
    pub rate: Option<f64>,
    /// Quantities of an array's columns, in order: `time`, `q`, `qd`, `tau`, each but the first for every joint.
    /// Empty: all of these. Other formats have names, and refuse it.
    pub columns: Vec<String>,
    /// Columns of a table and texts: only the rows that have each of these texts in its column are read.
    pub select: Vec<(String, String)>,
    /// Meanings of columns of a table, which take precedence over their names. Arrays and bags refuse them.
    pub map: Vec<Mapping>,
}

impl Options {
    /// Whether a joint, by its place among those that are read, is known to slide.
    pub(crate) fn is_slide(&self, joint: usize) -> bool {
        self.slides.get(joint).copied().unwrap_or(false)
    }
}

/// The unit of positions and velocities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angles {
    /// Nobody said: rad, and positions that range over more than 4π are refused.
    #[default]
    Unsaid,
    /// rad and rad/s, whatever the range
    Radians,
    /// ° and °/s, of every joint that is not known to slide
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
