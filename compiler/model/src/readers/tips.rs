//! Reads the list `tips` of a robot file.

use crate::parts::tips::TIP;
use crate::readers::tree::items;
use crate::text::decode::{Context, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{Entry, FixedFrame, Frame, Joint, Transform};

/// Reads the list `tips` of a file whose root is `root`. Returns the frames on which wrenches act, as indices into
/// `frames`.
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

/// Returns the tip frame of a file that has `tips` and no `tool`: the first of the tips. It is returned as the joint
/// that moves its link, or `None` for the last link, and its placement on this link.
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
