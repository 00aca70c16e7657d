//! Names of joints, and of the links that carry things, as other keys of a robot file refer to them.

use std::rc::Rc;

use crate::parts::frame::BASE;
use crate::readers::varying::fixed;
use crate::text::decode::{Context, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document;
use crate::text::document::{Content, MAX_JOINTS, Node};
use crate::text::source::quoted;

/// Reads the names of the joints even if other keys of the joints are wrong.
pub(crate) fn joint_names(root: &Node) -> Vec<String> {
    let name = |(index, joint): (usize, &Rc<Node>)| match joint.get("name").map(|name| &name.content) {
        Some(Content::Scalar(scalar)) => scalar.text.trim_end().to_owned(),
        _ => format!("joint{}", index + 1),
    };
    root.list("joints").iter().take(MAX_JOINTS).enumerate().map(name).collect()
}

/// Reads the name of a link from the value of `key`, and returns the joint that moves this link, from 0; `None` for
/// frame 0.
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
        let message = format!(
            "`{key}` names {}, which is no joint of this file; it must be `base` or the name of a joint: {}",
            quoted(&name),
            listed(joints)
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

/// Smallest and largest magnitude of a ratio: squares of larger ones, times an inertia, overflow in single precision.
const LEAST_RATIO: f64 = 1e-6;
const LARGEST_RATIO: f64 = 1e6;

/// Reads joints with their ratios from the value of `key`, in the order of the file.
pub(crate) fn ratios(
    cx: &Context,
    node: &Node,
    names: &[String],
    key: &'static str,
    example: &'static str,
) -> Option<Vec<(usize, f64)>> {
    let entries = match &node.content {
        Content::Mapping(entries) if !entries.is_empty() => entries,
        _ => {
            let message = format!("found {} where a mapping from joints to ratios is needed", node.described());
            return cx.refuse(Diagnostic::error(node.head(), message).help(example));
        }
    };
    let entry = |document::Entry { key: name, key_span, value }: &document::Entry| {
        let joint = named(cx, name, key_span.clone(), names, key);
        let ratio = fixed("the ratio")(cx, value)?;
        if ratio == 0.0 {
            let message = format!("the ratio {} is zero; a joint with ratio 0 has no effect here", quoted(name));
            return cx.refuse(Diagnostic::error(value.span.clone(), message).help("delete the entry"));
        }
        if !(LEAST_RATIO..=LARGEST_RATIO).contains(&ratio.abs()) {
            let message = format!("the ratio {} is {ratio:e}", quoted(name));
            let help = "a ratio is between 1e-6 and 1e6, or between -1e6 and -1e-6; check the units";
            return cx.refuse(Diagnostic::error(value.span.clone(), message).label("no gear has it").help(help));
        }
        Some((joint?, ratio))
    };
    let all: Vec<_> = entries.iter().map(entry).collect();
    all.into_iter().collect()
}

/// Returns the joint with this name, counted from 0, or reports that no joint has it.
pub(crate) fn named(
    cx: &Context,
    name: &str,
    span: std::ops::Range<usize>,
    names: &[String],
    key: &str,
) -> Option<usize> {
    if let Some(joint) = names.iter().position(|joint| joint == name) {
        return Some(joint);
    }
    let meant = cx.did_you_mean(name, names.iter().map(String::as_str));
    let (name, listed) = (quoted(name), listed(names));
    let message = format!("`{key}` names {name}, which is no joint of this file; its joints are {listed}");
    let help = meant.map(|meant| format!("did you mean {}?", quoted(meant)));
    cx.refuse(Diagnostic::error(span, message).label("no such joint").maybe_help(help))
}

/// Lists the names of the joints of a file, for a message.
fn listed(joints: &[String]) -> String {
    let listed = joints.iter().take(12).map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
    let rest = if joints.len() > 12 { ", and the other joints of the file" } else { "" };
    format!("{listed}{rest}")
}

/// Refuses a list of more than `most` items; `one` and `several` are the words for an item and for items.
pub(crate) fn at_most(cx: &Context, items: &[Rc<Node>], most: usize, [one, several]: [&str; 2]) -> Option<()> {
    let Some(excess) = items.get(most) else { return Some(()) };
    let message = format!("{} {several}; at most {most} {several} are allowed", items.len());
    cx.refuse(Diagnostic::error(excess.head(), message).label(format!("{one} {}", most + 1)))
}

/// Makes the error for an item whose name an earlier item already has. Both are counted from 0; `names` says in words
/// which names must differ.
pub(crate) fn taken(item: &Node, name: &str, what: &str, [index, first]: [usize; 2], names: &str) -> Diagnostic {
    let message = format!(
        "the name {} of {what} {} is already the name of {what} {}; {names} must differ",
        quoted(name),
        index + 1,
        first + 1
    );
    let span = item.get("name").map_or(item.head(), |name| name.span.clone());
    Diagnostic::error(span, message).label("name taken")
}

/// Returns a message if a name is no identifier; `what` says in words which thing has the name.
pub(crate) fn not_identifier(name: &str, what: &str) -> Option<String> {
    let is_identifier = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    (!is_identifier).then(|| {
        format!("{what} is not an identifier; it must be a letter from a to z or A to Z, then letters, digits and `_`")
    })
}
