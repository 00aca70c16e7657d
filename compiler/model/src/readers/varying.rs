//! Reads numbers that may depend on run-time parameters, and refuses dependence where it is not possible.

use std::ops::Range;

use crate::parts::quantity::Quantity;
use crate::text::decode::{Context, list, quantity};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::quoted;
use crate::{Entry, Inertia, InertiaElement, InertiaReference, parts::inertia};

/// Largest number of parameters that a message lists.
const MOST_LISTED: usize = 12;

/// Returns the help for a number that cannot depend on a run-time parameter.
pub(crate) fn leave_out(name: &str) -> String {
    format!("remove {} from the run-time parameters: rne then uses its value in the file", quoted(name))
}

/// Returns a reader of a number of the table, which records the formula if the number varies at run time.
pub(crate) fn entry(entry: Entry) -> impl Fn(&Context, &Node) -> Option<f64> {
    move |cx, node| {
        let quantity = nonzero(cx, node)?;
        if let Some(formula) = quantity.varying() {
            cx.run_time.borrow_mut().entries.push((entry, formula.clone()));
        }
        Some(quantity.value)
    }
}

/// Returns a reader of an element of a link's inertia about any point, which records the formula if the number varies.
pub(crate) fn inertia_element(joint: usize, element: InertiaElement) -> impl Fn(&Context, &Node) -> Option<f64> {
    move |cx, node| {
        let quantity = nonzero(cx, node)?;
        if let Some(formula) = quantity.varying() {
            cx.run_time.borrow_mut().written_inertia.push((joint, element, formula.clone()));
        }
        Some(quantity.value)
    }
}

/// Returns a reader of a number that no run-time parameter may change; `what` names it in messages, such as "the
/// angle".
pub(crate) fn fixed(what: &'static str) -> impl Fn(&Context, &Node) -> Option<f64> {
    move |cx, node| {
        let quantity = quantity(cx, node)?;
        if quantity.varying().is_none() {
            return Some(quantity.value);
        }
        let name = cx.parameter_name(quantity.first_parameter());
        let message = format!(
            "{what} {} depends on the run-time parameter {}; only lengths (not `b` and `at`), gravity, the numbers \
             under \
             `motor`, and the mass, centre of mass and inertia of a link that a joint moves may vary",
            quoted(cx.raw(node)),
            quoted(&name)
        );
        cx.refuse(Diagnostic::error(node.span.clone(), message).label("varies at run time").help(leave_out(&name)))
    }
}

/// Reads a number that must not be zero in the file if it varies, because zeros are folded away.
fn nonzero(cx: &Context, node: &Node) -> Option<Quantity> {
    let quantity = quantity(cx, node)?;
    if quantity.value != 0.0 || quantity.varying().is_none() {
        return Some(quantity);
    }
    let name = cx.parameter_name(quantity.first_parameter());
    let shown = cx.shown(node, quantity.value);
    cx.refuse(zero(node.span.clone(), &shown, &name))
}

fn zero(span: Range<usize>, shown: &str, name: &str) -> Diagnostic {
    let message = format!(
        "{shown} depends on the run-time parameter {}, but such a number must not be 0 in the file, because rne \
         removes operations with zeros from the code",
        quoted(name)
    );
    Diagnostic::error(span, message).label("zero in the file").help(format!(
        "give {} a value in the file for which this number is not zero, or remove it from the run-time parameters",
        quoted(name)
    ))
}

/// Computes the centre of mass of a joint's link from its first moment, kg m; the mass was read before and is not zero.
pub(crate) fn com_of_first_moment(cx: &Context, node: &Node, joint: usize, mass: f64) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (kg m)", |cx, node, axis| {
        let moment = quantity(cx, node)?;
        let mass = Quantity::known(mass, cx.run_time.borrow().formula(Entry::Mass(joint)));
        let com = moment / mass;
        if let Some(formula) = com.varying() {
            if com.value == 0.0 {
                let name = cx.parameter_name(com.first_parameter());
                return cx.refuse(zero(node.span.clone(), &cx.shown(node, com.value), &name));
            }
            cx.run_time.borrow_mut().entries.push((Entry::Com(joint, axis), formula.clone()));
        }
        Some(com.value)
    })
}

/// Computes the inertia of a joint's link about its centre of mass from the inertia that the file writes; all other
/// numbers of the link were read before. `place` is the place of the tensor in the file.
pub(crate) fn inertia_about_com(
    cx: &Context,
    place: Range<usize>,
    joint: usize,
    (written, about): (Inertia, InertiaReference),
    (mass, com): (f64, [f64; 3]),
) -> Option<Inertia> {
    let mut guard = cx.run_time.borrow_mut();
    let run_time = &mut *guard;
    if about == InertiaReference::Com {
        let start = run_time.written_inertia.iter().position(|(of, ..)| *of == joint);
        let elements = run_time.written_inertia.split_off(start.unwrap_or(run_time.written_inertia.len()));
        run_time.entries.extend(elements.into_iter().map(|(_, element, it)| (Entry::Inertia(joint, element), it)));
        return Some(written);
    }
    let read = |entry, value| Quantity::known(value, run_time.formula(entry));
    let origin = InertiaElement::ALL.map(|element| {
        let found = run_time.written_inertia.iter().find(|(of, which, _)| (*of, *which) == (joint, element));
        Quantity::known(*element.of(&written), found.map(|(.., formula)| formula))
    });
    let [xx, yy, zz, xy, xz, yz] = origin;
    let [x, y, z] = com;
    let moved = inertia::about_com(
        Inertia { xx, yy, zz, xy, xz, yz },
        &read(Entry::Mass(joint), mass),
        [read(Entry::Com(joint, 0), x), read(Entry::Com(joint, 1), y), read(Entry::Com(joint, 2), z)],
    );
    let mut inertia = Inertia::default();
    let mut zeros = Vec::new();
    for element in InertiaElement::ALL {
        let quantity = element.of(&moved);
        *element.of_mut(&mut inertia) = quantity.value;
        let Some(formula) = quantity.varying() else { continue };
        if quantity.value == 0.0 {
            zeros.push((element, quantity.first_parameter()));
        }
        run_time.entries.push((Entry::Inertia(joint, element), formula.clone()));
    }
    drop(guard);
    for (element, parameter) in &zeros {
        let shown = format!("the element {} = 0 of the inertia about the centre of mass", element.key());
        cx.report(zero(place.clone(), &shown, &cx.parameter_name(*parameter)));
    }
    zeros.is_empty().then_some(inertia)
}

/// Reports the names of run-time parameters that the file does not define under `parameters`.
pub(crate) fn unknown_names(cx: &Context, root: &Node) {
    let names = cx.run_time.borrow().names.clone();
    unknown(cx, root, names.iter().map(String::as_str), " for run time");
}

/// Reports the names of parameters that the caller sets and the file does not define under `parameters`.
pub(crate) fn unknown_settings(cx: &Context, root: &Node) {
    unknown(cx, root, cx.settings.iter().map(|(name, _)| *name), " to be set");
}

fn unknown<'n>(cx: &Context, root: &Node, names: impl Iterator<Item = &'n str>, what: &str) {
    let parameters = root.get("parameters");
    let known: Vec<&str> = match parameters.map(|node| &node.content) {
        None => Vec::new(),
        Some(Content::Mapping(entries)) => entries.iter().map(|entry| entry.key.as_str()).collect(),
        // The reader of `parameters` reports a value that is no mapping.
        Some(_) => return,
    };
    for name in names {
        if known.contains(&name) {
            continue;
        }
        let mut listed = known.iter().take(MOST_LISTED).map(|name| quoted(name)).collect::<Vec<_>>().join(", ");
        match known.len() {
            0 => "there is nothing".clone_into(&mut listed),
            n if n > MOST_LISTED => listed = format!("there are {listed} and {} more", n - MOST_LISTED),
            _ => listed.insert_str(0, "there are "),
        }
        let place = parameters.map_or(root.head(), Node::head);
        let message = format!("the robot file has no parameter {}{what}; under `parameters` {listed}", quoted(name));
        let help = cx.did_you_mean(name, known.iter().copied()).map_or_else(
            || format!("define `{name}: …` under `parameters`"),
            |meant| format!("did you mean `{meant}`?"),
        );
        cx.report(Diagnostic::error(place, message).help(help));
    }
}

/// Reports the run-time parameters that no number of the table depends on.
pub(crate) fn without_effect(cx: &Context) {
    let run_time = cx.run_time.borrow();
    let parameters = cx.parameters.borrow();
    for (index, name) in run_time.names.iter().enumerate() {
        let Some(parameter) = parameters.get(name) else { continue };
        if run_time.entries.iter().any(|(_, formula)| formula.depends_on(index)) {
            continue;
        }
        let message =
            format!("the run-time parameter {} has no effect: no number of the table depends on it", quoted(name));
        let error = Diagnostic::error(parameter.span.clone(), message).label("no effect");
        cx.report(error.help(format!("use {0} in a number, or remove it from the run-time parameters", quoted(name))));
    }
}
