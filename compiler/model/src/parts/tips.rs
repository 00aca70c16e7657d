//! Tips: the named frames of a robot on which wrenches act.

use crate::{Entry, FixedFrame, Robot};

/// The name of the tip frame where the file has no list `tips`.
pub(crate) const TIP: &str = "tip";

impl Robot {
    /// Returns the frames on which wrenches act, in the order of the wrenches: those of the list `tips`, or only the
    /// tip frame.
    #[must_use]
    pub fn wrench_frames(&self) -> Vec<FixedFrame> {
        if self.tips.is_empty() {
            return vec![self.tip()];
        }
        self.tips.iter().map(|&tip| self.frames[tip].fixed).collect()
    }

    /// Returns the names of the [`wrench_frames`](Self::wrench_frames): only `tip` where the file has no list `tips`.
    #[must_use]
    pub fn tip_names(&self) -> Vec<&str> {
        if self.tips.is_empty() {
            return vec![TIP];
        }
        self.tips.iter().map(|&tip| self.frames[tip].name.as_str()).collect()
    }

    /// Returns a message if the name of a tip is ambiguous: the robot has no list `tips`, and a frame has the name
    /// `tip`.
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

    /// Returns the number of frames on which wrenches act.
    #[must_use]
    pub const fn tip_count(&self) -> usize {
        if self.tips.is_empty() { 1 } else { self.tips.len() }
    }

    /// Returns which number of the table a component of a tip's translation is: `tip` is an index into
    /// [`wrench_frames`](Self::wrench_frames), `axis` is 0, 1, 2 for x, y, z.
    #[must_use]
    pub fn tip_entry(&self, tip: usize, axis: usize) -> Entry {
        self.tips.get(tip).map_or(Entry::ToolXyz(axis), |&frame| Entry::FrameXyz(frame, axis))
    }
}
