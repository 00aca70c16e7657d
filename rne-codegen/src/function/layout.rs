//! The shape of what a function returns.

/// How the numbers that a function returns are grouped, for any number of joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Number,
    /// So many of the same.
    Array(Length, &'static Self),
    /// Named parts.
    Record(Record, &'static [Self]),
}

/// The length of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// One element per joint.
    Joints,
    /// As many for every robot.
    Fixed(usize),
}

impl Shape {
    /// The shape for so many joints.
    #[must_use]
    pub fn layout(&self, dof: usize) -> Layout {
        match self {
            Self::Number => Layout::Number,
            Self::Array(Length::Joints, of) => Layout::Array(dof, Box::new(of.layout(dof))),
            Self::Array(Length::Fixed(length), of) => Layout::Array(*length, Box::new(of.layout(dof))),
            Self::Record(record, parts) => Layout::Record(*record, parts.iter().map(|part| part.layout(dof)).collect()),
        }
    }
}

/// How the numbers that a function returns are grouped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One number.
    Number,
    /// So many of the same.
    Array(usize, Box<Self>),
    /// Named parts.
    Record(Record, Vec<Self>),
}

/// The records that functions return.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// Rotation and translation.
    Pose,
    /// Force and moment.
    Wrench,
    /// By q and by q̇.
    TorqueDerivatives,
    /// M q̇ and its rate.
    MomentumAndRate,
}

impl Record {
    /// The name of its type.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pose => "Pose",
            Self::Wrench => "Wrench",
            Self::TorqueDerivatives => "TorqueDerivatives",
            Self::MomentumAndRate => "MomentumAndRate",
        }
    }

    /// The names of its parts.
    #[must_use]
    pub const fn fields(self) -> [&'static str; 2] {
        match self {
            Self::Pose => ["rotation", "translation"],
            Self::Wrench => ["force", "moment"],
            Self::TorqueDerivatives => ["dq", "dqd"],
            Self::MomentumAndRate => ["momentum", "rate"],
        }
    }
}

impl Layout {
    /// How many numbers there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Number => 1,
            Self::Array(length, of) => length * of.len(),
            Self::Record(_, parts) => parts.iter().map(Self::len).sum(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Puts numbers, in their order, into the shape: `array` and `record` join what their elements and parts became.
    pub fn fold<R>(
        &self,
        numbers: &mut impl Iterator<Item = R>,
        array: &impl Fn(Vec<R>) -> R,
        record: &impl Fn(Record, Vec<R>) -> R,
    ) -> Option<R> {
        match self {
            Self::Number => numbers.next(),
            Self::Array(length, of) => {
                (0..*length).map(|_| of.fold(numbers, array, record)).collect::<Option<_>>().map(array)
            }
            Self::Record(kind, parts) => {
                let parts = parts.iter().map(|part| part.fold(numbers, array, record)).collect::<Option<_>>();
                parts.map(|parts| record(*kind, parts))
            }
        }
    }
}
