//! A filtered run of states with accelerations: the input of identification and watching.

/// A filtered run without gaps: the states of a log between two interruptions, with accelerations.
///
/// Every list has a list per joint, base to tip, in the order of the robot file; each of those has as many numbers as
/// `time`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Times, s, increasing.
    pub time: Vec<f64>,
    /// Positions, rad or m.
    pub q: Vec<Vec<f64>>,
    /// Velocities, rad/s or m/s.
    pub qd: Vec<Vec<f64>>,
    /// Accelerations, rad/s² or m/s².
    pub qdd: Vec<Vec<f64>>,
    /// Torques or forces of the actuators, N m or N; empty if the log has no efforts.
    pub tau: Vec<Vec<f64>>,
    /// Torques or forces before the filter of [`Motions`](crate::Motions), N m or N; empty if they are unknown or equal
    /// to `tau`.
    pub recorded: Vec<Vec<f64>>,
}

impl Motion {
    /// Number of states.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no state.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }
}
