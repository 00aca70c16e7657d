//! The format itself: which keys a robot file has, what each means, and which values are allowed.

use std::cell::Cell;
use std::collections::HashMap;

use crate::loops::loops;
use crate::parts::body::bodies;
use crate::parts::contacts::contacts;
use crate::parts::coupling::{self, couplings};
use crate::parts::drive::drives;
use crate::parts::floating_base::{self, name_of_base};
use crate::parts::frame::{BASE, carrier, frames};
use crate::parts::link::link;
use crate::parts::quantity::Quantity;
use crate::parts::tips::{first_tip, tips};
use crate::parts::varying::{entry, fixed, unknown_names, unknown_settings, without_effect};
use crate::text::decode::{Context, Parameter, choice, list, not_negative, quantity, read_mapping, text};
use crate::text::diagnostic::Diagnostic;
use crate::text::document::{self, Content, MAX_JOINTS, Node};
use crate::text::expression::{Meaning, is_identifier, is_reserved};
use crate::text::source::{is_control, is_line_break, one_line, quoted, six_digits};
use crate::{
    Angle, Convention, Dh, Entry, FixedFrame, Inertia, InertiaReference, Joint, JointKind, LARGEST_ANGLE, Limits, Link,
    Motor, Robot, Row, Transform, lints::lint, lints::mirror, parts::tree,
};

/// More than every number of 64 joints with a name of its own.
const MAX_PARAMETERS: usize = 2000;

/// The robots that a caller takes, beside serial arms.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Takes {
    pub(crate) trees: bool,
    pub(crate) couplings: bool,
    pub(crate) loops: bool,
}

/// A whole robot file.
pub(crate) fn robot(cx: &Context, node: &Node, takes: Takes) -> Option<Robot> {
    // In another format every key may mean something else.
    if let Some(version) = node.get("format") {
        format(cx, version)?;
    }
    unknown_names(cx, node);
    unknown_settings(cx, node);
    cx.base_name.replace(name_of_base(node));
    read_mapping!(cx, node, "a robot file", {
        format: required "format" format,
        name: required "name" robot_name,
        title: optional "title" |cx, node| text_of_one_line(cx, node, "title"),
        source: required "source" lines,
        notes: optional "notes" lines,
        parameters: or(Vec::new()) "parameters" parameters,
        convention: required "convention" convention,
        gravity: required "gravity" gravity,
        base: or(Transform::IDENTITY) "base" |cx, node| transform(cx, node, Entry::BaseXyz),
        _floating_base: optional "floating_base" |_, _| Some(()),
        tool: or(Transform::IDENTITY) "tool" tool,
        frames: or(Vec::new()) "frames" |cx, list| frames(cx, list, node),
        joints: required "joints" joints,
        _couplings: optional "couplings" |_, _| Some(()),
        _loops: optional "loops" |_, _| Some(()),
        _motors: optional "motors" |_, _| Some(()),
        _bodies: optional "bodies" |_, _| Some(()),
        _tips: optional "tips" |_, _| Some(()),
        _contacts: optional "contacts" |_, _| Some(()),
    });
    let (mut joints, mut tool) = (joints, tool);
    let mut tip_on = tree::branches(cx, node, (format, convention), &mut joints)?;
    let tips = tips(cx, node, format, &frames)?;
    if node.get("tool").is_none()
        && let Some(first) = first_tip(cx, &frames, &tips, &joints)
    {
        (tip_on, tool) = first;
    }
    let contacts = contacts(cx, node, format, (&frames, &tips))?;
    couplings(cx, node, format, &mut joints)?;
    let (closed, of_loops) = loops(cx, node, (format, convention), &mut joints, takes.loops)?;
    let drives = drives(cx, node, format, &joints, &closed.passive)?;
    let mut bodies = bodies(cx, node, format, &joints)?;
    let mut floating_base = floating_base::floating_base(cx, node, format)?;
    if let Some(node) = node.get("gravity") {
        lint::gravity_upwards(cx, node, gravity, &base);
    }
    lint::unused_parameters(cx);
    // Where something else is wrong it may be that which has no effect.
    if !cx.has_errors() {
        without_effect(cx);
        lint::inertias(cx, node, convention, &joints, &of_loops);
        lint::nearly_parallel(cx, &joints);
        lint::placeholders(cx, node, &joints);
        lint::missing_friction(cx, node);
        mirror::twins(cx, node, &joints);
        coupling::lint_limits(cx, node, &joints);
        // the reach of a tree is not the sum of its rows
        if joints.iter().all(|joint| joint.branch.is_none()) {
            lint::light_for_reach(cx, node, &joints);
        }
        if !takes.trees {
            tree::refuse(cx, node, &joints, tip_on);
            floating_base::refuse(cx, node);
        }
        if !takes.couplings {
            coupling::refuse(cx, node, &joints, &drives);
        }
    }
    bodies.add_to(&mut joints, floating_base.as_mut());
    // joints of closed loops do not move freely
    if let Some(base) = floating_base.as_ref().filter(|_| !cx.has_errors() && closed.is_empty()) {
        lint::floating_inertia(cx, node, &base.link, convention, &joints);
    }
    let run_time = cx.run_time.take();
    Some(Robot {
        name,
        title,
        source,
        notes,
        convention,
        gravity,
        base,
        floating_base,
        tool,
        tip_on,
        parameters,
        joints,
        drives,
        frames,
        tips,
        contacts,
        bodies,
        at: None,
        run_time,
        closed,
        rotors: false,
    })
}

fn format(cx: &Context, node: &Node) -> Option<u32> {
    choice(cx, node, "format", &[("1", 1), ("2", 2)])
}

fn robot_name(cx: &Context, node: &Node) -> Option<String> {
    let name = text(cx, node)?;
    let valid = name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    if valid {
        return Some(name);
    }
    let message = format!(
        "the name {} is not an identifier; it must be a lower-case letter, then lower-case letters, digits and `_`",
        quoted(&name)
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).help("write a name for people into `title`"))
}

/// A text of one line: it stands in headings and in comments of generated code.
pub(crate) fn text_of_one_line(cx: &Context, node: &Node, what: &str) -> Option<String> {
    let text = printable(cx, node, &format!("the {what}"), is_line_break)?;
    if !text.contains(is_line_break) {
        return Some(text);
    }
    let message = format!("the {what} {} has a line break; a {what} is one line", quoted(&text));
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("more than one line"))
}

/// A text that may have several lines.
fn lines(cx: &Context, node: &Node) -> Option<String> {
    printable(cx, node, "the text", |c| is_line_break(c) || c == '\t')
}

/// A text without control characters but those allowed.
fn printable(cx: &Context, node: &Node, what: &str, is_allowed: impl Fn(char) -> bool) -> Option<String> {
    let text = text(cx, node)?;
    let Some(control) = text.chars().find(|&c| is_control(c) && !is_allowed(c)) else {
        lint::invisible(cx, node, &text);
        return Some(text);
    };
    let message = format!(
        "{what} {} has the control character U+{:04X}; it must be readable text",
        quoted(&text),
        u32::from(control)
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).label("control character"))
}

/// The acceleration of gravity in frame 0.
fn gravity(cx: &Context, node: &Node) -> Option<[f64; 3]> {
    let gravity = list(cx, node, "[x, y, z] (m/s²)", |cx, node, axis| entry(Entry::Gravity(axis))(cx, node))?;
    lint::gravity(cx, node, gravity);
    Some(gravity)
}

fn convention(cx: &Context, node: &Node) -> Option<Convention> {
    choice(cx, node, "convention", &[("standard", Convention::Standard), ("modified", Convention::Modified)])
}

fn parameters(cx: &Context, node: &Node) -> Option<Vec<(String, f64)>> {
    let Content::Mapping(entries) = &node.content else {
        let message = format!("found {} where a mapping from names to numbers is needed", node.described());
        return cx.refuse(Diagnostic::error(node.head(), message).help("such as `parameters: {m: 1.5, a: 0.6}`"));
    };
    if let Some(excess) = entries.get(MAX_PARAMETERS) {
        let message = format!("{} parameters; at most {MAX_PARAMETERS} are allowed", entries.len());
        return cx.refuse(Diagnostic::error(excess.key_span.clone(), message));
    }
    let declared = |entry: &document::Entry| {
        let span = entry.key_span.clone();
        let value = entry.value.span.clone();
        (entry.key.clone(), Parameter { span, value, meaning: Meaning::Later, used: Cell::new(false) })
    };
    // A repeated name, an error already, keeps its first value.
    *cx.parameters.borrow_mut() = entries.iter().rev().map(declared).collect();
    let mut values = Vec::new();
    for (index, document::Entry { key, key_span, value }) in entries.iter().enumerate() {
        let name = parameter_name(cx, key, key_span.clone());
        let mut quantity = quantity(cx, value);
        if let Some(&(_, set)) = cx.settings.iter().find(|(name, _)| name == key) {
            quantity = quantity.map(|_| Quantity::constant(set));
        }
        values.push(name.zip(quantity.as_ref().map(|quantity| quantity.value)));
        if let Some(own) = cx.run_time_index(key) {
            // What it is in the file is but its value there, whatever that depends on.
            quantity = quantity.map(|quantity| Quantity::parameter(own, quantity.value));
        } else if let Some(formula) = quantity.as_ref().and_then(Quantity::varying) {
            cx.run_time.borrow_mut().parameters.push((index, formula.clone()));
        }
        if let Some(parameter) = cx.parameters.borrow_mut().get_mut(key).filter(|known| known.span == *key_span) {
            parameter.meaning = quantity.map_or(Meaning::Faulty, Meaning::Value);
        }
    }
    values.into_iter().collect()
}

fn parameter_name(cx: &Context, name: &str, span: std::ops::Range<usize>) -> Option<String> {
    if is_reserved(name) {
        let message = format!("the parameter name `{name}` already has a meaning in every expression");
        return cx
            .refuse(Diagnostic::error(span, message).help("choose another name than pi, sqrt, sin, cos, tan, deg"));
    }
    if !is_identifier(name) {
        let message = format!(
            "the parameter name {} is not an identifier; it must be a letter from a to z or `_`, then letters, digits \
             and `_`",
            quoted(name)
        );
        return cx.refuse(Diagnostic::error(span, message));
    }
    Some(name.to_owned())
}

fn transform(cx: &Context, node: &Node, place: fn(usize) -> Entry) -> Option<Transform> {
    read_mapping!(cx, node, "a placement", {
        xyz: or([0.0; 3]) "xyz" |cx, node| position(cx, node, place),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Transform { xyz, rpy })
}

/// The tip frame on its link; which link that is, [`tree`] reads.
fn tool(cx: &Context, node: &Node) -> Option<Transform> {
    read_mapping!(cx, node, "`tool`", {
        _on: optional "on" |_, _| Some(()),
        xyz: or([0.0; 3]) "xyz" |cx, node| position(cx, node, Entry::ToolXyz),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Transform { xyz, rpy })
}

/// A placement that run-time parameters do not change.
pub(crate) fn fixed_transform(cx: &Context, node: &Node) -> Option<Transform> {
    read_mapping!(cx, node, "a placement", {
        xyz: or([0.0; 3]) "xyz" |cx, node| list(cx, node, "[x, y, z] (m)", |cx, node, _| fixed_length(cx, node)),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(Transform { xyz, rpy })
}

/// Where the cut joint of a loop is on one of its links.
pub(crate) fn end_of_loop(cx: &Context, node: &Node, names: &[String]) -> Option<FixedFrame> {
    read_mapping!(cx, node, "an end of a loop", {
        on: required "on" |cx, node| carrier(cx, node, names, "on"),
        xyz: or([0.0; 3]) "xyz" |cx, node| list(cx, node, "[x, y, z] (m)", |cx, node, _| fixed_length(cx, node)),
        rpy: or([Angle::ZERO; 3]) "rpy" roll_pitch_yaw,
    });
    Some(FixedFrame { on, placement: Transform { xyz, rpy } })
}

/// A length that run-time parameters do not change.
fn fixed_length(cx: &Context, node: &Node) -> Option<f64> {
    let value = fixed("the length")(cx, node)?;
    lint::length(cx, node, value);
    Some(value)
}

pub(crate) fn roll_pitch_yaw(cx: &Context, node: &Node) -> Option<[Angle; 3]> {
    let angles = list(cx, node, "[roll, pitch, yaw] (rad)", |cx, node, _| angle(cx, node))?;
    Some(angles.map(Angle::new))
}

fn joints(cx: &Context, node: &Node) -> Option<Vec<Joint>> {
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
            let message = format!(
                "the name {} of joint {} is already the name of joint {}; joint names must differ",
                quoted(&joint.name),
                index + 1,
                first + 1
            );
            let span = item.get("name").map_or(item.head(), |name| name.span.clone());
            cx.report(Diagnostic::error(span, message).label("name taken"));
        }
    }
    let joints = joints.into_iter().collect::<Option<Vec<Joint>>>()?;
    unique.then_some(joints)
}

/// A joint under a number or a name of its own, `- 1: {type: …}`: what is meant, if that is what stands there.
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

/// The joint with this index, from 0.
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
        lint::position_limits(cx, position, kind, &limits);
    }
    let (link, written_inertia) = link;
    let (motor, [coulomb_width, coulomb_displacement]) =
        motor.map_or((None, [None; 2]), |(motor, changes)| (Some(motor), changes));
    let (dh, before) = dh;
    // the link that carries it is not known yet
    let branch = at.or(before).map(|placement| FixedFrame { on: index.checked_sub(1), placement });
    let row = Row { kind, dh, link };
    Some(Joint {
        name,
        row,
        branch,
        written_inertia,
        limits,
        // no joint below is known yet
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

/// The row, and Rz(gamma) Tz(b) before it.
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

fn limits(cx: &Context, node: &Node) -> Option<Limits> {
    read_mapping!(cx, node, "`limits`", {
        position: optional "position" position_limits,
        velocity: optional "velocity" not_negative("velocity limit", fixed("the limit")),
        effort: optional "effort" not_negative("effort limit", fixed("the limit")),
    });
    Some(Limits { position, velocity, effort })
}

fn position_limits(cx: &Context, node: &Node) -> Option<(f64, f64)> {
    let [lower, upper] = list(cx, node, "[lower, upper] (rad or m)", |cx, node, _| fixed("the limit")(cx, node))?;
    if lower <= upper {
        return Some((lower, upper));
    }
    let message = format!(
        "the lower position limit {} lies above the upper one, {}; the order is [lower, upper]",
        six_digits(lower),
        six_digits(upper)
    );
    cx.refuse(Diagnostic::error(node.span.clone(), message).help("exchange the two"))
}

/// The motor, and the speed about which its friction changes its sign, or the displacement over which it does.
fn motor(cx: &Context, node: &Node, joint: usize) -> Option<(Motor, [Option<f64>; 2])> {
    read_mapping!(cx, node, "`motor`", {
        inertia: or(0.0) "inertia" not_negative("rotor inertia", entry(Entry::MotorInertia(joint))),
        gear_ratio: or(1.0) "gear_ratio" |cx, node| gear_ratio(cx, node, joint),
        viscous: or(0.0) "viscous" not_negative("viscous friction", entry(Entry::Viscous(joint))),
        coulomb: or([0.0; 2]) "coulomb" |cx, node| coulomb(cx, node, joint),
        width: optional "coulomb_width" not_negative("width", fixed("the width")),
        displacement: optional "coulomb_displacement" not_negative("displacement", fixed("the displacement")),
    });
    if let (Some(of_width), Some(_)) = (node.get("coulomb_width"), node.get("coulomb_displacement")) {
        lint::width_beside_displacement(cx, of_width);
    }
    Some((Motor { inertia, gear_ratio, viscous, coulomb }, [width, displacement]))
}

fn gear_ratio(cx: &Context, node: &Node, joint: usize) -> Option<f64> {
    let ratio = entry(Entry::GearRatio(joint))(cx, node)?;
    if ratio != 0.0 {
        return Some(ratio);
    }
    let message = format!("the gear ratio {} is zero; it must be motor turns per joint turn", cx.shown(node, ratio));
    cx.refuse(Diagnostic::error(node.span.clone(), message).help("a direct drive has `gear_ratio: 1`, the default"))
}

fn coulomb(cx: &Context, node: &Node, joint: usize) -> Option<[f64; 2]> {
    let places = [Entry::CoulombPositive(joint), Entry::CoulombNegative(joint)];
    let values: [f64; 2] =
        list(cx, node, "[Tc⁺, Tc⁻] (N m)", |cx, node, index| entry(*places.get(index)?)(cx, node))?;
    let Content::Sequence(items) = &node.content else { return None };
    let mut valid = true;
    for (item, value, sign, (name, rule)) in [
        (items.first(), values[0], 1.0, ("positive", "zero or positive")),
        (items.last(), values[1], -1.0, ("negative", "zero or negative")),
    ] {
        let Some(item) = item.filter(|_| sign * value < 0.0) else { continue };
        valid = false;
        let message = format!(
            "the Coulomb friction {} for {name} speed has the wrong sign; it must be {rule}",
            cx.shown(item, value)
        );
        cx.report(Diagnostic::error(item.span.clone(), message).help("the order is [Tc⁺, Tc⁻], Tc⁺ ≥ 0, Tc⁻ ≤ 0"));
    }
    valid.then_some(values)
}

fn angle(cx: &Context, node: &Node) -> Option<f64> {
    let value = fixed("the angle")(cx, node)?;
    if value.abs() >= LARGEST_ANGLE {
        let shown = cx.shown(node, value);
        let message = format!(
            "the angle {shown} rad is too large; angles must be below {LARGEST_ANGLE} rad, because a 64-bit float \
             stores larger angles in steps of more than 1e-9 rad"
        );
        return cx.refuse(Diagnostic::error(node.span.clone(), message).help("subtract whole turns from the angle"));
    }
    lint::angle(cx, node, value);
    Some(value)
}

fn length(place: Entry) -> impl Fn(&Context, &Node) -> Option<f64> {
    move |cx, node| {
        let value = entry(place)(cx, node)?;
        lint::length(cx, node, value);
        Some(value)
    }
}

/// A point or a displacement; `place` says where its components stand in the table.
pub(crate) fn position(cx: &Context, node: &Node, place: impl Fn(usize) -> Entry) -> Option<[f64; 3]> {
    list(cx, node, "[x, y, z] (m)", |cx, node, axis| length(place(axis))(cx, node))
}
