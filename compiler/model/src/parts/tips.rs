//! Tips: the named frames of a robot that carry wrenches.

use crate::{Entry, FixedFrame, Robot};

/// The name of the tip frame where the file has no list `tips`.
pub(crate) const TIP: &str = "tip";

impl Robot {
    /// The frames that carry wrenches, in the order of these: those of the list `tips`, or the tip frame alone.
    #[must_use]
    pub fn wrench_frames(&self) -> Vec<FixedFrame> {
        if self.tips.is_empty() {
            return vec![self.tip()];
        }
        self.tips.iter().map(|&tip| self.frames[tip].fixed).collect()
    }

    /// The names of [`wrench_frames`](Self::wrench_frames): `tip` where the file has no list `tips`.
    #[must_use]
    pub fn tip_names(&self) -> Vec<&str> {
        if self.tips.is_empty() {
            return vec![TIP];
        }
        self.tips.iter().map(|&tip| self.frames[tip].name.as_str()).collect()
    }

    /// The message for a tip whose name has two meanings: the robot has no list `tips`, and a frame has the name `tip`.
    #[must_use]
    pub fn two_tips(&self, name: &str) -> Option<String> {
        let has_two = self.tips.is_empty() && name == TIP && self.frames.iter().any(|frame| frame.name == TIP);
        has_two.then(|| {
            format!(
                "`{TIP}` is the tip of {}, which is at its `tool`, and also a frame of its file; choose another name \
                 for the frame, or write `tips: [{TIP}]` into the robot file",
                self.name
            )
        })
    }

    /// How many frames carry wrenches.
    #[must_use]
    pub const fn tip_count(&self) -> usize {
        if self.tips.is_empty() { 1 } else { self.tips.len() }
    }

    /// The number of the table that a component of a tip's translation is: the tip as in
    /// [`wrench_frames`](Self::wrench_frames), and the axis.
    #[must_use]
    pub fn tip_entry(&self, tip: usize, axis: usize) -> Entry {
        self.tips.get(tip).map_or(Entry::ToolXyz(axis), |&frame| Entry::FrameXyz(frame, axis))
    }
}
