//! Contacts: the tips of a robot on a floating base that the surroundings hold, such as a foot on the ground.

/// A tip that is held by something outside the robot: an entry of `contacts` in a robot file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The tip, as an index into the list `tips`.
    pub tip: usize,
    /// The motion of the tip that is held.
    pub kind: ContactKind,
}

/// The motion of a tip that is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// The origin of the tip is held; the tip can turn about this point.
    Point,
    /// The origin and the orientation of the tip are held.
    Weld,
}

impl Contact {
    /// The number that the equations of contacts add to each diagonal element of J M⁻¹ Jᵀ, in 1/kg for forces and 1/(kg
    /// m²) for moments. With it, the forces are finite even where the contacts hold more motions than the robot has:
    /// they are nearly those with the smallest sum of squares. A tip under a force of 100 N accelerates with 1e-6 m/s²
    /// instead of 0.
    pub const DAMPING: f64 = 1e-8;

    /// Returns how many accelerations of the tip are zero: 3 are those along x, y and z; 6 add those about x, y and z.
    #[must_use]
    pub const fn rows(self) -> usize {
        match self.kind {
            ContactKind::Point => 3,
            ContactKind::Weld => 6,
        }
    }
}

impl ContactKind {
    /// All kinds of contacts, with their words in robot files.
    pub const WORDS: [(&'static str, Self); 2] = [("point", Self::Point), ("weld", Self::Weld)];

    /// Returns the word of this kind of contact in robot files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Weld => "weld",
        }
    }
}
