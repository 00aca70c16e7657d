//! Events.

use std::fmt;

/// The test that found an event.
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
    /// All tests.
    pub const ALL: [Self; 3] = [Self::External, Self::Offset, Self::Friction];

    /// The name of the test.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::External => "external",
            Self::Offset => "offset",
            Self::Friction => "friction",
        }
    }
}

impl Test {
    /// The usual causes of its events.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::External => "a collision, a hand, a payload",
            Self::Offset => "a payload, a sensor's offset",
            Self::Friction => "wear, a brake, cold grease",
        }
    }
}

impl fmt::Display for Test {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A segment of a motion in which a joint is not what its model says.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// The joint, counted from 0.
    pub joint: usize,
    /// The test that found it.
    pub test: Test,
    /// The time at which it begins, s.
    pub start: f64,
    /// The time at which it ends, s: the end of the motion if it lasts until then.
    pub end: f64,
    /// Its largest deviation from the baseline, N m or N: of the observer, less what friction leaves open (torque of
    /// the environment on the arm, at least), or of the residual's means over half a second, or over all of it where it
    /// is shorter (measured less model; in the direction of motion for friction).
    pub peak: f64,
}

impl Event {
    /// Events of the same joint and test that are closer than `gap`, s, made one, by their beginnings.
    #[must_use]
    pub fn joined(mut events: Vec<Self>, gap: f64) -> Vec<Self> {
        events.sort_by(|a, b| (a.joint, a.test).cmp(&(b.joint, b.test)).then(a.start.total_cmp(&b.start)));
        let mut joined: Vec<Self> = Vec::with_capacity(events.len());
        for event in events {
            match joined.last_mut() {
                Some(last) if (last.joint, last.test) == (event.joint, event.test) && event.start - last.end <= gap => {
                    last.end = last.end.max(event.end);
                    last.peak = if event.peak.abs() > last.peak.abs() { event.peak } else { last.peak };
                }
                _ => joined.push(event),
            }
        }
        joined.sort_by(|a, b| a.start.total_cmp(&b.start).then((a.joint, a.test).cmp(&(b.joint, b.test))));
        joined
    }
}
