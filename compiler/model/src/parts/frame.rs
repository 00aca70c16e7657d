//! Named frames: places on the links of an arm, such as a camera, beside the tip.

use std::fmt;

use crate::text::decode::{Context, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, MAX_JOINTS, Node};
use crate::text::schema::{position, roll_pitch_yaw};
use crate::text::source::quoted;
use crate::text::spelling::nearest_name;
use crate::{Angle, Entry, FixedFrame, Robot, Transform};

/// Frames of a file. A chain of 64 joints with three frames on each link has fewer.
const MAX_FRAMES: usize = 256;

/// The name of frame 0 in `on`.
pub(crate) const BASE: &str = "base";

/// A named frame of a robot file: an entry of its list `frames`.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its name, `[A-Za-z][A-Za-z0-9_]*`; no joint and no other frame has it.
    pub name: String,
    /// The link that carries it, and its place there.
    pub fixed: FixedFrame,
}

/// A frame that has a name: one of the list `frames`, or the link frame of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameId {
    /// The frame of [`Robot::frames`] with this index.
    Named(usize),
    /// The link frame of the table that belongs to the joint with this index, from 0.
    Link(usize),
}

/// A name that is neither the name of a frame nor the name of a joint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFrame {
    /// The name that was asked for.
    pub name: String,
    /// The name of the robot.
    pub robot: String,
    /// The names of its frames.
    pub frames: Vec<String>,
    /// The names of its joints, which are the names of their link frames.
    pub joints: Vec<String>,
    /// Whether the name is that of frame 0, which no joint moves.
    pub is_base: bool,
}

impl fmt::Display for UnknownFrame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_base {
            return write!(
                f,
                "{} is the base of {}, and no frame of a link: {}",
                quoted(&self.name),
                self.robot,
                self.known()
            );
        }
        write!(f, "{} has no frame {}: {}", self.robot, quoted(&self.name), self.known())?;
        let known: Vec<&str> = self.frames.iter().chain(&self.joints).map(String::as_str).collect();
        match nearest_name(&self.name, &known) {
            Some(meant) => write!(f, "; did you mean {}?", quoted(meant)),
            None => Ok(()),
        }
    }
}

impl std::error::Error for UnknownFrame {}

impl UnknownFrame {
    /// The names that there are, in words.
    fn known(&self) -> String {
        let listed = |names: &[String]| names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        let frames = match self.frames.as_slice() {
            [] => "its file has no list `frames`".to_owned(),
            frames => format!("its frames are {}", listed(frames)),
        };
        format!("{frames}, and each joint names its link frame: {}", listed(&self.joints))
    }
}

impl Robot {
    /// The frame with this name: a frame of the list `frames`, or the link frame of the joint with this name.
    ///
    /// # Errors
    /// When neither a frame nor a joint has the name.
    pub fn frame(&self, name: &str) -> Result<FrameId, UnknownFrame> {
        let named = self.frames.iter().position(|frame| frame.name == name).map(FrameId::Named);
        let link = || self.joints.iter().position(|joint| joint.name == name).map(FrameId::Link);
        named.or_else(link).ok_or_else(|| UnknownFrame {
            name: name.to_owned(),
            robot: self.name.clone(),
            frames: self.frames.iter().map(|frame| frame.name.clone()).collect(),
            joints: self.joints.iter().map(|joint| joint.name.clone()).collect(),
            is_base: name == BASE || self.floating_base.as_ref().is_some_and(|base| base.name == name),
        })
    }

    /// The names of the frames that the robot has, in words.
    #[must_use]
    pub fn known_frames(&self) -> String {
        // no name is empty
        self.frame("").err().map_or_else(String::new, |unknown| unknown.known())
    }

    /// Every frame that has a name: first the list `frames` in the order of the file, then the link frames from base to
    /// tip.
    pub fn frame_ids(&self) -> impl Iterator<Item = FrameId> + use<> {
        (0..self.frames.len()).map(FrameId::Named).chain((0..self.joints.len()).map(FrameId::Link))
    }

    /// The name of a frame.
    #[must_use]
    pub fn frame_name(&self, frame: FrameId) -> &str {
        match frame {
            FrameId::Named(index) => &self.frames[index].name,
            FrameId::Link(joint) => &self.joints[joint].name,
        }
    }

    /// The link that carries a frame, and the place of the frame there.
    #[must_use]
    pub fn fixed_frame(&self, frame: FrameId) -> FixedFrame {
        match frame {
            FrameId::Named(index) => self.frames[index].fixed,
            FrameId::Link(joint) => FixedFrame { on: Some(joint), placement: Transform::IDENTITY },
        }
    }

    /// The arm as seen from a frame: [`Robot::at`] says which functions this changes.
    #[must_use]
    pub fn at_frame(self, frame: FrameId) -> Self {
        Self { at: Some(frame), ..self }
    }
}

/// The list `frames` of a robot file whose root is `root`.
pub(crate) fn frames(cx: &Context, node: &Node, root: &Node) -> Option<Vec<Frame>> {
    let Content::Sequence(items) = &node.content else {
        let message = format!("found {} where a list of frames is needed", node.described());
        let help = "begin each frame with a dash, such as `- {name: camera, on: joint6, xyz: [0, 0, 0.1]}`";
        return cx.refuse(Diagnostic::error(node.head(), message).label("a list of frames is needed").help(help));
    };
    if let Some(excess) = items.get(MAX_FRAMES) {
        let message = format!("{} frames; at most {MAX_FRAMES} frames are allowed", items.len());
        return cx.refuse(Diagnostic::error(excess.head(), message).label(format!("frame {}", MAX_FRAMES + 1)));
    }
    let joints = joint_names(root);
    let frames: Vec<Option<Frame>> =
        items.iter().enumerate().map(|(index, item)| frame(cx, item, index, &joints)).collect();
    let mut unique = true;
    for (index, (item, frame)) in items.iter().zip(&frames).enumerate() {
        let Some(frame) = frame else { continue };
        let first = frames[..index].iter().position(|known| known.as_ref().is_some_and(|it| it.name == frame.name));
        if let Some(first) = first {
            unique = false;
            let message = format!(
                "the name {} of frame {} is already the name of frame {}; the names of frames must differ",
                quoted(&frame.name),
                index + 1,
                first + 1
            );
            let span = item.get("name").map_or(item.head(), |name| name.span.clone());
            cx.report(Diagnostic::error(span, message).label("name taken"));
        }
    }
    let frames = frames.into_iter().collect::<Option<Vec<_>>>()?;
    unique.then_some(frames)
}

/// The names of the joints, whatever else is wrong with them.
pub(crate) fn joint_names(root: &Node) -> Vec<String> {
    let Some(Content::Sequence(items)) = root.get("joints").map(|joints| &joints.content) else { return Vec::new() };
    let name = |(index, joint): (usize, &std::rc::Rc<Node>)| match joint.get("name").map(|name| &name.content) {
        Some(Content::Scalar(scalar)) => scalar.text.trim_end().to_owned(),
        _ => format!("joint{}", index + 1),
    };
    items.iter().take(MAX_JOINTS).enumerate().map(name).collect()
}

/// The frame with this index, from 0.
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
    let is_identifier = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let (message, help) = if !is_identifier {
        let message = format!(
            "the frame name {} is not an identifier; it must be a letter from a to z or A to Z, then letters, digits \
             and `_`",
            quoted(&name)
        );
        (message, "the name is part of the names of generated functions, such as `jacobian_of_camera`".to_owned())
    } else if name == BASE {
        let message = "the frame name `base` is already the name of frame 0; choose another name";
        (message.to_owned(), "write `on: base` for a frame that is fixed to frame 0".to_owned())
    } else if cx.base_name.borrow().as_ref() == Some(&name) {
        let message = format!("the frame name {} is already the name of the floating base", quoted(&name));
        (message, "choose another name; the floating base's name is also the name of frame 0".to_owned())
    } else if let Some(joint) = joints.iter().position(|joint| *joint == name) {
        let message = format!(
            "the frame name {} is already the name of joint {}; the names of frames and joints must differ",
            quoted(&name),
            joint + 1
        );
        (message, format!("the name of joint {} is also the name of its link frame", joint + 1))
    } else {
        return Some(name);
    };
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("choose another name").help(help))
}

/// The joint that moves the link that the value of `key` names, from 0; `None` for frame 0.
#[allow(clippy::option_option)] // the outer `None` is a reported mistake
pub(crate) fn carrier(cx: &Context, node: &Node, joints: &[String], key: &str) -> Option<Option<usize>> {
    let name = text(cx, node)?;
    let joint = joints.iter().position(|joint| *joint == name);
    if name != BASE {
        if joint.is_some() {
            return Some(joint);
        }
        if cx.base_name.borrow().as_ref() == Some(&name) {
            return Some(None);
        }
        let listed = joints.iter().take(12).map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        let rest = if joints.len() > 12 { ", and the other joints of the file" } else { "" };
        let message = format!(
            "`{key}` names {}, which is no joint of this file; it must be `base` or the name of a joint: \
             {listed}{rest}",
            quoted(&name)
        );
        let number = name.parse::<usize>().ok().and_then(|number| joints.get(number.checked_sub(1)?));
        let help = match (number, cx.did_you_mean(&name, joints.iter().map(String::as_str).chain([BASE]))) {
            (Some(joint), _) => Some(format!("name the joint instead of its number: `{key}: {joint}`")),
            (None, Some(meant)) => Some(format!("did you mean {}?", quoted(meant))),
            (None, None) => None,
        };
        return cx.refuse(Diagnostic::error(node.span.clone(), message).label("no such joint").maybe_help(help));
    }
    let Some(joint) = joint else { return Some(None) };
    let message = format!("`{key}: base` means frame 0, but joint {} has the name `base`, too", joint + 1);
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("two meanings").help("rename the joint"))
}
