//! Named frames: places on the links of an arm, such as a camera, in addition to the tip.

use std::fmt;

use crate::text::source::quoted;
use crate::text::spelling::nearest_name;
use crate::{FixedFrame, Robot, Transform};

/// The name of frame 0 as a value of the key `on`.
pub(crate) const BASE: &str = "base";

/// A named frame of a robot file: an entry of its list `frames`.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The name of the frame, `[A-Za-z][A-Za-z0-9_]*`; no joint and no other frame has it.
    pub name: String,
    /// The link that carries the frame, and the placement of the frame on it.
    pub fixed: FixedFrame,
}

/// A frame that has a name: one of the list `frames`, or the link frame of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameId {
    /// The frame of [`Robot::frames`] with this index.
    Named(usize),
    /// The link frame of the joint with this index, from 0.
    Link(usize),
}

/// A name that is neither the name of a frame nor the name of a joint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFrame {
    /// The name that was asked for.
    pub name: String,
    /// The name of the robot.
    pub robot: String,
    /// The names of the named frames of the robot.
    pub frames: Vec<String>,
    /// The names of the joints of the robot, which are also the names of their link frames.
    pub joints: Vec<String>,
    /// Whether the name means frame 0, which no joint moves.
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
    /// Lists the names that exist, for a message.
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
    /// Returns the frame with this name: a frame of the list `frames`, or the link frame of the joint with this name.
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

    /// Lists the names of the frames of the robot, for a message.
    #[must_use]
    pub fn known_frames(&self) -> String {
        // no frame has an empty name, so this is an error that lists the names
        self.frame("").err().map_or_else(String::new, |unknown| unknown.known())
    }

    /// Returns every frame that has a name: first the list `frames` in the order of the file, then the link frames from
    /// base to tip.
    pub fn frame_ids(&self) -> impl Iterator<Item = FrameId> + use<> {
        (0..self.frames.len()).map(FrameId::Named).chain((0..self.joints.len()).map(FrameId::Link))
    }

    /// Returns the name of a frame.
    #[must_use]
    pub fn frame_name(&self, frame: FrameId) -> &str {
        match frame {
            FrameId::Named(index) => &self.frames[index].name,
            FrameId::Link(joint) => &self.joints[joint].name,
        }
    }

    /// Returns the link that carries a frame, and the placement of the frame on it.
    #[must_use]
    pub fn fixed_frame(&self, frame: FrameId) -> FixedFrame {
        match frame {
            FrameId::Named(index) => self.frames[index].fixed,
            FrameId::Link(joint) => FixedFrame { on: Some(joint), placement: Transform::IDENTITY },
        }
    }

    /// Returns the robot with its kinematic functions at a frame instead of the tip; [`Robot::at`] says which functions
    /// this changes.
    #[must_use]
    pub fn at_frame(self, frame: FrameId) -> Self {
        Self { at: Some(frame), ..self }
    }
}
