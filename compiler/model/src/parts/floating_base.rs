//! The floating base: a link that no joint holds, such as the trunk of a robot that walks. Its frame is frame 0.

use crate::parts::frame::{BASE, joint_names};
use crate::parts::tree::needs_format_2;
use crate::text::decode::{Context, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{Link, parts::matter};

/// The link that carries the joints of a floating base: `floating_base` of a robot file.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatingBase {
    /// Its name, `[A-Za-z][A-Za-z0-9_]*`, which means the same as `base`. No joint and no frame has it.
    pub name: String,
    /// Mass, centre of mass and inertia about the centre of mass, in frame 0.
    pub link: Link,
}

/// The name of the floating base, whatever else is wrong with it.
pub(crate) fn name_of_base(root: &Node) -> Option<String> {
    match root.get("floating_base")?.get("name").map(|name| &name.content) {
        Some(Content::Scalar(scalar)) => Some(scalar.text.trim_end().to_owned()),
        _ => None,
    }
}

/// Reads `floating_base` of a file whose root is `root`.
#[allow(clippy::option_option)] // the outer `None` is a reported mistake
pub(crate) fn floating_base(cx: &Context, root: &Node, format: u32) -> Option<Option<FloatingBase>> {
    let Some(node) = root.get("floating_base") else { return Some(None) };
    if format == 1 {
        return cx.refuse(needs_format_2("floating_base", node));
    }
    if let Some(base) = root.get("base") {
        let message = "the file has both `base` and `floating_base`; a base that floats has no fixed place in the \
                       world, so delete one of them";
        return cx.refuse(Diagnostic::error(base.head(), message).label("not with `floating_base`"));
    }
    read_mapping!(cx, node, "a floating base", {
        name: required "name" |cx, node| base_name(cx, node, root),
        link: required "link" base_link,
    });
    Some(Some(FloatingBase { name, link }))
}

fn base_link(cx: &Context, node: &Node) -> Option<Link> {
    read_mapping!(cx, node, "the link of a floating base", {
        mass: required "mass" matter::mass,
        com: or([0.0; 3]) "com" matter::com,
        written: or(matter::NO_INERTIA) "inertia" matter::tensor,
        about: or(matter::ABOUT_COM) "inertia_about" matter::reference,
        physical: or(true) "physical" matter::physical,
    });
    matter::link(cx, node, (mass, com), (written, about), physical)
}

fn base_name(cx: &Context, node: &Node, root: &Node) -> Option<String> {
    let name = text(cx, node)?;
    let is_identifier = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let message = if !is_identifier {
        format!(
            "the name {} of the floating base is not an identifier; it must be a letter from a to z or A to Z, then \
             letters, digits and `_`",
            quoted(&name)
        )
    } else if name != BASE && joint_names(root).contains(&name) {
        format!("the name {} of the floating base is already the name of a joint; names must differ", quoted(&name))
    } else {
        return Some(name);
    };
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("choose another name"))
}

/// Refuses a floating base for a function that takes serial arms on a fixed base only.
pub(crate) fn refuse(cx: &Context, root: &Node) {
    let Some(node) = root.get("floating_base") else { return };
    let message = "the base of this robot floats, and floating bases are not supported here";
    let help = "the section Floating bases of docs/robot-file.md lists the commands, derives and types that take them";
    cx.report(Diagnostic::error(node.head(), message).label("a floating base").help(help));
}
