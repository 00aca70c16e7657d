//! The list `contacts` of a robot file.

use crate::readers::tree::items;
use crate::text::decode::{Context, choice, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::Node;
use crate::text::source::quoted;
use crate::{Contact, ContactKind, Frame};

/// Reads the list `contacts` of a file whose root is `root` and whose tips are given.
pub(crate) fn contacts(
    cx: &Context,
    root: &Node,
    format: u32,
    (frames, tips): (&[Frame], &[usize]),
) -> Option<Vec<Contact>> {
    let help = "write a contact for each tip that is held, such as `contacts: [{tip: left, kind: point}]`";
    let items = items(cx, root, ("contacts", format), "contacts", help)?;
    if let Some(node) = root.get("contacts")
        && !items.is_empty()
        && root.get("floating_base").is_none()
    {
        let message =
            "`contacts` needs `floating_base`: the tips of a robot whose base is fixed are held by nothing else";
        let help = "add `floating_base: {name: trunk, link: {mass: …}}`, or delete `contacts`";
        return cx.refuse(Diagnostic::error(node.head(), message).label("without `floating_base`").help(help));
    }
    let names: Vec<&str> = tips.iter().map(|&tip| frames[tip].name.as_str()).collect();
    let mut contacts: Vec<Contact> = Vec::new();
    for item in items {
        let Some(contact) = contact(cx, item, frames, &names) else { continue };
        if contacts.iter().any(|other| other.tip == contact.tip) {
            let message =
                format!("the tip {} is in `contacts` twice; each tip has one contact", quoted(names[contact.tip]));
            let place = item.get("tip").map_or_else(|| item.head(), |tip| tip.span.clone());
            cx.report(Diagnostic::error(place, message).label("a second time"));
            continue;
        }
        contacts.push(contact);
    }
    (contacts.len() == items.len()).then_some(contacts)
}

fn contact(cx: &Context, node: &Node, frames: &[Frame], tips: &[&str]) -> Option<Contact> {
    read_mapping!(cx, node, "a contact", {
        tip: required "tip" |cx, node| tip(cx, node, frames, tips),
        kind: required "kind" |cx, node| choice(cx, node, "kind of contact", &ContactKind::WORDS),
    });
    Some(Contact { tip, kind })
}

/// Returns the index of a tip in the list of all tips.
fn tip(cx: &Context, node: &Node, frames: &[Frame], tips: &[&str]) -> Option<usize> {
    let name = text(cx, node)?;
    if let Some(place) = tips.iter().position(|tip| *tip == name) {
        return Some(place);
    }
    let known = match tips {
        [] => "the file has no list `tips`".to_owned(),
        _ => format!("its tips are {}", tips.iter().map(|tip| quoted(tip)).collect::<Vec<_>>().join(", ")),
    };
    let message = format!("`contacts` names {}, which is no tip of this file; {known}", quoted(&name));
    let help = cx.did_you_mean(&name, tips.iter().copied()).map_or_else(
        || {
            let listed = [tips, &[name.as_str()]].concat().join(", ");
            match frames.iter().find(|frame| frame.name == name) {
                Some(frame) if frame.fixed.on.is_none() => "a contact must be on a link that a joint moves".to_owned(),
                Some(_) => format!("add the name of the frame to the list `tips`: `tips: [{listed}]`"),
                None => format!("add the frame to `frames`, and its name to the list `tips`: `tips: [{listed}]`"),
            }
        },
        |meant| format!("did you mean {}?", quoted(meant)),
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("no such tip").help(help))
}
