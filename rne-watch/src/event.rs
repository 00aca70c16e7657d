//! What is found.

use std::fmt;

/// Which test found an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Test {
    /// The momentum observer is beyond its threshold for longer than the hold.
    External,
    /// The residual has an offset.
    Offset,
    /// The residual has an offset in the direction of motion.
    Friction,
}

impl Test {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::External, Self::Offset, Self::Friction];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::External => "external",
            Self::Offset => "offset",
            Self::Friction => "friction",
        }
    }
}

impl fmt::Display for Test {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A stretch of a motion in which a joint is not what its model says.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// The joint, counted from 0.
    pub joint: usize,
    /// What found it.
    pub test: Test,
    /// Where it begins, s.
    pub start: f64,
    /// Where it ends, s: the end of the motion where it lasts.
    pub end: f64,
    /// Its largest deviation from the baseline, N m or N: of the observer (torque of the environment on the arm), or of
    /// the residual's mean over a block (measured less model; in the direction of motion for friction).
    pub peak: f64,
}
