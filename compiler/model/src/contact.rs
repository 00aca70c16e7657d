//! Contacts: the tips of a robot on a floating base that something outside holds.

/// A tip that something outside the robot holds: `contacts` of a robot file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The tip, by its place in the list `tips`.
    pub tip: usize,
    /// The part of the tip that is held.
    pub kind: ContactKind,
}

/// The part of a tip that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// Its origin; the tip can turn about this point.
    Point,
    /// Its origin and its orientation.
    Weld,
}

impl Contact {
    /// The number that the equations of contacts add to each diagonal element of J M⁻¹ Jᵀ, in 1/kg for forces and 1/(kg
    /// m²) for moments. So contacts that hold more than a robot can move have finite forces: those with the smallest
    /// sum of squares, nearly. A tip under a force of 100 N accelerates with 1e-6 m/s² instead of 0.
    pub const DAMPING: f64 = 1e-8;

    /// How many accelerations are zero: the first of x, y, z and about x, y, z.
    #[must_use]
    pub const fn rows(self) -> usize {
        match self.kind {
            ContactKind::Point => 3,
            ContactKind::Weld => 6,
        }
    }
}

impl ContactKind {
    /// All of them, with their words in robot files.
    pub const WORDS: [(&'static str, Self); 2] = [("point", Self::Point), ("weld", Self::Weld)];

    /// Its word in robot files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Weld => "weld",
        }
    }
}
