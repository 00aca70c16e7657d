//! Computes the named frames of a table from the frames of a chain.

use std::collections::BTreeSet;

use rne_model::{Angle, FixedFrame, Frame, Robot, Transform};

use crate::chain::{Chain, ChainFrame};
use crate::geometry::{Pose, Vector};
use crate::table::Table;

/// Converts the frames of a chain to frames of a robot file, whose placements refer to the link frames of the table.
pub(crate) fn named_frames(chain: &Chain, table: &Table) -> Vec<Frame> {
    let frame = |ChainFrame { name, on, place }: &ChainFrame| {
        let link = on.map_or(table.start, |joint| table.frames[joint]);
        let placement = transform(link.inverse() * *place);
        Frame { name: name.clone(), fixed: FixedFrame { on: *on, placement } }
    };
    chain.frames.iter().map(frame).collect()
}

/// Renames frames so that a robot file accepts them: as identifiers that differ from the base, the joints and each
/// other.
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

/// Converts the name of a link to an identifier; `prefix` is put before a name that does not begin with a letter.
pub(crate) fn as_identifier(name: &str, prefix: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("{prefix}{name}") }
}

/// Converts a pose to a placement of a robot file.
pub(crate) fn transform(pose: Pose) -> Transform {
    let size = |v: Vector| v.to_f64().into_iter().map(f64::abs).fold(1.0, f64::max);
    let xyz = pose.translation.rounded(size(pose.translation)).map(|x| if x.abs() < 1e-15 { 0.0 } else { x });
    Transform { xyz, rpy: pose.rotation.to_rpy().map(Angle::new) }
}
