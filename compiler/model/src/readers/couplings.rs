//! Reads the list `couplings` of a robot file.

use crate::readers::names::{joint_names, named, ratios};
use crate::readers::tree::items;
use crate::readers::varying::fixed;
use crate::text::decode::{Context, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::{quoted, six_digits};
use crate::{Coupling, Drive, Entry, Joint, JointKind, LARGEST_ANGLE, lints::single_value};

/// Reports limits of followers that have no effect: all limits of a follower of several joints, effort limits, and
/// position limits that the followed joint cannot satisfy.
pub(crate) fn lint_limits(cx: &Context, root: &Node, joints: &[Joint]) {
    let items = root.list("joints");
    for (item, joint) in items.iter().zip(joints) {
        let (Some(coupling), Some(node)) = (&joint.coupling, item.get("limits")) else { continue };
        let name = quoted(&joint.name);
        let Some((followed, of_followed)) = coupling.limits_of_followed(joint.limits) else {
            let message = format!("the limits of {name} limit no other joint, because it follows several joints");
            let help = "code and commands do not use these limits; check the position of this joint yourself";
            cx.report(Diagnostic::note(node.head(), message).label("limits of a follower").help(help));
            continue;
        };
        let (followed, other) = (&joints[followed].limits, quoted(&joints[followed].name));
        if let (Some((lower, upper)), Some((low, high))) = (followed.position, of_followed.position)
            && low.max(lower) > high.min(upper)
        {
            let [low, high] = [low, high].map(six_digits);
            let message = format!(
                "{name} is within its position limits where {other} is from {low} to {high}, but the limits of {other} \
                 allow no such position"
            );
            let help = "check the limits, the ratio and the offset; code and commands use the limits of the joint that \
                        is followed";
            cx.report(Diagnostic::lint(node.head(), message).label("no position is within both").help(help));
        }
        if joint.limits.effort.is_some() && followed.effort.is_none() {
            let message = format!("the effort limit of {name} limits no torque, because {name} follows {other}");
            let help = format!("write the limit of the torque that moves both into `limits` of {other}");
            cx.report(Diagnostic::note(node.head(), message).label("effort limit of a follower").help(help));
        }
    }
}

/// An entry of the list `couplings`, as the file writes it.
struct Written {
    joint: usize,
    coupling: Coupling,
}

/// Reads the list `couplings` of a file whose root is `root`, and gives each follower its coupling.
pub(crate) fn couplings(cx: &Context, root: &Node, format: u32, joints: &mut [Joint]) -> Option<()> {
    let help = "begin each coupling with a dash, such as `- {joint: finger_b, follows: {finger_a: 1}}`";
    let items = items(cx, root, ("couplings", format), "couplings", help)?;
    let names = joint_names(root);
    let written: Vec<_> = items.iter().map(|item| coupling(cx, item, &names, joints)).collect();
    let written = written.into_iter().collect::<Option<Vec<_>>>()?;
    let mut valid = true;
    let mut refused = |mistake: Diagnostic| {
        valid = false;
        cx.report(mistake);
    };
    for (index, (item, Written { joint, coupling })) in items.iter().zip(&written).enumerate() {
        let (name, place) = (quoted(&names[*joint]), item.get("joint").unwrap_or(item).span.clone());
        if written[..index].iter().any(|other| other.joint == *joint) {
            let help = "write all joints that it follows in one entry, such as `follows: {a: 1, b: -1}`";
            let message = format!("{name} has a coupling already; a joint has at most one");
            refused(Diagnostic::error(place, message).label("a second coupling").help(help));
        } else if let Some((followed, _)) =
            coupling.follows.iter().find(|(followed, _)| written.iter().any(|other| other.joint == *followed))
        {
            let message = if followed == joint {
                format!("the joint {name} follows itself")
            } else {
                let followed = quoted(&names[*followed]);
                format!("{name} follows {followed}, which follows other joints itself")
            };
            let place = item.get("follows").unwrap_or(item).span.clone();
            let help = "name joints that follow no other, and multiply the ratios";
            refused(Diagnostic::error(place, message).label("must be an independent joint").help(help));
        }
        if joints[*joint].motor.is_some() {
            let help = "delete `motor`, or write its numbers at a joint that the follower follows";
            let message = format!("the joint {name} has a `motor`, but it follows other joints, which move it");
            refused(Diagnostic::error(item.head(), message).label("a follower has no motor").help(help));
        }
        // the offset of a sliding joint is a length that is added to `d`; that of a joint that turns is an angle
        let meets_offset = joints[*joint].row.kind == JointKind::Prismatic && coupling.offset != 0.0;
        if meets_offset && cx.run_time.borrow().entries.iter().any(|(entry, _)| *entry == Entry::D(*joint)) {
            let message = format!("`d` of the joint {name} varies at run time, and its coupling has an `offset`");
            refused(Diagnostic::error(item.head(), message).help("add the offset to `d`, and delete `offset`"));
        }
    }
    valid.then(|| {
        for (item, Written { joint, coupling }) in items.iter().zip(written) {
            if let Some(offset) = item.get("offset") {
                match joints[joint].row.kind {
                    JointKind::Revolute => single_value::angle(cx, offset, coupling.offset),
                    JointKind::Prismatic => single_value::length(cx, offset, coupling.offset),
                }
            }
            joints[joint].coupling = Some(coupling);
        }
    })
}

fn coupling(cx: &Context, node: &Node, names: &[String], joints: &[Joint]) -> Option<Written> {
    const EXAMPLE: &str = "write the joints that it follows and their ratios, such as `follows: {finger_a: 1}`";
    read_mapping!(cx, node, "a coupling", {
        joint: required "joint" |cx, node| {
            let name = text(cx, node)?;
            named(cx, &name, node.span.clone(), names, "joint")
        },
        follows: required "follows" |cx, node| ratios(cx, node, names, "follows", EXAMPLE),
        offset: or(0.0) "offset" |cx, node| {
            let offset = fixed("the offset")(cx, node)?;
            if offset.abs() < LARGEST_ANGLE {
                return Some(offset);
            }
            let help = "write the offset in rad, less full turns, or in m";
            let message = format!("the offset is {offset:e}");
            cx.refuse(Diagnostic::error(node.span.clone(), message).label("too large").help(help))
        },
    });
    let mut follows = follows;
    follows.sort_by_key(|(joint, _)| *joint);
    // a joint whose own entry could not be read has no index in `joints`
    (joint < joints.len()).then_some(Written { joint, coupling: Coupling { follows, offset } })
}

/// Refuses couplings and the list `motors` where the caller takes only robots without them.
pub(crate) fn refuse(cx: &Context, root: &Node, joints: &[Joint], drives: &[Drive]) {
    if joints.iter().any(|joint| joint.coupling.is_some()) {
        let key = if root.has_entries("couplings") { "couplings" } else { "loops" };
        let place = root.get(key).unwrap_or(root).head();
        let message = "the robot has couplings, and joints that follow others are not supported here";
        let help = "the section What takes which robot of docs/robot-file.md lists the commands, derives and types \
                    that take couplings";
        cx.report(Diagnostic::error(place, message).label("couplings").help(help));
    }
    if !drives.is_empty() {
        let place = root.get("motors").unwrap_or(root).head();
        let message = "the robot has a list `motors`, which is not supported here";
        let help = "the section What takes which robot of docs/robot-file.md lists the commands, derives and types \
                    that take it; elsewhere, delete the list and give joints a `motor: {inertia: …, gear_ratio: …}`, \
                    which leaves out that the rotor turns with the link that carries it";
        cx.report(Diagnostic::error(place, message).label("motors").help(help));
    }
}
