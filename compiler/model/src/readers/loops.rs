//! Reads the list `loops` of a robot file: parallelograms, which become couplings, and other closed loops.

use std::rc::Rc;

use crate::loops::closure::moving;
use crate::loops::mobility::{Count, Fault};
use crate::parts::pose::way;
use crate::readers::names::joint_names;
use crate::readers::names::named;
use crate::readers::placement::end_of_loop;
use crate::readers::texts::text_of_one_line;
use crate::readers::tree::items;
use crate::text::decode::{Context, choice, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{Content, Node};
use crate::text::source::{quoted, six_digits};
use crate::{ClosedLoop, ClosedLoops, Convention, Cut, Entry, FixedFrame, Joint, lints};

/// A loop as the file writes it.
struct Written {
    name: Option<String>,
    is_parallelogram: bool,
    cut: Cut,
    between: [FixedFrame; 2],
    dependent: Vec<usize>,
}

/// Reads the list `loops` of a file whose root is `root`. Gives the dependent joints of parallelograms their couplings,
/// and returns the other loops and the joints that move these.
pub(crate) fn loops(
    cx: &Context,
    root: &Node,
    (format, convention): (u32, Convention),
    joints: &mut [Joint],
    takes_loops: bool,
) -> Option<(ClosedLoops, Vec<usize>)> {
    let help = "begin each loop with a dash, as in the section Closed loops of docs/robot-file.md";
    let items = items(cx, root, ("loops", format), "loops", help)?;
    let names = joint_names(root);
    let written: Vec<_> = items.iter().map(|item| closed_loop(cx, item, &names)).collect();
    let written = written.into_iter().collect::<Option<Vec<_>>>()?;
    for (item, it) in items.iter().zip(&written) {
        let on_ways = it.between.iter().flat_map(|end| way(joints, end.on)).collect::<Vec<_>>();
        let is_length = |entry: &Entry| matches!(entry, Entry::A(joint) | Entry::D(joint) if on_ways.contains(joint));
        if cx.run_time.borrow().entries.iter().any(|(entry, _)| is_length(entry)) {
            let message = "a length of the loop varies at run time; the lengths of a closed loop must be fixed";
            return cx.refuse(Diagnostic::error(item.head(), message).label("varies at run time"));
        }
        if it.is_parallelogram {
            parallelogram_of(cx, item, it, convention, joints)?;
        }
    }
    let closed = written.into_iter().zip(items).enumerate().filter(|(_, (it, _))| !it.is_parallelogram);
    let (loops, items): (Vec<ClosedLoop>, Vec<&Rc<Node>>) = closed
        .map(|(index, (Written { name, cut, between, dependent, .. }, item))| {
            let name = name.unwrap_or_else(|| format!("loop{}", index + 1));
            (ClosedLoop { name, cut, between, dependent }, item)
        })
        .unzip();
    if loops.is_empty() {
        return Some((ClosedLoops::default(), Vec::new()));
    }
    if !takes_loops {
        let help = "the section What takes which robot of docs/robot-file.md lists the commands, derives and types \
                    that take closed loops";
        let message = "the robot has closed loops, which are not supported here";
        return cx.refuse(Diagnostic::error(items[0].head(), message).label("a closed loop").help(help));
    }
    let mut taken = Vec::new();
    for (index, (closed, item)) in loops.iter().zip(&items).enumerate() {
        names_differ(cx, item, &loops[..index], closed)?;
        moves(cx, item, closed, joints)?;
        dependents(cx, item, closed, joints, &taken)?;
        taken.extend(&closed.dependent);
    }
    match crate::loops::mobility::solved(joints, convention, loops.clone()) {
        Ok(_) if joints.iter().enumerate().all(|(joint, it)| it.coupling.is_some() || taken.contains(&joint)) => {
            let message = "the loops leave no joint that moves: the robot is rigid";
            let help = "check the lengths and the axes; an arm of one link needs no loop";
            cx.refuse(at(items[0], "dependent", message.to_owned()).help(help))
        }
        Ok((closed, remarks)) => {
            lints::closed_loops::closed_loops(cx, items[0], joints, &closed.loops, &remarks);
            Some((closed, remarks.joints))
        }
        Err(fault) => cx.refuse(refusal(&fault, &loops, &items, joints)),
    }
}

fn closed_loop(cx: &Context, node: &Node, names: &[String]) -> Option<Written> {
    read_mapping!(cx, node, "a loop", {
        name: optional "name" |cx, node| text_of_one_line(cx, node, "name of a loop"),
        kind: optional "kind" |cx, node| choice(cx, node, "kind", &[("parallelogram", ())]),
        cut: required "cut" |cx, node| choice(cx, node, "cut joint", &Cut::ALL.map(|cut| (cut.name(), cut))),
        between: required "between" |cx, node| two_ends(cx, node, names),
        dependent: required "dependent" |cx, node| dependent(cx, node, names),
    });
    Some(Written { name, is_parallelogram: kind.is_some(), cut, between, dependent })
}

fn two_ends(cx: &Context, node: &Node, names: &[String]) -> Option<[FixedFrame; 2]> {
    match &node.content {
        Content::Sequence(items) if items.len() == 2 => {
            let [one, other] = [&items[0], &items[1]].map(|item| end_of_loop(cx, item, names));
            Some([one?, other?])
        }
        _ => {
            let message = format!("found {} where a list of two places is needed", node.described());
            cx.refuse(Diagnostic::error(node.head(), message).label("two places"))
        }
    }
}

/// Reads a list of names of joints, each of which may be there once.
fn dependent(cx: &Context, node: &Node, names: &[String]) -> Option<Vec<usize>> {
    let items = match &node.content {
        Content::Sequence(items) if !items.is_empty() => items,
        _ => {
            let message = format!("found {} where a list of joints is needed", node.described());
            return cx.refuse(Diagnostic::error(node.head(), message).label("names of joints"));
        }
    };
    let mut joints = Vec::new();
    for item in items {
        let name = text(cx, item)?;
        let joint = named(cx, &name, item.span.clone(), names, "dependent")?;
        if joints.contains(&joint) {
            let message = format!("`dependent` names {} twice", quoted(&name));
            return cx.refuse(Diagnostic::error(item.span.clone(), message).label("a second time").help("delete it"));
        }
        joints.push(joint);
    }
    Some(joints)
}

/// Computes the couplings of a parallelogram and gives them to its dependent joints.
fn parallelogram_of(
    cx: &Context,
    item: &Node,
    it: &Written,
    convention: Convention,
    joints: &mut [Joint],
) -> Option<()> {
    if it.cut != Cut::Revolute {
        let message = format!("a parallelogram has no {} joint; it must be `cut: revolute`", it.cut.name());
        return cx.refuse(at(item, "cut", message).label("must be `revolute`"));
    }
    let Ok(dependent) = <[usize; 2]>::try_from(&it.dependent[..]) else {
        let message = format!("found a list of {} where a list of two joints is needed", it.dependent.len());
        return cx.refuse(at(item, "dependent", message).label("two joints"));
    };
    let couplings = match crate::loops::parallelogram::couplings(&it.between, dependent, convention, joints) {
        Ok(couplings) => couplings,
        Err(message) => {
            let help = "the section Parallelograms of docs/robot-file.md says what a loop must be";
            return cx.refuse(at(item, "between", message).label("no parallelogram").help(help));
        }
    };
    for (joint, coupling) in couplings {
        is_free(cx, item, joint, joints)?;
        joints[joint].coupling = Some(coupling);
    }
    Some(())
}

/// Refuses a dependent joint that already follows other joints or has a motor.
fn is_free(cx: &Context, item: &Node, joint: usize, joints: &[Joint]) -> Option<()> {
    let taken = match &joints[joint] {
        Joint { coupling: Some(_), .. } => "follows other joints already",
        Joint { motor: Some(_), .. } => "has a `motor`, but the loop moves it",
        _ => return Some(()),
    };
    let message = format!("the dependent joint {} {taken}", quoted(&joints[joint].name));
    cx.refuse(at(item, "dependent", message).help("name other dependent joints of the loop"))
}

fn names_differ(cx: &Context, item: &Node, others: &[ClosedLoop], closed: &ClosedLoop) -> Option<()> {
    if others.iter().all(|other| other.name != closed.name) {
        return Some(());
    }
    let message = format!("two loops have the name {}; the names of loops must differ", quoted(&closed.name));
    cx.refuse(at(item, "name", message).label("name taken").help("give each loop a `name` of its own"))
}

/// Refuses a loop whose two places cannot move relative to each other.
fn moves(cx: &Context, item: &Node, closed: &ClosedLoop, joints: &[Joint]) -> Option<()> {
    let [one, other] = closed.between.map(|end| way(joints, end.on));
    if one != other {
        return Some(());
    }
    let link =
        one.last().map_or_else(|| "`base`".to_owned(), |&joint| format!("the link of {}", quoted(&joints[joint].name)));
    let message = format!("both places of the loop {} are on {link}: no joint moves them", quoted(&closed.name));
    let help = "name two links that joints move against each other; a weld of parts of one link needs no loop";
    cx.refuse(at(item, "between", message).label("one link").help(help))
}

/// Checks each dependent joint of a loop by itself.
fn dependents(cx: &Context, item: &Node, closed: &ClosedLoop, joints: &[Joint], taken: &[usize]) -> Option<()> {
    let moves = moving(joints, closed);
    for &joint in &closed.dependent {
        is_free(cx, item, joint, joints)?;
        let name = quoted(&joints[joint].name);
        if taken.contains(&joint) {
            let message = format!("{name} is a dependent joint of another loop already");
            let help = "name each dependent joint in one loop; the loops are solved together";
            return cx.refuse(at(item, "dependent", message).label("named twice").help(help));
        }
        if !moves.contains(&joint) {
            let message = format!(
                "{name} does not move the loop {}; the joints that move it are {}",
                quoted(&closed.name),
                listed(joints, &moves)
            );
            return cx.refuse(at(item, "dependent", message).help("name dependent joints among these"));
        }
    }
    Some(())
}

/// Makes an error at a key of a loop.
fn at(item: &Node, key: &str, message: String) -> Diagnostic {
    Diagnostic::error(item.get(key).unwrap_or(item).head(), message)
}

/// Lists the names of some joints, for a message.
pub(crate) fn listed(joints: &[Joint], of: &[usize]) -> String {
    const MOST: usize = 12;
    let names: Vec<String> = of.iter().take(MOST).map(|&joint| quoted(&joints[joint].name)).collect();
    let rest = if of.len() > MOST { ", and others" } else { "" };
    format!("{}{rest}", names.join(", "))
}

/// Writes singular values, the largest first, for a message; a value that is zero up to rounding is written as 0.
fn values(of: &[f64]) -> String {
    let least = 1e-12 * of.first().copied().unwrap_or(0.0);
    let value = |&value: &f64| short(if value < least { 0.0 } else { value });
    of.iter().map(value).collect::<Vec<_>>().join(", ")
}

/// Writes a number with three significant digits.
pub(crate) fn short(value: f64) -> String {
    format!("{value:.2e}").parse().map_or_else(|_| six_digits(value), six_digits)
}

fn suggestion(joints: &[Joint], choice: &[usize]) -> String {
    match choice {
        [] => String::new(),
        _ => format!("; for example {}: a joint with a motor is not dependent", listed(joints, choice)),
    }
}

fn refusal(fault: &Fault, loops: &[ClosedLoop], items: &[&Rc<Node>], joints: &[Joint]) -> Diagnostic {
    match fault {
        Fault::Open { index, apart: [length, angle] } => {
            let name = quoted(&loops[*index].name);
            let by = if *angle > 1e-9 { format!(" and turned by {} rad", short(*angle)) } else { String::new() };
            let nearest = if length.is_finite() && *length < 1e100 {
                format!(
                    "the nearest one leaves its two places {} m apart{by}",
                    short(if *length < 1e-12 { 0.0 } else { *length })
                )
            } else {
                "its lengths are too large".to_owned()
            };
            let message = format!("no configuration closes the loop {name}: {nearest}");
            let help = if *angle > 3.0 {
                "the axes of the two places are opposite there; if the joint turns about the same line, turn one place \
                 by `rpy: [pi, 0, 0]`"
            } else {
                "check the lengths and the places of `between`; it must close to 1e-12 of its size, so write angles \
                 and axes with all digits, such as `pi/2`"
            };
            at(items[*index], "between", message).label("the loop stays open").help(help)
        }
        Fault::Count(count) => wrong_count(count, loops, items, joints),
        Fault::Undetermined { index, joints: moved, singular_values, choice } => {
            let message = format!(
                "the other joints do not determine the dependent joints {}: these can move while all others are at \
                 rest (singular values {})",
                listed(joints, moved),
                values(singular_values)
            );
            let help = format!("name other dependent joints{}", suggestion(joints, choice));
            at(items[*index], "dependent", message).label("not determined").help(help)
        }
        Fault::NoOrder => {
            let message = "no order of elimination has pivots at all configurations that close the loops";
            let help = "name other dependent joints, or narrow the position limits to the configurations that are used";
            at(items[0], "dependent", message.to_owned()).help(help)
        }
    }
}

fn wrong_count(count: &Count, loops: &[ClosedLoop], items: &[&Rc<Node>], joints: &[Joint]) -> Diagnostic {
    let Count { loops: group, repeats, named, rank, singular_values, size, closures, joints: all, choice } = count;
    let mut names = group.iter().map(|&index| quoted(&loops[index].name)).collect::<Vec<_>>();
    let mended = names[0].clone();
    names.sort_unstable();
    let s = if *named == 1 { "" } else { "s" };
    let who = match &names[..] {
        [name] => format!("the loop {name} has {named} dependent joint{s}, but its"),
        names => {
            let names = names.join(", ");
            format!("the loops {names} share joints and have {named} dependent joint{s} together, but their")
        }
    };
    let message = format!(
        "{who} equations determine {rank}: this is the rank of their Jacobian at {closures} configurations that close \
         the loops (singular values {}; lengths in units of {} m)",
        values(singular_values),
        short(*size)
    );
    let help = if *repeats {
        format!("delete the loop {mended}: its equations follow from those of the other loops")
    } else {
        format!("name {rank} dependent joints among {}{}", listed(joints, all), suggestion(joints, choice))
    };
    at(items[group[0]], "dependent", message).label(format!("{rank} are needed")).help(help)
}
