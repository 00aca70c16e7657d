//! Tips: the named frames of a robot that carry wrenches.

use crate::parts::tree::items;
use crate::text::decode::{Context, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{Entry, FixedFrame, Frame, Joint, Robot, Transform};

/// The name of the tip frame where the file has no list `tips`.
const TIP: &str = "tip";

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

/// Reads the list `tips` of a file whose root is `root`: the frames that carry wrenches, each counted from 0.
pub(crate) fn tips(cx: &Context, root: &Node, format: u32, frames: &[Frame]) -> Option<Vec<usize>> {
    if root.get("tips").is_none()
        && let Some(frame) = frames.iter().position(|frame| frame.name == TIP)
        && let Some(Content::Sequence(listed)) = root.get("frames").map(|node| &node.content)
        && let Some(node) = listed.get(frame).and_then(|frame| frame.get("name"))
    {
        let message = "the frame `tip` has the name of the tip of the robot, which is at its `tool`";
        let help = "choose another name, or write `tips: [tip]`: then wrenches at `tip` act at this frame";
        cx.report(Diagnostic::lint(node.span.clone(), message).label("two meanings").help(help));
    }
    let help = "write the names of the frames that carry wrenches, such as `tips: [left, right]`";
    let items = items(cx, root, ("tips", format), "names", help)?;
    let mut tips = Vec::new();
    for item in items {
        let place = || item.span.clone();
        let Some(name) = text(cx, item) else { continue };
        let mistake = match frames.iter().position(|frame| frame.name == name) {
            Some(tip) if tips.contains(&tip) => {
                let message = format!("{} is in the list twice; each tip carries one wrench", quoted(&name));
                Diagnostic::error(place(), message).label("a second time")
            }
            Some(tip) if frames[tip].fixed.on.is_none() => {
                let message =
                    format!("the tip {} is on `base`; a tip must be on a link that a joint moves", quoted(&name));
                Diagnostic::error(place(), message).label("on the base")
            }
            Some(tip) => {
                tips.push(tip);
                continue;
            }
            None => unknown(cx, place(), &name, frames),
        };
        cx.report(mistake);
    }
    (tips.len() == items.len()).then_some(tips)
}

fn unknown(cx: &Context, place: std::ops::Range<usize>, name: &str, frames: &[Frame]) -> Diagnostic {
    let listed = frames.iter().take(12).map(|frame| quoted(&frame.name)).collect::<Vec<_>>().join(", ");
    let known = match frames.len() {
        0 => "the file has no list `frames`".to_owned(),
        1..=12 => format!("its frames are {listed}"),
        _ => format!("its frames are {listed}, and others"),
    };
    let message = format!("`tips` names {}, which is no frame of this file; {known}", quoted(name));
    let help = cx.did_you_mean(name, frames.iter().map(|frame| frame.name.as_str())).map_or_else(
        || format!("add the frame to `frames`: `- {{name: {name}, on: JOINT, xyz: [0, 0, 0]}}`"),
        |meant| format!("did you mean {}?", quoted(meant)),
    );
    Diagnostic::error(place, message).label("no such frame").help(help)
}

/// The tip frame of a file that has `tips` and no `tool`: the first of them. Its link is returned, if it is not the
/// last one, with its place there.
#[allow(clippy::type_complexity)] // a link and a placement
pub(crate) fn first_tip(
    cx: &Context,
    frames: &[Frame],
    tips: &[usize],
    joints: &[Joint],
) -> Option<(Option<usize>, Transform)> {
    let &first = tips.first()?;
    let FixedFrame { on, placement } = frames.get(first)?.fixed;
    let mut run_time = cx.run_time.borrow_mut();
    let of_tool = run_time.entries.iter().filter_map(|(entry, formula)| match entry {
        Entry::FrameXyz(frame, axis) if *frame == first => Some((Entry::ToolXyz(*axis), formula.clone())),
        _ => None,
    });
    let of_tool: Vec<_> = of_tool.collect();
    run_time.entries.extend(of_tool);
    Some((on.filter(|&on| on + 1 != joints.len()), placement))
}
