//! Reads the key `floating_base` of a robot file.

use crate::parts::frame::BASE;
use crate::readers::link::inertia_reference;
use crate::readers::names::{joint_names, not_identifier};
use crate::readers::tree::needs_format_2;
use crate::text::decode::{Context, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{FloatingBase, Inertia, InertiaReference, Link, readers::matter};

/// Reads the name of the floating base even if other keys of it are wrong.
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
        written: or(Inertia::default()) "inertia" matter::fixed_tensor,
        about: or(InertiaReference::Com) "inertia_about" inertia_reference,
        physical: or(true) "physical" matter::physical,
    });
    matter::link(cx, node, (mass, com), (written, about), physical)
}

fn base_name(cx: &Context, node: &Node, root: &Node) -> Option<String> {
    let name = text(cx, node)?;
    let what = format!("the name {} of the floating base", quoted(&name));
    let message = if let Some(message) = not_identifier(&name, &what) {
        message
    } else if name != BASE && joint_names(root).contains(&name) {
        format!("{what} is already the name of a joint; names must differ")
    } else {
        return Some(name);
    };
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("choose another name"))
}

/// Refuses a floating base where the caller takes only serial arms on a fixed base.
pub(crate) fn refuse(cx: &Context, root: &Node) {
    let Some(node) = root.get("floating_base") else { return };
    let message = "the base of this robot floats, and floating bases are not supported here";
    let help = "the section What takes which robot of docs/robot-file.md lists the commands, derives and types that \
                take floating bases";
    cx.report(Diagnostic::error(node.head(), message).label("a floating base").help(help));
}
