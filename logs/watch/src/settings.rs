//! Settings of the momentum observer and of contacts.

use crate::WatchError;

/// Settings of the momentum observer and of the detection of contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The gain of the momentum observer, Hz. A larger gain responds sooner, but with more noise.
    pub gain: f64,
    /// Shortest duration of an external torque that is an event, s.
    pub hold: f64,
    /// Largest rate of false alarms per hour of motion, of all joints together.
    pub false_alarms: f64,
}

impl Default for Settings {
    /// Returns a gain of 20 Hz, a hold of 5 ms, and one false alarm in a hundred hours.
    fn default() -> Self {
        Self { gain: 20.0, hold: 0.005, false_alarms: 0.01 }
    }
}

impl Settings {
    /// Checks that all settings are above zero.
    ///
    /// # Errors
    /// When a setting is not above zero.
    pub(crate) fn check(&self) -> Result<(), WatchError> {
        let all = [("the gain", self.gain), ("the hold", self.hold), ("the rate of false alarms", self.false_alarms)];
        match all.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((name, _)) => Err(WatchError::Setting(name)),
            None => Ok(()),
        }
    }
}
