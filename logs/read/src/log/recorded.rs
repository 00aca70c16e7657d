//! Reads all states of a log as they were recorded, without a filter.

use crate::columns::quantity::Quantity;
use crate::log::motions::check_units;
use crate::log::pass::Pass;
use crate::log::survey::Survey;
use crate::{Log, LogError};

impl Log {
    /// Reads the log again and returns its states one by one as they were recorded: no filter changes a number, no
    /// state is interpolated, and the ends of runs are kept.
    ///
    /// # Errors
    ///
    /// If a file cannot be read; if positions may be degrees and the options do not specify the unit; if efforts are
    /// currents and the options have no torque constants.
    pub fn recorded(&self, survey: &Survey) -> Result<Recorded<'_>, LogError> {
        check_units(self, survey)?;
        Ok(Recorded { log: self, pass: self.pass()?, begun: 0 })
    }
}

/// The states of a log as they were recorded.
pub struct Recorded<'a> {
    log: &'a Log,
    pass: Pass<'a>,
    /// Number of runs that have begun.
    begun: u64,
}

/// A state as it was recorded, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedState<'a> {
    /// The number of the run, from 0, as in [`Survey::runs`].
    pub run: u64,
    /// The time stamp, ns, in the log's own time.
    pub stamp: i64,
    /// The time since [`Layout::origin`](crate::Layout::origin), s.
    pub time: f64,
    /// Positions by joint, rad or m.
    pub q: &'a [f64],
    /// Velocities by joint, rad/s or m/s; empty if the log has none.
    pub qd: &'a [f64],
    /// Torques or forces by joint, N m or N; empty if the log has none.
    pub tau: &'a [f64],
}

impl std::fmt::Debug for Recorded<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Recorded").field("begun", &self.begun).finish_non_exhaustive()
    }
}

impl Recorded<'_> {
    /// Reads the next state; `None` at the end of the log.
    ///
    /// # Errors
    ///
    /// If a file cannot be read.
    #[expect(clippy::cast_precision_loss, reason = "a quarter of a ns after a month")]
    pub fn read(&mut self) -> Result<Option<RecordedState<'_>>, LogError> {
        let Some((state, begins)) = self.pass.next()? else { return Ok(None) };
        self.begun += u64::from(begins.is_some());
        let layout = &self.log.layout;
        let numbers = |quantity| &state.numbers[layout.places(quantity)];
        Ok(Some(RecordedState {
            run: self.begun.saturating_sub(1),
            stamp: state.time,
            // a division instead of a multiplication by 1e-9, so that 0.12 s gives exactly the number 0.12
            time: state.time.saturating_sub(layout.origin) as f64 / 1e9,
            q: numbers(Quantity::Position),
            qd: numbers(Quantity::Velocity),
            tau: numbers(Quantity::Effort),
        }))
    }

    /// Returns the fraction of the log that was read, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.pass.progress()
    }
}
