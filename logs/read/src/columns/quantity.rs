//! Position, velocity, effort or acceleration.

/// A quantity of a joint in a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// rad or m
    Position,
    /// rad/s or m/s
    Velocity,
    /// N m or N, or a current in A
    Effort,
    /// rad/s² or m/s². It is read from a column of a [`Mapping`](crate::Mapping) alone; else it is derived.
    Acceleration,
}

impl Quantity {
    /// All of them, in the order of a state's numbers.
    pub const ALL: [Self; 4] = [Self::Position, Self::Velocity, Self::Effort, Self::Acceleration];

    /// The word for it, as in `elbow.position`.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Effort => "effort",
            Self::Acceleration => "acceleration",
        }
    }

    /// The word for several of them, as in "positions of all joints".
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
