//! Reads placements of a robot file, and the lengths and angles in them.

use crate::readers::names::carrier;
use crate::readers::varying::{entry, fixed};
use crate::text::decode::{Context, list, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::{Angle, Entry, FixedFrame, LARGEST_ANGLE, Transform, lints::single_value};

pub(crate) fn transform(cx: &Context, node: &Node, place: fn(usize) -> Entry) -> Option<Transform> {
    read_mapping!(cx, node, "a placement", {
        xyz: or([0.0; 3]) "xyz" |cx, node| position(cx, node, place),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Transform { xyz, rpy })
}

/// Reads the placement of the tip frame on its link; [`tree`] reads which link that is.
pub(crate) fn tool(cx: &Context, node: &Node) -> Option<Transform> {
    read_mapping!(cx, node, "`tool`", {
        _on: optional "on" |_, _| Some(()),
        xyz: or([0.0; 3]) "xyz" |cx, node| position(cx, node, Entry::ToolXyz),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Transform { xyz, rpy })
}

/// Reads a placement that run-time parameters do not change.
pub(crate) fn fixed_transform(cx: &Context, node: &Node) -> Option<Transform> {
    read_mapping!(cx, node, "a placement", {
        xyz: or([0.0; 3]) "xyz" fixed_position,
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Transform { xyz, rpy })
}

/// Reads one end of a loop: a link, and the place of the cut joint on it.
pub(crate) fn end_of_loop(cx: &Context, node: &Node, names: &[String]) -> Option<FixedFrame> {
    read_mapping!(cx, node, "an end of a loop", {
        on: required "on" |cx, node| carrier(cx, node, names, "on"),
        xyz: or([0.0; 3]) "xyz" fixed_position,
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(FixedFrame { on, placement: Transform { xyz, rpy } })
}

/// Reads a point that run-time parameters do not change.
fn fixed_position(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, _| fixed_length(cx, node))
}

/// Reads a length that run-time parameters do not change.
pub(crate) fn fixed_length(cx: &Context, node: &Node) -> Option<f64> {
    let value = fixed("the length")(cx, node)?;
    single_value::length(cx, node, value);
    Some(value)
}

pub(crate) fn roll_pitch_yaw(cx: &Context, node: &Node) -> Option<[Angle; 3]> {
    let angles = list(cx, node, "[roll, pitch, yaw] (rad)", |cx, node, _| angle(cx, node))?;
    Some(angles.map(Angle::new))
}

pub(crate) fn angle(cx: &Context, node: &Node) -> Option<f64> {
    let value = fixed("the angle")(cx, node)?;
    if value.abs() >= LARGEST_ANGLE {
        let shown = cx.shown(node, value);
        let message = format!(
            "the angle {shown} rad is too large; angles must be below {LARGEST_ANGLE} rad, because a 64-bit float \
             stores larger angles in steps of more than 1e-9 rad"
        );
        return cx.refuse(Diagnostic::error(node.span.clone(), message).help("subtract whole turns from the angle"));
    }
    single_value::angle(cx, node, value);
    Some(value)
}

pub(crate) fn length(place: Entry) -> impl Fn(&Context, &Node) -> Option<f64> {
    move |cx, node| {
        let value = entry(place)(cx, node)?;
        single_value::length(cx, node, value);
        Some(value)
    }
}

/// Reads a point or a displacement; `place` returns the entry of the table for each component.
pub(crate) fn position(cx: &Context, node: &Node, place: impl Fn(usize) -> Entry) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, axis| length(place(axis))(cx, node))
}
