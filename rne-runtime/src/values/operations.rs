//! Operation counts of one evaluation.

/// Operations of one evaluation of a generated function. A subtraction counts as an addition, a negation is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Multiplications.
    pub mul: usize,
    /// Additions and subtractions.
    pub add: usize,
    /// Divisions.
    pub div: usize,
    /// Number of angles whose sine or cosine is used.
    pub sincos: usize,
    /// Statements, each a value with a name.
    pub statements: usize,
}

impl Operations {
    /// Multiplications and additions together.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.mul + self.add
    }
}
