//! Named frames of a table, from the frames of a chain.

use std::collections::BTreeSet;

use rne_model::{Angle, FixedFrame, Frame, Robot, Transform};

use crate::chain::{Chain, ChainFrame};
use crate::geometry::{Pose, Vector};
use crate::table::Table;

/// The frames of a chain as a robot file has them: from the link frames of the table.
pub(crate) fn named_frames(chain: &Chain, table: &Table) -> Vec<Frame> {
    let frame = |ChainFrame { name, on, place }: &ChainFrame| {
        let link = on.map_or(table.start, |joint| table.frames[joint]);
        let placement = transform(link.inverse() * *place);
        Frame { name: name.clone(), fixed: FixedFrame { on: *on, placement } }
    };
    chain.frames.iter().map(frame).collect()
}

/// Gives frames names that a robot file takes: identifiers, none of which is the name of the base, of a joint, or of
/// another frame.
pub(crate) fn as_identifiers(frames: Vec<ChainFrame>, robot: &Robot) -> Vec<ChainFrame> {
    let is_base = |name: &str| name == "base" || robot.floating_base.as_ref().is_some_and(|base| base.name == name);
    let is_reserved = |name: &str| is_base(name) || robot.joints.iter().any(|joint| joint.name == name);
    let mut taken = BTreeSet::new();
    let named = |frame: ChainFrame| {
        let mut name = as_identifier(&frame.name, "frame_");
        if is_reserved(&name) {
            name.push_str("_frame");
        }
        let free = (2..).map(|number| format!("{name}_{number}"));
        let name = std::iter::once(name.clone())
            .chain(free)
            .find(|name| !taken.contains(name) && !is_reserved(name))
            .unwrap_or_default();
        taken.insert(name.clone());
        ChainFrame { name, ..frame }
    };
    frames.into_iter().map(named).collect()
}

/// The name of a link as an identifier; `prefix` stands before one that begins with no letter.
pub(crate) fn as_identifier(name: &str, prefix: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("{prefix}{name}") }
}

/// A placement of the robot file.
pub(crate) fn transform(pose: Pose) -> Transform {
    let size = |v: Vector| v.to_f64().into_iter().map(f64::abs).fold(1.0, f64::max);
    let xyz = pose.translation.rounded(size(pose.translation)).map(|x| if x.abs() < 1e-15 { 0.0 } else { x });
    Transform { xyz, rpy: pose.rotation.to_rpy().map(Angle::new) }
}
