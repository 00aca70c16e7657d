//! Reads the list `frames` of a robot file.

use crate::parts::frame::BASE;
use crate::readers::names::{at_most, carrier, joint_names, not_identifier, taken};
use crate::readers::placement::{position, roll_pitch_yaw};
use crate::text::decode::{Context, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{Angle, Entry, FixedFrame, Frame, Transform};

/// Largest number of frames in a file, more than a chain of 64 joints with three frames on each link has.
const MAX_FRAMES: usize = 256;

/// Reads the list `frames` of a robot file whose root is `root`.
pub(crate) fn frames(cx: &Context, node: &Node, root: &Node) -> Option<Vec<Frame>> {
    let Content::Sequence(items) = &node.content else {
        let message = format!("found {} where a list of frames is needed", node.described());
        let help = "begin each frame with a dash, such as `- {name: camera, on: joint6, xyz: [0, 0, 0.1]}`";
        return cx.refuse(Diagnostic::error(node.head(), message).label("a list of frames is needed").help(help));
    };
    at_most(cx, items, MAX_FRAMES, ["frame", "frames"])?;
    let joints = joint_names(root);
    let frames: Vec<Option<Frame>> =
        items.iter().enumerate().map(|(index, item)| frame(cx, item, index, &joints)).collect();
    let mut unique = true;
    for (index, (item, frame)) in items.iter().zip(&frames).enumerate() {
        let Some(frame) = frame else { continue };
        let first = frames[..index].iter().position(|known| known.as_ref().is_some_and(|it| it.name == frame.name));
        if let Some(first) = first {
            unique = false;
            cx.report(taken(item, &frame.name, "frame", [index, first], "the names of frames"));
        }
    }
    let frames = frames.into_iter().collect::<Option<Vec<_>>>()?;
    unique.then_some(frames)
}

/// Reads the frame with this index, from 0.
fn frame(cx: &Context, node: &Node, index: usize, joints: &[String]) -> Option<Frame> {
    read_mapping!(cx, node, "a frame", {
        name: required "name" |cx, node| frame_name(cx, node, joints),
        on: required "on" |cx, node| carrier(cx, node, joints, "on"),
        xyz: or([0.0; 3]) "xyz" |cx, node| position(cx, node, |axis| Entry::FrameXyz(index, axis)),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Frame { name, fixed: FixedFrame { on, placement: Transform { xyz, rpy } } })
}

fn frame_name(cx: &Context, node: &Node, joints: &[String]) -> Option<String> {
    let name = text(cx, node)?;
    let what = format!("the frame name {}", quoted(&name));
    let (message, help) = if let Some(message) = not_identifier(&name, &what) {
        (message, "the name is part of the names of generated functions, such as `jacobian_of_camera`".to_owned())
    } else if name == BASE {
        let message = "the frame name `base` is already the name of frame 0; choose another name";
        (message.to_owned(), "write `on: base` for a frame that is fixed to frame 0".to_owned())
    } else if cx.base_name.borrow().as_ref() == Some(&name) {
        let message = format!("{what} is already the name of the floating base");
        (message, "choose another name; the floating base's name is also the name of frame 0".to_owned())
    } else if let Some(joint) = joints.iter().position(|joint| *joint == name) {
        let message =
            format!("{what} is already the name of joint {}; the names of frames and joints must differ", joint + 1);
        (message, format!("the name of joint {} is also the name of its link frame", joint + 1))
    } else {
        return Some(name);
    };
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("choose another name").help(help))
}
