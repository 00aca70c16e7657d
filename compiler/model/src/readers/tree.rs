//! Reads the tree of a robot file: which link carries each joint, where its row begins on this link, and which link
//! carries the tip.

use std::rc::Rc;

use crate::readers::names::{carrier, joint_names};
use crate::robot::parent;
use crate::text::decode::Context;
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{Convention, FixedFrame, Joint, Transform};

/// Finds the link that carries each joint, and writes it into `branch`; a joint that continues the row before it, as in
/// a chain, gets no branch. `joints` have the placements of their rows already. Returns the joint whose link carries
/// the tip, if it is not the last joint.
#[allow(clippy::option_option)] // the outer `None` is a reported mistake
pub(crate) fn branches(
    cx: &Context,
    root: &Node,
    (format, convention): (u32, Convention),
    joints: &mut [Joint],
) -> Option<Option<usize>> {
    let names = joint_names(root);
    let items = root.list("joints");
    let mut valid = true;
    for (index, (item, joint)) in items.iter().zip(joints.iter_mut()).enumerate() {
        let keys = keys(item);
        if let (1, Some((key, node))) = (format, keys.first()) {
            valid = false;
            cx.report(needs_format_2(key, node));
            continue;
        }
        let of_row = |key: &str| keys.iter().find(|(known, _)| *known == key).map(|(_, node)| *node);
        if let Some((key, node)) = keys.iter().find(|(key, _)| ["gamma", "b"].contains(key))
            && let Some(mistake) = misplaced(key, node, convention, of_row("at").is_some())
        {
            valid = false;
            cx.report(mistake);
            continue;
        }
        let on = match of_row("parent") {
            None => index.checked_sub(1),
            Some(node) => {
                let Some(on) = carrier_of_row(cx, node, &names, index) else {
                    valid = false;
                    continue;
                };
                on
            }
        };
        let placement = joint.branch.map_or(Transform::IDENTITY, |branch| branch.placement);
        let is_of_chain = on == index.checked_sub(1) && placement.is_identity();
        joint.branch = (!is_of_chain).then_some(FixedFrame { on, placement });
    }
    if !valid {
        return None;
    }
    tip(cx, root, format, &names, joints)
}

/// Returns the keys of a joint that need `format: 2`, because a chain has none of them.
fn keys(item: &Node) -> Vec<(&'static str, &Node)> {
    let of_joint = ["parent", "at"].map(|key| (key, item.get(key)));
    let of_row = ["gamma", "b"].map(|key| (key, item.get("dh").and_then(|dh| dh.get(key))));
    of_joint.into_iter().chain(of_row).filter_map(|(key, node)| Some((key, node?))).collect()
}

pub(crate) fn needs_format_2(key: &str, node: &Node) -> Diagnostic {
    let message = format!("the key `{key}` needs `format: 2`, and this file has `format: 1`");
    Diagnostic::error(node.head(), message)
        .label("not in `format: 1`")
        .help("write `format: 2` at the top of the file; everything else keeps its meaning")
}

/// Returns the items of a list that only files of `format: 2` may have; none where the file has no such list. `what` is
/// the word for the items.
pub(crate) fn items<'n>(
    cx: &Context,
    root: &'n Node,
    (key, format): (&str, u32),
    what: &str,
    help: &str,
) -> Option<&'n [Rc<Node>]> {
    let Some(node) = root.get(key) else { return Some(&[]) };
    if format == 1 {
        return cx.refuse(needs_format_2(key, node));
    }
    let Content::Sequence(items) = &node.content else {
        let needed = format!("a list of {what} is needed");
        let message = format!("found {} where {needed}", node.described());
        return cx.refuse(Diagnostic::error(node.head(), message).label(needed).help(help));
    };
    Some(items)
}

/// Returns an error for a `gamma` or a `b` in a row that cannot have it.
fn misplaced(key: &str, node: &Node, convention: Convention, has_placement: bool) -> Option<Diagnostic> {
    if convention == Convention::Standard {
        let message = format!("a standard row has no `{key}`, because its frame 0 is the link frame of its parent");
        let help = "write `at: {xyz: [0, 0, 0], rpy: [0, 0, 0]}` beside `dh`: the placement of the row's frame 0 in \
                    the link frame of the parent";
        return Some(Diagnostic::error(node.head(), message).label("for modified rows").help(help));
    }
    has_placement.then(|| {
        let message = format!("the joint has both `at` and `{key}`; each places the row on its parent, so delete one");
        Diagnostic::error(node.head(), message).help("`gamma` and `b` are the placement Rz(gamma) Tz(b)")
    })
}

/// Reads the link that carries the joint with this index: that of an earlier joint, or frame 0.
#[allow(clippy::option_option)] // the outer `None` is a reported mistake
fn carrier_of_row(cx: &Context, node: &Node, names: &[String], index: usize) -> Option<Option<usize>> {
    let on = carrier(cx, node, names, "parent")?;
    let Some(parent) = on.filter(|&parent| parent >= index) else { return Some(on) };
    let (message, help) = if parent == index {
        (
            format!("joint {} names itself as its parent", index + 1),
            "name the joint whose link carries this joint, or `base` for frame 0".to_owned(),
        )
    } else {
        let parent = names.get(parent).map(|name| quoted(name)).unwrap_or_default();
        (
            format!("the parent {parent} stands below joint {}; a joint must stand below its parent", index + 1),
            format!("move this joint below {parent}"),
        )
    };
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("not an earlier joint").help(help))
}

/// Reads the joint whose link carries the tip, if it is not the last joint.
#[allow(clippy::option_option)] // the outer `None` is a reported mistake
fn tip(cx: &Context, root: &Node, format: u32, names: &[String], joints: &[Joint]) -> Option<Option<usize>> {
    let tool = root.get("tool");
    let last = joints.len().checked_sub(1);
    if let Some(node) = tool.and_then(|tool| tool.get("on")) {
        if format == 1 {
            return cx.refuse(needs_format_2("on", node));
        }
        if let Some(on) = carrier(cx, node, names, "on")? {
            return Some(Some(on).filter(|_| Some(on) != last));
        }
        let message = "the tip cannot be on `base`; it must be on a link that a joint moves";
        let help = "name a joint, such as `on: joint6`";
        return cx.refuse(Diagnostic::error(node.span.clone(), message).help(help));
    }
    let carries = |joint: usize| (joint..joints.len()).any(|other| parent(joints, other) == Some(joint));
    let ends: Vec<&Joint> = joints.iter().enumerate().filter(|(at, _)| !carries(*at)).map(|(_, joint)| joint).collect();
    // without `tool` the first frame of `tips` is the tip, so it need not be named
    if ends.len() < 2 || (tool.is_none() && root.has_entries("tips")) {
        return Some(None);
    }
    let listed: Vec<_> = ends.iter().take(6).map(|joint| quoted(&joint.name)).collect();
    let rest = if ends.len() > 6 { ", and others" } else { "" };
    let message = format!(
        "the robot has {} ends ({}{rest}), and the file does not say which of them carries the tip",
        ends.len(),
        listed.join(", ")
    );
    let place = tool.or_else(|| root.get("joints")).unwrap_or(root).head();
    let help = format!(
        "write `tool: {{on: {}}}`, with `xyz` and `rpy` if the tip is not the link frame; `frames` names other places, \
         and `tips` those that carry wrenches",
        ends[0].name
    );
    cx.refuse(Diagnostic::error(place, message).label("`tool` must name a link").help(help))
}

/// Refuses a tree where the caller takes serial arms only. The error is at the first row that is not on the link of the
/// row before it, else at the tip, else at the first row that begins at a placement of its own.
pub(crate) fn refuse(cx: &Context, root: &Node, joints: &[Joint], tip_on: Option<usize>) {
    let items = root.list("joints");
    let branches = || items.iter().zip(joints).enumerate().filter(|(_, (_, joint))| joint.branch.is_some());
    let named = |index: usize, joint: &Joint| format!("joint {} ({})", index + 1, quoted(&joint.name));
    let fork = branches().find(|(index, _)| parent(joints, *index) != index.checked_sub(1));
    let of_fork = fork.map(|(index, (item, joint))| {
        let what = format!("{} is not on the link of the row before: the robot is a tree", named(index, joint));
        (item.get("parent").unwrap_or(item).head(), what)
    });
    let of_tip = tip_on.map(|_| {
        let on = root.get("tool").and_then(|tool| tool.get("on"));
        (on.unwrap_or(root).head(), "the tip is not on the last link: the robot is a tree".to_owned())
    });
    let of_placement = branches().next().map(|(index, (item, joint))| {
        let (key, node) = keys(item).pop().unwrap_or(("at", item));
        (node.head(), format!("{} begins at `{key}`, which only rows of trees have", named(index, joint)))
    });
    let Some((place, what)) = of_fork.or(of_tip).or(of_placement) else { return };
    let help = "the section What takes which robot of docs/robot-file.md lists the commands, derives and types that \
                take trees; the others take serial arms";
    let message = format!("{what}, and trees are not supported here");
    cx.report(Diagnostic::error(place, message).label("a tree").help(help));
}
