//! The quantities of a joint: position, velocity, effort or acceleration.

/// A quantity of a joint in a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Position, rad or m.
    Position,
    /// Velocity, rad/s or m/s.
    Velocity,
    /// Torque, N m, force, N, or current, A.
    Effort,
    /// Acceleration, rad/s² or m/s². It is read only from a column of a [`Mapping`](crate::Mapping); otherwise it is
    /// derived.
    Acceleration,
}

impl Quantity {
    /// All quantities, in the order of the numbers of a state.
    pub const ALL: [Self; 4] = [Self::Position, Self::Velocity, Self::Effort, Self::Acceleration];

    /// Returns the word for the quantity, as in `elbow.position`.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Effort => "effort",
            Self::Acceleration => "acceleration",
        }
    }

    /// Returns the plural of the word, as in "positions of all joints".
    #[must_use]
    pub const fn plural(self) -> &'static str {
        match self {
            Self::Position => "positions",
            Self::Velocity => "velocities",
            Self::Effort => "efforts",
            Self::Acceleration => "accelerations",
        }
    }
}
