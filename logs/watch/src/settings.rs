//! Settings of watching.

use crate::WatchError;

/// Settings of watching.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The gain of the momentum observer, Hz: larger sees sooner, and more noise.
    pub gain: f64,
    /// Shortest duration of an external torque that is an event, s.
    pub hold: f64,
    /// False alarms per hour of motion, at most, of all joints and tests together.
    pub false_alarms: f64,
}

impl Default for Settings {
    /// 20 Hz, 5 ms, one false alarm in a hundred hours.
    fn default() -> Self {
        Self { gain: 20.0, hold: 0.005, false_alarms: 0.01 }
    }
}

impl Settings {
    /// # Errors
    /// When one is not above zero.
    pub(crate) fn check(&self) -> Result<(), WatchError> {
        let all = [("the gain", self.gain), ("the hold", self.hold), ("the rate of false alarms", self.false_alarms)];
        match all.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((name, _)) => Err(WatchError::Setting(name)),
            None => Ok(()),
        }
    }
}
