//! Reads the list `joints` of a robot file: names, types and rows.

use std::collections::HashMap;

use crate::parts::frame::BASE;
use crate::readers::limits::limits;
use crate::readers::link::link;
use crate::readers::motor::motor;
use crate::readers::names::taken;
use crate::readers::placement::{angle, fixed_length, fixed_transform, length};
use crate::readers::texts::text_of_one_line;
use crate::text::decode::{Context, choice, read_mapping};
use crate::text::diagnostic::Diagnostic;
use crate::text::document;
use crate::text::document::{Content, MAX_JOINTS, Node};
use crate::text::source::{one_line, quoted};
use crate::{
    Angle, Dh, Entry, FixedFrame, Inertia, InertiaReference, Joint, JointKind, Limits, Link, Row, Transform,
    lints::single_value,
};

pub(crate) fn joints(cx: &Context, node: &Node) -> Option<Vec<Joint>> {
    let Content::Sequence(items) = &node.content else {
        let message = format!("found {} where a list of joints is needed", node.described());
        let help = "begin each joint with a dash, such as `- type: revolute`; joints are not numbered, because their \
                    order counts";
        return cx.refuse(Diagnostic::error(node.head(), message).label("a list of joints is needed").help(help));
    };
    if items.is_empty() {
        let message = "the robot has no joints; 1 to 64 joints are allowed";
        return cx.refuse(Diagnostic::error(node.span.clone(), message).help("list the joints from base to tip"));
    }
    if let Some(excess) = items.get(MAX_JOINTS) {
        let message = format!("{} joints; 1 to {MAX_JOINTS} joints are allowed", items.len());
        return cx.refuse(Diagnostic::error(excess.head(), message).label(format!("joint {}", MAX_JOINTS + 1)));
    }
    let joints: Vec<Option<Joint>> = items.iter().enumerate().map(|(index, item)| joint(cx, item, index)).collect();
    let mut known = HashMap::new();
    let mut unique = true;
    for (index, (item, joint)) in items.iter().zip(&joints).enumerate() {
        let Some(joint) = joint else { continue };
        if let Some(first) = known.insert(joint.name.clone(), index) {
            unique = false;
            cx.report(taken(item, &joint.name, "joint", [index, first], "joint names"));
        }
    }
    let joints = joints.into_iter().collect::<Option<Vec<Joint>>>()?;
    unique.then_some(joints)
}

/// Returns an error with help for a joint that is below a number or a name, such as `- 1: {type: …}`; `None` for any
/// other item.
fn wrapped_joint(node: &Node) -> Option<Diagnostic> {
    let Content::Mapping(entries) = &node.content else { return None };
    let [document::Entry { key, key_span, value }] = entries.as_slice() else { return None };
    value.get("type").or_else(|| value.get("dh"))?;
    let message =
        format!("the joint is below a key {}, but the list item must begin with the keys of the joint", quoted(key));
    let help = if key.chars().all(|c| c.is_ascii_digit()) {
        format!(
            "joints are not numbered, because their order counts: delete `{key}:`, so that the joint begins with `- \
             type: …`"
        )
    } else {
        format!("write `- name: {}`, and below that `type`, `dh` and the other keys", one_line(key))
    };
    Some(Diagnostic::error(key_span.clone(), message).label("not here").help(help))
}

/// Reads the joint with this index, from 0.
fn joint(cx: &Context, node: &Node, index: usize) -> Option<Joint> {
    if let Some(mistake) = wrapped_joint(node) {
        return cx.refuse(mistake);
    }
    read_mapping!(cx, node, "a joint", {
        name: or(format!("joint{}", index + 1)) "name" joint_name,
        _parent: optional "parent" |_, _| Some(()),
        at: optional "at" fixed_transform,
        kind: required "type" joint_kind,
        dh: required "dh" |cx, node| dh(cx, node, index),
        link: or((Link::default(), (Inertia::default(), InertiaReference::Com))) "link"
            |cx, node| link(cx, node, index),
        limits: or(Limits::default()) "limits" limits,
        motor: optional "motor" |cx, node| motor(cx, node, index),
    });
    if let Some(position) = node.get("limits").and_then(|limits| limits.get("position")) {
        single_value::position_limits(cx, position, kind, &limits);
    }
    let (link, written_inertia) = link;
    let (motor, [coulomb_width, coulomb_displacement]) =
        motor.map_or((None, [None; 2]), |(motor, changes)| (Some(motor), changes));
    let (dh, before) = dh;
    // `parent` is read later, so the joint is on the link of the row before for now
    let branch = at.or(before).map(|placement| FixedFrame { on: index.checked_sub(1), placement });
    let row = Row { kind, dh, link };
    Some(Joint {
        name,
        row,
        branch,
        written_inertia,
        limits,
        // `couplings` are read later, when all joints are known
        coupling: None,
        motor,
        coulomb_width,
        coulomb_displacement,
    })
}

fn joint_name(cx: &Context, node: &Node) -> Option<String> {
    let name = text_of_one_line(cx, node, "joint name")?;
    if name == BASE {
        let message = "the joint has the name `base`, which is the name of frame 0, too";
        let help = "rename the joint: readers take `base` for frame 0, and with `format: 2` `parent: base` is an error";
        cx.report(Diagnostic::lint(node.span.clone(), message).label("two meanings").help(help));
    }
    Some(name)
}

fn joint_kind(cx: &Context, node: &Node) -> Option<JointKind> {
    choice(cx, node, "joint type", &[("revolute", JointKind::Revolute), ("prismatic", JointKind::Prismatic)])
}

/// Reads a row of the table, and the placement Rz(gamma) Tz(b) before it if there is one.
fn dh(cx: &Context, node: &Node, joint: usize) -> Option<(Dh, Option<Transform>)> {
    read_mapping!(cx, node, "`dh`", {
        theta: required "theta" angle,
        d: required "d" length(Entry::D(joint)),
        a: required "a" length(Entry::A(joint)),
        alpha: required "alpha" angle,
        gamma: or(0.0) "gamma" angle,
        b: or(0.0) "b" fixed_length,
    });
    let before = Transform { xyz: [0.0, 0.0, b], rpy: [Angle::ZERO, Angle::ZERO, Angle::new(gamma)] };
    let before = (!before.is_identity()).then_some(before);
    Some((Dh { theta: Angle::new(theta), d, a, alpha: Angle::new(alpha) }, before))
}
